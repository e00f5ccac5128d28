/** The modules that wasm-bindgen writes. Their names are spelled out, for bundlers to see them. */

/** @type {Record<import('./core.js').WasmBuild, () => Promise<{ makeBindings: () => import('./core.js').Bindings }>>} */
const MODULES = {
  single: () => import('../wasm/single/pointweave.js'),
  threads: () => import('../wasm/threads/pointweave.js'),
  files: () => import('../wasm/files/pointweave.js'),
  las: () => import('../wasm/las/pointweave.js'),
  e57: () => import('../wasm/e57/pointweave.js'),
  packed: () => import('../wasm/packed/pointweave.js'),
  pictures: () => import('../wasm/pictures/pointweave.js'),
  exports: () => import('../wasm/exports/pointweave.js'),
  prepare: () => import('../wasm/prepare/pointweave.js'),
  light: () => import('../wasm/light/pointweave.js'),
  samples: () => import('../wasm/samples/pointweave.js'),
};

/**
 * An instance of its own, not started. Nothing keeps it but its owner.
 * @param {import('./core.js').WasmBuild} build
 * @returns {Promise<import('./core.js').Bindings>}
 */
export async function loadBindings(build) {
  const { makeBindings } = await MODULES[build]();
  return makeBindings();
}
