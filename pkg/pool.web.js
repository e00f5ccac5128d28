/** Workers of the pool, in a browser. */

/**
 * Keeps them from being collected, which Firefox does to a worker that nothing names.
 * @type {Set<Worker>}
 */
const alive = new Set();

/**
 * @param {import('./pool.js').Share} share
 * @returns {import('./pool.js').PoolWorker}
 */
export function startPoolWorker(share) {
  const worker = new Worker(new URL('./pool-worker.js', import.meta.url), { type: 'module', name: 'pointweave-pool' });
  alive.add(worker);
  worker.postMessage(share);
  return {
    ready: new Promise((resolve, reject) => {
      worker.onmessage = () => resolve();
      worker.onerror = (event) => reject(new Error(event.message ?? 'the script of a pool worker did not load'));
    }),
    terminate() {
      alive.delete(worker);
      worker.terminate();
    },
  };
}
