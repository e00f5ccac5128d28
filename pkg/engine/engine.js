/**
 * The engine: one queue of calls, and one host (made when needed, made anew after a crash and after most aborts)
 * that does them.
 */
import { counted } from './amount.js';
import { direction } from './axes.js';
import { chooseBuild } from './choice.js';
import { keepAlive } from './keep-alive.js';
import { cloudArgument, resultArgument } from './clouds.js';
import { baking, left, lightened, meshArgument, ownMesh, pointsBeside, shownPoints } from './light.js';
import { compressorFor, encoderFor } from '../files/compressor.js';
import { PointweaveError } from './errors.js';
import { inProcessHost, workerHost } from './worker-host.js';
import { sharedMemory } from './memory.js';
import { encoded, opened } from './pictures.js';
import { posterArguments, posterOf } from './posing.js';
import { checkEngineOptions, checkModel, checkOptions } from './options.js';
import { checkRecipe, halves, lookedAt, ofAllPoints, preparedArgument, preparedOf, split } from './preparing.js';
import { readScan } from '../files/archive.js';
import { readerError } from '../files/reading.js';
import { signed } from './reports.js';
import { unlessAborted } from './unless-aborted.js';
import { byteSourceOf, nameOf } from '../files/byte-source.js';

/** @import { Build, CallOptions, CloudInfo, EngineOptions, FileCloud, Model, PointCloud, ReadOptions, ReconstructOptions } from '../types.js' */
/** @import { PrepareOption, ReduceOptions, ReducedCloud, SampleOptions, SurfaceMesh, WriteOptions } from '../types.js' */
/** @import { Host, Watch, WorkerLike } from './worker-host.js' */
/** @import { Bindings, Request, WasmBuild } from './core.js' */

/**
 * What differs between a browser and Node.
 * @typedef {object} Platform
 * @property {boolean} worker whether the single-threaded build gets a worker unless it is told
 * @property {() => number} cores
 * @property {() => { possible: boolean, reason: string }} threads whether memory can be shared here, and why
 * @property {(build: WasmBuild, wasmUrl: EngineOptions['wasmUrl']) => Promise<WebAssembly.Module>} compile
 * @property {(build: WasmBuild) => Promise<Bindings>} loadBindings an instance of its own, not started
 * @property {(workerUrl: EngineOptions['workerUrl']) => WorkerLike} startWorker
 */

/** @typedef {import('../types.js').Engine} Declared */

/** About how much of a reconstruction with `triangles` is over when they are counted. */
const LIGHT = 0.85;
/** The same of one with `texture`. */
const TEXTURED = 0.6;

/** How long a host without a call keeps its workers and memory; to start anew takes some tenths of a second. */
const IDLE_MS = 60_000;

/** A timer of longer than this would fire at once. */
const LONGEST_TIMER_MS = 2 ** 31 - 1;

/** @implements {Declared} */
export class Engine {
  /** @type {Platform} */
  #platform;
  #worker;
  #wasmUrl;
  #workerUrl;
  #idleMs;
  /** What computes, and why. @type {ReturnType<typeof chooseBuild>} */
  #choice;
  /** What else is to be said of it. */
  #note = '';
  /** Ends when the last call of the queue has. @type {Promise<unknown>} */
  #tail = Promise.resolve();
  /** @type {Promise<Host> | undefined} */
  #host;
  /** Ends when the host is free: a call that was aborted may have to stop first. @type {Promise<unknown>} */
  #work = Promise.resolve();
  /** Calls that have not ended. */
  #calls = 0;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #idle;
  #disposal = new AbortController();

  /**
   * Nothing is loaded before the first call, or {@link Engine.ready}.
   * @param {Platform} platform
   * @param {EngineOptions} [options]
   */
  constructor(platform, options) {
    const { threads = 'auto', worker, wasmUrl, workerUrl, idleMs = IDLE_MS } = checkEngineOptions(options);
    this.#platform = platform;
    this.#worker = worker;
    this.#wasmUrl = wasmUrl;
    this.#workerUrl = workerUrl;
    this.#idleMs = idleMs;
    this.#choice = chooseBuild(platform, threads, worker);
  }

  get build() {
    return this.#choice.build;
  }

  get threads() {
    return this.#choice.threads;
  }

  get reason() {
    return [this.#choice.reason, this.#note].filter(Boolean).join('; ');
  }

  /**
   * @template {Float32Array | Float64Array} P
   * @param {PointCloud<P>} cloud
   * @param {ReduceOptions & PrepareOption & CallOptions} [options]
   * @returns {Promise<ReducedCloud<P>>}
   */
  async reduce(cloud, options) {
    return this.#compute('reduce', cloud, options);
  }

  /**
   * @template {Float32Array | Float64Array} P
   * @param {PointCloud<P>} cloud
   * @param {ReconstructOptions & PrepareOption & import('../types.js').TextureOption & CallOptions} [options]
   * @returns {Promise<SurfaceMesh<P>>}
   */
  async reconstruct(cloud, options) {
    return this.#compute('reconstruct', cloud, options);
  }

  /**
   * @template {Float32Array | Float64Array} P
   * @param {PointCloud<P> | PointCloud<P>[]} cloud
   * @param {import('../types.js').Step[]} steps
   * @param {CallOptions} [options]
   * @returns {Promise<import('../types.js').Prepared<P>>}
   */
  async prepare(cloud, steps, options) {
    const { transfer, ...watch } = this.#check('prepare', options);
    const recipe = checkRecipe(steps);
    return this.#prepared(preparedArgument(cloud, recipe, transfer), recipe, watch);
  }

  /**
   * @template {import('../types.js').TriangleMesh} T
   * @param {T} mesh
   * @param {import('../types.js').SimplifyOptions & CallOptions} options
   * @returns {Promise<import('../types.js').Simplified<T>>}
   */
  async simplify(mesh, options) {
    const { own, transfer, ...watch } = this.#check('simplify', options);
    const args = [meshArgument(mesh, transfer), own];
    return lightened(mesh, await this.#runIn('light', { call: 'simplify', args }, watch));
  }

  /**
   * @template {import('../types.js').TriangleMesh} T
   * @param {T} mesh
   * @param {PointCloud} cloud
   * @param {import('../types.js').TextureOptions & { triangles?: number } & CallOptions} [options]
   * @returns {Promise<import('../types.js').Textured<T>>}
   */
  async texture(mesh, cloud, options) {
    const { own, transfer, ...watch } = this.#check('texture', options);
    const { args, range } = baking(pointsBeside(cloud, mesh, own), own);
    const request = { call: /** @type {const} */ ('texture'), args: [meshArgument(mesh, transfer), ...args] };
    return lightened(mesh, await this.#runIn('light', request, watch), range);
  }

  /** @param {PointCloud | import('../types.js').TriangleMesh} what @param {import('../types.js').PosterOptions & CallOptions} [options] */
  async poster(what, options) {
    const { own, transfer, ...watch } = this.#check('poster', options);
    const [shown, settings] = posterArguments(what, own, transfer);
    const args = [await opened(shown, this.#decoder(watch)), settings];
    return posterOf(await this.#runIn('light', { call: 'poster', args }, watch), settings);
  }

  /** @param {PointCloud} cloud @param {CallOptions} [options] @returns {Promise<CloudInfo>} */
  async inspect(cloud, options) {
    const { transfer, ...watch } = this.#check('inspect', options);
    return this.#run({ call: 'inspect', args: [cloudArgument(cloud, transfer)] }, watch);
  }

  /** @param {File | Blob | ArrayBuffer | Uint8Array} data @param {ReadOptions & CallOptions} [options] @returns {Promise<FileCloud>} */
  async read(data, options) {
    const { own, transfer, ...watch } = this.#check('read', options);
    const file = byteSourceOf(data, transfer);
    const given = { name: nameOf(data), ...own };
    return this.#queued(watch, async (signal) => {
      /** @type {import('../files/archive.js').Open} */
      const open = (build, job) => this.#withModule(build, signal, job).catch((error) => {
        throw readerError(error, build);
      });
      return readScan(open, file, given, { signal, onProgress: watch.onProgress });
    });
  }

  /** @param {PointCloud | ReducedCloud | SurfaceMesh} result @param {WriteOptions & CallOptions} [options] @returns {Promise<Uint8Array>} */
  async write(result, options) {
    const { own, transfer, ...watch } = this.#check('write', options);
    const { meshopt, pictures, ...plain } = own;
    if (plain.up) plain.up = direction(plain.up);
    const compress = await compressorFor(meshopt);
    const encode = await encoderFor(pictures);
    const given = resultArgument(result, transfer);
    const args = [encode ? await encoded(given, this.#decoder(watch), encode) : given, plain];
    /** @type {Uint8Array} */
    const bytes = await this.#runIn('exports', { call: 'write', args }, watch);
    return compress ? compress(bytes) : bytes;
  }

  /** @param {Model} model @param {SampleOptions & CallOptions} [options] @returns {Promise<PointCloud<Float32Array>>} */
  async sample(model, options) {
    const { own, transfer, ...watch } = this.#check('sample', options);
    return this.#runIn('samples', { call: 'sample', args: [{ model: checkModel(model), ...own }] }, watch);
  }

  /** Ends the worker or the pool. The call under way and those that wait reject with `disposed`. */
  async dispose() {
    if (this.#disposal.signal.aborted) return;
    this.#disposal.abort(new PointweaveError({ code: 'disposed', message: 'the engine was disposed of' }));
    clearTimeout(this.#idle);
    await this.#endHost();
  }

  /** Starts the host before the first call. It ends when none comes. */
  async ready() {
    await this.#busy(() => this.#started());
  }

  /** The host, started when there is none. A start that fails is forgotten, so that the next call tries again. */
  #started() {
    this.#disposal.signal.throwIfAborted();
    this.#host ??= this.#start().catch((error) => {
      this.#host = undefined;
      throw error;
    });
    return this.#host;
  }

  async #endHost() {
    const host = this.#host;
    this.#host = undefined;
    await host?.then((started) => started.end(), nothing);
  }

  /**
   * Does something with the host, which ends when nothing has been done with it for long enough.
   * @template T
   * @param {() => Promise<T>} work
   */
  async #busy(work) {
    this.#calls++;
    clearTimeout(this.#idle);
    try {
      return await keepAlive(work());
    } finally {
      this.#calls--;
      if (this.#calls === 0 && this.#host && this.#idleMs <= LONGEST_TIMER_MS) {
        this.#idle = setTimeout(() => this.#endHost(), this.#idleMs);
        if (typeof this.#idle === 'object') this.#idle.unref(); // Node does not wait for it
      }
    }
  }

  /**
   * Everything that can be wrong before the caller's arrays are taken.
   * @param {Parameters<typeof checkOptions>[0]} call
   * @param {unknown} options
   */
  #check(call, options) {
    this.#disposal.signal.throwIfAborted();
    const checked = checkOptions(call, options);
    checked.signal?.throwIfAborted();
    return checked;
  }

  /**
   * A reduction or a reconstruction, after a recipe where there is one.
   * @param {'reduce' | 'reconstruct'} call
   * @param {any} cloud
   * @param {unknown} options
   * @returns {Promise<any>}
   */
  async #compute(call, cloud, options) {
    const { own: { prepare, ...own }, transfer, ...watch } = this.#check(call, options);
    const given = cloudArgument(cloud, transfer);
    const { texture, lods, ...engineOwn } = own;
    const budgets = lods ?? [own.triangles];
    if (budgets[0] === undefined && !texture) return this.#made(call, given, own, prepare, watch);
    const [first, second] = split(watch, texture ? TEXTURED : LIGHT);
    const points = texture && shownPoints(given, texture);
    const mesh = await this.#made(call, given, engineOwn, prepare, first);
    let rest = second;
    const levels = [];
    for (const [i, triangles] of budgets.entries()) {
      const after = budgets.length - i - 1;
      const [now, later] = split(rest, 1 / (after + 1));
      const baked = texture && baking(left(points, mesh), texture, triangles);
      const args = baked ? [ownMesh(mesh), ...baked.args] : [ownMesh(mesh), { triangles }];
      // The last call may have the memory.
      /** @type {Request} */
      const request = { call: texture ? 'texture' : 'simplify', args: after > 0 ? structuredClone(args) : args };
      levels.push(lightened(mesh, await this.#runIn('light', request, now), baked?.range));
      rest = later;
    }
    return lods ? { ...levels[0], lods: levels.slice(1) } : levels[0];
  }

  /**
   * @param {'reduce' | 'reconstruct'} call
   * @param {PointCloud} given
   * @param {Record<string, any>} own
   * @param {import('../types.js').Step[] | undefined} prepare
   * @param {Watch} watch
   * @returns {Promise<any>}
   */
  async #made(call, given, own, prepare, watch) {
    if (!prepare) return this.#run({ call, args: [given, counted(own, given)] }, watch);
    const [first, second] = halves(watch);
    const prepared = await this.#prepared([given], prepare, first);
    return ofAllPoints(await this.#run({ call, args: [prepared.cloud, counted(own, prepared.cloud)] }, second), prepared);
  }

  /**
   * @param {import('../types.js').PointCloud[]} clouds of this engine
   * @param {import('../types.js').Step[]} steps
   * @param {Watch} watch
   */
  async #prepared(clouds, steps, watch) {
    return preparedOf(clouds, await this.#runIn('prepare', { call: 'prepare', args: [lookedAt(clouds), steps] }, watch));
  }

  /**
   * Waits for the calls before, then has the host do this one.
   * @param {Request} request
   * @param {Watch} watch
   */
  async #run(request, watch) {
    return this.#queued(watch, async (signal) => {
      await unlessAborted(this.#work, signal);
      const work = this.#ask(request, { signal, onProgress: watch.onProgress });
      this.#work = work.then(nothing, nothing);
      return work;
    });
  }

  /**
   * Waits for the calls before, then has a module of its own do this one.
   * @param {Exclude<WasmBuild, Build>} build
   * @param {Request} request
   * @param {Watch} watch
   */
  async #runIn(build, request, watch) {
    return this.#queued(watch, (signal) => this.#withModule(build, signal, (ask) => ask(request, watch.onProgress)));
  }

  /**
   * Has the host do a request.
   * @param {Request} request
   * @param {Watch & { signal: AbortSignal }} watch
   */
  async #ask(request, watch) {
    const host = await unlessAborted(this.#started(), watch.signal);
    try {
      return signed(await host.run(request, watch), this);
    } finally {
      if (!host.usable()) this.#host = undefined;
    }
  }

  /**
   * Waits for the calls before, then does a job; those after wait for it.
   * @template T
   * @param {Watch} watch
   * @param {(signal: AbortSignal) => Promise<T>} job
   * @returns {Promise<T>}
   */
  async #queued({ signal: own }, job) {
    const signal = own ? AbortSignal.any([this.#disposal.signal, own]) : this.#disposal.signal;
    const before = this.#tail;
    const result = this.#busy(async () => {
      await unlessAborted(before, signal);
      return unlessAborted(job(signal), signal);
    });
    this.#tail = Promise.all([before, result.then(nothing, nothing)]);
    return result;
  }

  /**
   * Does something with the wasm of a reader, of pictures, writers or samples, which is loaded for it and ends after it, with its memory.
   * @template T
   * @param {Exclude<WasmBuild, Build>} build
   * @param {AbortSignal} signal
   * @param {(ask: (request: Request, onProgress?: Watch['onProgress']) => Promise<any>) => Promise<T>} job
   * @returns {Promise<T>}
   */
  async #withModule(build, signal, job) {
    const { compile, loadBindings, startWorker, worker } = this.#platform;
    const module = await unlessAborted(compile(build, this.#wasmUrl), signal);
    const inWorker = this.build === 'threads' || (this.#worker ?? worker);
    const host = await (inWorker
      ? workerHost(() => startWorker(this.#workerUrl), { build, threads: 1, module })
      : inProcessHost(await loadBindings(build), { build, module }));
    try {
      return await job((request, onProgress) => host.run(request, { signal, onProgress }));
    } finally {
      host.end();
    }
  }

  /** What reads pictures. @param {Watch} watch @returns {import('./pictures.js').Decode} */
  #decoder(watch) {
    return (file) => this.#runIn('pictures', { call: 'decodePicture', args: [file] }, { signal: watch.signal });
  }

  /** @returns {Promise<Host>} */
  async #start() {
    if (this.build === 'threads') {
      try {
        return await this.#startBuild();
      } catch (error) {
        const why = error instanceof Error ? error.message : String(error);
        this.#choice = { build: 'single', threads: 1, reason: `the threads build did not start: ${why}` };
      }
    }
    return this.#startBuild();
  }

  async #startBuild() {
    const { build, threads } = this;
    const { compile, loadBindings, startWorker, worker } = this.#platform;
    const module = await compile(build, this.#wasmUrl);
    const startOne = () => startWorker(this.#workerUrl);
    if (build === 'threads') {
      const { memory, note } = sharedMemory();
      const host = await workerHost(startOne, { build, threads, module, memory });
      this.#note = note;
      return host;
    }
    return this.#worker ?? worker
      ? workerHost(startOne, { build, threads, module })
      : inProcessHost(await loadBindings(build), { build, module });
  }
}

function nothing() {}
