/** Meshes with fewer triangles, and with pictures: what wasm takes of them, and what it made beside what they had. */
import { cloudArgument, resultArgument } from './clouds.js';
import { badInput } from './inputs.js';
import { select } from './preparing.js';

/** @import { PointCloud, SurfaceMesh } from '../types.js' */

/** The distances of the vertices travel among their attributes, under a name that no attribute has. */
const DISTANCES = '';
/** Stands for one that there is not, which wasm takes for no number: what is mixed with it is below 0. */
const NONE = -1e30;

/**
 * What wasm takes of a mesh.
 * @param {any} mesh
 * @param {boolean} [transfer]
 */
export function meshArgument(mesh, transfer) {
  if (!(mesh?.indices instanceof Uint32Array)) throw badInput('mesh', 'a mesh with positions and indices', mesh);
  return withDistances(mesh, resultArgument(mesh, transfer));
}

/** The same of a mesh that is no caller's. @param {SurfaceMesh} mesh */
export function ownMesh(mesh) {
  const { positions, normals, indices, colors, attributes } = mesh;
  return withDistances(mesh, { positions, normals, indices, colors, attributes });
}

/**
 * What wasm takes of a scan whose colours go into pictures, in memory of its own.
 * @param {PointCloud} cloud
 * @returns {PointCloud}
 */
export function shownPoints({ positions, colors }) {
  return { positions: positions.slice(), colors: colors?.slice() };
}

/**
 * The same of a scan that may be counted from another origin than the mesh.
 * @param {PointCloud} cloud
 * @param {{ origin?: [number, number, number] }} mesh
 * @returns {PointCloud}
 */
export function pointsBeside(cloud, { origin = [0, 0, 0] }) {
  const { origin: own = [0, 0, 0], ...given } = cloudArgument(cloud);
  const moved = own.map((x, axis) => x - origin[axis]);
  if (moved.every((x) => x === 0)) return shownPoints(given);
  return { positions: Float64Array.from(given.positions, (x, i) => x + moved[i % 3]), colors: given.colors?.slice() };
}

/** Those of them that a recipe left. @param {PointCloud} points @param {SurfaceMesh} mesh */
export function left(points, { prepared }) {
  if (!prepared) return points;
  const kept = Array.from(prepared.labels.keys()).filter((i) => prepared.labels[i] === 0);
  return select(points, kept);
}

/** @param {any} mesh @param {Record<string, any>} argument */
function withDistances({ distances }, argument) {
  if (!distances?.vertices) return argument;
  return { ...argument, attributes: { ...argument.attributes, [DISTANCES]: distances.vertices.map((/** @type {number} */ x) => (x >= 0 ? x : NONE)) } };
}

/**
 * @param {any} mesh as it was
 * @param {any} made what wasm made of it
 */
export function lightened(mesh, { report: simplified, attributes = {}, ...made }) {
  const { normals, colors, attributes: before, distances, uvs, tangents, textures, report, ...others } = mesh;
  const { [DISTANCES]: vertices, ...carried } = attributes;
  const { from, error, reason, ...counts } = simplified ?? {};
  return {
    ...others,
    ...made,
    ...(Object.keys(carried).length > 0 && { attributes: carried }),
    ...(distances && { distances: { ...distances, vertices: vertices.map((/** @type {number} */ x) => (x >= 0 ? x : NaN)) } }),
    report: { ...report, ...counts, ...(simplified && { simplified }) },
  };
}
