/** The wasm of the steps, in this thread. */
import { readFile } from 'node:fs/promises';
import { platform } from '../engine/platform.node.js';
import { inProcessHost } from '../engine/worker-host.js';

/** @import { Bindings, Request, WasmBuild } from '../engine/core.js' */
/** @typedef {(request: Request) => Promise<any>} Ask */

/** No page loads that of tiles, so nothing but this knows of it. @type {Promise<WebAssembly.Module> | undefined} */
let compiled;

/**
 * Does something with an instance that is made for it.
 * @template T
 * @param {WasmBuild | 'tiles'} build
 * @param {AbortSignal} signal
 * @param {(ask: Ask) => Promise<T>} job
 * @returns {Promise<T>}
 */
export async function withModule(build, signal, job) {
  const [module, bindings] = await (build === 'tiles' ? ownModule() : Promise.all([platform.compile(build, undefined), platform.loadBindings(build)]));
  const host = await inProcessHost(bindings, { build: /** @type {WasmBuild} */ (build), module });
  return job((request) => host.run(request, { signal }));
}

/** @returns {Promise<[WebAssembly.Module, Bindings]>} */
async function ownModule() {
  const wasm = new URL('../wasm/tiles/pointweave_bg.wasm', import.meta.url);
  compiled ??= readFile(wasm).then((bytes) => WebAssembly.compile(bytes));
  const { makeBindings } = await import('../wasm/tiles/pointweave.js');
  return [await compiled, makeBindings()];
}
