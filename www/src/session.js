import { DEFAULTS, read, reconstruct, reduce, sample, write } from 'pointweave';
import { frameOf } from './frame.js';

/**
 * @import { PointCloud, ReducedCloud, SurfaceMesh } from 'pointweave'
 * @import { Frame } from './frame.js'
 *
 * Where a scan comes from: a title to show, a name to save under, and for a simulated scan its model.
 * @typedef {{ title: string, file: string, model?: 'duck' | 'pig' | 'part' }} Source
 * @typedef {Source & { cloud: PointCloud, count: number, frame: Frame }} Scan
 * @typedef {{ scan: Scan, reduced: ReducedCloud, mesh: SurfaceMesh | null }} Outcome
 * @typedef {'starting' | 'reading' | 'working' | 'ready'} State
 */

const DEFAULT_SHARE = /** @type {{ ratio: number }} */ (DEFAULTS.reduce.target).ratio;
/** The least and the most points that the page keeps of its own accord: enough for a shape, few enough to wait for. */
const ENOUGH = 2_000;
const AMPLE = 60_000;

/** Codes that say: there is no surface here, but the points can still be reduced. */
const NO_SURFACE = new Set(['degenerate', 'too-few-points']);

/**
 * What is open, what was made of it, and the one job that may be running. Knows the engine, not the page.
 *
 * Events: `state` (a State), `opened` (a Scan), `progress` ({stage, overall}), `made` (an Outcome),
 * `cancelled`, `failed` ({error, title}); the value is the event's `detail`.
 */
export class Session extends EventTarget {
  /** @type {Scan | null} */
  scan = null;
  /** @type {Outcome | null} the last result of the open scan */
  outcome = null;
  /** The share of the points to keep. */
  share = DEFAULT_SHARE;
  #shareChosen = false;
  /** @type {AbortController | null} */
  #job = null;

  /** Generates one of the package's simulated scans and makes its mesh. */
  openSample(/** @type {'duck' | 'pig' | 'part'} */ model, /** @type {string} */ title, /** @type {number} */ count) {
    return this.#open({ title, file: model, model }, (signal) => sample(model, { count, seed: 1, signal }));
  }

  /** Reads a file of the person's and makes its mesh. */
  openFile(/** @type {File} */ file) {
    const name = file.name.replace(/\.[^.]*$/, '') || 'scan';
    return this.#open({ title: file.name, file: name }, (signal) => read(file, { name: file.name, signal }));
  }

  /** Keeps another share of the points: stops what runs and starts again. */
  async setShare(/** @type {number} */ share) {
    if (share === this.share) return;
    this.#shareChosen = true;
    this.share = share;
    if (this.scan) await this.run();
  }

  /** How many points will be kept: exactly this many. */
  get keptCount() {
    return this.scan ? keptOf(this.scan.count, this.share) : 0;
  }

  /** Reduces and meshes the open scan. */
  async run() {
    const scan = this.scan;
    if (!scan) return;
    const job = this.#begin('working');
    try {
      const outcome = await this.#make(scan, job.signal);
      if (job.signal.aborted) return;
      this.outcome = outcome;
      this.#end(job, 'made', outcome);
    } catch (error) {
      this.#end(job, 'failed', { error, title: scan.title });
    }
  }

  /** Stops the running job, if there is one. */
  cancel() {
    if (!this.#job) return;
    this.#job.abort();
    this.#end(this.#job, 'cancelled');
  }

  /** The bytes of a PLY file of what was made. */
  ply(/** @type {'reduced' | 'mesh'} */ what) {
    const result = this.outcome?.[what];
    if (!result) throw new Error(`there is no ${what} to write yet`);
    return write(result, { format: 'ply' });
  }

  /**
   * @param {Source} source
   * @param {(signal: AbortSignal) => Promise<PointCloud>} load
   */
  async #open(source, load) {
    const job = this.#begin('reading');
    try {
      const cloud = await load(job.signal);
      if (job.signal.aborted) return;
      const count = cloud.positions.length / 3;
      if (count === 0) throw Object.assign(new Error('the file holds no points'), { code: 'empty-cloud' });
      this.scan = { ...source, cloud, count, frame: frameOf(cloud) };
      this.outcome = null;
      if (!this.#shareChosen) this.share = startingShare(count);
      this.#emit('opened', this.scan);
    } catch (error) {
      this.#end(job, 'failed', { error, title: source.title });
      // The scan that was open stays; the job that this file interrupted goes on.
      if (this.#job === null && this.scan && !this.outcome) await this.run();
      return;
    }
    await this.run();
  }

  /** @returns {Promise<Outcome>} */
  async #make(/** @type {Scan} */ scan, /** @type {AbortSignal} */ signal) {
    const target = { count: this.keptCount };
    const onProgress = (/** @type {object} */ progress) => signal.aborted || this.#emit('progress', progress);
    try {
      const mesh = await reconstruct(scan.cloud, { reduce: { target }, signal, onProgress });
      return { scan, reduced: mesh.cloud, mesh };
    } catch (error) {
      if (signal.aborted || !NO_SURFACE.has(/** @type {any} */ (error).code)) throw error;
      const reduced = await reduce(scan.cloud, { target, signal });
      this.#emit('failed', { error, title: scan.title });
      return { scan, reduced, mesh: null };
    }
  }

  #begin(/** @type {State} */ state) {
    this.#job?.abort();
    this.#job = new AbortController();
    this.#emit('state', state);
    return this.#job;
  }

  /** Reports how a job ended, unless another has taken its place. */
  #end(/** @type {AbortController} */ job, /** @type {string} */ event, /** @type {unknown} */ detail = undefined) {
    if (this.#job !== job) return;
    this.#job = null;
    this.#emit('state', 'ready');
    this.#emit(event, detail);
  }

  #emit(/** @type {string} */ type, /** @type {unknown} */ detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}

/** How many of `count` points a share of them is. */
export function keptOf(/** @type {number} */ count, /** @type {number} */ share) {
  return Math.max(1, Math.round(count * share));
}

/** The share to keep of a new scan, until the person has chosen one. */
function startingShare(/** @type {number} */ count) {
  const kept = Math.min(AMPLE, Math.max(ENOUGH, count * DEFAULT_SHARE));
  return Math.min(1, kept / count);
}
