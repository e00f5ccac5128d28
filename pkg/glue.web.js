/** The modules that wasm-bindgen writes. The names are spelled out, for bundlers to see them. */

/** How many instances of a build this realm has asked for. */
const asked = { single: 0, threads: 0 };

/**
 * A module holds one wasm instance, so every instance needs a module of its own; the query makes it so.
 * In a worker the first is the only one.
 * @param {import('./types.js').Build} build
 * @returns {Promise<import('./core.js').Glue>}
 */
export function loadGlue(build) {
  const copy = asked[build]++;
  if (copy > 0) {
    const url = new URL(`./wasm/${build}/pointweave.js`, import.meta.url);
    return import(/* @vite-ignore */ /* webpackIgnore: true */ `${url}?copy=${copy}`);
  }
  return build === 'threads' ? import('./wasm/threads/pointweave.js') : import('./wasm/single/pointweave.js');
}
