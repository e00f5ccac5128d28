/** The wasm of the steps, in this thread. */
import { readFile } from 'node:fs/promises';
import { platform } from '../engine/platform.node.js';
import { inProcessHost } from '../engine/worker-host.js';

/** @import { Request, WasmBuild } from '../engine/core.js' */
/** @typedef {(request: Request) => Promise<any>} Ask */

/**
 * Does something with an instance that is made for it.
 * @template T
 * @param {WasmBuild} build
 * @param {AbortSignal} signal
 * @param {(ask: Ask) => Promise<T>} job
 * @returns {Promise<T>}
 */
export async function withModule(build, signal, job) {
  const [module, bindings] = await Promise.all([platform.compile(build, undefined), bindingsOf(build)]);
  const host = await inProcessHost(bindings, { build, module });
  return job((request) => host.run(request, { signal }));
}

/** No page loads those of tiles, so no bundler needs to know of them. @param {WasmBuild} build */
async function bindingsOf(build) {
  return build === 'tiles' ? (await import('../wasm/tiles/pointweave.js')).makeBindings() : platform.loadBindings(build);
}

/** The package's version. */
export async function version() {
  return JSON.parse(await readFile(new URL('../package.json', import.meta.url), 'utf8')).version;
}
