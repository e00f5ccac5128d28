/** What the command line says of a scan beside its file: where it was seen from, and which way is up. */
import { AXES, UNITS } from '../engine/axes.js';
import { UsageError } from './usage.js';

/** @import { PointCloud } from '../types.js' */

/** How `parseArgs` is told of them. */
export const CLOUD_FLAGS = /** @type {const} */ ({ viewpoint: { type: 'string', multiple: true }, up: { type: 'string' }, unit: { type: 'string' } });

/** For the help. */
export const CLOUD_ROWS = [
  ['--viewpoint X,Y,Z', "a place that it was seen from, in the file's frame, can be repeated: each point was seen from the nearest"],
  ['--up AXIS', 'which way is up: x, y, z, -x, -y, -z or a direction X,Y,Z'],
  ['--unit NAME', `what a coordinate of the file is: ${UNITS.join(', ')}`],
];

/**
 * @typedef {object} Said
 * @property {[number, number, number][]} viewpoints
 * @property {[number, number, number]} [up]
 * @property {import('../types.js').Unit} [unit]
 */

/** @param {{ viewpoint?: string[], up?: string, unit?: any }} values of `parseArgs` @returns {Said} */
export function cloudSaid({ viewpoint = [], up, unit }) {
  if (unit !== undefined && !UNITS.includes(unit)) throw new UsageError(`--unit is '${unit}': expected one of ${UNITS.join(', ')}`);
  const viewpoints = viewpoint.map((text) => triple('viewpoint', text, 'three numbers X,Y,Z'));
  return { viewpoints, up: up === undefined ? undefined : upFrom(up), unit };
}

/** @param {string} text */
function upFrom(text) {
  if (Object.hasOwn(AXES, text)) return AXES[text];
  const direction = triple('up', text, 'x, y, z, -x, -y, -z or a direction X,Y,Z');
  if (direction.every((x) => x === 0)) throw new UsageError(`--up is '${text}': expected a direction that is not 0,0,0`);
  return direction;
}

/** @param {string} name @param {string} text @param {string} expected @returns {[number, number, number]} */
function triple(name, text, expected) {
  const numbers = text.split(',').map((word) => (word.trim() === '' ? NaN : Number(word)));
  if (numbers.length !== 3 || !numbers.every(Number.isFinite)) throw new UsageError(`--${name} is '${text}': expected ${expected}`);
  return /** @type {[number, number, number]} */ (numbers);
}

/**
 * The cloud with what was said of it, which counts for more than what its file says.
 * @template {PointCloud} T
 * @param {T} cloud
 * @param {Said} said
 * @returns {T}
 */
export function withSaid(cloud, { viewpoints, up, unit }) {
  const positions = Float64Array.from(viewpoints.flat());
  const of = viewpoints.length > 1 ? nearest(cloud.positions, positions) : undefined;
  return { ...cloud, ...(viewpoints.length > 0 && { viewpoints: { positions, of } }), ...(up && { up }), ...(unit && { unit }) };
}

/** For each point the index of the nearest viewpoint. @param {ArrayLike<number>} points @param {Float64Array} viewpoints */
function nearest(points, viewpoints) {
  return Uint32Array.from({ length: points.length / 3 }, (_, i) => {
    let best = 0;
    let least = Infinity;
    for (let v = 0; v < viewpoints.length; v += 3) {
      const distance = Math.hypot(points[3 * i] - viewpoints[v], points[3 * i + 1] - viewpoints[v + 1], points[3 * i + 2] - viewpoints[v + 2]);
      if (distance < least) [best, least] = [v / 3, distance];
    }
    return best;
  });
}
