/** Lengths and angles between places, and results of another size. */

/** @typedef {[number, number, number]} Triple */

/** @param {Triple} a @param {Triple} b */
export function distance(a, b) {
  return Math.hypot(...a.map((value, k) => value - b[k]));
}

/** Between the ways from the second place to the others, in degrees. @param {Triple} a @param {Triple} b @param {Triple} c */
export function angleAt(a, b, c) {
  const dot = a.reduce((sum, value, k) => sum + (value - b[k]) * (c[k] - b[k]), 0);
  const cosine = dot / (distance(a, b) * distance(c, b) || 1);
  return (Math.acos(Math.min(1, Math.max(-1, cosine))) * 180) / Math.PI;
}

/**
 * The same, so many times as large. It lies in no reference system of maps any more.
 * @template {{ positions: Float32Array | Float64Array, origin?: Triple, crs?: unknown }} Result
 * @param {Result} result
 * @param {number} scale
 * @returns {Result}
 */
export function scaled(result, scale) {
  if (scale === 1) return result;
  const { origin, crs, ...rest } = result;
  return /** @type {Result} */ ({ ...rest, positions: result.positions.map((value) => scale * value), ...(origin && { origin: origin.map((value) => scale * value) }) });
}
