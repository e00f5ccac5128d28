/** Quantities with their units, in model-viewer's syntax, as `camera-orbit` is written. */

/** The distance of the first look in per cent: at 100 % an object reaches to the edges, as a ball does in model-viewer. */
export const WHOLE = 110;
/** Degrees. @type {Record<string, number>} */
export const ANGLES = { deg: 1, rad: 180 / Math.PI };
/** Units of the file, which glTF says are metres. @type {Record<string, number>} */
export const LENGTHS = { m: 1, cm: 0.01, mm: 0.001 };

/** A number with one of these units; undefined for all else. @param {string} word @param {Record<string, number>} units */
export function quantity(word, units) {
  const [, digits, unit] = /^([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)([a-z%]*)$/.exec(word) ?? [];
  return digits !== undefined && Object.hasOwn(units, unit) ? Number(digits) * units[unit] : undefined;
}
