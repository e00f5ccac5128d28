/** The modules that wasm-bindgen writes. Their names are spelled out, for bundlers to see them. */

/**
 * An instance of its own, not started. Nothing keeps it but its owner.
 * @param {import('./types.js').Build} build
 * @returns {Promise<import('./core.js').Glue>}
 */
export async function loadGlue(build) {
  const { makeGlue } = await (build === 'threads' ? import('./wasm/threads/pointweave.js') : import('./wasm/single/pointweave.js'));
  return makeGlue();
}
