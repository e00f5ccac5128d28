import { addressOf, readAddress } from './session/address.js';
import { Comparison } from './controls/comparison.js';
import { Controls } from './controls/controls.js';
import { announce } from './dom.js';
import { page } from './page.js';
import { acceptFiles } from './session/files.js';
import * as format from './results/format.js';
import { helpDialog } from './help.js';
import { describeKeys, listenToKeys } from './keys.js';
import { Look } from './look/look.js';
import { tendMenus } from './menus.js';
import { MessageCard } from './results/messages.js';
import { offerPictures } from './session/pictures.js';
import { Numbers } from './results/numbers.js';
import { Opening } from './controls/opening.js';
import { ProgressBar } from './results/progress.js';
import { MESSY, isSample } from './controls/samples.js';
import { Saving } from './session/saving.js';
import { Section } from './look/section.js';
import { Session } from './session/session.js';
import { Standing } from './controls/standing.js';
import { SideCard } from './results/side.js';
import { Sharing } from './session/sharing.js';
import { Shown } from './state/shown.js';
import { kept } from './state/keeping.js';
import { Steps } from './controls/steps.js';
import { fromOf, same } from './state/from.js';
import { contentsOf } from './results/contents.js';
import { stepsOf, switchedOff } from './tidy/recipe.js';
import { Suggestion } from './tidy/suggestion.js';
import { Tidy } from './tidy/tidy.js';
import { Measure } from './measure/measure.js';
import { meaningOf } from './controls/targets.js';
import { say } from './words/say.js';

/**
 * @import { Key } from './keys.js'
 * @import { Part } from './session/parts.js'
 * @import { Outcome, Scan, State } from './session/session.js'
 * @import { SampleName } from './controls/samples.js'
 * @import { Edits, Listed, Value } from './state/shown.js'
 */

/** @type {Record<string, [number, number, number]>} */
const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1], '-x': [-1, 0, 0], '-y': [0, -1, 0], '-z': [0, 0, -1] };

/** Puts the session, the picture and the controls together. */
export class App {
  #root = page.app;
  #session = new Session();
  #shown = new Shown(addressOf);
  #steps = new Steps(this.#shown);
  #look = new Look(this.#root, () => this.#shown.change({ look: this.#look.state }, { step: false }), () => this.#stand({ up: this.#look.upright }));
  #standing = new Standing((stand) => this.#stand(stand), (chosen) => {
    if (chosen) this.#side.stop();
    this.#look.choosePiece(chosen);
  });
  #tidy = new Tidy(this.#session, this.#look, (recipe) => this.#recut(recipe), () => this.#clear());
  #section = new Section(this.#look, () => this.#clear());
  #measure = new Measure(this.#look, (size) => this.#stand(size), () => this.#tidy.stop());
  #suggestion = new Suggestion(this.#session, () => this.#tidy.start('floor'));
  /** What an address wants to be cut off the scan that it names, or the next that a person opens. @type {Listed[]} */
  #awaited = [];
  #numbers = new Numbers();
  #side = new SideCard((triangle) => this.#flip(triangle), (chosen) => {
    if (chosen) this.#standing.stop();
    this.#look.choosePiece(chosen);
  });
  #sharing = new Sharing();
  #run = page.run;
  #choose = acceptFiles((files) => this.#opening.open(files));
  #message = new MessageCard(this.#choose);
  #opening = new Opening(this.#session, this.#message, (parts) => this.#show(parts), () => this.#recut([{ step: 'register' }, ...(this.#shown.value.edits.recipe ?? [])]));
  #progress = new ProgressBar(() => this.#session.cancel());
  #saving = new Saving(this.#session, this.#look, (error, name) => this.#message.showError(error, name), (how) => this.#closeHoles(how));
  #controls = new Controls(this.#session.settings, () => this.#settingsChanged(), (target) => meaningOf(target, this.#session.scan));
  #comparison = new Comparison(this.#session, (count) => this.#keep(count), (error) => this.#message.showError(error, say('comparison')));

  constructor() {
    this.#listenToSession();
    this.#listenToControls();
    tendMenus();
  }

  /** Opens what the address asks for, by default the duck. */
  start() {
    const recalled = this.#shown.recall();
    if (recalled) return this.#follow(recalled);
    const { words, sample, src, recipe, view, paint } = readAddress();
    this.#session.settings.read(words);
    this.#awaited = recipe;
    this.#look.wish(view, paint);
    this.#controls.show(this.#session.target, 0);
    if (!src || sample) return this.#session.openSample(sample ?? 'duck');
    return this.#session.openAddress(src);
  }

  /** Shows other parts of the scan, as a step that can be undone. @param {Part[]} parts */
  #show(parts) {
    const { scan } = this.#shown.value;
    if (!scan || !('key' in scan)) return;
    this.#note({ scan: { ...scan, parts } });
    this.#opening.parts(parts, scan.key);
  }

  /** What works in the picture is put away. */
  #clear() {
    this.#tidy.stop();
    this.#measure.stop();
    this.#section.stop();
  }

  /** Shows another value: a step of the history, or what a reload finds. */
  async #follow(/** @type {Value} */ { scan, settings, look, edits }) {
    const session = this.#session;
    this.#message.hide();
    session.settings.take(settings);
    this.#look.wish(look.view, look.paint);
    this.#controls.show(session.target, session.scan?.count ?? 0);
    if (session.scan && same(scan, fromOf(session.scan))) {
      if (this.#root.dataset.state === 'reading') session.cancel(); // another scan was on its way
      this.#edit(edits);
      session.apply(); // begins at once, if at all; #made then turns the pieces
      if (session.outcome && !session.busy && !same(session.turned, edits.turned ?? [])) session.turn(edits.turned ?? []);
    } else if (scan && 'key' in scan) {
      const found = await kept(scan.key);
      if (this.#shown.value.scan !== scan) return; // another step came
      if (found) return this.#opening.kept(found, scan);
      this.#message.show('kept-no-more', scan.key, { standIn: !session.scan });
      this.#stay();
      if (!session.scan) await session.openSample('duck');
    } else if (scan && 'src' in scan) await session.openAddress(scan.src);
    else await session.openSample(scan?.model ?? 'duck');
  }

  #listenToSession() {
    const session = this.#session;
    session.on('state', (state) => this.#enter(state));
    session.on('opened', (scan) => this.#opened(scan));
    session.on('cut', (scan) => this.#left(scan));
    session.on('progress', (progress) => this.#progress.update(progress));
    session.on('made', (outcome) => this.#made(outcome));
    session.on('turned', (outcome) => this.#turned(outcome));
    session.on('cancelled', () => this.#cancelled());
    session.on('failed', (failure) => this.#failed(failure));
    this.#shown.on('changed', (value) => this.#noteAddress(value));
    this.#shown.on('moved', (value) => (value ? this.#follow(value) : this.#addressChanged()));
  }

  #listenToControls() {
    page.choose.addEventListener('click', this.#choose);
    page.skip.addEventListener('click', (event) => {
      event.preventDefault(); // another # would be another address
      page.panel.focus();
    });
    this.#run.addEventListener('click', () => this.#session.run());
    for (const button of this.#samples()) {
      button.addEventListener('click', () => this.#openSample(/** @type {SampleName} */ (button.dataset.sample)));
    }
    const savePicture = offerPictures((type, quality) => this.#look.picture(type, quality), () => this.#session.scan?.file ?? 'scan', (name) => this.#sharing.posted(name));
    /** @type {Key[]} */
    const keys = [
      ...this.#look.keys,
      ...this.#steps.keys,
      { key: 'm', does: say('Measure in the picture'), act: () => this.#measure.toggle() },
      { key: 'x', does: say('Section plane'), act: () => this.#section.toggle() },
      { key: 's', does: say('Save the picture'), act: savePicture },
      { key: 'o', does: say('Open a scan from this device'), act: this.#choose },
      { key: '?', does: say('This list'), act: () => showHelp() },
      { key: 'Escape', shown: 'Esc', does: say('Close a message or menu, cancel the work'), act: () => this.#escape() },
    ];
    const showHelp = helpDialog(describeKeys(keys));
    page.helpOpen.addEventListener('click', showHelp);
    listenToKeys(keys);
  }

  #openSample(/** @type {SampleName} */ model) {
    this.#message.hide();
    return this.#session.openSample(model);
  }

  #enter(/** @type {State} */ state) {
    this.#root.dataset.state = state;
    this.#side.busy = state !== 'ready';
    this.#run.hidden = true;
    if (state === 'reading') {
      this.#progress.start(say('Reading the scan'));
    } else if (state === 'working') {
      this.#numbers.stale();
      this.#progress.start(say('Starting'));
    } else {
      this.#progress.stop();
    }
  }

  #opened(/** @type {Scan} */ scan) {
    for (const button of this.#samples()) button.ariaPressed = String(button.dataset.sample === scan.model);
    document.title = `${scan.title} · Pointweave`;
    page.captionTitle.textContent = scan.title;
    this.#look.opened(scan);
    const known = same(fromOf(scan), this.#shown.value.scan);
    const edits = known ? this.#shown.value.edits : this.#wanted(scan);
    this.#tidy.opened();
    this.#measure.stop();
    this.#section.stop();
    this.#edit(edits);
    this.#showStanding(scan);
    this.#reset(scan);
    this.#note(known ? {} : { scan: fromOf(scan), edits }, { step: !known });
    this.#opening.opened(scan, known);
    if ((scan.model && !MESSY.includes(scan.model)) || edits.recipe?.length) this.#suggestion.hide();
    else this.#suggestion.opened(scan);
  }

  /** What an address wants to be done to a scan: to the one that it names, or to the first that a person opens. @returns {Edits} */
  #wanted(/** @type {Scan} */ scan) {
    if (scan.model && !readAddress().sample) return {};
    const recipe = this.#awaited;
    this.#awaited = [];
    return recipe.length ? { recipe } : {};
  }

  /** Nothing was made of this scan yet. */
  #reset(/** @type {Scan} */ scan) {
    page.captionDetail.textContent = contentsOf(scan, this.#session.whole?.count);
    this.#showSize(scan);
    this.#numbers.opened(scan);
    this.#side.show(null, { all: false, piece: false });
    this.#saving.offer(null);
    this.#controls.show(this.#session.target, scan.count);
  }

  /** Something was cut off the scan, or is there again. */
  #left(/** @type {Scan} */ scan) {
    this.#look.cut(scan);
    this.#reset(scan);
    this.#showStanding(scan);
    this.#opening.registered(scan);
    this.#section.refit();
    this.#tidy.left();
  }

  /** Another recipe, as a step that can be undone. */
  #recut(/** @type {Listed[]} */ recipe) {
    const { turned, recipe: before, ...rest } = this.#shown.value.edits;
    const edits = recipe.length ? { ...rest, recipe } : rest;
    this.#suggestion.hide();
    this.#edit(edits);
    this.#note({ edits });
    this.#session.apply();
  }

  #made(/** @type {Outcome} */ outcome) {
    const { reduced, mesh } = outcome;
    const { turned = [] } = this.#shown.value.edits;
    if (mesh && turned.length) this.#session.turn(turned); // which shows and offers it
    else this.#offer(outcome, false);
    this.#showStanding(outcome.scan);
    this.#numbers.made(outcome, this.#session.settings.options(this.#session.target));
    this.#comparison.made(outcome);
    const points = format.count(reduced.positions.length / 3);
    announce(mesh ? say('Done: {points} points kept, {triangles} triangles', { points, triangles: format.count(mesh.indices.length / 3) }) : say('Done: {points} points kept, no mesh', { points }));
  }

  /** A person turns a piece over, or all. @param {number} [triangle] */
  #flip(triangle) {
    const session = this.#session;
    if (triangle === undefined) session.flip();
    else session.turn([...session.turned, triangle]);
    this.#note({ edits: { ...this.#shown.value.edits, turned: session.turned } });
    announce(triangle === undefined ? say('The mesh was flipped') : say('The piece was flipped'));
  }

  /** Shows what was made, and offers files of it. @param {Outcome} outcome @param {boolean} piece whether one was turned by hand */
  #offer(outcome, piece) {
    this.#look.made(outcome);
    this.#side.show(outcome.mesh, { all: this.#flipped, piece });
    this.#saving.offer(outcome);
  }

  #turned(/** @type {Outcome} */ outcome) {
    this.#offer(outcome, this.#session.turned.length > 0);
    this.#controls.show(this.#session.target, outcome.scan.count);
  }

  /** Which way is up, and the unit, as a person says it. */
  #stand(/** @type {import('./controls/standing.js').Stand} */ stand) {
    if (!this.#session.scan) return;
    const edits = { ...this.#shown.value.edits, ...stand };
    this.#edit(edits);
    this.#note({ edits });
  }

  /** Which way is up, and the unit: of the picture, the scan and whatever is saved of it. What nobody said is as the file says it. */
  #edit(/** @type {Edits} */ { up, unit, scale = 1, recipe = [] }) {
    const session = this.#session;
    const { scan, outcome } = session;
    if (!scan) return;
    session.recipe = stepsOf(recipe);
    this.#tidy.show(recipe);
    const before = { ...scan.cloud };
    const { stale } = session;
    session.stand({ up: typeof up === 'string' ? AXES[up] : up ?? scan.own.up, unit: unit ?? scan.own.unit });
    const isTurned = !same(before.up, scan.cloud.up);
    const isMeasured = before.unit !== scan.cloud.unit || scale !== session.scale;
    session.scale = scale;
    this.#measure.size = { scale, unit: scan.cloud.unit };
    if (!isTurned && !isMeasured) return;
    if (isTurned) this.#look.stand(up ?? 'auto');
    this.#showStanding(scan);
    if (session.stale !== stale) this.#run.hidden = stale;
    if (isMeasured) {
      this.#showSize(scan);
      this.#numbers.measure(scan.cloud.unit, scale);
      this.#look.relabel(scale);
    }
    if (outcome) this.#saving.offer(outcome);
  }

  /** How the scan stands, and whether what was made of it would be another now. */
  #showStanding(/** @type {Scan} */ { cloud: { up, unit } }) {
    const picked = up !== undefined && !Object.values(AXES).some((axis) => axis.every((x, i) => Math.abs(x - up[i]) < 1e-6));
    const mesh = Boolean(this.#session.outcome?.mesh);
    this.#standing.show({ up: this.#look.upright, unit, scale: this.#session.scale }, { picked, mesh, stale: this.#session.stale });
  }

  #showSize(/** @type {Scan} */ { frame, cloud: { unit } }) {
    page.captionSize.textContent = `${frame.size.map((edge) => format.length(this.#session.scale * edge)).join(' × ')} ${unit ?? ''}`.trim();
  }

  get #flipped() {
    return this.#session.settings.get('flip') === true;
  }

  #cancelled() {
    announce(say('Cancelled'));
    this.#run.hidden = !this.#session.scan;
    this.#stay();
  }

  /** What could not be shown is not in the value either. */
  #stay() {
    const { scan } = this.#session;
    if (scan && !same(fromOf(scan), this.#shown.value.scan)) this.#note({ scan: fromOf(scan), edits: {} }, { step: false });
  }

  /** @param {{ error: any, title: string, given?: File, model?: SampleName }} failure `given`: the file that could not be read */
  #failed({ error, title, given, model }) {
    if (this.#refused(error)) return;
    const standIn = !this.#session.scan && !model;
    this.#message.showError(error, title, { standIn });
    if (given) this.#opening.failed(given, error);
    this.#run.hidden = !this.#session.scan || Boolean(this.#session.outcome);
    this.#stay();
    if (standIn) this.#session.openSample('duck');
  }

  /** A step of a recipe that came with an address, or that was switched on, cannot be done: it is switched off, and all else is. */
  #refused(/** @type {any} */ error) {
    const { edits } = this.#shown.value;
    const recipe = switchedOff(edits.recipe, error);
    if (!recipe) return false;
    this.#message.show('bad-step', error.message);
    this.#edit({ ...edits, recipe });
    this.#note({ edits: { ...edits, recipe } }, { step: false });
    this.#session.apply();
    return true;
  }

  #escape() {
    if (this.#message.open) this.#message.hide();
    else if (this.#tidy.open) this.#tidy.stop();
    else if (this.#measure.open) this.#measure.stop();
    else if (this.#section.open) this.#section.stop();
    else if (this.#side.choosing) this.#side.stop();
    else if (this.#standing.picking) this.#standing.stop();
    else this.#session.cancel();
  }

  /** Keeps so many points: chosen in the chart. */
  #keep(/** @type {number} */ count) {
    this.#session.settings.target = { kind: 'count', value: count };
    this.#settingsChanged();
  }

  #closeHoles(/** @type {'closed' | 'base'} */ how) {
    this.#session.settings.set('boundary', how);
    this.#settingsChanged();
  }

  #settingsChanged() {
    this.#controls.show(this.#session.target, this.#session.scan?.count ?? 0);
    const { turned, ...edits } = this.#shown.value.edits;
    this.#note({ edits });
    this.#session.apply();
  }

  /** Notes what is shown now: by default as a step that can be undone. @param {Partial<Value>} [parts] @param {{ step?: boolean }} [how] */
  #note(parts = {}, how) {
    this.#shown.change({ settings: this.#session.settings.chosen, look: this.#look.state, ...parts }, how);
  }

  /** The address always says what is shown, so that it can be shared, kept and reloaded. */
  #noteAddress(/** @type {Value} */ value) {
    const { scan } = this.#session;
    this.#sharing.show(addressOf(value), scan, `${scan?.file ?? 'scan'}-mesh.glb`);
  }

  /** Somebody put another # behind the same address. */
  #addressChanged() {
    const { words, sample, recipe, view, paint } = readAddress();
    this.#session.settings.read(words);
    this.#look.wish(view, paint);
    const other = isSample(sample) && sample !== this.#session.scan?.model;
    const { recipe: before, ...rest } = other ? {} : this.#shown.value.edits;
    const edits = recipe.length ? { ...rest, recipe } : rest;
    if (!other) this.#edit(edits);
    this.#note(other ? { scan: { model: sample }, edits } : { edits }, { step: false });
    if (other) this.#openSample(sample);
    else this.#settingsChanged();
  }

  #samples() {
    return /** @type {NodeListOf<HTMLButtonElement>} */ (document.querySelectorAll('[data-sample]'));
  }
}
