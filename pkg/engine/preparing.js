/** A recipe's work in JavaScript: what wasm looks at, the points that are left, and results of them told of the points that were given. */
import { cloudsArgument } from './clouds.js';
import { registers, scansArgument, together } from './registering.js';
import { badOption, isObject, rule } from './rules.js';

/** @import { PointCloud, Prepared, Step } from '../types.js' */
/** @import { Watch } from './worker-host.js' */

/** Stands for a point that a recipe dropped. */
const DROPPED = 2 ** 32 - 1;

/** About how much of a call with `prepare` the recipe takes. */
const SHARE = 0.3;

const EXPECTED = 'an array of steps, each an object with step';

/** The option `prepare`. What a step holds is checked in Rust. */
export const RECIPE = rule(EXPECTED, (value) => Array.isArray(value) && value.every(isObject));

/** @param {unknown} steps @returns {Step[]} */
export function checkRecipe(steps) {
  if (!RECIPE.accepts(steps, '')) throw badOption('prepare', EXPECTED, steps);
  return /** @type {Step[]} */ (steps);
}

/**
 * The caller's clouds of a recipe: one, or those that it registers.
 * @param {unknown} clouds
 * @param {Step[]} steps
 * @param {boolean} [transfer]
 * @returns {PointCloud[]}
 */
export function preparedArgument(clouds, steps, transfer) {
  return registers(steps, clouds) ? scansArgument(/** @type {unknown[]} */ (clouds), transfer) : [cloudsArgument(clouds, transfer)];
}

/**
 * What a recipe looks at, in memory of its own.
 * @param {PointCloud[]} clouds
 * @returns {PointCloud[]}
 */
export function lookedAt(clouds) {
  return clouds.map(({ positions, normals, colors, viewpoints, up }) => ({
    positions: positions.slice(),
    normals: normals?.slice(),
    // One cloud has none to agree with.
    colors: clouds.length > 1 ? colors?.slice() : undefined,
    viewpoints: viewpoints && { positions: viewpoints.positions.slice(), of: viewpoints.of?.slice() },
    up,
  }));
}

/**
 * @param {PointCloud[]} clouds
 * @param {{ kept: Uint32Array, labels: Uint8Array, steps: any[], floor?: PointCloud['floor'] }} found
 * @returns {Prepared<any>}
 */
export function preparedOf(clouds, { kept, labels, steps, floor }) {
  const cloud = clouds.length > 1 ? together(clouds, steps[0].scans) : clouds[0];
  return { cloud: { ...select(cloud, kept), ...(floor && { floor }) }, kept, labels, steps };
}

/**
 * Some points of a cloud, with all that is theirs.
 * @template {PointCloud} T
 * @param {T} cloud
 * @param {ArrayLike<number>} kept their indices
 * @returns {T}
 */
export function select(cloud, kept) {
  const { positions, colors, normals, attributes, viewpoints } = cloud;
  const chosen = Object.entries(attributes ?? {}).map(([name, values]) => [name, picked(values, kept, 1)]);
  const others = Object.entries(cloud).filter(([, value]) => value !== undefined);
  return /** @type {T} */ ({
    ...Object.fromEntries(others),
    positions: picked(positions, kept, 3),
    ...(colors && { colors: picked(colors, kept, 3) }),
    ...(normals && { normals: picked(normals, kept, 3) }),
    ...(attributes && { attributes: Object.fromEntries(chosen) }),
    ...(viewpoints && { viewpoints: { positions: viewpoints.positions, ...(viewpoints.of && { of: picked(viewpoints.of, kept, 1) }) } }),
  });
}

/**
 * @template {Uint8Array | Uint32Array | Float32Array | Float64Array} A
 * @param {A} values
 * @param {ArrayLike<number>} kept
 * @param {number} each
 */
function picked(values, kept, each) {
  const some = /** @type {A} */ (new /** @type {any} */ (values.constructor)(each * kept.length));
  for (let i = 0; i < kept.length; i++) {
    for (let k = 0; k < each; k++) some[each * i + k] = values[each * kept[i] + k];
  }
  return some;
}

/**
 * A result whose indices and arrays are of the points that were given to the call, and not of those that a recipe left.
 * @param {any} result
 * @param {Prepared<any>} prepared
 */
export function ofAllPoints(result, { kept, labels, steps }) {
  const cloud = result.cloud ?? result;
  cloud.nearest = cloud.nearest.map((/** @type {number} */ i) => kept[i]);
  if (cloud.assignment) cloud.assignment = spread(cloud.assignment, kept, new Uint32Array(labels.length).fill(DROPPED));
  if (result.distances) result.distances.points = spread(result.distances.points, kept, new Float32Array(labels.length).fill(NaN));
  result.prepared = { labels, steps };
  return result;
}

/** @template {Uint32Array | Float32Array} A @param {A} values @param {Uint32Array} kept @param {A} into */
function spread(values, kept, into) {
  kept.forEach((i, k) => (into[i] = values[k]));
  return into;
}

/**
 * The two halves of a call with `prepare`, each of which tells its own progress, as parts of the whole.
 * @param {Watch} watch
 * @returns {[Watch, Watch]}
 */
export function halves(watch) {
  return split(watch, SHARE);
}

/**
 * A call of two steps, the first of which takes about this share of its time.
 * @param {Watch} watch
 * @param {number} share
 * @returns {[Watch, Watch]}
 */
export function split({ signal, onProgress }, share) {
  const part = (/** @type {number} */ from, /** @type {number} */ to) => ({
    signal,
    onProgress: onProgress && ((/** @type {import('../types.js').Progress} */ progress) => onProgress({ ...progress, overall: from + (to - from) * progress.overall })),
  });
  return [part(0, share), part(share, 1)];
}
