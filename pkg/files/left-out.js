/** Points that stand for a missing measurement leave the arrays; `src/formats/sentinels.rs` says which they are. */

/**
 * @typedef {object} LeftOut
 * @property {boolean} huge those with a coordinate of 1e30 or more
 * @property {Float64Array[]} noData those with one of these coordinates, by axis
 * @property {Float64Array} noReturns those at one of these places, `x y z` each
 */

/** As in `src/formats/sentinels.rs`. */
const HUGE = 1e30;

/**
 * Which points stay, and how many do not, by why; nothing where all stay.
 * @param {Float32Array | Float64Array} positions
 * @param {LeftOut} leftOut
 * @returns {{ stay: Uint8Array, points: number, skipped: Record<string, number> } | undefined}
 */
export function leftOutOf(positions, { huge, noData, noReturns }) {
  if (!huge && noReturns.length === 0 && noData.every((values) => values.length === 0)) return undefined;
  const count = positions.length / 3;
  const stay = new Uint8Array(count);
  const values = noData.map((axis) => new Set(axis));
  const places = new Set(triples(noReturns));
  const counts = { 'no-data': 0, 'no-return': 0 };
  let points = 0;
  for (let i = 0; i < count; i++) {
    const [x, y, z] = [positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]];
    if ([x, y, z].some((value, axis) => values[axis].has(value) || (huge && Math.abs(value) >= HUGE))) counts['no-data']++;
    else if (places.size > 0 && places.has(key(x, y, z))) counts['no-return']++;
    else points += stay[i] = 1;
  }
  return { stay, points, skipped: Object.fromEntries(Object.entries(counts).filter(([, left]) => left > 0)) };
}

/**
 * The values of the points that stay.
 * @template {Uint8Array | Uint32Array | Float32Array | Float64Array} T
 * @param {T} values
 * @param {{ stay: Uint8Array, points: number }} which
 * @param {number} each values a point
 * @returns {T}
 */
export function kept(values, { stay, points }, each) {
  const left = /** @type {T} */ (new /** @type {any} */ (values.constructor)(each * points));
  let at = 0;
  for (let i = 0; i < stay.length; i++) {
    if (!stay[i]) continue;
    for (let part = 0; part < each; part++) left[at++] = values[each * i + part];
  }
  return left;
}

/** @param {Float64Array} values */
function* triples(values) {
  for (let i = 0; i < values.length; i += 3) yield key(values[i], values[i + 1], values[i + 2]);
}

/** Zeros are one place, whatever their sign. @param {number} x @param {number} y @param {number} z */
const key = (x, y, z) => `${x + 0} ${y + 0} ${z + 0}`;
