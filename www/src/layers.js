import { BufferAttribute, BufferGeometry, LineSegments, Mesh, Points } from 'three';
import { typicalSpacing } from './session/density.js';
import { toFrame } from './frame.js';
import { boxMaterial, edgeMaterial, meshMaterial, pointMaterial } from './materials.js';

/** @import { Frame } from './frame.js' */

/**
 * What a layer is made of: a cloud, or a mesh when there are indices.
 * @typedef {object} Drawable
 * @property {Float32Array | Float64Array} positions
 * @property {[number, number, number]} [origin]
 * @property {Float32Array} [normals]
 * @property {Uint8Array} [colors]
 * @property {Uint32Array} [indices]
 *
 * @typedef {Points | Mesh} Layer  one draw call each
 */

/** Points wider than their spacing close the surface; narrower ones can be told apart. */
const SCAN_COVER = 1.8;
const REDUCED_COVER = 0.85;
/** However sparse the scan, its points stay points: a share of the diagonal. */
const LARGEST = 0.012;

/**
 * @param {Drawable} source
 * @param {Frame} frame
 */
export function cloudLayer(source, frame) {
  const shaded = Boolean(source.normals);
  const geometry = geometryOf(source, frame);
  const spacing = typicalSpacing(/** @type {Float32Array} */ (geometry.getAttribute('position').array));
  const diameter = Math.min(LARGEST, spacing * (shaded ? REDUCED_COVER : SCAN_COVER));
  const layer = new Points(geometry, pointMaterial({ shaded, diameter }));
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
  const layer = new Mesh(geometry, meshMaterial());
  layer.frustumCulled = false;
  return layer;
}

/** The edges of a mesh layer's triangles, each once, over the same vertices. */
export function edgeLayer(/** @type {Layer} */ mesh) {
  const corners = /** @type {BufferAttribute} */ (mesh.geometry.index).array;
  const vertices = mesh.geometry.getAttribute('position').count;
  const edges = new Float64Array(corners.length);
  for (let i = 0; i < corners.length; i++) {
    const [a, b] = [corners[i], corners[i % 3 === 2 ? i - 2 : i + 1]];
    edges[i] = Math.min(a, b) * vertices + Math.max(a, b);
  }
  edges.sort();
  const once = edges.filter((edge, i) => edge !== edges[i - 1]);
  const ends = new Uint32Array(2 * once.length);
  once.forEach((edge, i) => {
    ends[2 * i] = Math.floor(edge / vertices);
    ends[2 * i + 1] = edge % vertices;
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', mesh.geometry.getAttribute('position'));
  geometry.setIndex(new BufferAttribute(ends, 1));
  const layer = new LineSegments(geometry, edgeMaterial());
  layer.frustumCulled = false;
  return layer;
}

/**
 * Boxes, given by their lowest and highest corners, as lines.
 * @param {{ positions: Float32Array | Float64Array, origin?: [number, number, number] }} corners
 * @param {Frame} frame
 */
export function boxLayer(corners, frame) {
  const ends = toFrame(corners, frame);
  const boxes = ends.length / 6;
  const points = new Float32Array(24 * boxes);
  const lines = new Uint32Array(24 * boxes);
  for (let k = 0; k < boxes; k++) {
    for (let corner = 0; corner < 8; corner++) {
      // Bit by bit: whether the corner is high along x, y and z.
      for (let axis = 0; axis < 3; axis++) points[24 * k + 3 * corner + axis] = ends[6 * k + axis + ((corner >> axis) & 1 ? 3 : 0)];
    }
    BOX_EDGES.forEach((corner, i) => (lines[24 * k + i] = 8 * k + corner));
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(points, 3));
  geometry.setIndex(new BufferAttribute(lines, 1));
  const layer = new LineSegments(geometry, boxMaterial());
  layer.frustumCulled = false;
  return layer;
}

/** Corners that differ in one direction alone. */
const BOX_EDGES = [0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7];

/**
 * Gives a layer colours, one sRGB triple a point or vertex, or takes them away. Those of measured values are to be
 * read against a legend, so light and shade change them less.
 * @param {Layer} layer
 * @param {Uint8Array | null} colors
 * @param {boolean} measured
 */
export function paint(layer, colors, measured) {
  const mesh = layer instanceof Mesh;
  const material = /** @type {any} */ (layer.material);
  if (colors) {
    const values = mesh ? linearColors(colors) : colors;
    const attribute = layer.geometry.getAttribute('color');
    // The buffer of the last colours is used again: three.js frees one only with the whole geometry.
    if (attribute) {
      attribute.array.set(values);
      attribute.needsUpdate = true;
    } else layer.geometry.setAttribute('color', new BufferAttribute(values, 3, true));
  }
  if (mesh) {
    material.userData.measured.value = measured ? 1 : 0;
    if (material.vertexColors !== Boolean(colors)) {
      material.vertexColors = Boolean(colors);
      material.needsUpdate = true;
    }
  } else {
    material.uniforms.measured.value = measured ? 1 : 0;
    if ('COLORED' in material.defines !== Boolean(colors)) {
      if (colors) material.defines.COLORED = '';
      else delete material.defines.COLORED;
      material.needsUpdate = true;
    }
  }
}

/** Whether {@link paint} has given it colours. */
export function isPainted(/** @type {Layer} */ layer) {
  const material = /** @type {any} */ (layer.material);
  return layer instanceof Mesh ? material.vertexColors : 'COLORED' in material.defines;
}

/** Frees what a layer holds on the GPU. */
export function disposeLayer(/** @type {Layer | LineSegments} */ layer) {
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
