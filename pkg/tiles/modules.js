/** The wasm of the steps, in this thread. */
import { readFile } from 'node:fs/promises';
import { withInstance } from '../engine/instance.js';
import { platform } from '../engine/platform.node.js';

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
export function withModule(build, signal, job) {
  /** @type {[Promise<WebAssembly.Module>, Promise<Bindings>]} */
  const wasm = build === 'tiles' ? [compileOwn(), loadOwn()] : [platform.compile(build, undefined), platform.loadBindings(build)];
  return withInstance(wasm, /** @type {WasmBuild} */ (build), { signal }, job);
}

function compileOwn() {
  compiled ??= readFile(new URL('../wasm/tiles/pointweave_bg.wasm', import.meta.url)).then((bytes) => WebAssembly.compile(bytes));
  return compiled;
}

/** @returns {Promise<Bindings>} */
async function loadOwn() {
  return (await import('../wasm/tiles/pointweave.js')).makeBindings();
}
