/** Meshes with fewer triangles, and with pictures: what wasm takes of them, and what it made beside what they had. */
import { RAMP } from '../viewer/colormap.js';
import { frameOf } from '../viewer/frame.js';
import { likelyUp } from '../viewer/upright.js';
import { direction } from './axes.js';
import { cloudArgument, resultArgument } from './clouds.js';
import { badInput } from './inputs.js';
import { select } from './preparing.js';
import { badOption } from './rules.js';

/** @import { PointCloud, SurfaceMesh } from '../types.js' */

/** The distances of the vertices travel among their attributes, under a name that no attribute has. */
const DISTANCES = '';
/** Stands for one that there is not, which wasm takes for no number: what is mixed with it is below 0. */
const NONE = -1e30;
/** The values that become colours. */
const SHOWN = 'shown';

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
 * What wasm takes of a scan whose colours, or whose values, go into pictures, in memory of its own.
 * @param {PointCloud} cloud
 * @param {import('../types.js').TextureOptions} texture
 * @returns {PointCloud}
 */
export function shownPoints(cloud, { scalar }) {
  const { positions, colors } = cloud;
  if (scalar === undefined) return { positions: positions.slice(), colors: colors?.slice() };
  return { positions: positions.slice(), attributes: { [SHOWN]: valuesOf(cloud, scalar) } };
}

/**
 * The same of a scan that may be counted from another origin than the mesh.
 * @param {PointCloud} cloud
 * @param {{ origin?: [number, number, number] }} mesh
 * @param {import('../types.js').TextureOptions} texture
 * @returns {PointCloud}
 */
export function pointsBeside(cloud, { origin = [0, 0, 0] }, texture) {
  const { origin: own = [0, 0, 0], ...given } = cloudArgument(cloud);
  const moved = own.map((x, axis) => x - origin[axis]);
  const shown = shownPoints(given, texture);
  if (moved.every((x) => x === 0)) return shown;
  return { ...shown, positions: Float64Array.from(given.positions, (x, i) => x + moved[i % 3]) };
}

/**
 * What wasm takes beside the mesh to make pictures, and which values the ends of the colours stand for.
 * @param {PointCloud} points as {@link shownPoints} gives them
 * @param {import('../types.js').TextureOptions} texture
 * @param {number} [triangles]
 * @returns {{ args: any[], range?: [number, number] }}
 */
export function baking(points, { scalar, range, ...own }, triangles) {
  const settings = triangles === undefined ? own : { ...own, triangles };
  const values = points.attributes?.[SHOWN];
  if (!values) return { args: [points, settings] };
  const [low, high] = range ?? middleOf(values);
  const shares = values.map((x) => (x - low) / (high - low));
  return { args: [{ positions: points.positions, attributes: { [SHOWN]: shares } }, { ...settings, ramp: RAMP.slice() }], range: [low, high] };
}

/**
 * An attribute of a scan, or how high its points are.
 * @param {PointCloud} cloud
 * @param {string} name
 */
function valuesOf(cloud, name) {
  const { positions, attributes = {} } = cloud;
  if (attributes[name]) return attributes[name].slice();
  if (name !== 'height') throw badOption('scalar', [...Object.keys(attributes), 'height'].map((known) => `'${known}'`).join(', '), name);
  const [x, y, z] = direction(cloud.up ?? likelyUp(cloud, frameOf(cloud).size));
  return Float32Array.from({ length: positions.length / 3 }, (_, i) => x * positions[3 * i] + y * positions[3 * i + 1] + z * positions[3 * i + 2]);
}

/** Where all but a fiftieth at each end lie. @param {Float32Array} values @returns {[number, number]} */
function middleOf(values) {
  const sorted = values.filter(Number.isFinite).sort();
  const at = (/** @type {number} */ share) => sorted[Math.round(share * (sorted.length - 1))] ?? 0;
  const [low, high] = [at(0.02), at(0.98)];
  return high > low ? [low, high] : [low, low + 1];
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
 * @param {[number, number]} [range] of the values that are its colours
 */
export function lightened(mesh, { report: simplified, attributes = {}, ...made }, range) {
  if (range && made.textures.color) made.textures.color.range = range;
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
