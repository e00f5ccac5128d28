/** The modules that wasm-bindgen writes, in Node. */

let copies = 0;

/**
 * A module holds one wasm instance, so every instance needs a module of its own; the query makes it so.
 * @param {import('./core.js').WasmBuild} build
 * @returns {Promise<import('./core.js').Glue>}
 */
export function loadGlue(build) {
  return import(`./wasm/${build}/pointweave.js?copy=${copies++}`);
}
