/** The element itself: attributes and the viewport come in, jobs and events go out. */
import { PointweaveError, toRecord } from '../engine/errors.js';
import { listenToKeys } from '../viewer/keyboard.js';
import { calm, inSight } from '../viewer/watching.js';
import { nextLoad } from './awaited.js';
import { describe, setOrRemove } from './described.js';
import { Hotspots } from './hotspots.js';
import { KEYS } from './keys.js';
import { Panels } from './panels.js';
import { VIEWS, buildParts } from './parts.js';
import { VIEWER } from './posed.js';
import { Prompt } from './prompt.js';
import { InRoom, SOURCE } from './room.js';
import { isNamedGlb, openSource, showSource, wishOf } from './source.js';
import { Speech } from './speech.js';
import { AR, CAMERA, LIGHT } from './switching.js';
import { themeOf } from './theme.js';
import { inReach } from './watching.js';
import { WORDS } from './words.js';

/** @import { EngineOptions } from '../types.js' */
/** @import { AbortReason, ErrorDetail, LoadDetail, PointWeaveEventMap, Stage, View, Words } from '../element.js' */
/** @import { Viewer } from '../viewer.js' */
/** @import { Glb, Scan, Tileset } from './source.js' */

/** Work under way. @typedef {{ src: string, controller: AbortController, share: number, stage: Stage }} Job */

export class PointWeaveElement extends InRoom {
  /** What people see and hear; assign other words for another language. @type {Words} */
  static words = WORDS;
  /** As that of `createEngine`, for files that are elsewhere. @type {EngineOptions['wasmUrl']} */
  static wasmUrl;
  /** As that of `createEngine`. @type {EngineOptions['workerUrl']} */
  static workerUrl;

  #parts = buildParts(this.attachShadow({ mode: 'open', delegatesFocus: true }));
  #panels = new Panels(this.#parts);
  #speech = new Speech(this.#parts.spoken);
  /** @type {Job | undefined} */
  #job;
  #attached = false;
  #near = false;
  #seen = false;
  #paused = false;
  #scheduled = false;
  /** The poster has been sent away by the page, where it stays until then. */
  #dismissed = false;
  #prompt = new Prompt(this.#parts.prompt);
  #hotspots = new Hotspots(this, this.#parts.hotspots);
  #resized = new ResizeObserver(() => this.#dress());

  constructor() {
    super();
    const { canvas, cancel, retry, reset, pause, fullscreen, choices, image, poster } = this.#parts;
    cancel.addEventListener('click', () => (this.abort(), retry.focus()));
    retry.addEventListener('click', () => this.#retry());
    reset.addEventListener('click', () => this.resetCamera());
    pause.addEventListener('click', () => this.#pause());
    fullscreen.addEventListener('click', () => this.toggleFullscreen());
    image.addEventListener('error', () => this.#panels.setPoster(''));
    poster.addEventListener('slotchange', () => this.#cover());
    for (const { input, view } of choices) input.addEventListener('change', () => this.#choose(view));
    canvas.addEventListener('transitionend', () => this.#color());
    listenToKeys(canvas, KEYS, () => (this.controls && this[VIEWER] ? this.#hands : undefined));
    this.upgrade();
  }

  connectedCallback() {
    if (this.#attached) return;
    this.#attached = true;
    inReach().add(this, (isNear) => isNear && this.#come());
    inSight().add(this, (isSeen) => this.#see(isSeen));
    calm().addEventListener('change', this.#dress);
    this.#resized.observe(this);
    this[VIEWER]?.resume();
    this.#panels.label(PointWeaveElement.words);
    this.#describe();
    this.#dress();
    if (this.loading === 'eager') this.#come();
    this.#schedule();
  }

  /** Moved elements come back at once; only who stays away is taken apart. */
  disconnectedCallback() {
    queueMicrotask(() => {
      if (this.isConnected || !this.#attached) return;
      this.#attached = false;
      this.#abort('removed');
      inReach().delete(this);
      inSight().delete(this);
      this.#see(false);
      calm().removeEventListener('change', this.#dress);
      this.#resized.disconnect();
      this.#speech.hush();
      this[VIEWER]?.suspend();
    });
  }

  /** @param {string} name @param {string | null} before @param {string | null} now */
  attributeChangedCallback(name, before, now) {
    if (before === now) return;
    if (CAMERA.includes(name)) this.pose(name);
    if (LIGHT.includes(name)) this.light();
    if (AR.includes(name)) this.offerAr();
    switch (name) {
      case 'src':
        this.#forget();
        this.#schedule();
        break;
      case 'ratio':
      case 'count':
      case 'orientation':
      case 'flip':
        this.#retarget();
        this.#schedule();
        break;
      case 'view':
        this.#schedule();
        break;
      case 'poster':
        if (this.#near) this.#panels.setPoster(this.poster);
        break;
      case 'alt':
        this.#describe();
        break;
      case 'controls':
      case 'camera-controls':
        this.#describe();
        this.#dress();
        break;
      case 'auto-rotate':
        this.#paused = false;
        this.#dress();
        break;
      case 'reveal':
        this.#cover();
        break;
      case 'interaction-prompt':
        this.#prompt.hide();
        break;
      case 'up':
        if (this[VIEWER]) this[VIEWER].up = this.up;
        break;
      case 'loading':
        if (this.loading === 'eager' && this.#attached) this.#come();
        break;
    }
  }

  /** Whether the view that is asked for is shown. */
  get loaded() {
    return this.#loaded && !this.#job;
  }

  /** Stops the job under way, if there is one. */
  abort() {
    if (!this.#abort('called')) return;
    this.#panels.showError(PointWeaveElement.words.stopped);
  }

  /** Fetches `src` and computes everything once more. */
  reload() {
    this.#forget();
    this.#schedule();
  }

  /** What `load` tells, as soon as the view that is asked for is shown; rejects with what `error` tells. */
  async whenLoaded() {
    return this.loaded && this[SOURCE] && this[VIEWER] ? this.#shown(this.src, this[SOURCE], this[VIEWER]) : nextLoad(this);
  }

  /** Sends the poster away, which `reveal="manual"` keeps until then. */
  dismissPoster() {
    this.#dismissed = true;
    this.#come();
    this.#cover();
  }

  /** Puts the poster back. */
  showPoster() {
    this.#dismissed = false;
    this.#panels.showPoster(true);
  }

  get #loaded() {
    return Boolean(this[SOURCE] && this[VIEWER]?.has(this[SOURCE].kind === 'scan' ? this.view : this.#best()));
  }

  /** Of what is shown. */
  get report() {
    const shown = this[SOURCE]?.kind === 'scan' ? this[SOURCE].of(this.#best()) : undefined;
    return shown && 'report' in shown ? /** @type {NonNullable<LoadDetail['report']>} */ (shown.report) : null;
  }

  #come() {
    if (this.#near) return;
    this.#near = true;
    this.#panels.setPoster(this.poster);
    this.#schedule();
  }

  /** What was out of sight has not heard of new colours. @param {boolean} seen */
  #see(seen) {
    this.#seen = seen;
    if (seen) this.#color();
  }

  #color() {
    if (this[VIEWER]) this[VIEWER].colors = themeOf(this, this.#parts.canvas);
  }

  /** However many attributes change at once, what follows from them is done once. */
  #schedule() {
    if (this.#scheduled) return;
    this.#scheduled = true;
    queueMicrotask(() => {
      this.#scheduled = false;
      this.#update();
    });
  }

  #update() {
    if (!this.#attached || !this.#near || !this.src) return;
    if (this[SOURCE]) this.#showBest();
    if (this.#job) return;
    if (this.#loaded) this.#panels.hideError();
    else this.#run();
  }

  /** From `src` to the view that is asked for, by whatever is missing. */
  async #run() {
    const { src } = this;
    const controller = new AbortController();
    const { signal } = controller;
    /** @type {Job} */
    const job = (this.#job = { src, controller, share: 0, stage: 'fetch' });
    const { wasmUrl, workerUrl } = PointWeaveElement;
    const work = {
      signal,
      onProgress: (/** @type {Stage} */ stage, /** @type {number} */ share) => this.#progress(job, stage, share),
      seen: () => this.#seen,
      engine: { threads: this.threads, wasmUrl, workerUrl },
    };
    this.#panels.begin();
    this.#speech.begin();
    try {
      const [viewer, source] = await Promise.all([this.#ready(), this[SOURCE] ?? openSource(src, this.view, work)]);
      signal.throwIfAborted();
      if (!this[SOURCE]) {
        await showSource(viewer, source, src, work);
        signal.throwIfAborted();
        this[SOURCE] = source;
        this.#showBest();
      }
      while (source.kind === 'scan' && !viewer.has(this.view)) {
        await source.make(this.view, wishOf(this), work);
        signal.throwIfAborted();
        const { reduced = null, mesh = null } = source;
        viewer.set('reduced', reduced && { ...reduced, oriented: Boolean(mesh) });
        viewer.set('mesh', mesh);
      }
      if (job.share < 1) this.#progress(job, job.stage, 1);
      signal.throwIfAborted(); // by who heard of that
      this.#job = undefined;
      this.#finish(src, source, viewer);
    } catch (error) {
      if (signal.aborted) return; // #abort has said so
      this.#job = undefined;
      controller.abort(error); // the half that still runs
      this.#fail(src, error);
    }
  }

  /** The viewer, made when it is first needed, and what reads a GLB where one is likely to come. */
  async #ready() {
    const glb = isNamedGlb(this.src) && import('../viewer/glb.js');
    const [{ createViewer }] = await Promise.all([import('../viewer/viewer.js'), glb]).catch((error) => {
      throw new PointweaveError({ code: 'load-failed', message: `three.js did not load: ${error.message}` });
    });
    if (this[VIEWER]) return this[VIEWER];
    const viewer = createViewer(this.#parts.canvas, { interactive: this.controls, up: this.up });
    viewer.addEventListener('move', ({ detail: { by } }) => {
      if (by !== 'program') this.#prompt.done();
      this.tellMove(by);
      if (by === 'keys') this.#speech.atRest(() => PointWeaveElement.words.pose(viewer.pose));
    });
    viewer.addEventListener('stream', () => this.tellStream());
    if (!this.#attached) viewer.suspend();
    this[VIEWER] = viewer;
    this.pose();
    await this.light();
    this.#hotspots.follow(viewer);
    this.#color();
    this.#dress();
    return viewer;
  }

  /** @param {string} src @param {Glb | Scan | Tileset} source @param {Viewer} viewer */
  #finish(src, source, viewer) {
    this.#panels.end();
    this.#showBest();
    viewer.draw();
    const detail = this.#shown(src, source, viewer);
    const { words } = PointWeaveElement;
    this.#speech.say([this.alt || words.untitled, words.shown(detail), ...this.#doubts].join('. '));
    this.#send('load', detail);
    this.#prompt.wait(() => this.controls && this.loaded && this.interactionPrompt === 'auto');
  }

  /** @param {string} src @param {Glb | Scan | Tileset} source @param {Viewer} viewer @returns {LoadDetail} */
  #shown(src, source, viewer) {
    const view = this.#best();
    return { src, kind: source.kind, view, ...viewer.size(view), report: this.report };
  }

  /** @param {string} src @param {unknown} cause */
  #fail(src, cause) {
    const error = /** @type {ErrorDetail['error']} */ (cause instanceof PointweaveError ? cause : new PointweaveError(toRecord(cause)));
    const { errors } = PointWeaveElement.words;
    this.#panels.end();
    this.#panels.showError(errors[error.code] ?? errors.other, error.message);
    this.#send('error', { src, error });
  }

  /** @param {Job} job @param {Stage} stage @param {number} share */
  #progress(job, stage, share) {
    if (job !== this.#job) return;
    job.share = Math.max(job.share, share);
    job.stage = stage;
    const { stages, progress } = PointWeaveElement.words;
    const words = stages[stage] ?? stage;
    this.#panels.progress(words, job.share);
    this.#speech.progress(progress(words, Math.round(100 * job.share)));
    this.#send('progress', { src: job.src, stage, overall: job.share });
  }

  /** Says whether there was something to stop. @param {AbortReason} reason */
  #abort(reason) {
    const job = this.#job;
    if (!job) return false;
    this.#job = undefined;
    job.controller.abort(new DOMException(`stopped: ${reason}`, 'AbortError'));
    this.#panels.end();
    this.#send('abort', { src: job.src, reason });
    return true;
  }

  /** Nothing of the old `src` is shown any more. */
  #forget() {
    this.#abort('src');
    this[SOURCE] = undefined;
    this[VIEWER]?.clear();
    this.#panels.hideError();
    this.#panels.showPoster(true);
    this.#prompt.hide();
    this.#dress();
  }

  /** What was computed for another target is not shown any more; the points stay. */
  #retarget() {
    if (this[SOURCE]?.kind !== 'scan') return; // the job that fetches will ask for the target when it is there
    this.#abort('target');
    this[SOURCE].forget();
    for (const view of /** @type {const} */ (['reduced', 'mesh'])) this[VIEWER]?.set(view, null);
    this.#showBest();
  }

  #retry() {
    this.#panels.hideError();
    this.focus();
    this.#schedule();
  }

  /** The view that is asked for, or what there is instead. @returns {View} */
  #best() {
    return [this.view, ...VIEWS.toReversed()].find((view) => this[VIEWER]?.has(view)) ?? this.view;
  }

  /** What may be wrong with what is shown, in words. */
  get #doubts() {
    return (this.report?.doubts ?? []).map(PointWeaveElement.words.doubt);
  }

  /** Says which view it is. */
  #showBest() {
    const view = this.#best();
    setOrRemove(this.#parts.canvas, 'title', this.#doubts.join(' '));
    if (this[VIEWER]) this[VIEWER].view = view;
    this.#cover();
    this.#dress();
    return view;
  }

  /** The poster lies over the picture until that is there, and sent for. */
  #cover() {
    const ready = this.#loaded || (Boolean(this[SOURCE]) && !this.#panels.hasPoster);
    this.#panels.showPoster(!ready || (this.reveal === 'manual' && !this.#dismissed));
  }

  /** By hand, unlike `view = …`. @param {View} view */
  #choose(view) {
    if (!this.#views.includes(view) || view === this.view) return;
    this.view = view;
    this.dispatchEvent(new Event('change'));
    if (this[VIEWER]?.has(view)) this.#speech.say(PointWeaveElement.words.shown({ view, ...this[VIEWER].size(view) }));
  }

  /** What can be chosen: all of a scan, for it is computed; else what there is. */
  get #views() {
    return (this[SOURCE]?.kind ?? 'scan') === 'scan' ? [...VIEWS] : VIEWS.filter((view) => this[VIEWER]?.has(view));
  }

  /** Brings what can be handled in line with the attributes. */
  #dress = () => {
    const { controls, autoRotate } = this;
    const turns = autoRotate && !calm().wanted;
    const view = (this[SOURCE]?.kind ?? 'scan') === 'scan' ? this.view : this.#best();
    const state = { present: Boolean(this[SOURCE]), controls, turns, paused: this.#paused, views: this.#views, view };
    this.#panels.showToolbar(state, PointWeaveElement.words);
    this.offerAr();
    if (!this[VIEWER]) return;
    this[VIEWER].insets = controls ? this.#panels.room : { top: 0, bottom: 0 };
    this[VIEWER].interactive = controls;
    this[VIEWER].autoRotate = turns && !this.#paused;
  };

  #describe() {
    describe(this.#parts.canvas, this, PointWeaveElement.words.untitled);
  }

  #pause() {
    if (!this.autoRotate || calm().wanted) return;
    this.#paused = !this.#paused;
    this.#dress();
  }

  /** What the keys act on that do not move. @type {import('./keys.js').Hands} */
  #hands = { choose: (view) => this.#choose(view), pause: () => this.#pause() };

  /**
   * @template {keyof PointWeaveEventMap} Type
   * @param {Type} type
   * @param {PointWeaveEventMap[Type] extends CustomEvent<infer Detail> ? Detail : never} detail
   */
  #send(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}
