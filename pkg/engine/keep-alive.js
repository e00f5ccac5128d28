/** Keeps Node's event loop alive while a promise is pending. */

/** As long as a timer can be. */
const LONG_MS = 2 ** 31 - 1;

/**
 * What a promise gives. A process that has nothing else to wait for drains V8's background tasks instead, as while wasm is
 * compiled, and can lock itself up when one of them needs a garbage collection; a timer is something to wait for.
 * @template T
 * @param {Promise<T>} promise
 */
export async function keepAlive(promise) {
  const timer = setInterval(() => {}, LONG_MS);
  try {
    return await promise;
  } finally {
    clearInterval(timer);
  }
}
