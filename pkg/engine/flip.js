/** A mesh with its other side out, all of it or one piece. */
import { PointweaveError } from './errors.js';

/** @import { SurfaceMesh } from '../types.js' */

/**
 * @template {SurfaceMesh} T
 * @param {T} mesh
 * @param {{ triangle?: number }} [options]
 * @returns {T}
 */
export function flip(mesh, { triangle } = {}) {
  const { positions, normals, tangents, indices, cloud } = mesh ?? {};
  if (!(indices instanceof Uint32Array && cloud)) {
    const expected = 'a mesh of reconstruct';
    throw new PointweaveError({ code: 'bad-input', message: `expected ${expected}`, expected, found: typeof mesh });
  }
  if (triangle === undefined) {
    return { ...mesh, indices: wound(indices, () => true), normals: turned(normals, () => true), ...(tangents && { tangents: turned(tangents, () => true, 4) }), cloud: { ...cloud, normals: turned(cloud.normals, () => true) } };
  }
  const triangles = indices.length / 3;
  if (!(Number.isInteger(triangle) && triangle >= 0 && triangle < triangles)) {
    const expected = `an integer from 0 to ${triangles - 1}`;
    throw new PointweaveError({ code: 'bad-option', message: `option triangle is ${triangle}: expected ${expected}`, expected, found: triangle });
  }
  const piece = pieces(indices, positions.length / 3);
  const chosen = piece[indices[3 * triangle]];
  const near = nearest(positions, cloud.positions);
  const isIn = (/** @type {number} */ vertex) => piece[vertex] === chosen;
  return {
    ...mesh,
    indices: wound(indices, isIn),
    normals: turned(normals, isIn),
    // Then a picture of normals is still right.
    ...(tangents && { tangents: turned(tangents, isIn, 4) }),
    cloud: { ...cloud, normals: turned(cloud.normals, (point) => isIn(near(point))) },
  };
}

/** Triangles the other way round where their first corner is chosen. @param {Uint32Array} indices @param {(vertex: number) => boolean} chosen */
function wound(indices, chosen) {
  const other = indices.slice();
  for (let t = 0; t < other.length; t += 3) {
    if (chosen(other[t])) [other[t + 1], other[t + 2]] = [other[t + 2], other[t + 1]];
  }
  return other;
}

/** @param {Float32Array} normals @param {(index: number) => boolean} chosen */
function turned(normals, chosen, each = 3) {
  const other = normals.slice();
  for (let i = 0; i < other.length / each; i++) {
    if (chosen(i)) for (let k = each * i; k < each * (i + 1); k++) other[k] = -other[k];
  }
  return other;
}

/** For each vertex the least vertex that triangles join it to. @param {Uint32Array} indices @param {number} vertices */
function pieces(indices, vertices) {
  const least = Uint32Array.from({ length: vertices }, (_, i) => i);
  const root = (/** @type {number} */ i) => {
    while (least[i] !== i) i = least[i] = least[least[i]];
    return i;
  };
  for (let t = 0; t < indices.length; t += 3) {
    const [a, b, c] = [root(indices[t]), root(indices[t + 1]), root(indices[t + 2])];
    least[a] = least[b] = least[c] = Math.min(a, b, c);
  }
  return least.map((_, i) => root(i));
}

/** Vertices of a mesh lie about as far apart as points, so that this many cells along the diagonal hold a few each. */
const CELLS = 128;
/** Farther away, rings hold more cells than there are vertices to look at. */
const RINGS = 8;

/**
 * The vertex nearest to a point.
 * @param {ArrayLike<number>} vertices
 * @param {ArrayLike<number>} points
 * @returns {(point: number) => number}
 */
function nearest(vertices, points) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < vertices.length; i++) {
    low[i % 3] = Math.min(low[i % 3], vertices[i]);
    high[i % 3] = Math.max(high[i % 3], vertices[i]);
  }
  const size = Math.hypot(...high.map((x, k) => x - low[k])) / CELLS || 1;
  const cellOf = (/** @type {ArrayLike<number>} */ of, /** @type {number} */ i) => [0, 1, 2].map((k) => Math.floor((of[3 * i + k] - low[k]) / size));
  const key = (/** @type {number[]} */ [x, y, z]) => (x * 4096 + y) * 4096 + z;
  /** @type {Map<number, number[]>} */
  const cells = new Map();
  for (let v = 0; v < vertices.length / 3; v++) {
    const at = key(cellOf(vertices, v));
    const there = cells.get(at);
    if (there) there.push(v);
    else cells.set(at, [v]);
  }
  return (point) => {
    const center = cellOf(points, point);
    const [x, y, z] = [points[3 * point], points[3 * point + 1], points[3 * point + 2]];
    let [best, least] = [0, Infinity];
    const look = (/** @type {number} */ v) => {
      const distance = Math.hypot(vertices[3 * v] - x, vertices[3 * v + 1] - y, vertices[3 * v + 2] - z);
      if (distance < least) [best, least] = [v, distance];
    };
    // Rings of cells, until what lies in the next one is farther.
    for (let ring = 0; (ring - 1) * size < least; ring++) {
      if (ring > RINGS) {
        for (let v = 0; v < vertices.length / 3; v++) look(v);
        break;
      }
      for (const cell of shell(center, ring)) cells.get(key(cell))?.forEach(look);
    }
    return best;
  };
}

/** The cells `ring` cells away. @param {number[]} center @param {number} ring */
function* shell([x, y, z], ring) {
  for (let i = -ring; i <= ring; i++) {
    for (let j = -ring; j <= ring; j++) {
      const step = Math.max(Math.abs(i), Math.abs(j)) === ring ? 1 : 2 * ring;
      for (let k = -ring; k <= ring; k += step) yield [x + i, y + j, z + k];
    }
  }
}
