/**
 * The viewer's frame: the scan's bounding box centred at 0 with a diagonal of 1.
 * The shift is made in double precision, so georeferenced scans do not jitter on the GPU.
 *
 * @typedef {object} Frame
 * @property {[number, number, number]} center  in world units (positions + origin)
 * @property {[number, number, number]} size    edge lengths of the bounding box
 * @property {number} diagonal                  length of its diagonal, 1 when all points coincide
 */

/** @typedef {{ positions: Float32Array | Float64Array, origin?: [number, number, number] }} Placed */

/**
 * Of the finite coordinates; the engine says what is wrong with the others.
 * @param {Placed} cloud
 * @returns {Frame}
 */
export function frameOf({ positions, origin = [0, 0, 0] }) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i += 3) {
    for (let axis = 0; axis < 3; axis++) {
      const value = positions[i + axis];
      if (!Number.isFinite(value)) continue;
      if (value < low[axis]) low[axis] = value;
      if (value > high[axis]) high[axis] = value;
    }
  }
  const size = /** @type {[number, number, number]} */ (low.map((value, axis) => high[axis] - value));
  const center = /** @type {[number, number, number]} */ (low.map((value, axis) => (value + high[axis]) / 2 + origin[axis]));
  return { center, size, diagonal: Math.hypot(...size) || 1 };
}

/**
 * Positions of a cloud or mesh in the viewer's frame.
 * @param {Placed} placed
 * @param {Frame} frame
 */
export function toFrame({ positions, origin = [0, 0, 0] }, { center, diagonal }) {
  const scale = 1 / diagonal;
  const out = new Float32Array(positions.length);
  for (let axis = 0; axis < 3; axis++) {
    const shift = origin[axis] - center[axis];
    for (let i = axis; i < out.length; i += 3) out[i] = (positions[i] + shift) * scale;
  }
  return out;
}
