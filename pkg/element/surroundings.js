/** The pictures of `environment-image`: equirectangular, an HDR file or any image that the browser reads. */
import { EquirectangularReflectionMapping, TextureLoader, SRGBColorSpace } from 'three';
import { PointweaveError } from '../engine/errors.js';

/** Those of all elements of the page, by address. @type {Map<string, Promise<import('three').Texture>>} */
const made = new Map();

/** @param {string} address */
export function surroundingsAt(address) {
  const known = made.get(address) ?? load(address);
  made.set(address, known);
  known.catch(() => made.delete(address));
  return known;
}

/** @param {string} address @returns {Promise<import('three').Texture>} */
async function load(address) {
  try {
    const isHdr = /\.hdr$/i.test(new URL(address, document.baseURI).pathname);
    const texture = isHdr ? await hdrAt(address) : await new TextureLoader().loadAsync(address);
    texture.mapping = EquirectangularReflectionMapping;
    if (!isHdr) texture.colorSpace = SRGBColorSpace;
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
