import { announce, byId } from './dom.js';
import { acceptFiles, saveFile } from './files.js';
import * as format from './format.js';
import { KeepControl } from './keep.js';
import { listenToKeys } from './keys.js';
import { MessageCard } from './messages.js';
import { Numbers } from './numbers.js';
import { ProgressBar } from './progress.js';
import { Session, keptOf } from './session.js';
import { followTheme } from './theme.js';
import { Viewer } from './viewer.js';

/**
 * @import { View } from './viewer.js'
 * @import { Outcome, Scan, State } from './session.js'
 */

/** The simulated scans, at the sizes of the paper's examples. */
const SAMPLES = /** @type {const} */ ({
  duck: { title: 'Toy duck', count: 35_647 },
  pig: { title: 'Toy pig', count: 171_875 },
  part: { title: 'Machined part', count: 60_000 },
});

const TURN = Math.PI / 24;

/** Puts the session, the picture and the controls together. */
export class App {
  #root = byId('app', HTMLElement);
  #session = new Session();
  #viewer = openViewer();
  #numbers = new Numbers();
  #run = byId('run', HTMLButtonElement);
  /** The person chose a view for this scan; finishing a job does not change it. */
  #viewChosen = false;
  #choose = acceptFiles((files) => this.#openFiles(files));
  #message = new MessageCard(this.#choose);
  #progress = new ProgressBar(() => this.#session.cancel());
  #keep = new KeepControl((share) => this.#describeKeep(share), (share) => this.#session.setShare(share));

  constructor() {
    this.#listenToSession();
    this.#listenToControls();
    this.#keep.set(this.#session.share);
    if (this.#viewer) followTheme((theme) => this.#viewer?.setTheme(theme));
    byId('no-webgl', HTMLElement).hidden = Boolean(this.#viewer);
  }

  openSample(/** @type {keyof typeof SAMPLES} */ model) {
    const { title, count } = SAMPLES[model];
    return this.#session.openSample(model, title, count);
  }

  #openFiles(/** @type {File[]} */ files) {
    if (!files.length) return;
    if (files.length > 1) announce(`One scan at a time: opening ${files[0].name}`);
    return this.#session.openFile(files[0]);
  }

  #listenToSession() {
    const on = (/** @type {string} */ type, /** @type {(detail: any) => void} */ act) =>
      this.#session.addEventListener(type, (event) => act(/** @type {CustomEvent} */ (event).detail));
    on('state', (/** @type {State} */ state) => this.#enter(state));
    on('opened', (/** @type {Scan} */ scan) => this.#opened(scan));
    on('progress', (progress) => this.#progress.update(progress));
    on('made', (/** @type {Outcome} */ outcome) => this.#made(outcome));
    on('cancelled', () => this.#cancelled());
    on('failed', ({ error, title }) => this.#failed(error, title));
  }

  #listenToControls() {
    byId('choose', HTMLButtonElement).addEventListener('click', this.#choose);
    byId('fit', HTMLButtonElement).addEventListener('click', () => this.#viewer?.orbit.fit());
    byId('up', HTMLButtonElement).addEventListener('click', () => this.#turnUp());
    this.#run.addEventListener('click', () => this.#session.run());
    for (const what of /** @type {const} */ (['mesh', 'reduced'])) {
      byId(`download-${what}`, HTMLButtonElement).addEventListener('click', () => this.#download(what));
    }
    for (const button of this.#samples()) {
      button.addEventListener('click', () => this.openSample(/** @type {keyof typeof SAMPLES} */ (button.dataset.sample)));
    }
    byId('views', HTMLFieldSetElement).addEventListener('change', (event) => {
      this.#viewChosen = true;
      this.#show(/** @type {View} */ (/** @type {HTMLInputElement} */ (event.target).value));
    });
    const orbit = this.#viewer?.orbit;
    listenToKeys(byId('stage', HTMLElement), {
      1: () => this.#chooseView('points'),
      2: () => this.#chooseView('reduced'),
      3: () => this.#chooseView('mesh'),
      f: () => orbit?.fit(),
      u: () => this.#turnUp(),
      Escape: () => this.#message.hide(),
      '+': () => orbit?.zoom(1 / 1.2),
      '=': () => orbit?.zoom(1 / 1.2),
      '-': () => orbit?.zoom(1.2),
      ArrowLeft: () => orbit?.turn(-TURN, 0),
      ArrowRight: () => orbit?.turn(TURN, 0),
      ArrowUp: () => orbit?.turn(0, TURN),
      ArrowDown: () => orbit?.turn(0, -TURN),
    });
  }

  #enter(/** @type {State} */ state) {
    this.#root.dataset.state = state;
    this.#run.hidden = true;
    if (state === 'reading') {
      this.#message.hide();
      this.#progress.start('Reading the scan');
    } else if (state === 'working') {
      this.#numbers.stale();
      this.#progress.start('Starting');
    } else {
      this.#progress.stop();
    }
  }

  #opened(/** @type {Scan} */ scan) {
    this.#mark(scan.model);
    document.title = `${scan.title} · Pointweave`;
    byId('caption-title', HTMLElement).textContent = scan.title;
    byId('caption-detail', HTMLElement).textContent = `${scan.model ? 'simulated scan, ' : ''}${format.count(scan.count)} points`;
    byId('caption-size', HTMLElement).textContent = scan.frame.size.map(format.length).join(' × ');
    this.#viewer?.open(scan.cloud, scan.frame);
    this.#viewChosen = false;
    this.#offer('reduced', false);
    this.#offer('mesh', false);
    this.#show('points');
    this.#numbers.opened(scan.count);
    this.#keep.set(this.#session.share);
    this.#describeKeep(this.#session.share);
  }

  #made(/** @type {Outcome} */ outcome) {
    const { reduced, mesh } = outcome;
    this.#viewer?.set('reduced', reduced);
    this.#viewer?.set('mesh', mesh);
    this.#offer('reduced', true);
    this.#offer('mesh', Boolean(mesh));
    this.#numbers.made(outcome);
    const current = /** @type {View} */ (this.#root.dataset.view);
    this.#show(this.#viewChosen && (mesh || current !== 'mesh') ? current : mesh ? 'mesh' : 'reduced');
    announce(mesh
      ? `Done: ${format.count(reduced.positions.length / 3)} points kept, ${format.count(mesh.indices.length / 3)} triangles`
      : `Done: ${format.count(reduced.positions.length / 3)} points kept, no mesh`);
  }

  #cancelled() {
    announce('Cancelled');
    this.#run.hidden = !this.#session.scan;
  }

  #failed(/** @type {unknown} */ error, /** @type {string} */ title) {
    this.#message.showError(error, title);
    this.#run.hidden = !this.#session.scan || Boolean(this.#session.outcome);
  }

  #show(/** @type {View} */ view) {
    this.#root.dataset.view = view;
    radio(view).checked = true;
    this.#viewer?.show(view);
  }

  #chooseView(/** @type {View} */ view) {
    if (radio(view).disabled) return;
    this.#viewChosen = true;
    this.#show(view);
    announce(`${radio(view).labels?.[0].innerText.replace(/\d/, '').trim()} is shown`);
  }

  /** Makes a view, and the download of what it shows, possible or not. */
  #offer(/** @type {'reduced' | 'mesh'} */ view, /** @type {boolean} */ possible) {
    radio(view).disabled = !possible;
    byId(`download-${view}`, HTMLButtonElement).disabled = !possible;
  }

  #describeKeep(/** @type {number} */ share) {
    const scan = this.#session.scan;
    if (!scan) return;
    this.#keep.describe(`${format.count(keptOf(scan.count, share))} of ${format.count(scan.count)} points. Curved places keep more.`);
  }

  #turnUp() {
    if (this.#viewer) announce(`${this.#viewer.orbit.nextUp()} is up`);
  }

  async #download(/** @type {'reduced' | 'mesh'} */ what) {
    const name = `${this.#session.outcome?.scan.file}-${what}.ply`;
    try {
      saveFile(/** @type {Uint8Array<ArrayBuffer>} */ (await this.#session.ply(what)), name);
      announce(`${name} saved`);
    } catch (error) {
      this.#message.showError(error, name);
    }
  }

  /** Marks the open sample in the gallery, or none. */
  #mark(/** @type {string | undefined} */ model) {
    for (const button of this.#samples()) button.ariaPressed = String(button.dataset.sample === model);
  }

  #samples() {
    return /** @type {NodeListOf<HTMLButtonElement>} */ (document.querySelectorAll('[data-sample]'));
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

function radio(/** @type {View} */ view) {
  const input = document.querySelector(`input[name="view"][value="${view}"]`);
  return /** @type {HTMLInputElement} */ (input);
}
