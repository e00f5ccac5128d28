/**
 * The worker's side of a {@link import('./hosts.js').workerHost}: starts one core, then answers one
 * request after the other. It is never asked to stop; who has enough of it terminates the worker.
 */
import { Core } from './core.js';
import { toRecord } from './errors.js';

/**
 * @typedef {import('./core.js').CoreOptions} StartMessage
 * @typedef {{ start: StartMessage } | { request: import('./core.js').Request }} ToWorker
 * @typedef {{ started: true } | { progress: import('./types.js').Progress } | { value: any }
 *   | { error: import('./errors.js').ErrorRecord, broken: boolean }} FromWorker
 */

/**
 * @param {{ listen: (receive: (message: ToWorker) => void) => void,
 *   post: (message: FromWorker, transfer?: ArrayBuffer[]) => void }} port
 * @param {(build: import('./types.js').Build) => Promise<import('./core.js').Glue>} loadGlue
 */
export function serve(port, loadGlue) {
  /** @type {Core | undefined} */
  let core;

  /** @param {ToWorker} message */
  const answer = async (message) => {
    try {
      if ('start' in message) {
        core = await Core.start(await loadGlue(message.start.build), message.start);
        port.post({ started: true });
      } else if (core) {
        const value = core.run(message.request, (progress) => {
          port.post({ progress });
          return false; // an abort terminates the worker
        });
        port.post({ value }, buffersOf(value));
      }
    } catch (error) {
      port.post({ error: toRecord(error), broken: core?.broken ?? true });
    }
  };
  port.listen(answer);
}

/**
 * The buffers of all typed arrays in a result, to hand over instead of copy.
 * @param {unknown} value
 * @param {Set<ArrayBuffer>} [found]
 * @returns {ArrayBuffer[]}
 */
export function buffersOf(value, found = new Set()) {
  if (ArrayBuffer.isView(value)) {
    if (value.buffer instanceof ArrayBuffer) found.add(value.buffer);
  } else if (typeof value === 'object' && value !== null) {
    for (const part of Object.values(value)) buffersOf(part, found);
  }
  return [...found];
}
