/**
 * Tiles of one level meet exactly, those of two levels nearly: between their borders a ray may slip through. So a mesh gets a strip along
 * its border that goes down behind the surface, where nobody sees it but through such a crack.
 */
import { BufferAttribute } from 'three';

/** @import { BufferGeometry, Material } from 'three' */

/**
 * The strip is drawn from the side to which it looks, away from the tile: from the other its edge would shine through the neighbour's.
 * @param {Material} material of a mesh with a strip
 */
export function showStripsFromOutside(material) {
  if (material.userData.strip) return;
  material.userData.strip = true;
  const before = material.onBeforeCompile;
  material.customProgramCacheKey = () => `strip ${before}`;
  material.onBeforeCompile = (shader, renderer) => {
    before.call(material, shader, renderer);
    shader.vertexShader = shader.vertexShader.replace('void main() {', /* glsl */ `
      attribute float strip;
      varying float ofStrip;
      void main() {
        ofStrip = strip;`);
    shader.fragmentShader = shader.fragmentShader.replace('void main() {', /* glsl */ `
      varying float ofStrip;
      void main() {
        if (ofStrip > 0.0 && !gl_FrontFacing) discard;`);
  };
}

/**
 * Adds the strip. Takes one pass over the triangles.
 * @param {BufferGeometry} geometry with an index and normals
 * @param {number} depth of the strip, in the geometry's unit
 */
export function addSkirts(geometry, depth) {
  const corners = /** @type {BufferAttribute} */ (geometry.index).array;
  const { count } = geometry.getAttribute('position');
  const edges = borderOf(corners, count);
  /** Where the lower end of a border's vertex is. @type {Map<number, number>} */
  const below = new Map();
  for (const vertex of edges) if (!below.has(vertex)) below.set(vertex, count + below.size);
  if (below.size === 0) return;
  const normal = geometry.getAttribute('normal');
  for (const [name, attribute] of Object.entries(geometry.attributes)) {
    const { itemSize, normalized, array } = /** @type {BufferAttribute} */ (attribute);
    const size = name === 'position' ? 3 : itemSize;
    const Type = /** @type {new (length: number) => import('three').TypedArray} */ (array.constructor);
    const longer = new BufferAttribute(new Type(size * (count + below.size)), size, normalized);
    const copy = (/** @type {number} */ from, /** @type {number} */ to) => {
      for (let k = 0; k < size; k++) longer.setComponent(to, k, attribute.getComponent(from, k));
    };
    for (let i = 0; i < count; i++) copy(i, i);
    for (const [from, to] of below) {
      copy(from, to);
      if (name === 'position') for (let k = 0; k < 3; k++) longer.setComponent(to, k, attribute.getComponent(from, k) - depth * normal.getComponent(from, k));
    }
    geometry.setAttribute(name, longer);
  }
  geometry.setAttribute('strip', new BufferAttribute(new Uint8Array(count + below.size).fill(1, count), 1));
  const all = new Uint32Array(corners.length + 3 * edges.length);
  all.set(corners);
  for (let i = 0, at = corners.length; i < edges.length; i += 2, at += 6) {
    const [a, b] = [edges[i], edges[i + 1]];
    const [c, d] = [below.get(a), below.get(b)].map(Number);
    all.set([b, a, c, b, c, d], at);
  }
  geometry.setIndex(new BufferAttribute(all, 1));
}

/**
 * The edges that one triangle alone has, as pairs of vertices. At a vertex inside of a mesh every neighbour comes once after it and once
 * before it in a triangle, so that all of them cancel out; what is left are a few candidates.
 * @param {ArrayLike<number>} corners
 * @param {number} count of vertices
 */
function borderOf(corners, count) {
  const left = new Int32Array(count);
  for (let i = 0; i < corners.length; i += 3) {
    const [a, b, c] = [corners[i], corners[i + 1], corners[i + 2]];
    left[a] ^= mixed(b) ^ mixed(c);
    left[b] ^= mixed(c) ^ mixed(a);
    left[c] ^= mixed(a) ^ mixed(b);
  }
  /** @type {Set<number>} */
  const open = new Set();
  for (let i = 0; i < corners.length; i++) {
    const [a, b] = [corners[i], corners[i % 3 === 2 ? i - 2 : i + 1]];
    if (!left[a] || !left[b]) continue;
    const back = b * count + a;
    if (!open.delete(back)) open.add(a * count + b);
  }
  return [...open].flatMap((edge) => [Math.floor(edge / count), edge % count]);
}

/** Numbers whose bits have nothing to do with each other. @param {number} vertex */
function mixed(vertex) {
  return Math.imul(vertex + 1, 0x9e3779b1);
}
