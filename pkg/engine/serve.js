/**
 * The worker's side of {@link import('./worker-host.js').workerHost}: starts one core, then answers one
 * request after the other. Who has enough of it terminates the worker, or raises a flag in shared memory, which stops the
 * request and leaves the core as it is.
 */
import { buffersOf } from './arrays.js';
import { Core } from './core.js';
import { toRecord } from './errors.js';
import { loadBindings } from './wasm-bindings.js';

/**
 * @typedef {{ start: import('./core.js').CoreOptions & { stop?: Int32Array } } | { request: import('./core.js').Request }} ToWorker
 * @typedef {{ value: any } | { error: import('./errors.js').ErrorRecord } | { progress: import('../types.js').Progress }} FromWorker
 */

/**
 * @param {{ listen: (receive: (message: ToWorker) => void) => void,
 *   post: (message: FromWorker, transfer?: ArrayBuffer[]) => void }} port
 */
export function serve(port) {
  /** @type {Core} */
  let core;
  /** @type {Int32Array | undefined} */
  let stop;

  /** @param {ToWorker} message */
  const answer = async (message) => {
    if ('request' in message) {
      return core.run(message.request, (progress) => {
        port.post({ progress });
        return stop !== undefined && Atomics.load(stop, 0) !== 0;
      });
    }
    stop = message.start.stop;
    core = await Core.start(await loadBindings(message.start.build), message.start);
  };

  port.listen((message) => {
    answer(message).then(
      (value) => port.post({ value }, buffersOf(value)),
      (error) => port.post({ error: toRecord(error) }),
    );
  });
}
