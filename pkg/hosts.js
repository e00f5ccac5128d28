/**
 * Where an engine's work is done: in this thread or in a worker. A host takes one request at a time.
 */
import { Core } from './core.js';
import { PointweaveError } from './errors.js';
import { buffersOf } from './serve.js';

/** @import { Build, Progress } from './types.js' */
/** @import { CoreOptions, Glue, Request } from './core.js' */

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
 * @property {(message: import('./serve.js').ToWorker, transfer?: ArrayBuffer[]) => void} post
 * @property {(receive: (message: import('./serve.js').FromWorker) => void, fail: (why: string) => void) => void} listen
 * @property {(busy: boolean) => void} hold whether the process has to wait for it
 * @property {() => void} terminate
 */

/** A pool that has not started by then never will (a policy forbids its workers, say). */
const START_LIMIT_MS = 15_000;

/**
 * @param {Glue} glue
 * @param {CoreOptions} options
 * @returns {Promise<Host>}
 */
export async function inProcessHost(glue, options) {
  const core = await Core.start(glue, options);
  let ended = false;
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
        throw stopped ? stopped.error : error;
      }
    },
    usable: () => !core.broken && !ended,
    end() {
      ended = true;
      glue.stopThreadPool?.();
    },
  };
}

/**
 * @param {WorkerLike} worker
 * @param {CoreOptions} options
 * @returns {Promise<Host>}
 */
export async function workerHost(worker, options) {
  let alive = true;
  /** What the request under way is waiting for. */
  let settle = {
    /** @param {any} _value */
    resolve(_value) {},
    /** @param {unknown} _error */
    reject(_error) {},
    /** @param {Progress} _progress */
    progress(_progress) {},
  };

  const end = () => {
    alive = false;
    worker.terminate();
  };
  worker.listen(
    (message) => {
      if ('progress' in message) settle.progress(message.progress);
      else if ('error' in message) {
        if (message.broken) end();
        settle.reject(new PointweaveError(message.error));
      } else settle.resolve('value' in message ? message.value : undefined);
    },
    (why) => {
      end();
      settle.reject(new PointweaveError({ code: 'internal', message: `the worker died: ${why}` }));
    },
  );

  /**
   * @param {import('./serve.js').ToWorker} message
   * @param {Watch} watch
   * @returns {Promise<any>}
   */
  const ask = (message, { signal, onProgress }) =>
    new Promise((resolve, reject) => {
      const done = () => {
        signal?.removeEventListener('abort', abort);
        worker.hold(false);
      };
      settle = {
        resolve: (value) => (done(), resolve(value)),
        reject: (error) => (done(), reject(error)),
        progress(progress) {
          try {
            onProgress?.(progress);
          } catch (error) {
            stop(error);
          }
        },
      };
      /** @param {unknown} reason */
      const stop = (reason) => {
        end();
        settle.reject(reason);
      };
      const abort = () => stop(signal?.reason);
      signal?.addEventListener('abort', abort);
      worker.hold(true);
      worker.post(message, buffersOf(message));
    });

  const started = ask({ start: options }, {});
  const late = setTimeout(() => {
    end();
    settle.reject(new PointweaveError({ code: 'internal', message: `no start within ${START_LIMIT_MS / 1000} s` }));
  }, START_LIMIT_MS);
  try {
    await started;
  } catch (error) {
    end();
    throw error;
  } finally {
    clearTimeout(late);
  }
  return {
    run: (request, watch) => ask({ request }, watch),
    usable: () => alive,
    end,
  };
}

/** Resolves after the events that are already waiting. */
function nextTask() {
  return new Promise((resolve) => setTimeout(resolve));
}
