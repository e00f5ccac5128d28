import { BufferAttribute, BufferGeometry, Mesh, Points } from 'three';
import { toFrame } from './frame.js';
import { meshMaterial, pointMaterial } from './materials.js';

/** @import { Frame } from './frame.js' */

/**
 * What a layer is made of: a cloud, or a mesh when there are indices.
 * @typedef {object} Drawable
 * @property {Float32Array | Float64Array} positions
 * @property {[number, number, number]} [origin]
 * @property {Float32Array} [normals]
 * @property {Uint8Array} [colors]
 * @property {Uint32Array} [indices]
 */

/** Area of a scanned surface over the squared diagonal of its box: about that of a sphere. */
const TYPICAL_AREA = 0.9;
/** Points wider than their spacing close the surface; narrower ones can be told apart. */
const SCAN_COVER = 1.6;
const REDUCED_COVER = 0.85;

/**
 * One draw call for each layer.
 * @param {Drawable} source
 * @param {Frame} frame
 */
export function cloudLayer(source, frame) {
  const shaded = Boolean(source.normals);
  const spacing = Math.sqrt(TYPICAL_AREA / Math.max(1, source.positions.length / 3));
  const diameter = spacing * (shaded ? REDUCED_COVER : SCAN_COVER);
  const geometry = geometryOf(source, frame);
  if (source.colors) geometry.setAttribute('color', new BufferAttribute(source.colors, 3, true));
  const layer = new Points(geometry, pointMaterial({ colored: Boolean(source.colors), shaded, diameter }));
  layer.frustumCulled = false;
  return layer;
}

/**
 * @param {Drawable} source
 * @param {Frame} frame
 */
export function meshLayer(source, frame) {
  const geometry = geometryOf(source, frame);
  geometry.setIndex(new BufferAttribute(/** @type {Uint32Array} */ (source.indices), 1));
  if (source.colors) geometry.setAttribute('color', new BufferAttribute(linearColors(source.colors), 3, true));
  const layer = new Mesh(geometry, meshMaterial({ colored: Boolean(source.colors) }));
  layer.frustumCulled = false;
  return layer;
}

/** Frees what a layer holds on the GPU. */
export function disposeLayer(/** @type {Points | Mesh} */ layer) {
  layer.geometry.dispose();
  const material = /** @type {import('three').Material & { matcap?: import('three').Texture }} */ (layer.material);
  material.matcap?.dispose();
  material.dispose();
}

function geometryOf(/** @type {Drawable} */ source, /** @type {Frame} */ frame) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(toFrame(source, frame), 3));
  if (source.normals) geometry.setAttribute('normal', new BufferAttribute(source.normals, 3));
  return geometry;
}

/** three.js lights in linear colour: sRGB bytes to linear 16-bit values, by a table. */
function linearColors(/** @type {Uint8Array} */ colors) {
  const table = Uint16Array.from({ length: 256 }, (_, value) => {
    const srgb = value / 255;
    return 65535 * (srgb <= 0.04045 ? srgb / 12.92 : ((srgb + 0.055) / 1.055) ** 2.4);
  });
  return Uint16Array.from(colors, (value) => table[value]);
}
