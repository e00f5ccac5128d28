/** Directions along axes, by their names. */

/** @type {Record<string, [number, number, number]>} */
export const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1], '-x': [-1, 0, 0], '-y': [0, -1, 0], '-z': [0, 0, -1] };

/** Units of coordinates; all but degrees are lengths. */
export const UNITS = ['mm', 'cm', 'm', 'in', 'ft', 'us-ft', 'deg'];

/**
 * A direction by its name, or as it is.
 * @param {string | [number, number, number]} up
 */
export function direction(up) {
  return typeof up === 'string' ? AXES[up] : up;
}

/** @param {unknown} value */
export function isDirection(value) {
  if (typeof value === 'string') return Object.hasOwn(AXES, value);
  return Array.isArray(value) && value.length === 3 && value.every(Number.isFinite) && value.some((x) => x !== 0);
}
