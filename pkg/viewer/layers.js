/** Scans and meshes as things to draw, one draw call each. */
import { BufferAttribute, BufferGeometry, LineSegments, Mesh, Points, SRGBColorSpace, Sphere, Texture } from 'three';
import { typicalSpacing } from './density.js';
import { toFrame } from './frame.js';
import { boxMaterial, edgeMaterial, meshMaterial, pointMaterial } from './materials.js';
import { wear } from './pictures.js';

/** @import { Drawable, Frame, Placed } from '../viewer.js' */
/** @import { Rgb } from './colors.js' */
/** @import { Normals } from './materials.js' */

/** Points wider than their spacing close the surface; narrower ones can be told apart, which needs the far side out of the way. */
const COVER = { none: 1.8, unoriented: 1.6, oriented: 0.9 };
/** However sparse the scan, its points stay points: a share of the diagonal. */
const LARGEST = 0.015;

/**
 * A layer of a cloud, or of a mesh where there are indices. Pictures of a mesh come later, which `changed` is told.
 * @param {Drawable} source
 * @param {Frame} frame
 * @param {() => void} changed
 */
export function layerOf(source, frame, changed) {
  return source.indices ? meshLayer(source, frame, changed) : cloudLayer(source, frame);
}

/** @param {Drawable} source @param {Frame} frame */
function cloudLayer(source, frame) {
  const normals = !source.normals ? 'none' : source.oriented ? 'oriented' : 'unoriented';
  const geometry = geometryOf(source, frame);
  const positions = /** @type {Float32Array} */ (geometry.getAttribute('position').array);
  return colored(still(new Points(geometry, pointMaterial({ colored: false, normals, diameter: diameter(positions, normals) }))), source);
}

/** @param {Drawable} source @param {Frame} frame @param {() => void} changed */
function meshLayer(source, frame, changed) {
  const geometry = geometryOf(source, frame);
  geometry.setIndex(new BufferAttribute(/** @type {Uint32Array} */ (source.indices), 1));
  if (!source.normals) geometry.computeVertexNormals();
  const mesh = still(new Mesh(geometry, meshMaterial()));
  if (!source.uvs || !source.textures) return colored(mesh, source);
  wear(mesh, source, changed);
  return source.textures.color ? mesh : colored(mesh, source);
}

/** @template {Points | Mesh} Layer @param {Layer} layer @param {Drawable} source */
function colored(layer, { colors }) {
  layer.userData.themed = true;
  if (colors) paint(layer, colors, false);
  return layer;
}

/** How large points are drawn. @param {Float32Array} positions in the frame @param {Normals} normals */
export function diameter(positions, normals) {
  return cover(typicalSpacing(positions), normals);
}

/** How large points are drawn that are so far apart. @param {number} spacing in the frame @param {Normals} normals */
export function cover(spacing, normals) {
  return Math.min(LARGEST, spacing * COVER[normals]);
}

/**
 * Gives a layer colours, one sRGB triple a point or vertex, or takes them away. Those of measured values are to be read against a
 * legend, so light and shade change them less.
 * @param {Points | Mesh} layer
 * @param {Uint8Array | null} colors
 * @param {boolean} measured
 */
export function paint(layer, colors, measured) {
  const mesh = layer instanceof Mesh;
  const material = /** @type {any} */ (layer.material);
  if (colors) {
    const values = mesh ? linearColors(colors) : colors;
    const attribute = /** @type {BufferAttribute | undefined} */ (layer.geometry.getAttribute('color'));
    // The buffer of the last colours is used again: three.js frees one only with the whole geometry.
    if (attribute) {
      attribute.array = values;
      attribute.needsUpdate = true;
    } else layer.geometry.setAttribute('color', new BufferAttribute(values, 3, true));
  }
  (mesh ? material.userData : material.uniforms).measured.value = measured ? 1 : 0;
  layer.userData.themed = !colors;
  if (Boolean(colors) === (mesh ? material.vertexColors : 'COLORED' in material.defines)) return;
  if (mesh) material.vertexColors = !material.vertexColors;
  else if (colors) material.defines.COLORED = '';
  else delete material.defines.COLORED;
  material.needsUpdate = true;
}

/**
 * What has no colours of its own gets the theme's; white of a GLB, what a page asks for.
 * @param {any} layer
 * @param {Rgb} color
 * @param {Rgb} [plain]
 */
export function tint({ material, userData }, color, plain) {
  if (userData.plain && plain) material.color.setRGB(...plain, SRGBColorSpace);
  else if (material.uniforms) material.uniforms.tint.value.setRGB(...color);
  else if (userData.themed) material.color.setRGB(...color, SRGBColorSpace);
  else if (userData.themed === false) material.color.setRGB(1, 1, 1);
}

/** The edges of a mesh's triangles, each once, over the same vertices. @param {Mesh} mesh */
export function edgesOf({ geometry }) {
  const position = geometry.getAttribute('position');
  const corners = /** @type {BufferAttribute} */ (geometry.index).array;
  const edges = new Float64Array(corners.length);
  for (let i = 0; i < corners.length; i++) {
    const [a, b] = [corners[i], corners[i % 3 === 2 ? i - 2 : i + 1]];
    edges[i] = Math.min(a, b) * position.count + Math.max(a, b);
  }
  edges.sort();
  const once = edges.filter((edge, i) => edge !== edges[i - 1]);
  const ends = new Uint32Array(2 * once.length);
  once.forEach((edge, i) => {
    ends[2 * i] = Math.floor(edge / position.count);
    ends[2 * i + 1] = edge % position.count;
  });
  return lines(/** @type {BufferAttribute} */ (position), ends, edgeMaterial());
}

/** Corners of a box that differ in one direction alone. */
const BOX_EDGES = [0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7];

/** Boxes as lines. @param {Placed} corners the lowest and the highest of each @param {Frame} frame */
export function boxesOf(corners, frame) {
  const ends = toFrame(corners, frame);
  const boxes = ends.length / 6;
  const points = new Float32Array(24 * boxes);
  const indices = new Uint32Array(24 * boxes);
  for (let k = 0; k < boxes; k++) {
    for (let corner = 0; corner < 8; corner++) {
      // Bit by bit: whether the corner is high along x, y and z.
      for (let axis = 0; axis < 3; axis++) points[24 * k + 3 * corner + axis] = ends[6 * k + axis + ((corner >> axis) & 1 ? 3 : 0)];
    }
    BOX_EDGES.forEach((corner, i) => (indices[24 * k + i] = 8 * k + corner));
  }
  return lines(new BufferAttribute(points, 3), indices, boxMaterial());
}

/** @param {BufferAttribute} position @param {Uint32Array} indices @param {import('three').Material} material */
function lines(position, indices, material) {
  const geometry = new BufferGeometry().setAttribute('position', position).setIndex(new BufferAttribute(indices, 1));
  const layer = still(new LineSegments(geometry, material));
  layer.userData.themed = true;
  return layer;
}

/** What an object holds on the GPU. three.js makes it anew should the object be drawn again. @param {import('three').Object3D} object */
export function free(object) {
  const { geometry, material } = /** @type {Mesh} */ (object);
  geometry.dispose();
  const { matcap, ...maps } = /** @type {Record<string, any>} */ (material); // the matcap is the page's
  for (const value of Object.values(maps)) if (value instanceof Texture) value.dispose();
  /** @type {import('three').Material} */ (material).dispose();
}

/**
 * It fills the picture, so nothing is gained by looking whether it can be seen.
 * @template {import('three').Object3D} Layer
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
  // The frame's ball: three.js would pass over all points for a smaller one.
  geometry.boundingSphere = new Sphere(undefined, 0.5);
  return geometry;
}

/** three.js lights in linear colour: sRGB bytes to linear 16-bit values, by a table. @param {Uint8Array} colors */
function linearColors(colors) {
  const table = Uint16Array.from({ length: 256 }, (_, value) => {
    const srgb = value / 255;
    return 65535 * (srgb <= 0.04045 ? srgb / 12.92 : ((srgb + 0.055) / 1.055) ** 2.4);
  });
  const out = new Uint16Array(colors.length);
  for (let i = 0; i < out.length; i++) out[i] = table[colors[i]];
  return out;
}
