import { PAINTS, canPaint, createViewer, paintOf } from 'pointweave/viewer';
import { announce, element, radio } from '../dom.js';
import { page } from '../page.js';
import * as format from '../results/format.js';
import { say } from '../words/say.js';
import { Legend } from './legend.js';
import { tellWhenLost } from './lost.js';
import { NAMES, SIDES } from './names.js';
import { WORDS, size } from './paint-words.js';
import { Painting } from './painting.js';
import { PieceChoice } from './piece.js';
import { Split } from './split.js';
import { followTheme } from './theme.js';

/**
 * @import { Axis, Paint, PaintName, Side, Subject } from 'pointweave/viewer'
 * @import { Key } from '../keys.js'
 * @import { Outcome, Scan } from '../session/session.js'
 * @typedef {'points' | 'reduced' | 'mesh' | 'kept' | 'light'} View `kept`: a mesh of other settings, to compare with; `light`: a model with pictures
 * @typedef {'points' | 'reduced' | 'mesh' | 'compare'} Choice
 */

/** Room for what lies over the picture, in CSS pixels. On narrow and on low screens the tools stand at the right. */
const INSETS = { top: 72, bottom: 76 };
const ASIDE = '(max-width: 1239px), (max-height: 500px)';
const TOOLS = 60;

/** The ways to stand a scan upright, in the order in which the button goes through them: toys and statues, land and rooms, depth cameras (whose y points down), and the rest. @type {Record<Axis, string>} */
const UPS = { y: 'Y', z: 'Z', '-y': '−Y', '-z': '−Z', x: 'X', '-x': '−X' };

/** Paints that cost nothing: colours that are there already. */
const READY = new Set(['natural', 'plain']);

const VIEWS = /** @type {const} */ (['points', 'reduced', 'mesh', 'compare']);

/** How the scan and what was made of it are looked at: which view, in which colours, from where. */
export class Look {
  #root;
  #changed;
  #turned;
  #viewer = openViewer();
  #legend = new Legend();
  #views = page.views;
  #paints = page.paints;
  #edges = page.edges;
  #parallel = page.parallel;
  #boxes = page.boxes;
  #pointSize = page.pointSize;
  /** @type {Scan | null} */
  #scan = null;
  /** @type {Outcome | null} */
  #outcome = null;
  /** What was kept to be compared with. @type {Outcome | null} */
  #kept = null;
  /** It has been put beside another. */
  #beside = false;
  #keep = page.keepMesh;
  /** @type {Choice} */
  #view = 'points';
  /** The scan has colours that say what would be cut off. */
  #marked = false;
  /** Which side of the whole scan is up, where nobody says. @type {Axis} */
  #likely = 'y';
  /** The person's choice for this scan; finishing a job does not change it. @type {Choice | null} */
  #chosen = null;
  /** An address chose it, before its scan was there. */
  #wished = false;
  /** @type {PaintName} */
  #paint = 'natural';
  /** The layers that have these colours; the others get them when they are shown. @type {Map<View, Paint>} */
  #painted = new Map();
  #painting = new Painting();
  /** Layers whose colours are being made. @type {Set<View>} */
  #awaited = new Set();
  #piece = new PieceChoice(page.canvas, (x, y) => this.#viewer?.pick(x, y) ?? null, () => this.#viewer?.insets ?? { left: 0, right: 0 });
  #split = new Split(() => this.#show(this.#view), (view) => this.#viewer && (this.#viewer.view = view));

  /**
   * @param {HTMLElement} root  told the view, for styles
   * @param {() => void} changed  another view or other colours
   * @param {() => void} turned  another side is up
   */
  constructor(root, changed, turned) {
    this.#root = root;
    this.#changed = changed;
    this.#turned = turned;
    const viewer = this.#viewer;
    page.noWebgl.hidden = Boolean(viewer);
    this.#paints.append(...PAINTS.map((name) => paintChoice(name, WORDS.names[name])));
    if (viewer) {
      followTheme((theme) => (viewer.colors = theme));
      tellWhenLost(viewer);
    }
    page.canvas.addEventListener('dblclick', ({ offsetX, offsetY }) => {
      const place = this.placeAt(offsetX, offsetY);
      if (place) viewer?.pivot(place);
    });
    page.fit.addEventListener('click', () => viewer?.fit());
    page.up.addEventListener('click', () => this.#turnUp());
    this.#views.addEventListener('change', (event) => this.#choose(/** @type {Choice} */ (valueOf(event))));
    this.#paints.addEventListener('change', (event) => this.#choosePaint(/** @type {PaintName} */ (valueOf(event))));
    this.#edges.addEventListener('change', () => viewer?.showEdges(this.#edges.checked));
    this.#boxes.addEventListener('change', () => this.#showBoxes());
    this.#pointSize.addEventListener('input', () => this.#sizePoints());
    this.#keep.addEventListener('click', () => this.#keepMesh());
    this.#parallel.addEventListener('change', () => viewer && (viewer.parallel = this.#parallel.checked));
    for (const button of /** @type {NodeListOf<HTMLButtonElement>} */ (document.querySelectorAll('[data-side]'))) {
      button.addEventListener('click', () => this.#lookFrom(/** @type {Side} */ (button.dataset.side)));
    }
  }

  get state() {
    return { view: this.#chosen ?? 'mesh', paint: this.#paint };
  }

  /** What to show of the next scan, where an address says so. @param {string | null} view @param {string | null} paint */
  wish(view, paint) {
    this.#chosen = VIEWS.find((name) => name === view) ?? null;
    this.#wished = this.#chosen !== null;
    this.#paint = PAINTS.find((name) => name === paint) ?? 'natural';
    if (this.#outcome) this.#settle();
  }

  opened(/** @type {Scan} */ scan) {
    if (!this.#wished) this.#chosen = null;
    this.#wished = false;
    if (this.#viewer) this.#viewer.up = 'auto';
    this.#open(scan);
    this.#likely = this.upright;
  }

  /** Something was cut off, or is there again. What is left is looked at from the same side. */
  cut(/** @type {Scan} */ scan) {
    const viewer = this.#viewer;
    const before = viewer?.pose;
    // What stands on a floor may be taller than wide.
    if (viewer?.up === 'auto' && !scan.cloud.up) viewer.up = this.#likely;
    this.#open(scan);
    if (!viewer || !before) return;
    const { azimuth, elevation } = viewer.pose;
    viewer.turn(((before.azimuth - azimuth) * Math.PI) / 180, ((before.elevation - elevation) * Math.PI) / 180);
    viewer.fit();
  }

  #open(/** @type {Scan} */ scan) {
    this.#scan = scan;
    this.#outcome = this.#kept = null;
    this.#painting.reset();
    this.#keep.hidden = true;
    this.#split.offerKept(false);
    this.#viewer?.show(bare({ ...scan.cloud, normals: undefined }), { frame: scan.frame });
    for (const view of VIEWS) radio('view', view).disabled = view !== 'points';
    this.#offerPaints();
    this.#show('points');
  }

  made(/** @type {Outcome} */ outcome) {
    this.#outcome = outcome;
    const { reduced, mesh } = outcome;
    this.#viewer?.set('reduced', bare({ ...reduced, oriented: Boolean(mesh) }));
    this.#viewer?.set('mesh', mesh && bare(mesh));
    for (const view of VIEWS) radio('view', view).disabled = view === 'mesh' && !mesh;
    this.#split.offerMesh(Boolean(mesh));
    this.#keep.hidden = !mesh;
    this.#showBoxes();
    if (this.#kept && mesh && !this.#beside) {
      this.#beside = true;
      this.#split.putBeside();
      this.#chosen = 'compare';
      this.#changed();
    }
    this.#settle();
  }

  /** Keeps the mesh, so that the next one is shown beside it. */
  #keepMesh() {
    const outcome = this.#outcome;
    if (!outcome?.mesh) return;
    this.#kept = outcome;
    this.#beside = false;
    this.#viewer?.set('kept', bare(outcome.mesh));
    this.#offerPaints();
    this.#split.offerKept(true);
    this.#show(this.#view);
    announce(say('The mesh is kept. The next one is shown beside it.'));
  }

  /** Puts a light model beside the scan, as it would be saved; null takes it away. @param {import('pointweave').SurfaceMesh | null} model */
  showLight(model) {
    this.#viewer?.set('light', model);
    this.#split.offerLight(Boolean(model));
    if (model) this.#view = 'compare';
    if (this.#scan) this.#show(this.#view);
  }

  /** Has the person choose a triangle of the mesh in the picture, or no more. @param {import('./piece.js').Chosen | null} chosen */
  choosePiece(chosen) {
    if (chosen && this.#view !== 'mesh' && this.#view !== 'compare') this.#show('mesh');
    this.#piece.ask(chosen);
  }

  /**
   * Shows the scan in these colours, whatever is made meanwhile; null: what was shown before.
   * @param {Uint8Array | null} colors
   */
  mark(colors) {
    if (!colors && !this.#marked) return;
    this.#marked = colors !== null;
    this.#painted.delete('points');
    if (!colors) return this.#show(this.#view);
    this.#root.dataset.view = 'points';
    this.#legend.show(null, false);
    this.#split.show(false);
    if (!this.#viewer) return;
    this.#viewer.paint('points', { colors, legend: null });
    this.#viewer.view = 'points';
  }

  /** The place of the scan or of a mesh that is seen there, in CSS pixels; in the coordinates of the file. @param {number} x @param {number} y */
  placeAt(x, y) {
    return (this.#viewer?.pick(x, y) ?? this.#viewer?.pickPoint(x, y))?.position ?? null;
  }

  /** Leaves room at the lower edge, in CSS pixels; by default that for the views. @param {number} [height] */
  leave(height = INSETS.bottom) {
    if (this.#viewer) this.#viewer.insets = { bottom: height };
  }

  /** The box of what is shown. */
  get frame() {
    return this.#scan?.frame ?? null;
  }

  /** Where things are in the picture; null where there is none. @returns {import('pointweave/viewer').Viewer | null} */
  get aim() {
    return this.#viewer;
  }

  /** @returns {Key[]} */
  get keys() {
    const viewer = this.#viewer;
    const from = (/** @type {Side} */ side) => () => this.#lookFrom(side);
    return [
      ...VIEWS.map((view, i) => ({ key: String(i + 1), does: say(NAMES[view]), act: () => this.#chooseByKey(view) })),
      { key: 'c', does: say('Next colours'), act: () => this.#nextPaint() },
      { key: 'e', does: say('Edges of the triangles'), act: () => this.#edges.click() },
      { key: 'b', does: say('Boxes of the octree'), act: () => this.#boxes.click() },
      { key: 'f', does: say('Fit the view'), act: () => viewer?.fit() },
      { key: 'Double click', shown: say('Double click'), does: say('Turn around this place') },
      { key: 'u', does: say('Turn another side up'), act: () => this.#turnUp() },
      { key: 'v', shown: 'V R T', does: say('Look from the front, the right, the top'), act: from('front') },
      { key: 'r', act: from('right') },
      { key: 't', act: from('top') },
      { key: 'p', does: say('Perspective or parallel lines'), act: () => this.#parallel.click() },
      { key: '+', also: ['='], shown: '+ −', does: say('Nearer, farther'), act: () => viewer?.zoom(1 / 1.2) },
      { key: '-', act: () => viewer?.zoom(1.2) },
      { key: 'Arrows', shown: '← → ↑ ↓', does: say('Turn, while the picture has the focus') },
      { key: 'Home', does: say('The first look, while the picture has the focus') },
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
    announce(say('{view} is shown', { view: say(NAMES[view]) }));
  }

  #show(/** @type {Choice} */ view) {
    this.#view = view;
    if (this.#marked) return;
    this.#root.dataset.view = view;
    radio('view', view).checked = true;
    const compared = view === 'compare';
    this.#split.show(compared);
    const { left, right } = this.#split.sides;
    this.#split.describe((side) => (side === 'kept' ? this.#kept : this.#outcome));
    if (compared) this.#color(left);
    const seen = compared ? right : /** @type {View} */ (view);
    const paint = this.#color(seen);
    this.#legend.show(paint?.legend ?? null, this.#awaited.has(seen));
    if (this.#viewer) this.#viewer.view = compared ? this.#split.view : view;
  }

  /** Gives a layer the chosen colours, unless it has them; a light model keeps its pictures. */
  #color(/** @type {View} */ view) {
    if (view === 'light') return undefined;
    const known = this.#painted.get(view);
    const [layer, outcome] = view === 'kept' ? /** @type {const} */ (['mesh', this.#kept]) : [view, this.#outcome];
    const subject = this.#subjectOf(outcome);
    const drawn = layer === 'points' || Boolean(outcome?.[layer]);
    if (known || !subject || !drawn) return known;
    if (READY.has(this.#paint) || !canPaint(this.#paint, subject)) return this.#put(view, paintOf(this.#paint, layer, subject, WORDS));
    if (!this.#awaited.has(view)) this.#make(view, layer, subject);
    return undefined;
  }

  /** Has colours made that take a while. @param {View} view @param {'points' | 'reduced' | 'mesh'} layer @param {Subject} subject */
  async #make(view, layer, subject) {
    const awaited = this.#awaited.add(view);
    this.#root.dataset.painting = '';
    const paint = await this.#painting.paint(this.#paint, layer, subject, () => awaited === this.#awaited);
    if (!paint || awaited !== this.#awaited) return;
    awaited.delete(view);
    if (!awaited.size) delete this.#root.dataset.painting;
    this.#put(view, paint);
    this.#show(this.#view);
  }

  #put(/** @type {View} */ view, /** @type {Paint} */ paint) {
    if (this.#marked && view === 'points') return paint;
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
    const names = PAINTS.filter((name) => canPaint(name, subject));
    const next = names[(names.indexOf(this.#paint) + 1) % names.length];
    this.#choosePaint(next);
    announce(say('Colours: {name}', { name: WORDS.names[next] }));
  }

  /** What can be chosen now; every layer is to be coloured anew. */
  #offerPaints() {
    this.#painted.clear();
    this.#awaited = new Set();
    delete this.#root.dataset.painting;
    const subject = this.#subject;
    if (!subject) return;
    for (const name of PAINTS) {
      const input = radio('paint', name);
      input.disabled = !canPaint(name, subject);
      input.checked = name === this.#paint;
    }
  }

  /** The octree's sub-domains, where they are asked for. */
  #showBoxes() {
    const { cells, origin } = this.#outcome?.reduced ?? {};
    this.#viewer?.showBoxes(this.#boxes.checked && cells ? { positions: cells, origin } : null);
  }

  /** The slider's steps multiply: its middle is the size that points have of themselves, its ends a quarter and four times that. */
  #sizePoints() {
    const scale = 4 ** this.#pointSize.valueAsNumber;
    if (this.#viewer) this.#viewer.pointSize = scale;
    this.#pointSize.setAttribute('aria-valuetext', format.times(scale));
  }

  /** The picture as it is shown, without what lies over it. @param {string} type @param {number} [quality] */
  async picture(type, quality) {
    return (await this.#viewer?.toBlob(type, quality)) ?? null;
  }

  get #subject() {
    return this.#subjectOf(this.#outcome);
  }

  #subjectOf(/** @type {Outcome | null} */ outcome) {
    const { cloud, frame } = this.#scan ?? {};
    const other = outcome === this.#kept ? this.#outcome : this.#kept;
    return cloud && { cloud, frame, reduced: outcome?.reduced, mesh: outcome?.mesh, beside: other?.mesh };
  }

  #lookFrom(/** @type {Side} */ side) {
    this.#viewer?.lookFrom(side);
    this.#parallel.checked = true;
    announce(say('Seen from this side: {side}', { side: say(SIDES[side]) }));
  }

  #turnUp() {
    if (!this.#viewer) return;
    const axes = /** @type {Axis[]} */ (Object.keys(UPS));
    const next = axes[(axes.indexOf(this.#viewer.upright) + 1) % axes.length];
    this.#viewer.up = next;
    this.#turned();
    announce(say('{side} is up', { side: UPS[next] }));
  }

  /** Which side is up; without a picture, as of most objects. */
  get upright() {
    return this.#viewer?.upright ?? 'y';
  }

  /** The unit or the size has changed: legends say lengths anew. @param {number} scale */
  relabel(scale) {
    size.scale = scale;
    if (!this.#scan) return;
    this.#offerPaints();
    this.#show(this.#view);
  }

  /** Stands what is shown on another side, or on a plane with that normal. */
  stand(/** @type {Axis | [number, number, number] | 'auto'} */ up) {
    if (this.#viewer) this.#viewer.up = up === 'auto' && this.#scan?.kept && !this.#scan.cloud.up ? this.#likely : up;
  }
}

/** The viewer, or null where there is no WebGL 2: the rest of the page works without it. */
function openViewer() {
  try {
    const viewer = createViewer(page.canvas, { embedded: false, insets: INSETS });
    const aside = matchMedia(ASIDE);
    const follow = () => (viewer.insets = { right: aside.matches ? TOOLS : 0 });
    aside.addEventListener('change', follow);
    follow();
    return viewer;
  } catch (error) {
    console.warn('Pointweave draws nothing:', error);
    return null;
  }
}

/** Without its colours: paints give it some. @template {import('pointweave/viewer').Drawable} Source @param {Source} source */
function bare(source) {
  return { ...source, colors: undefined };
}

function paintChoice(/** @type {string} */ name, /** @type {string} */ words) {
  const label = element('label');
  label.append(element('input', { type: 'radio', name: 'paint', value: name }), element('span', { textContent: words }));
  return label;
}

function valueOf(/** @type {Event} */ event) {
  return /** @type {HTMLInputElement} */ (event.target).value;
}
