/** A file's bytes from its address, with progress, and what went wrong as the package's own error. */
import { PointweaveError } from '../engine/errors.js';

/**
 * @param {string} src
 * @param {{ signal: AbortSignal, onProgress: (fraction: number) => void }} watch
 * @returns {Promise<Uint8Array>}
 */
export async function fetchBytes(src, { signal, onProgress }) {
  try {
    const response = await fetch(src, { signal });
    if (!response.ok) throw failed(`${src} did not load: ${response.status} ${response.statusText}`.trim(), response.status);
    return new Uint8Array(await counted(response, onProgress).arrayBuffer());
  } catch (error) {
    signal.throwIfAborted();
    throw error instanceof PointweaveError ? error : failed(`${src} did not load: ${error instanceof Error ? error.message : error}`);
  }
}

/**
 * The response, counted as it comes. Where its length is not told, the share that is done is not known either.
 * @param {Response} response
 * @param {(fraction: number) => void} onProgress
 */
function counted(response, onProgress) {
  const length = Number(response.headers.get('content-length'));
  if (!response.body || !length) return response;
  let sum = 0;
  const count = new TransformStream({
    transform(chunk, controller) {
      sum += chunk.byteLength;
      onProgress(Math.min(1, sum / length)); // a compressed response is longer than it says
      controller.enqueue(chunk);
    },
  });
  return new Response(response.body.pipeThrough(count));
}

/** @param {string} message @param {number} [found] */
function failed(message, found) {
  return new PointweaveError({ code: 'load-failed', message, found });
}
