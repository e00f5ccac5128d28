/**
 * The frame that pictures are made in: the bounding box centred at 0 with a diagonal of 1. The shift is made in double
 * precision, so georeferenced scans do not jitter on the GPU.
 *
 * @typedef {object} Frame
 * @property {number[]} center in world units (positions + origin)
 * @property {number[]} size edge lengths of the bounding box
 * @property {number} diagonal 1 where all points coincide
 */

/** @typedef {{ positions: Float32Array | Float64Array, origin?: [number, number, number] }} Placed */

/** @param {number[]} low @param {number[]} high @returns {Frame} */
export function frameBetween(low, high) {
  const size = low.map((value, axis) => Math.max(0, high[axis] - value));
  return { center: low.map((value, axis) => (value + high[axis]) / 2), size, diagonal: Math.hypot(...size) || 1 };
}

/** Of the finite coordinates; the engine says what is wrong with the others. @param {Placed} placed */
export function frameOf({ positions, origin = [0, 0, 0] }) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i++) {
    const value = positions[i];
    const axis = i % 3;
    if (!Number.isFinite(value)) continue;
    if (value < low[axis]) low[axis] = value;
    if (value > high[axis]) high[axis] = value;
  }
  return frameBetween(low.map((value, axis) => value + origin[axis]), high.map((value, axis) => value + origin[axis]));
}

/** Positions in the frame. @param {Placed} placed @param {Frame} frame */
export function toFrame({ positions, origin = [0, 0, 0] }, { center, diagonal }) {
  const out = new Float32Array(positions.length);
  for (let axis = 0; axis < 3; axis++) {
    const shift = origin[axis] - center[axis];
    for (let i = axis; i < out.length; i += 3) out[i] = (positions[i] + shift) / diagonal;
  }
  return out;
}

/**
 * Mean distance between neighbours, from the area that the points cover: the share of a coarse grid's cells that hold a
 * point, each standing for the piece of surface that crosses it.
 * @param {Float32Array} positions in the frame
 */
export function typicalSpacing(positions) {
  const cells = 64;
  const areaOfCell = 0.7 / cells ** 2;
  const taken = new Uint8Array(cells ** 3);
  const index = (/** @type {number} */ value) => Math.min(cells - 1, Math.max(0, Math.floor((value + 0.5) * cells)));
  let count = 0;
  for (let i = 0; i < positions.length; i += 3) {
    const cell = index(positions[i]) + cells * (index(positions[i + 1]) + cells * index(positions[i + 2]));
    count += 1 - taken[cell];
    taken[cell] = 1;
  }
  return Math.sqrt((areaOfCell * count) / Math.max(1, positions.length / 3));
}
