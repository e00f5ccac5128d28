/** The element itself: attributes and the viewport come in, jobs and events go out. */
import { PointweaveError } from '../engine/errors.js';
import { Reflecting } from './attributes.js';
import { layerColors } from './colors.js';
import { listenToKeys } from './keyboard.js';
import { Panels } from './panels.js';
import { VIEWS, buildParts } from './parts.js';
import { openSource } from './source.js';
import { Speech } from './speech.js';
import { calm, viewport } from './watching.js';
import { WORDS } from './words.js';

/** @import { EngineOptions } from '../types.js' */
/** @import { AbortReason, ErrorDetail, LoadDetail, PointWeaveEventMap, Stage, View, Words } from '../element.js' */
/** @import { Picture } from './picture.js' */
/** @import { Glb, Scan } from './source.js' */

/** More device pixels than this in a CSS pixel cost much and show nothing. */
const FINEST = 2;

/** Work under way. @typedef {{ src: string, controller: AbortController, share: number, stage: Stage }} Job */

export class PointWeaveElement extends Reflecting {
  /** What people see and hear; assign other words for another language. @type {Words} */
  static words = WORDS;
  /** As that of `createEngine`, for files that are elsewhere. @type {EngineOptions['wasmUrl']} */
  static wasmUrl;
  /** As that of `createEngine`. @type {EngineOptions['workerUrl']} */
  static workerUrl;

  #parts = buildParts(this.attachShadow({ mode: 'open', delegatesFocus: true }));
  #panels = new Panels(this.#parts);
  #speech = new Speech(this.#parts.spoken);
  /** @type {Picture | undefined} */
  #picture;
  /** What `src` holds, once it is there. @type {Glb | Scan | undefined} */
  #source;
  /** @type {Job | undefined} */
  #job;
  #attached = false;
  #near = false;
  #seen = false;
  #paused = false;
  #scheduled = false;
  #size = { width: 0, height: 0, ratio: 1 };
  #resizes = new ResizeObserver(([entry]) => this.#resized(entry));

  constructor() {
    super();
    const { canvas, cancel, retry, reset, pause, fullscreen, choices, image, poster } = this.#parts;
    cancel.addEventListener('click', () => (this.abort(), retry.focus()));
    retry.addEventListener('click', () => this.#retry());
    reset.addEventListener('click', () => this.resetCamera());
    pause.addEventListener('click', () => this.#pause());
    fullscreen.addEventListener('click', () => this.#toggleFullscreen());
    image.addEventListener('error', () => this.#panels.setPoster(''));
    poster.addEventListener('slotchange', () => this.#panels.showPoster(!this.#loaded));
    for (const { input, view } of choices) input.addEventListener('change', () => this.#choose(view));
    canvas.addEventListener('transitionend', () => this.#picture?.paintIn(layerColors(canvas)));
    listenToKeys(canvas, () => (this.controls && this.#picture ? this.#hands : undefined));
    this.upgrade();
  }

  connectedCallback() {
    if (this.#attached) return;
    this.#attached = true;
    const { near, seen } = viewport();
    near.add(this, (isNear) => isNear && this.#come());
    seen.add(this, (isSeen) => this.#see(isSeen));
    this.#observe();
    calm().addEventListener('change', this.#dress);
    this.#picture?.attach();
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
      const { near, seen } = viewport();
      near.delete(this);
      seen.delete(this);
      this.#see(false);
      this.#resizes.disconnect();
      calm().removeEventListener('change', this.#dress);
      this.#speech.hush();
      this.#picture?.detach();
    });
  }

  /** @param {string} name @param {string | null} before @param {string | null} now */
  attributeChangedCallback(name, before, now) {
    if (before === now) return;
    switch (name) {
      case 'src':
        this.#forget();
        this.#schedule();
        break;
      case 'ratio':
      case 'count':
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
        this.#describe();
        this.#dress();
        break;
      case 'auto-rotate':
        this.#paused = false;
        this.#dress();
        break;
      case 'up':
        this.#picture?.stand(this.up);
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

  resetCamera() {
    this.#picture?.orbit.home();
  }

  /** The picture as it is shown, without background: to make a poster of. @param {string} [type] @param {number} [quality] */
  toBlob(type, quality) {
    this.#picture?.paint();
    return new Promise((/** @type {(blob: Blob | null) => void} */ resolve) => this.#parts.canvas.toBlob(resolve, type, quality));
  }

  get #loaded() {
    return Boolean(this.#source && this.#picture?.has(this.#source.kind === 'scan' ? this.view : this.#best()));
  }

  get #target() {
    const { count, ratio } = this;
    return count !== null ? { count } : ratio !== null ? { ratio } : undefined;
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
    if (seen) this.#picture?.paintIn(layerColors(this.#parts.canvas));
    this.#picture?.see(seen);
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
    if (this.#source) this.#showBest();
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
      const [picture, source] = await Promise.all([this.#ready(), this.#source ?? openSource(src, this.view, work)]);
      signal.throwIfAborted();
      if (!this.#source) {
        await (source.kind === 'glb' ? picture.openGlb(source.bytes, signal) : picture.openCloud(source.cloud));
        this.#source = source;
        this.#showBest();
      }
      while (source.kind === 'scan' && !picture.has(this.view)) {
        await source.make(this.view, this.#target, work);
        signal.throwIfAborted();
        if (source.reduced) picture.addComputed(source.reduced, source.mesh);
      }
      if (job.share < 1) this.#progress(job, job.stage, 1);
      signal.throwIfAborted(); // by who heard of that
      this.#job = undefined;
      this.#finish(src, source, picture);
    } catch (error) {
      if (signal.aborted) return; // #abort has said so
      this.#job = undefined;
      controller.abort(error); // the half that still runs
      this.#fail(src, error);
    }
  }

  /** The picture, made when it is first needed. */
  async #ready() {
    const { Picture } = await import('./picture.js').catch((error) => {
      throw new PointweaveError({ code: 'load-failed', message: `three.js did not load: ${error.message}` });
    });
    if (!this.#picture) {
      const { canvas } = this.#parts;
      this.#picture = new Picture(canvas);
      this.#picture.paintIn(layerColors(canvas));
      this.#picture.stand(this.up);
      if (this.#attached) this.#picture.attach();
      this.#picture.see(this.#seen);
      this.#dress();
    }
    return this.#picture;
  }

  /** @param {string} src @param {Glb | Scan} source @param {Picture} picture */
  #finish(src, source, picture) {
    this.#panels.end();
    const view = this.#showBest();
    picture.paint();
    const result = source.kind === 'scan' ? source.of(view) : undefined;
    const report = result && 'report' in result ? /** @type {LoadDetail['report']} */ (result.report) : null;
    const detail = { src, kind: source.kind, view, ...picture.size(view), report };
    const { words } = PointWeaveElement;
    this.#speech.say(`${this.alt || words.untitled}. ${words.shown(detail)}`);
    this.#send('load', detail);
  }

  /** @param {string} src @param {unknown} cause */
  #fail(src, cause) {
    const error = /** @type {ErrorDetail['error']} */ (cause instanceof PointweaveError
      ? cause
      : new PointweaveError({ code: 'internal', message: cause instanceof Error ? cause.message : String(cause) }));
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
    this.#source = undefined;
    this.#picture?.clear();
    this.#panels.hideError();
    this.#panels.showPoster(true);
    this.#dress();
  }

  /** What was computed for another target is not shown any more; the points stay. */
  #retarget() {
    if (this.#source?.kind !== 'scan') return; // the job that fetches will ask for the target when it is there
    this.#abort('target');
    this.#source.forget();
    this.#picture?.forgetComputed();
    this.#showBest();
  }

  #retry() {
    this.#panels.hideError();
    this.focus();
    this.#schedule();
  }

  /** The view that is asked for, or what there is instead. @returns {View} */
  #best() {
    return [this.view, ...VIEWS.toReversed()].find((view) => this.#picture?.has(view)) ?? this.view;
  }

  /** Says which view it is. */
  #showBest() {
    const view = this.#best();
    this.#picture?.show(view);
    if (this.#loaded || !this.#panels.hasPoster) this.#panels.showPoster(false);
    this.#dress();
    return view;
  }

  /** By hand, unlike `view = …`. @param {View} view */
  #choose(view) {
    if (!this.#views.includes(view) || view === this.view) return;
    this.view = view;
    this.dispatchEvent(new Event('change'));
    if (this.#picture?.has(view)) this.#speech.say(PointWeaveElement.words.shown({ view, ...this.#picture.size(view) }));
  }

  /** What can be chosen: all of a scan, for it is computed; what there is in a GLB. */
  get #views() {
    return this.#source?.kind === 'glb' ? this.#picture?.views ?? [] : [...VIEWS];
  }

  /** Brings what can be handled in line with the attributes. */
  #dress = () => {
    const { controls, autoRotate } = this;
    const turns = autoRotate && !calm().wanted;
    const view = this.#source?.kind === 'glb' ? this.#best() : this.view;
    const state = { present: Boolean(this.#source), controls, turns, paused: this.#paused, views: this.#views, view };
    this.#panels.showToolbar(state, PointWeaveElement.words);
    this.#picture?.resize(this.#size, controls);
    this.#picture?.orbit.enable(controls);
    this.#picture?.orbit.turnSlowly(turns && !this.#paused);
  };

  /** Without controls it is an image, with them something to handle. */
  #describe() {
    const { canvas } = this.#parts;
    const { controls } = this;
    const decorative = this.hasAttribute('alt') && !this.alt && !controls;
    canvas.setAttribute('role', controls ? 'application' : 'img');
    canvas.setAttribute('aria-label', this.alt || PointWeaveElement.words.untitled);
    setOrRemove(canvas, 'tabindex', controls && '0');
    setOrRemove(canvas, 'aria-describedby', controls && 'keys');
    setOrRemove(canvas, 'aria-hidden', decorative && 'true');
  }

  #pause() {
    if (!this.autoRotate || calm().wanted) return;
    this.#paused = !this.#paused;
    this.#dress();
  }

  async #toggleFullscreen() {
    if (document.fullscreenElement === this) await document.exitFullscreen();
    else await this.requestFullscreen();
  }

  /** What the keys move. @type {import('./keyboard.js').Hands} */
  #hands = {
    turn: (right, over) => this.#move((orbit) => orbit.turn(right, over)),
    zoom: (factor) => this.#move((orbit) => orbit.zoom(factor)),
    home: () => this.#move((orbit) => orbit.home()),
    choose: (view) => this.#choose(view),
    pause: () => this.#pause(),
  };

  /** Moves, and says where one looks from then. @param {(orbit: Picture['orbit']) => void} how */
  #move(how) {
    const orbit = this.#picture?.orbit;
    if (!orbit) return;
    how(orbit);
    this.#speech.atRest(() => PointWeaveElement.words.pose(orbit.pose));
  }

  /** The size is told once at the start, and again when the window goes to a screen of other pixels. */
  #observe() {
    const { canvas } = this.#parts;
    this.#resizes.disconnect();
    try {
      this.#resizes.observe(canvas, { box: 'device-pixel-content-box' });
    } catch {
      this.#resizes.observe(canvas); // a browser that does not know device pixels
    }
  }

  /** @param {ResizeObserverEntry} entry */
  #resized({ contentRect: { width, height } }) {
    const ratio = Math.min(devicePixelRatio, FINEST);
    this.#size = { width: Math.round(width * ratio), height: Math.round(height * ratio), ratio };
    this.#picture?.resize(this.#size, this.controls);
  }

  /**
   * @template {keyof PointWeaveEventMap} Type
   * @param {Type} type
   * @param {PointWeaveEventMap[Type] extends CustomEvent<infer Detail> ? Detail : never} detail
   */
  #send(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}

/** @param {HTMLElement} element @param {string} name @param {string | false} value */
function setOrRemove(element, name, value) {
  if (value) element.setAttribute(name, value);
  else element.removeAttribute(name);
}
