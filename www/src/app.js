import { addressOf, readAddress } from './session/address.js';
import { Comparison } from './controls/comparison.js';
import { Controls } from './controls/controls.js';
import { announce, byId } from './dom.js';
import { acceptFiles } from './session/files.js';
import * as format from './results/format.js';
import { helpDialog } from './help.js';
import { describeKeys, listenToKeys } from './keys.js';
import { Look } from './look/look.js';
import { tendMenus } from './menus.js';
import { MessageCard } from './results/messages.js';
import { Numbers } from './results/numbers.js';
import { ProgressBar } from './results/progress.js';
import { isSample } from './controls/samples.js';
import { Saving } from './session/saving.js';
import { Session } from './session/session.js';
import { SideCard } from './results/side.js';
import { Sharing } from './session/sharing.js';
import { meaningOf } from './controls/targets.js';

/**
 * @import { Key } from './keys.js'
 * @import { Outcome, Scan, State } from './session/session.js'
 * @import { SampleName } from './controls/samples.js'
 */

/** Puts the session, the picture and the controls together. */
export class App {
  #root = byId('app', HTMLElement);
  #session = new Session();
  #look = new Look(this.#root, () => this.#noteAddress());
  #numbers = new Numbers();
  #side = new SideCard((triangle) => this.#session.flip(triangle), (chosen) => this.#look.choosePiece(chosen));
  #sharing = new Sharing();
  #run = byId('run', HTMLButtonElement);
  #choose = acceptFiles((files) => this.#openFiles(files));
  #message = new MessageCard(this.#choose);
  #progress = new ProgressBar(() => this.#session.cancel());
  #saving = new Saving(this.#session, (error, name) => this.#message.showError(error, name));
  #controls = new Controls(this.#session.settings, () => this.#settingsChanged(), (target) => meaningOf(target, this.#session.scan));
  #comparison = new Comparison(this.#session, (count) => this.#keep(count), (error) => this.#message.showError(error, 'comparison'));

  constructor() {
    this.#listenToSession();
    this.#listenToControls();
    tendMenus();
  }

  /** Opens what the address asks for, by default the duck. */
  start() {
    const { words, sample, src, view, paint } = readAddress();
    this.#session.settings.read(words);
    this.#look.wish(view, paint);
    this.#controls.show(this.#session.target, 0);
    if (src && !sample) return this.#session.openAddress(src);
    return this.#session.openSample(sample ?? 'duck');
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
    on('turned', ({ outcome, piece }) => this.#turned(outcome, piece));
    on('cancelled', () => this.#cancelled());
    on('failed', ({ error, title }) => this.#failed(error, title));
  }

  #listenToControls() {
    byId('choose', HTMLButtonElement).addEventListener('click', this.#choose);
    this.#run.addEventListener('click', () => this.#session.run());
    for (const button of this.#samples()) {
      button.addEventListener('click', () => this.#session.openSample(/** @type {SampleName} */ (button.dataset.sample)));
    }
    addEventListener('hashchange', () => this.#addressChanged());
    /** @type {Key[]} */
    const keys = [
      ...this.#look.keys,
      { key: 'o', does: 'Open a scan from this device', act: this.#choose },
      { key: '?', does: 'This list', act: () => showHelp() },
      { key: 'Escape', shown: 'Esc', does: 'Close a message or menu, cancel the work', act: () => this.#escape() },
    ];
    const showHelp = helpDialog(describeKeys(keys));
    byId('help-open', HTMLButtonElement).addEventListener('click', showHelp);
    listenToKeys(keys);
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
    for (const button of this.#samples()) button.ariaPressed = String(button.dataset.sample === scan.model);
    document.title = `${scan.title} · Pointweave`;
    byId('caption-title', HTMLElement).textContent = scan.title;
    byId('caption-detail', HTMLElement).textContent = contentsOf(scan);
    byId('caption-size', HTMLElement).textContent = scan.frame.size.map(format.length).join(' × ');
    this.#look.opened(scan);
    this.#numbers.opened(scan);
    this.#side.show(null, { all: false, piece: false });
    this.#saving.offer(null);
    this.#controls.show(this.#session.target, scan.count);
    this.#noteAddress();
  }

  #made(/** @type {Outcome} */ outcome) {
    const { reduced, mesh } = outcome;
    this.#look.made(outcome);
    this.#numbers.made(outcome, this.#session.settings.options(this.#session.target));
    this.#side.show(mesh, { all: this.#flipped, piece: false });
    this.#saving.offer(outcome);
    this.#comparison.made(outcome);
    const kept = `Done: ${format.points(reduced.positions.length / 3)} kept`;
    announce(mesh ? `${kept}, ${format.count(mesh.indices.length / 3)} triangles` : `${kept}, no mesh`);
  }

  /** @param {Outcome} outcome @param {boolean} piece  not all of it */
  #turned(outcome, piece) {
    this.#look.made(outcome);
    this.#side.show(outcome.mesh, { all: this.#flipped, piece });
    this.#saving.offer(outcome);
    this.#controls.show(this.#session.target, outcome.scan.count);
    this.#noteAddress();
    announce(piece ? 'The piece was flipped' : 'The mesh was flipped');
  }

  get #flipped() {
    return this.#session.settings.get('flip') === true;
  }

  #cancelled() {
    announce('Cancelled');
    this.#run.hidden = !this.#session.scan;
  }

  #failed(/** @type {unknown} */ error, /** @type {string} */ title) {
    this.#message.showError(error, title);
    this.#run.hidden = !this.#session.scan || Boolean(this.#session.outcome);
  }

  #escape() {
    if (this.#message.open) this.#message.hide();
    else if (this.#side.choosing) this.#side.stop();
    else this.#session.cancel();
  }

  /** Keeps so many points: chosen in the chart. */
  #keep(/** @type {number} */ count) {
    this.#session.settings.target = { kind: 'count', value: count };
    this.#settingsChanged();
  }

  #settingsChanged() {
    this.#controls.show(this.#session.target, this.#session.scan?.count ?? 0);
    this.#noteAddress();
    this.#session.apply();
  }

  /** The address always says what is shown, so that it can be shared, kept and reloaded. */
  #noteAddress() {
    const { scan, settings } = this.#session;
    const address = addressOf(scan, settings, this.#look.state);
    if (scan) history.replaceState(null, '', address);
    this.#sharing.show(address, scan, `${scan?.file ?? 'scan'}-mesh.glb`);
  }

  /** Somebody put another # behind the same address. */
  #addressChanged() {
    const { words, sample, view, paint } = readAddress();
    this.#session.settings.read(words);
    this.#look.wish(view, paint);
    if (isSample(sample) && sample !== this.#session.scan?.model) this.#session.openSample(sample);
    else this.#settingsChanged();
  }

  #samples() {
    return /** @type {NodeListOf<HTMLButtonElement>} */ (document.querySelectorAll('[data-sample]'));
  }
}

/** What a scan holds, and what of its file was no point. */
function contentsOf(/** @type {Scan} */ { model, count, cloud }) {
  const { dropped = 0, faces = 0 } = cloud.file ?? {};
  const points = format.points(count) + (faces ? `, the corners of ${format.count(faces)} faces` : '');
  const rest = dropped ? `, ${format.count(dropped)} without a place left out` : '';
  return `${model ? 'simulated scan, ' : ''}${points}${rest}`;
}
