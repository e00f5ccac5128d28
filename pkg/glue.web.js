/** The modules that wasm-bindgen writes. The names are spelled out, for bundlers to see them. */

/** How many instances of a build this realm has asked for. */
const asked = { single: 0, threads: 0, files: 0, las: 0, e57: 0 };

/**
 * A module holds one wasm instance, so every instance needs a module of its own; the query makes it so.
 * In a worker the first is the only one.
 * @param {import('./core.js').WasmBuild} build
 * @returns {Promise<import('./core.js').Glue>}
 */
export function loadGlue(build) {
  const copy = asked[build]++;
  if (copy > 0) {
    const url = new URL(`./wasm/${build}/pointweave.js`, import.meta.url);
    return import(/* @vite-ignore */ /* webpackIgnore: true */ `${url}?copy=${copy}`);
  }
  switch (build) {
    case 'threads': return import('./wasm/threads/pointweave.js');
    case 'files': return import('./wasm/files/pointweave.js');
    case 'las': return import('./wasm/las/pointweave.js');
    case 'e57': return import('./wasm/e57/pointweave.js');
    default: return import('./wasm/single/pointweave.js');
  }
}
