/**
 * Where an engine's work is done: in this thread, or in a worker with or without more that lend it
 * their threads. A host takes one request at a time.
 */
import { buffersOf } from './arrays.js';
import { Core } from './core.js';
import { PointweaveError } from './errors.js';

/** @import { Build, Progress } from './types.js' */
/** @import { CoreOptions, Glue, Request } from './core.js' */
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

/** A pool that has not started by then never will, and the single-threaded build takes over. */
const POOL_LIMIT_MS = 30_000;

/**
 * @param {Glue} glue of the single-threaded build
 * @param {CoreOptions} options
 * @returns {Promise<Host>}
 */
export async function inProcessHost(glue, options) {
  const core = await Core.start(glue, options);
  let usable = true;
  return {
    async run(request, { signal, onProgress }) {
      await nextTask(); // timers and events between two calls get their turn: an abort among them is seen
      signal?.throwIfAborted();
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
        if (stopped) throw stopped.error;
        usable = !isFatal(error);
        throw error;
      }
    },
    usable: () => usable,
    end: () => void (usable = false),
  };
}

/**
 * @param {() => WorkerLike} startWorker
 * @param {CoreOptions & { threads: number }} options
 * @returns {Promise<Host>}
 */
export async function workerHost(startWorker, { build, threads, module }) {
  /** The first computes, the others lend it their threads. */
  const workers = [connect(startWorker())];
  const [main] = workers;
  let alive = true;
  const end = () => {
    alive = false;
    for (const worker of workers) worker.terminate();
  };
  /** @param {unknown} error */
  const die = (error) => {
    end();
    main.fail(error);
  };

  const start = async () => {
    const memory = await main.ask({ start: { build, module } });
    if (build !== 'threads') return;
    workers.push(...Array.from({ length: threads }, () => connect(startWorker())));
    const pool = workers.slice(1);
    await Promise.all(pool.map((worker) => worker.ask({ start: { build, module, memory } })));
    for (const worker of pool) worker.ask({ request: { call: 'lendThread', args: [] } }).catch(die);
    await main.ask({ request: { call: 'buildPool', args: [threads] } });
  };

  const late = build === 'threads' && setTimeout(() => {
    die(new PointweaveError({ code: 'internal', message: `no pool within ${POOL_LIMIT_MS / 1000} s` }));
  }, POOL_LIMIT_MS);
  main.hold(true);
  try {
    await start();
  } catch (error) {
    end();
    throw error;
  } finally {
    if (late) clearTimeout(late);
    main.hold(false);
  }

  return {
    async run(request, { signal, onProgress }) {
      const abort = () => die(signal?.reason);
      signal?.addEventListener('abort', abort);
      main.hold(true);
      try {
        return await main.ask({ request }, (progress) => {
          try {
            onProgress?.(progress);
          } catch (error) {
            die(error);
          }
        });
      } catch (error) {
        if (isFatal(error)) end();
        throw error;
      } finally {
        signal?.removeEventListener('abort', abort);
        main.hold(false);
      }
    },
    usable: () => alive,
    end,
  };
}

/**
 * Questions to a worker, one at a time, as promises.
 * @param {WorkerLike} worker
 */
function connect(worker) {
  /** @type {{ resolve: (value: any) => void, reject: (error: unknown) => void, progress?: (progress: Progress) => void }} */
  let asked = { resolve() {}, reject() {} };
  worker.listen(
    (message) => {
      if ('progress' in message) asked.progress?.(message.progress);
      else if ('error' in message) asked.reject(new PointweaveError(message.error));
      else asked.resolve(message.value);
    },
    (why) => asked.reject(new PointweaveError({ code: 'internal', message: `the worker died: ${why}` })),
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
      }),
    /** Rejects the question under way. @param {unknown} error */
    fail(error) {
      asked.progress = undefined;
      asked.reject(error);
    },
    hold: worker.hold,
    terminate: worker.terminate,
  };
}

/**
 * Whether an instance that threw this must not be called again.
 * @param {unknown} error
 */
function isFatal(error) {
  return !(error instanceof PointweaveError) || error.code === 'internal' || error.code === 'out-of-memory';
}

/** Resolves after the events that are already waiting. */
function nextTask() {
  return new Promise((resolve) => setTimeout(resolve));
}
