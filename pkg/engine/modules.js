/** Compiled wasm, kept: a fresh worker after an abort then starts in milliseconds. */

/** @type {Map<string, Promise<WebAssembly.Module>>} */
const modules = new Map();

/**
 * @param {string} url
 * @param {(url: string) => Promise<WebAssembly.Module>} compile a failure is forgotten
 */
export function compileOnce(url, compile) {
  let module = modules.get(url);
  if (!module) {
    module = compile(url);
    modules.set(url, module);
    module.catch(() => modules.delete(url));
  }
  return module;
}
