/** One engine for all elements that want the same; it is loaded and made when the first scan comes. */

/** @import { Engine, EngineOptions } from '../types.js' */

/** @type {Map<string, Promise<Engine>>} */
const engines = new Map();

/** @param {EngineOptions} options */
export function sharedEngine(options) {
  const key = JSON.stringify(options);
  let engine = engines.get(key);
  if (!engine) {
    engine = import('../index.js').then(({ createEngine }) => createEngine(options));
    engine.catch(() => engines.delete(key)); // the next one tries again
    engines.set(key, engine);
  }
  return engine;
}
