/** One engine for all elements that want the same number of threads; it is loaded and made when the first scan comes. */

/** @import { Engine, EngineOptions } from '../types.js' */

/** @type {Map<string, Promise<Engine>>} */
const engines = new Map();

/**
 * @param {'auto' | number} threads
 * @param {EngineOptions['wasmUrl']} wasmUrl
 */
export function sharedEngine(threads, wasmUrl) {
  const key = JSON.stringify([threads, wasmUrl]);
  let engine = engines.get(key);
  if (!engine) {
    engine = import('../index.js').then(({ createEngine }) => createEngine({ threads, wasmUrl }));
    engine.catch(() => engines.delete(key)); // the next one tries again
    engines.set(key, engine);
  }
  return engine;
}
