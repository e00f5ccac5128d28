/** The pictures of `environment-image`: equirectangular, an HDR file or any image that the browser reads. */
import { EquirectangularReflectionMapping, TextureLoader, SRGBColorSpace } from 'three';
import { PointweaveError } from '../engine/errors.js';

/** @param {string} address @returns {Promise<import('three').Texture>} */
export async function surroundingsAt(address) {
  const { pathname } = new URL(address, document.baseURI);
  try {
    const texture = /\.hdr$/i.test(pathname) ? await hdrAt(address) : await new TextureLoader().loadAsync(address);
    texture.mapping = EquirectangularReflectionMapping;
    if (!/\.hdr$/i.test(pathname)) texture.colorSpace = SRGBColorSpace;
    return texture;
  } catch (error) {
    throw new PointweaveError({ code: 'load-failed', message: `${address} did not load: ${error instanceof Error ? error.message : 'it is no picture'}` });
  }
}

/** @param {string} address */
async function hdrAt(address) {
  const { RGBELoader } = await import('three/addons/loaders/RGBELoader.js');
  return new RGBELoader().loadAsync(address);
}
