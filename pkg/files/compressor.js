/** Finds what compresses GLB files, where it is asked for: most programs neither have nor need it. */
import { PointweaveError } from '../engine/errors.js';

/** No bundler is to follow it: the packages that it imports need not be there. */
const MODULE = '../meshopt.js';
const PACKAGES = ['@gltf-transform/core', '@gltf-transform/extensions', 'meshoptimizer'];

/**
 * @param {boolean | ((glb: Uint8Array) => Promise<Uint8Array>)} meshopt
 * @returns {Promise<((glb: Uint8Array) => Promise<Uint8Array>) | undefined>}
 */
export async function compressorFor(meshopt) {
  if (typeof meshopt === 'function') return meshopt;
  if (!meshopt) return undefined;
  try {
    return (await import(/* webpackIgnore: true */ /* turbopackIgnore: true */ /* @vite-ignore */ MODULE)).compress;
  } catch (error) {
    const why = error instanceof Error ? error.message : String(error);
    throw new PointweaveError({
      code: 'missing-package',
      message: `meshopt needs packages that did not load (${why}): npm install ${PACKAGES.join(' ')}; with a bundler, hand over compress of pointweave/meshopt`,
      expected: PACKAGES,
    });
  }
}
