/**
 * The worker's side of {@link import('./hosts.js').workerHost}: starts one core, then answers one
 * request after the other. It is never asked to stop; who has enough of it terminates the worker.
 */
import { buffersOf } from './arrays.js';
import { Core } from './core.js';
import { toRecord } from './errors.js';

/**
 * @typedef {{ start: import('./core.js').CoreOptions } | { request: import('./core.js').Request }} ToWorker
 * @typedef {{ value: any } | { error: import('./errors.js').ErrorRecord } | { progress: import('./types.js').Progress }} FromWorker
 */

/**
 * @param {{ listen: (receive: (message: ToWorker) => void) => void,
 *   post: (message: FromWorker, transfer?: ArrayBuffer[]) => void }} port
 * @param {(build: import('./core.js').WasmBuild) => Promise<import('./core.js').Glue>} loadGlue
 */
export function serve(port, loadGlue) {
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
    return message.start.build === 'threads' ? core.memory : undefined; // to share it
  };

  port.listen((message) => {
    answer(message).then(
      (value) => port.post({ value }, buffersOf(value)),
      (error) => port.post({ error: toRecord(error) }),
    );
  });
}
