import { autoCount, createEngine, flip, read, reconstruct, reduce, sample, splitOrigin, write } from 'pointweave';
import { frameOf } from 'pointweave/viewer';
import { COMPRESSED, expandAside } from './compressing.js';
import { fetchBytes, ownAddress } from './fetching.js';
import { Reading } from './parts.js';
import { Preparing } from './preparing.js';
import { scaled } from '../measure/lengths.js';
import { SAMPLES } from '../controls/samples.js';
import { Settings, TARGETS } from '../controls/settings.js';
import { Emitter } from '../state/emitter.js';
import { say } from '../words/say.js';

/**
 * @import { FileCloud, PointCloud, Prepared, Progress, ReducedCloud, Step, SurfaceMesh } from 'pointweave'
 * @import { Frame } from 'pointweave/viewer'
 * @import { SampleName } from '../controls/samples.js'
 * @import { Part } from './parts.js'
 * @import { Target } from '../controls/settings.js'
 *
 * Where a scan comes from: a title to show, a name to save under, and where it can be had again.
 * `key`: under which the browser keeps a file, `columns`: what those of a table were said to hold.
 * `parts`: of several files, which of them are shown.
 * @typedef {{ title: string, file: string, model?: SampleName, src?: string, given?: File, key?: string, columns?: string[], parts?: Part[] }} Source
 * What the file itself says of how it stands. @typedef {Pick<PointCloud, 'up' | 'unit'>} Own
 * @typedef {PointCloud & Partial<Pick<FileCloud, 'file' | 'columns' | 'skipped'>>} Opened
 * `kept`: of a scan that was tidied, which points of the file are left.
 * `clouds`: those of its parts.
 * @typedef {Source & { cloud: Opened, clouds?: PointCloud[], count: number, frame: Frame, own: Own, kept?: Uint32Array }} Scan
 * @typedef {{ scan: Scan, reduced: ReducedCloud, mesh: SurfaceMesh | null }} Outcome
 * @typedef {'starting' | 'reading' | 'working' | 'ready'} State
 */

/** Stages whose settings have not changed are not run again. */
const REMEMBERED = { keep: true };

/** Codes that say: there is no surface here, but the points can still be reduced. */
const NO_SURFACE = new Set(['degenerate', 'too-few-points']);

/**
 * What is open, what was made of it, and the one job that may be running. Knows the engine, not the page. `failed`: a source that could
 * not be opened, or the title of a scan that could not be worked on.
 * @extends {Emitter<{
 *   state: State, opened: Scan, cut: Scan, progress: { stage: string, overall: number }, made: Outcome, turned: Outcome, cancelled: undefined,
 *   unread: File, failed: { error: any, title: string, given?: File, model?: SampleName },
 * }>}
 */
export class Session extends Emitter {
  settings = new Settings();
  /** What is open, without what the recipe cuts off. @type {Scan | null} */
  scan = null;
  /** The same as it was opened. @type {Scan | null} */
  whole = null;
  /** What is cut off before anything else is done. @type {Step[]} */
  recipe = [];
  /** What is saved is so many times as large as the file says. */
  scale = 1;
  #preparing = new Preparing();
  #reading = new Reading();
  /** What the recipe left; null where there is none. @type {Prepared<any> | null} */
  #prepared = null;
  /** @type {Outcome | null} the last result of the open scan */
  outcome = null;
  /** The same before pieces were turned over. @type {Outcome | null} */
  #unturned = null;
  /** Triangles whose pieces are turned over. @type {number[]} */
  turned = [];
  /** The options of the last job. */
  #asked = '';
  /** Which way was up for it. */
  #stood = '';
  /** @type {AbortController | null} */
  #job = null;
  /** A result of the open scan is asked for and not there yet. A file that cannot be read only interrupts that; Cancel ends it. */
  #wanted = false;
  /** What is computed beside the job, and ends with it. @type {AbortController | null} */
  #aside = null;

  /** Generates one of the package's simulated scans and makes its mesh. */
  openSample(/** @type {SampleName} */ model) {
    const { title, count } = SAMPLES[model];
    return this.#open({ title: say(title), file: model, model }, async (signal) => ({ cloud: await sample(model, { count, seed: 1, signal }) }));
  }

  /**
   * Reads a file of the person's and makes its mesh.
   * @param {File} file
   * @param {{ columns?: string[], beside?: File[], key?: string }} [options] what the columns of a table hold; files that a mesh may name; where
   *   the browser keeps it
   */
  openFile(file, { columns, beside, key } = {}) {
    const source = { title: file.name, file: stem(file.name), given: file, key, columns };
    return this.#open(source, async (signal) => {
      return { cloud: await readAny(file, { name: file.name, columns, beside, signal, onProgress: this.#report(signal) }) };
    });
  }

  /**
   * Reads several files of the person's and makes the mesh of all as one.
   * @param {File[]} files
   * @param {Part[]} parts which of them are scans, and which of these are shown; a mesh may name the others
   * @param {string} key where the browser keeps them
   */
  openParts(files, parts, key) {
    const shown = parts.flatMap(({ of, off }) => (off ? [] : [files[of]]));
    return this.#open({ title: shown[0].name, file: stem(shown[0].name), key, parts }, (signal) => {
      /** @type {(file: File, watch: any) => Promise<Opened>} */
      const readOne = (file, watch) => readAny(file, { name: file.name, beside: files.filter((other) => other !== file), ...watch });
      return this.#reading.all(shown, readOne, (file) => this.emit('unread', file), { signal, onProgress: this.#report(signal) });
    });
  }

  /** Keeps with the scan, and with what was made of it, which way is up and what a coordinate is. */
  stand(/** @type {Own} */ { up, unit }) {
    const { scan, whole, outcome } = this;
    if (!scan) return;
    for (const one of [scan.cloud, whole?.cloud, this.#unturned?.reduced, this.#unturned?.mesh, outcome?.reduced, outcome?.mesh]) if (one) Object.assign(one, { up, unit });
  }

  /** The result was made when another side was up, which helps to tell which side is out: made again, it may be another. */
  get stale() {
    return this.outcome !== null && JSON.stringify(this.scan?.cloud.up) !== this.#stood;
  }

  /** Reads a file beside the page and makes its mesh. */
  openAddress(/** @type {string} */ src) {
    const name = src.split('/').at(-1)?.split(/[?#]/)[0] || 'scan';
    return this.#open({ title: name, file: stem(name), src }, async (signal) => {
      const onProgress = this.#report(signal);
      const bytes = await fetchBytes(ownAddress(src), signal, (share) => onProgress({ stage: 'download', overall: share }));
      return { cloud: await readAny(bytes, { name, signal, onProgress }) };
    });
  }

  /** What is kept: what the person has chosen, or what suits the scan. @returns {Target} */
  get target() {
    return this.settings.target ?? { kind: 'ratio', value: this.scan ? autoCount(this.scan.count) / this.scan.count : TARGETS.ratio.start };
  }

  /** Works again if the settings ask for something else than the last job made or makes. */
  async apply() {
    if (this.scan && this.#wish !== this.#asked) await this.run();
  }

  /** All that a result follows from. */
  get #wish() {
    return JSON.stringify([this.recipe, this.settings.options(this.target)]);
  }

  /** Cuts off what the recipe says, reduces and meshes the rest. */
  async run() {
    if (!this.whole) return;
    const job = this.#begin('working');
    this.#wanted = true;
    this.#asked = this.#wish;
    this.#stood = JSON.stringify(this.whole.cloud.up);
    const { title } = this.whole;
    try {
      const scan = await this.#cut(this.whole, job.signal);
      if (job.signal.aborted) return;
      this.#asked = this.#wish;
      const outcome = await this.#make(scan, job.signal);
      if (job.signal.aborted) return;
      this.outcome = this.#unturned = outcome;
      this.stand(scan.cloud); // as was said meanwhile
      this.turned = [];
      this.#wanted = false;
      this.#end(job, 'made', outcome);
    } catch (error) {
      if (!job.signal.aborted) this.#wanted = false;
      this.#end(job, 'failed', { error, title });
    }
  }

  /** What a recipe would leave of the scan as it was opened. @param {Step[]} recipe @param {AbortSignal} signal */
  async tried(recipe, signal) {
    return this.#preparing.of(/** @type {Scan} */ (this.whole), recipe, { signal });
  }

  /** What each step of the recipe did. */
  get reports() {
    return this.#prepared?.steps ?? [];
  }

  /** The floor of a scan, by at most so many of its points; undefined where there is none. @param {Scan} scan @param {number} most @param {AbortSignal} signal */
  async floor({ cloud: { positions, up }, count }, most, signal) {
    await nextTask();
    const step = Math.ceil(count / most);
    const some = positions.slice(0, 3 * Math.ceil(count / step));
    for (let i = 0; i < some.length; i++) some[i] = positions[3 * step * Math.floor(i / 3) + (i % 3)];
    const { steps: [{ planes = [] }] } = await this.#preparing.once({ positions: some, up }, [{ step: 'plane', drop: 'none' }], { signal });
    return planes.find(({ floor }) => floor);
  }

  /** Something is being read or made. */
  get busy() {
    return this.#job !== null;
  }

  /** Stops the running job, if there is one. */
  cancel() {
    if (!this.#job) return;
    this.#job.abort();
    this.#wanted = false;
    this.#asked = '';
    this.#end(this.#job, 'cancelled');
  }

  /**
   * How far the mesh is from the scan when other counts of points are kept: one job after the other, until one of
   * the person's begins. In an engine of its own, so that saving does not wait.
   * @param {number[]} counts
   * @param {(count: number, distance: import('pointweave').Distances) => void} found
   * @returns {Promise<boolean>} whether all were made
   */
  async compare(counts, found) {
    const { scan, settings } = this;
    if (!scan || this.#job) return false;
    this.#aside?.abort();
    const { signal } = (this.#aside = new AbortController());
    const { reduce: reduction, surface } = settings.options(this.target);
    const engine = counts.length ? await createEngine() : null;
    try {
      for (const count of counts) {
        const options = { ...surface, reduce: { ...reduction, target: { count } }, ...REMEMBERED, signal };
        const { report } = await /** @type {import('pointweave').Engine} */ (engine).reconstruct(scan.cloud, options);
        if (signal.aborted) return false;
        found(count, report.distance);
      }
      return true;
    } catch (error) {
      if (signal.aborted) return false;
      throw error;
    } finally {
      await engine?.dispose();
    }
  }

  /** Turns all of the mesh to its other side. */
  flip() {
    if (!this.#unturned?.mesh) return;
    const { settings } = this;
    this.#unturned = withMesh(this.#unturned, flip(this.#unturned.mesh));
    settings.set('flip', !settings.get('flip'));
    this.#asked = JSON.stringify(settings.options(this.target));
    this.turn(this.turned);
  }

  /** Turns over the pieces of these triangles and no others, until the next job. */
  turn(/** @type {number[]} */ triangles) {
    if (!this.#unturned?.mesh) return;
    this.turned = triangles;
    const mesh = triangles.reduce((turned, triangle) => flip(turned, { triangle }), this.#unturned.mesh);
    this.outcome = triangles.length ? withMesh(this.#unturned, mesh) : this.#unturned;
    this.emit('turned', this.outcome);
  }

  /** Ends {@link compare}. */
  stopComparing() {
    this.#aside?.abort();
    this.#aside = null;
  }

  /**
   * The bytes of a file of what was made.
   * @param {'reduced' | 'mesh'} what
   * @param {import('pointweave').WriteOptions} options
   */
  async file(what, options) {
    const result = this.outcome?.[what];
    if (!result) throw new Error(`there is no ${what} to write yet`);
    return write(scaled(result, this.scale), options);
  }

  /**
   * @param {Source} source
   * @param {(signal: AbortSignal) => Promise<{ cloud: Opened, clouds?: Opened[] }>} load
   */
  async #open(source, load) {
    const job = this.#begin('reading');
    try {
      // One pass over the points a task.
      const { cloud: loaded, clouds } = await load(job.signal);
      const cloud = splitOrigin(loaded);
      await nextTask();
      const frame = frameOf(cloud);
      await nextTask();
      if (job.signal.aborted) return;
      const count = cloud.positions.length / 3;
      if (count === 0) throw Object.assign(new Error('the file holds no points'), { code: 'empty-cloud' });
      const title = clouds && clouds.length > 1 ? say('{count} scans', { count: clouds.length }) : source.title;
      this.scan = this.whole = { ...source, title, cloud, clouds, count, frame, own: { up: cloud.up, unit: cloud.unit } };
      this.recipe = [];
      this.#prepared = null;
      this.outcome = this.#unturned = null;
      this.emit('opened', this.scan);
      // The picture of it is a task, and its way to the engine another.
      await nextTask();
      if (job.signal.aborted) return;
    } catch (error) {
      this.#end(job, 'failed', { error, ...source });
      // The scan that was open stays; the job that this file interrupted goes on, one that was cancelled does not.
      if (this.#job === null && this.#wanted) await this.run();
      return;
    }
    await this.run();
  }

  /** Shows what the recipe leaves, unless that is what is shown. @param {Scan} whole @param {AbortSignal} signal @returns {Promise<Scan>} */
  async #cut(whole, signal) {
    const onProgress = this.#report(signal);
    const prepared = this.recipe.length ? await this.#preparing.of(whole, this.recipe, { signal, onProgress }) : null;
    if (signal.aborted || prepared === this.#prepared) return /** @type {Scan} */ (this.scan);
    const scan = prepared ? await leftOf(whole, prepared) : whole;
    await nextTask();
    if (signal.aborted) return scan;
    this.#prepared = prepared;
    this.scan = scan;
    this.outcome = this.#unturned = null;
    this.emit('cut', scan);
    return scan;
  }

  /** @returns {Promise<Outcome>} */
  async #make(/** @type {Scan} */ scan, /** @type {AbortSignal} */ signal) {
    const { reduce: reduction, surface } = this.settings.options(this.target);
    const options = { ...reduction, assignment: true, cells: true };
    const onProgress = this.#report(signal);
    try {
      const mesh = await reconstruct(scan.cloud, { ...surface, reduce: options, ...REMEMBERED, distances: true, signal, onProgress });
      return { scan, reduced: mesh.cloud, mesh };
    } catch (error) {
      if (signal.aborted || !NO_SURFACE.has(/** @type {any} */ (error).code)) throw error;
      const reduced = await reduce(scan.cloud, { ...options, signal });
      this.emit('failed', { error, title: scan.title });
      return { scan, reduced, mesh: null };
    }
  }

  /** Passes progress on until the job is aborted. */
  #report(/** @type {AbortSignal} */ signal) {
    return (/** @type {Pick<Progress, 'overall'> & { stage: string }} */ progress) => {
      if (!signal.aborted) this.emit('progress', progress);
    };
  }

  #begin(/** @type {State} */ state) {
    this.#job?.abort();
    this.stopComparing();
    this.#job = new AbortController();
    this.emit('state', state);
    return this.#job;
  }

  /**
   * Reports how a job ended, unless another has taken its place.
   * @param {AbortController} job
   * @param {'made' | 'failed' | 'cancelled'} event
   * @param {any} [detail]
   */
  #end(job, event, detail) {
    if (this.#job !== job) return;
    this.#job = null;
    this.emit('state', 'ready');
    this.emit(event, detail);
  }
}

/**
 * Reads a scan. A GLB that is compressed, as the page's own small files and those of other programs are, is expanded first.
 * @param {Blob | Uint8Array<ArrayBuffer>} data
 * @param {import('pointweave').ReadOptions & { signal: AbortSignal, onProgress: (progress: Progress) => void }} options
 */
async function readAny(data, options) {
  try {
    return await read(data, options);
  } catch (error) {
    const { code, found } = /** @type {{ code?: string, found?: unknown }} */ (error);
    if (code !== 'unsupported-file' || found !== COMPRESSED) throw error;
  }
  const plain = await expandAside(data instanceof Blob ? new Uint8Array(await data.arrayBuffer()) : data);
  options.signal.throwIfAborted();
  return read(plain, options);
}

/** A scan without what was cut off. @param {Scan} whole @param {Prepared<any>} prepared @returns {Promise<Scan>} */
async function leftOf(whole, { cloud: left, kept }) {
  await nextTask();
  const cloud = splitOrigin({ ...left, up: whole.cloud.up, unit: whole.cloud.unit });
  return { ...whole, cloud, count: kept.length, frame: frameOf(cloud), kept };
}

/** @param {Outcome} outcome @param {SurfaceMesh} mesh @returns {Outcome} */
function withMesh(outcome, mesh) {
  return { ...outcome, mesh, reduced: mesh.cloud };
}

/** Lets the browser draw and answer in between. */
function nextTask() {
  return new Promise((next) => setTimeout(next));
}

/** A file's name without its ending. */
function stem(/** @type {string} */ name) {
  return name.replace(/\.[^.]*$/, '') || 'scan';
}
