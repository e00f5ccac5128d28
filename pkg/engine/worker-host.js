/**
 * Runs requests one at a time, in this thread, in a worker, or in a worker with a thread pool; and stops one when its signal is
 * aborted or its `onProgress` throws.
 */
import { buffersOf } from './arrays.js';
import { Core } from './core.js';
import { PointweaveError, isFatal } from './errors.js';

/** @import { Build, Progress } from '../types.js' */
/** @import { CoreOptions, Bindings, Request } from './core.js' */
/** @import { FromWorker, ToWorker } from './serve.js' */

/**
 * @typedef {object} Watch
 * @property {AbortSignal} [signal]
 * @property {(progress: Progress) => void} [onProgress] what it throws stops the work and rejects the call
 */

/**
 * @typedef {object} Host
 * @property {(request: Request, watch: Watch) => Promise<any>} run
 * @property {() => boolean} usable false when it died or was ended: the next call needs another
 * @property {() => void} end
 */

/**
 * A worker of either kind, browser or Node, as far as it is used here.
 * @typedef {object} WorkerLike
 * @property {(message: ToWorker, transfer: ArrayBuffer[]) => void} post
 * @property {(receive: (message: FromWorker) => void, fail: (why: string) => void) => void} listen
 * @property {(busy: boolean) => void} hold whether the process has to wait for it
 * @property {() => void} terminate
 */

/**
 * A call that keeps what it has measured may take so long to stop by itself; then its worker is terminated, as others are at
 * once. Only the next call waits for it. It stops within 20 ms; a machine with other work to do takes longer.
 */
const GRACE_MS = 1000;

/** A pool that has not started by then never will, and the single-threaded build takes over. */
const POOL_LIMIT_MS = 30_000;

/**
 * @param {Bindings} bindings of the single-threaded build
 * @param {CoreOptions} options
 * @returns {Promise<Host>}
 */
export async function inProcessHost(bindings, options) {
  const core = await Core.start(bindings, options);
  let ended = false;
  return {
    async run(request, watch) {
      await nextTask(); // timers and events between two calls get their turn: an abort among them is seen
      watch.signal?.throwIfAborted();
      return runHere(core, request, watch);
    },
    usable: () => core.alive && !ended,
    end: () => void (ended = true),
  };
}

/**
 * Does a request in this thread, which hears of an abort only when it comes from `onProgress`.
 * @param {Core} core
 * @param {Request} request
 * @param {Watch} watch
 */
export function runHere(core, request, { signal, onProgress }) {
  /** @type {{ error: unknown } | undefined} */
  let stopped;
  try {
    return core.run(request, (progress) => {
      try {
        onProgress?.(progress);
        signal?.throwIfAborted();
      } catch (error) {
        stopped = { error };
      }
      return stopped !== undefined;
    });
  } catch (error) {
    throw stopped ? stopped.error : error;
  }
}

/**
 * @param {() => WorkerLike} startWorker
 * @param {CoreOptions & { threads: number, poolLimitMs?: number }} options
 * @returns {Promise<Host>}
 */
export async function workerHost(startWorker, { build, threads, module, memory, poolLimitMs = POOL_LIMIT_MS }) {
  /** The first computes, the others lend it their threads. */
  const workers = [connect(startWorker())];
  const [main] = workers;
  let alive = true;
  const end = () => {
    if (!alive) return;
    alive = false;
    for (const worker of workers) worker.terminate();
  };
  /** Why it died. @type {{ error: unknown } | undefined} */
  let death;
  /** @type {(error: unknown) => void} */
  let tell = () => {};
  /** @param {unknown} error */
  const die = (error) => {
    end();
    death ??= { error };
    tell(error);
  };
  /**
   * What `promise` gives, or why the host died. `Promise.race` would keep every answer as long as the host lives.
   * @param {Promise<any>} promise
   * @returns {Promise<any>}
   */
  const unlessDead = (promise) => new Promise((resolve, reject) => {
    tell = reject;
    promise.then(resolve, reject);
    if (death) reject(death.error);
  });

  /** Not 0: the call under way is to stop. Where memory cannot be shared, a worker that computes hears nothing. */
  const stop = typeof SharedArrayBuffer === 'function' ? new Int32Array(new SharedArrayBuffer(4)) : undefined;

  const start = async () => {
    await main.ask({ start: { build, module, memory, stop } });
    if (build !== 'threads' || !alive) return;
    workers.push(...Array.from({ length: threads }, () => connect(startWorker())));
    const pool = workers.slice(1);
    await Promise.all(pool.map((worker) => worker.ask({ start: { build, module, memory } })));
    for (const worker of pool) worker.ask({ request: { call: 'lendThread', args: [] } }).catch(die);
    await main.ask({ request: { call: 'buildPool', args: [threads] } });
  };

  const late = build === 'threads' && setTimeout(() => {
    die(new PointweaveError({ code: 'internal', message: `no pool within ${poolLimitMs / 1000} s` }));
  }, poolLimitMs);
  main.hold(true);
  try {
    await unlessDead(start());
  } catch (error) {
    end();
    throw error;
  } finally {
    if (late) clearTimeout(late);
    main.hold(false);
  }

  return {
    async run(request, { signal, onProgress }) {
      /** @type {ReturnType<typeof setTimeout> | undefined} */
      let grace;
      const abort = () => {
        if (!stop || !keeps(request)) return die(signal?.reason);
        Atomics.store(stop, 0, 1);
        grace = setTimeout(() => die(signal?.reason), GRACE_MS);
      };
      if (stop) Atomics.store(stop, 0, 0);
      signal?.addEventListener('abort', abort);
      main.hold(true);
      try {
        const answer = main.ask({ request }, (progress) => {
          try {
            if (alive) onProgress?.(progress);
          } catch (error) {
            die(error);
          }
        });
        const result = await unlessDead(answer);
        if (!signal?.aborted) return result;
      } catch (error) {
        if (isFatal(error)) end();
        if (!signal?.aborted) throw error;
      } finally {
        clearTimeout(grace);
        signal?.removeEventListener('abort', abort);
        main.hold(false);
      }
      throw signal.reason;
    },
    usable: () => alive,
    end,
  };
}

/** Whether a request leaves something in the worker that the next one can use. @param {Request} request */
function keeps({ args }) {
  return /** @type {{ keep?: boolean } | undefined} */ (args[1])?.keep === true;
}

/**
 * Questions to a worker, one at a time, as promises.
 * @param {WorkerLike} worker
 */
function connect(worker) {
  /** @type {{ resolve: (value: any) => void, reject: (error: unknown) => void, progress?: (progress: Progress) => void }} */
  let asked = { resolve() {}, reject() {} };
  let started = false;
  worker.listen(
    (message) => {
      started = true;
      if ('progress' in message) asked.progress?.(message.progress);
      else if ('error' in message) asked.reject(new PointweaveError(message.error));
      else asked.resolve(message.value);
    },
    (why) => asked.reject(started
      ? new PointweaveError({ code: 'internal', message: `the worker died: ${why}` })
      : new PointweaveError({ code: 'load-failed', message: `the worker did not start: ${why}` })),
  );
  return {
    /**
     * @param {ToWorker} message its arrays are handed over
     * @param {(progress: Progress) => void} [progress]
     * @returns {Promise<any>}
     */
    ask: (message, progress) =>
      new Promise((resolve, reject) => {
        asked = { resolve, reject, progress };
        worker.post(message, buffersOf(message));
      }).finally(() => {
        asked.progress = undefined; // an idle worker keeps nothing of its last caller
      }),
    hold: worker.hold,
    terminate: worker.terminate,
  };
}

/** Resolves after the events that are already waiting. */
function nextTask() {
  return new Promise((resolve) => setTimeout(resolve));
}
