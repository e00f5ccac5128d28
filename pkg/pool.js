/**
 * The workers of the threads build. Each runs the same wasm module over the same memory and lends its
 * thread to the pool that `src/pool.rs` builds.
 */

/**
 * What a worker of the pool is started with.
 * @typedef {{ module: WebAssembly.Module, memory: WebAssembly.Memory }} Share
 */

/**
 * @typedef {object} PoolWorker
 * @property {Promise<void>} ready settles when its instance stands and it is about to lend its thread
 * @property {() => void} terminate
 */

/**
 * @param {{ buildPool?: (threads: number) => void }} glue the instance that will use the pool
 * @param {number} threads
 * @param {Share} share
 * @param {(share: Share) => PoolWorker} startWorker
 * @returns {Promise<() => void>} ends the pool; the instance must not be called again
 */
export async function startPool(glue, threads, share, startWorker) {
  const workers = Array.from({ length: threads }, () => startWorker(share));
  const end = () => {
    for (const worker of workers) worker.terminate();
  };
  try {
    await Promise.all(workers.map(({ ready }) => ready));
    glue.buildPool?.(threads);
  } catch (error) {
    end();
    throw error;
  }
  return end;
}

/**
 * A worker's side.
 * @param {{ default: (from: { module_or_path: WebAssembly.Module, memory: WebAssembly.Memory }) => Promise<unknown>,
 *   runWorker: () => void }} glue
 * @param {Share} share
 * @param {() => void} ready
 */
export async function lendThread(glue, { module, memory }, ready) {
  await glue.default({ module_or_path: module, memory });
  ready();
  glue.runWorker();
}
