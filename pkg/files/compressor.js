/** Finds what makes files smaller, where it is asked for: most programs neither have nor need it. */
import { PointweaveError } from '../engine/errors.js';

/** What does it, and the packages that it imports. No bundler is to follow them: they need not be there. */
const PEERS = {
  meshopt: { module: '../meshopt.js', name: 'compress', packages: ['@gltf-transform/core', '@gltf-transform/extensions', 'meshoptimizer'] },
  webp: { module: '../webp.js', name: 'webp', packages: ['@jsquash/webp'] },
  ktx2: { module: '../ktx2.js', name: 'ktx2', packages: ['ktx2-encoder'] },
};

/**
 * @param {boolean | ((glb: Uint8Array) => Promise<Uint8Array>)} meshopt
 * @returns {Promise<((glb: Uint8Array) => Promise<Uint8Array>) | undefined>}
 */
export async function compressorFor(meshopt) {
  if (typeof meshopt === 'function') return meshopt;
  return meshopt ? found('meshopt') : undefined;
}

/**
 * @param {import('../types.js').WriteOptions['pictures']} pictures
 * @returns {Promise<import('../types.js').PictureEncoder | undefined>}
 */
export async function encoderFor(pictures = 'png') {
  if (typeof pictures === 'function') return pictures;
  return pictures === 'png' ? undefined : found(pictures);
}

/** @param {keyof typeof PEERS} what @returns {Promise<any>} */
async function found(what) {
  const { module, name, packages } = PEERS[what];
  try {
    return (await import(/* webpackIgnore: true */ /* turbopackIgnore: true */ /* @vite-ignore */ module))[name];
  } catch (error) {
    const why = error instanceof Error ? error.message : String(error);
    throw new PointweaveError({
      code: 'missing-package',
      message: `${what} needs packages that did not load (${why}): npm install ${packages.join(' ')}; with a bundler, hand over ${name} of pointweave/${what}`,
      expected: packages,
    });
  }
}
