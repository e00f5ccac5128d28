/** Scans and meshes as things to draw, one draw call each. */
import { BufferAttribute, BufferGeometry, Mesh, Points } from 'three';
import { toFrame, typicalSpacing } from './frame.js';
import { meshMaterial, pointMaterial } from './materials.js';

/** @import { Frame } from './frame.js' */
/** @import { Normals } from './materials.js' */

/**
 * A cloud, or a mesh where there are indices.
 * @typedef {object} Drawable
 * @property {Float32Array | Float64Array} positions
 * @property {[number, number, number]} [origin]
 * @property {Float32Array} [normals]
 * @property {Uint8Array} [colors]
 * @property {Uint32Array} [indices]
 */

/** Points wider than their spacing close the surface; narrower ones can be told apart, which needs the far side out of the way. */
const COVER = { none: 1.8, unoriented: 1.6, oriented: 0.95 };
/** However sparse the scan, its points stay points: a share of the diagonal. */
const LARGEST = 0.02;

/**
 * @param {Drawable} source
 * @param {Frame} frame
 * @param {Normals} normals
 */
export function cloudLayer(source, frame, normals) {
  const geometry = geometryOf(source, frame);
  if (source.colors) geometry.setAttribute('color', new BufferAttribute(source.colors, 3, true));
  const positions = /** @type {Float32Array} */ (geometry.getAttribute('position').array);
  return still(new Points(geometry, pointMaterial({ colored: Boolean(source.colors), normals, diameter: diameter(positions, normals) })));
}

/** @param {Drawable} source @param {Frame} frame */
export function meshLayer(source, frame) {
  const geometry = geometryOf(source, frame);
  geometry.setIndex(new BufferAttribute(/** @type {Uint32Array} */ (source.indices), 1));
  if (source.colors) geometry.setAttribute('color', new BufferAttribute(linearColors(source.colors), 3, true));
  const layer = still(new Mesh(geometry, meshMaterial({ vertexColors: Boolean(source.colors) })));
  layer.userData.themed = !source.colors;
  return layer;
}

/** How large points are drawn. @param {Float32Array} positions in the frame @param {Normals} normals */
export function diameter(positions, normals) {
  return Math.min(LARGEST, typicalSpacing(positions) * COVER[normals]);
}

/**
 * It fills the picture, so nothing is gained by looking whether it can be seen.
 * @template {Points | Mesh} Layer
 * @param {Layer} layer
 */
function still(layer) {
  layer.frustumCulled = false;
  return layer;
}

/** @param {Drawable} source @param {Frame} frame */
function geometryOf(source, frame) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(toFrame(source, frame), 3));
  if (source.normals) geometry.setAttribute('normal', new BufferAttribute(source.normals, 3));
  return geometry;
}

/** three.js lights in linear colour: sRGB bytes to linear 16-bit values, by a table. @param {Uint8Array} colors */
function linearColors(colors) {
  const table = Uint16Array.from({ length: 256 }, (_, value) => {
    const srgb = value / 255;
    return 65535 * (srgb <= 0.04045 ? srgb / 12.92 : ((srgb + 0.055) / 1.055) ** 2.4);
  });
  return Uint16Array.from(colors, (value) => table[value]);
}
