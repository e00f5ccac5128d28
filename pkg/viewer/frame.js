/**
 * The frame that pictures are made in: the bounding box centred at 0 with a diagonal of 1. The shift is made in double
 * precision, so georeferenced scans do not jitter on the GPU.
 */

/** @import { Frame, Placed } from '../viewer.js' */
/** @typedef {[number, number, number]} Triple */

/** Of nothing. @type {Frame} */
export const ITSELF = { center: [0, 0, 0], size: [1, 1, 1], diagonal: 1 };

/** @param {Triple} low @param {Triple} high @returns {Frame} */
export function frameBetween(low, high) {
  const size = /** @type {Triple} */ (low.map((value, axis) => Math.max(0, high[axis] - value)));
  const center = /** @type {Triple} */ (low.map((value, axis) => (value + high[axis]) / 2));
  return { center, size, diagonal: Math.hypot(...size) || 1 };
}

/** Of the finite coordinates; the engine says what is wrong with the others. @param {Placed} placed */
export function frameOf({ positions, origin = [0, 0, 0] }) {
  const low = /** @type {Triple} */ ([Infinity, Infinity, Infinity]);
  const high = /** @type {Triple} */ ([-Infinity, -Infinity, -Infinity]);
  for (let i = 0; i < positions.length; i += 3) {
    for (let axis = 0; axis < 3; axis++) {
      const value = positions[i + axis];
      if (!Number.isFinite(value)) continue;
      if (value < low[axis]) low[axis] = value;
      if (value > high[axis]) high[axis] = value;
    }
  }
  const { center, ...frame } = frameBetween(low, high);
  return { center: /** @type {Triple} */ (center.map((value, axis) => value + origin[axis])), ...frame };
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

/** At most so many of the positions: enough to know how large something looks. @param {Float32Array} positions @param {number} [most] */
export function thinned(positions, most = 4096) {
  const step = 3 * Math.max(1, Math.ceil(positions.length / 3 / most));
  const picked = new Float32Array(3 * Math.ceil(positions.length / step));
  for (let i = 0, at = 0; i < positions.length; i += step, at += 3) picked.set(positions.subarray(i, i + 3), at);
  return picked;
}

/** @param {Float32Array[]} parts */
export function joined(parts) {
  const out = new Float32Array(parts.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const part of parts) {
    out.set(part, at);
    at += part.length;
  }
  return out;
}
