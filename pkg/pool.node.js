/** Workers of the pool, in Node. */
import { Worker } from 'node:worker_threads';

/**
 * @param {import('./pool.js').Share} share
 * @returns {import('./pool.js').PoolWorker}
 */
export function startPoolWorker(share) {
  const worker = new Worker(new URL('./pool-worker.node.js', import.meta.url), { workerData: share, name: 'pointweave-pool' });
  const ready = new Promise((resolve, reject) => {
    worker.once('message', () => resolve(undefined));
    worker.once('error', reject);
  });
  return {
    // From then on a process may end without waiting for it.
    ready: ready.then(() => worker.unref()),
    terminate: () => void worker.terminate(),
  };
}
