/** An instance of wasm for one job, in the thread that asks. */
import { inProcessHost } from './worker-host.js';

/** @import { Bindings, Request, WasmBuild } from './core.js' */

/**
 * Does something with an instance that is made for it.
 * @template T
 * @param {[Promise<WebAssembly.Module>, Promise<Bindings>]} wasm
 * @param {WasmBuild} build
 * @param {import('./worker-host.js').Watch} watch
 * @param {(ask: (request: Request) => Promise<any>) => Promise<T>} job
 * @returns {Promise<T>}
 */
export async function withInstance(wasm, build, watch, job) {
  const [module, bindings] = await Promise.all(wasm);
  const host = await inProcessHost(bindings, { build, module });
  return job((request) => host.run(request, watch));
}
