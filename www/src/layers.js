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

/** Points wider than their spacing close the surface; narrower ones can be told apart. */
const SCAN_COVER = 1.8;
const REDUCED_COVER = 0.85;
/** However sparse the scan, its points stay points: a share of the diagonal. */
const LARGEST = 0.012;

/**
 * One draw call for each layer.
 * @param {Drawable} source
 * @param {Frame} frame
 */
export function cloudLayer(source, frame) {
  const shaded = Boolean(source.normals);
  const geometry = geometryOf(source, frame);
  const spacing = typicalSpacing(/** @type {Float32Array} */ (geometry.getAttribute('position').array));
  const diameter = Math.min(LARGEST, spacing * (shaded ? REDUCED_COVER : SCAN_COVER));
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

/**
 * Mean distance between neighbours, from the area that the points cover: the share of a coarse grid's cells that
 * hold a point, each standing for the piece of surface that crosses it.
 */
function typicalSpacing(/** @type {Float32Array} */ positions) {
  const cells = 64;
  const areaOfCell = 0.7 / cells ** 2;
  const taken = new Uint8Array(cells ** 3);
  const index = (/** @type {number} */ value) => Math.min(cells - 1, Math.max(0, Math.floor((value + 0.5) * cells)));
  let count = 0;
  for (let i = 0; i < positions.length; i += 3) {
    const cell = index(positions[i]) + cells * (index(positions[i + 1]) + cells * index(positions[i + 2]));
    count += 1 - taken[cell];
    taken[cell] = 1;
  }
  return Math.sqrt((areaOfCell * count) / Math.max(1, positions.length / 3));
}

/** three.js lights in linear colour: sRGB bytes to linear 16-bit values, by a table. */
function linearColors(/** @type {Uint8Array} */ colors) {
  const table = Uint16Array.from({ length: 256 }, (_, value) => {
    const srgb = value / 255;
    return 65535 * (srgb <= 0.04045 ? srgb / 12.92 : ((srgb + 0.055) / 1.055) ** 2.4);
  });
  return Uint16Array.from(colors, (value) => table[value]);
}
