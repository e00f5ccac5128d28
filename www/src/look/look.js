import { announce, byId, element } from '../dom.js';
import { Legend } from './legend.js';
import { PAINTS, isPossible, paintOf } from './paints.js';
import { Split } from './split.js';
import { followTheme } from './theme.js';
import { likelyUp } from './upright.js';
import { Viewer } from '../viewer.js';

/**
 * @import { Key } from '../keys.js'
 * @import { Side } from '../orbit.js'
 * @import { Paint, PaintName } from './paints.js'
 * @import { Outcome, Scan } from '../session/session.js'
 * @import { View } from '../viewer.js'
 * @typedef {View | 'compare'} Choice
 */

const TURN = Math.PI / 24;
const VIEWS = /** @type {const} */ (['points', 'reduced', 'mesh', 'compare']);
const NAMES = { points: 'Scan', reduced: 'Reduced points', mesh: 'Mesh', compare: 'Comparison' };

/** How the scan and what was made of it are looked at: which view, in which colours, from where. */
export class Look {
  #root;
  #changed;
  #viewer = openViewer();
  #legend = new Legend();
  #views = byId('views', HTMLFieldSetElement);
  #paints = byId('paints', HTMLElement);
  #edges = byId('edges', HTMLInputElement);
  #parallel = byId('parallel', HTMLInputElement);
  #boxes = byId('boxes', HTMLInputElement);
  /** @type {Scan | null} */
  #scan = null;
  /** @type {Outcome | null} */
  #outcome = null;
  /** @type {Choice} */
  #view = 'points';
  /** The person's choice for this scan; finishing a job does not change it. @type {Choice | null} */
  #chosen = null;
  /** An address chose it, before its scan was there. */
  #wished = false;
  /** @type {PaintName} */
  #paint = 'natural';
  /** The layers that have these colours; the others get them when they are shown. @type {Map<View, Paint>} */
  #painted = new Map();
  #split = new Split(() => this.#show(this.#view));

  /**
   * @param {HTMLElement} root  told the view, for styles
   * @param {() => void} changed  another view or other colours
   */
  constructor(root, changed) {
    this.#root = root;
    this.#changed = changed;
    const viewer = this.#viewer;
    byId('no-webgl', HTMLElement).hidden = Boolean(viewer);
    this.#paints.append(...Object.entries(PAINTS).map(([name, words]) => paintChoice(name, words)));
    if (viewer) followTheme((theme) => viewer.setTheme(theme));
    byId('fit', HTMLButtonElement).addEventListener('click', () => viewer?.orbit.fit());
    byId('up', HTMLButtonElement).addEventListener('click', () => this.#turnUp());
    this.#views.addEventListener('change', (event) => this.#choose(/** @type {Choice} */ (valueOf(event))));
    this.#paints.addEventListener('change', (event) => this.#choosePaint(/** @type {PaintName} */ (valueOf(event))));
    this.#edges.addEventListener('change', () => viewer?.showEdges(this.#edges.checked));
    this.#boxes.addEventListener('change', () => this.#showBoxes());
    this.#parallel.addEventListener('change', () => viewer?.orbit.setParallel(this.#parallel.checked));
    for (const button of /** @type {NodeListOf<HTMLButtonElement>} */ (document.querySelectorAll('[data-side]'))) {
      button.addEventListener('click', () => this.#lookFrom(/** @type {Side} */ (button.dataset.side)));
    }
  }

  get state() {
    return { view: this.#chosen ?? 'mesh', paint: this.#paint };
  }

  /** What to show of the next scan, where an address says so. @param {string | null} view @param {string | null} paint */
  wish(view, paint) {
    const wanted = VIEWS.find((name) => name === view) ?? null;
    this.#chosen = wanted;
    this.#wished = wanted !== null;
    this.#paint = paint !== null && Object.hasOwn(PAINTS, paint) ? /** @type {PaintName} */ (paint) : 'natural';
    if (this.#outcome) this.#settle();
  }

  opened(/** @type {Scan} */ scan) {
    this.#scan = scan;
    this.#outcome = null;
    if (!this.#wished) this.#chosen = null;
    this.#wished = false;
    this.#viewer?.open(scan.cloud, scan.frame, likelyUp(scan));
    for (const view of VIEWS) radio('view', view).disabled = view !== 'points';
    this.#offerPaints();
    this.#show('points');
  }

  made(/** @type {Outcome} */ outcome) {
    this.#outcome = outcome;
    const { reduced, mesh } = outcome;
    this.#viewer?.set('reduced', reduced);
    this.#viewer?.set('mesh', mesh);
    for (const view of VIEWS) radio('view', view).disabled = view === 'mesh' && !mesh;
    this.#split.offerMesh(Boolean(mesh));
    this.#showBoxes();
    this.#settle();
  }

  /** @returns {Key[]} */
  get keys() {
    const orbit = this.#viewer?.orbit;
    const from = (/** @type {Side} */ side) => () => this.#lookFrom(side);
    return [
      ...VIEWS.map((view, i) => ({ key: String(i + 1), does: NAMES[view], act: () => this.#chooseByKey(view) })),
      { key: 'c', does: 'Next colours', act: () => this.#nextPaint() },
      { key: 'e', does: 'Edges of the triangles', act: () => this.#edges.click() },
      { key: 'b', does: 'Boxes of the octree', act: () => this.#boxes.click() },
      { key: 'f', does: 'Fit the view', act: () => orbit?.fit() },
      { key: 'u', does: 'Turn another side up', act: () => this.#turnUp() },
      { key: 'v', shown: 'V R T', does: 'Look from the front, the right, the top', act: from('front') },
      { key: 'r', act: from('right') },
      { key: 't', act: from('top') },
      { key: 'p', does: 'Perspective or parallel lines', act: () => this.#parallel.click() },
      { key: '+', also: ['='], shown: '+ −', does: 'Nearer, farther', act: () => orbit?.zoom(1 / 1.2) },
      { key: '-', act: () => orbit?.zoom(1.2) },
      { key: 'ArrowLeft', shown: '← → ↑ ↓', does: 'Turn, while the picture has the focus', act: () => orbit?.turn(-TURN, 0) },
      { key: 'ArrowRight', act: () => orbit?.turn(TURN, 0) },
      { key: 'ArrowUp', act: () => orbit?.turn(0, TURN) },
      { key: 'ArrowDown', act: () => orbit?.turn(0, -TURN) },
    ];
  }

  /** Shows what was chosen, or the best there is. */
  #settle() {
    const { mesh } = /** @type {Outcome} */ (this.#outcome);
    this.#offerPaints();
    const best = mesh ? 'mesh' : 'reduced';
    this.#show(this.#chosen && (mesh || this.#chosen !== 'mesh') ? this.#chosen : best);
  }

  #choose(/** @type {Choice} */ view) {
    this.#chosen = view;
    this.#show(view);
    this.#changed();
  }

  #chooseByKey(/** @type {Choice} */ view) {
    if (radio('view', view).disabled) return;
    this.#choose(view);
    announce(`${NAMES[view]} is shown`);
  }

  #show(/** @type {Choice} */ view) {
    this.#view = view;
    this.#root.dataset.view = view;
    radio('view', view).checked = true;
    const compared = view === 'compare';
    this.#split.show(compared);
    const { left, right } = this.#split.sides;
    if (compared) this.#color(left);
    const paint = this.#color(compared ? right : view);
    this.#legend.show(paint?.legend ?? null);
    this.#viewer?.show(compared ? { left, right, at: this.#split.at } : { view });
  }

  /** Gives a layer the chosen colours, unless it has them. */
  #color(/** @type {View} */ view) {
    const known = this.#painted.get(view);
    const drawn = view === 'points' || Boolean(this.#outcome?.[view]);
    if (known || !this.#scan || !drawn) return known;
    const paint = paintOf(this.#paint, view, { scan: this.#scan, outcome: this.#outcome });
    this.#viewer?.paint(view, paint);
    this.#painted.set(view, paint);
    return paint;
  }

  #choosePaint(/** @type {PaintName} */ name) {
    this.#paint = name;
    this.#offerPaints();
    this.#show(this.#view);
    this.#changed();
  }

  #nextPaint() {
    const subject = this.#subject;
    if (!subject) return;
    const names = /** @type {PaintName[]} */ (Object.keys(PAINTS)).filter((name) => isPossible(name, subject));
    const next = names[(names.indexOf(this.#paint) + 1) % names.length];
    this.#choosePaint(next);
    announce(`Colours: ${PAINTS[next]}`);
  }

  /** What can be chosen now; every layer is to be coloured anew. */
  #offerPaints() {
    this.#painted.clear();
    const subject = this.#subject;
    if (!subject) return;
    for (const name of /** @type {PaintName[]} */ (Object.keys(PAINTS))) {
      const input = radio('paint', name);
      input.disabled = !isPossible(name, subject);
      input.checked = name === this.#paint;
    }
  }

  /** The octree's sub-domains, where they are asked for. */
  #showBoxes() {
    const { cells, origin } = this.#outcome?.reduced ?? {};
    this.#viewer?.showBoxes(this.#boxes.checked && cells ? { positions: cells, origin } : null);
  }

  get #subject() {
    return this.#scan && { scan: this.#scan, outcome: this.#outcome };
  }

  #lookFrom(/** @type {Side} */ side) {
    this.#viewer?.orbit.look(side);
    this.#parallel.checked = true;
    announce(`Seen from the ${side}`);
  }

  #turnUp() {
    if (this.#viewer) announce(`${this.#viewer.orbit.nextUp()} is up`);
  }
}

/** The viewer, or null where there is no WebGL 2: the rest of the page works without it. */
function openViewer() {
  try {
    return new Viewer(byId('canvas', HTMLCanvasElement));
  } catch (error) {
    console.warn('Pointweave draws nothing:', error);
    return null;
  }
}

function paintChoice(/** @type {string} */ name, /** @type {string} */ words) {
  const label = element('label');
  label.append(element('input', { type: 'radio', name: 'paint', value: name }), element('span', { textContent: words }));
  return label;
}

function valueOf(/** @type {Event} */ event) {
  return /** @type {HTMLInputElement} */ (event.target).value;
}

function radio(/** @type {'view' | 'paint'} */ name, /** @type {string} */ value) {
  return /** @type {HTMLInputElement} */ (document.querySelector(`input[name="${name}"][value="${value}"]`));
}
