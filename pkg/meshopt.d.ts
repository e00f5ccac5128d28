/**
 * Compresses a GLB file that `write` made, without loss (`EXT_meshopt_compression`). Needs `@gltf-transform/core`,
 * `@gltf-transform/extensions` and `meshoptimizer`. Where a bundler makes the program, hand it to `write` as `meshopt`.
 */
export function compress(glb: Uint8Array): Promise<Uint8Array>;
