/**
 * The worker's side of {@link import('./hosts.js').workerHost}: starts one core, then answers one
 * request after the other. It is never asked to stop; who has enough of it terminates the worker.
 */
import { buffersOf } from './arrays.js';
import { Core } from './core.js';
import { toRecord } from './errors.js';
import { loadGlue } from './glue.js';

/**
 * @typedef {{ start: import('./core.js').CoreOptions } | { request: import('./core.js').Request }} ToWorker
 * @typedef {{ value: any } | { error: import('./errors.js').ErrorRecord } | { progress: import('./types.js').Progress }} FromWorker
 */

/**
 * @param {{ listen: (receive: (message: ToWorker) => void) => void,
 *   post: (message: FromWorker, transfer?: ArrayBuffer[]) => void }} port
 */
export function serve(port) {
  /** @type {Core} */
  let core;

  /** @param {ToWorker} message */
  const answer = async (message) => {
    if ('request' in message) {
      return core.run(message.request, (progress) => {
        port.post({ progress });
        return false; // an abort terminates the worker
      });
    }
    core = await Core.start(await loadGlue(message.start.build), message.start);
  };

  port.listen((message) => {
    answer(message).then(
      (value) => port.post({ value }, buffersOf(value)),
      (error) => port.post({ error: toRecord(error) }),
    );
  });
}
