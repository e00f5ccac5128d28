/** @import { Placed } from '../viewer.js' */

/** Single precision that moves a coordinate by no more than this share of the extent along its axis loses nothing of a scan. */
const ROUNDING = 2 ** -22;

/**
 * Splits an origin of whole numbers off a cloud whose coordinates are far from zero for its size, as those of maps are:
 * positions become differences from it, in place, and the origin goes with the cloud into all that is made of it.
 * Nothing is lost: what is split off along an axis is between half and twice every coordinate there, so the differences are
 * exact (Sterbenz, 1974), and positions plus origin are the file's coordinates to the bit.
 *
 * @template {Placed} Cloud
 * @param {Cloud} cloud
 * @returns {Cloud} the same
 */
export function splitOrigin(cloud) {
  const { positions } = cloud;
  if (cloud.origin || !(positions instanceof Float64Array)) return cloud;
  const spans = [0, 1, 2].map((axis) => spanOf(positions, axis));
  if (!spans.some(({ low, high, rounding }) => rounding > ROUNDING * (high - low))) return cloud;
  const origin = /** @type {[number, number, number]} */ (spans.map(wholeNumber));
  if (origin.every((value) => value === 0)) return cloud;
  for (let i = 0; i < positions.length; i++) positions[i] -= origin[i % 3];
  return Object.assign(cloud, { origin });
}

/** The ends of the finite coordinates along an axis, and the most that single precision moves one. @typedef {{ low: number, high: number, rounding: number }} Span */

/** @param {Float64Array} positions @param {number} axis @returns {Span} */
function spanOf(positions, axis) {
  const span = { low: Infinity, high: -Infinity, rounding: 0 };
  for (let i = axis; i < positions.length; i += 3) {
    const value = positions[i];
    if (!Number.isFinite(value)) continue;
    span.low = Math.min(span.low, value);
    span.high = Math.max(span.high, value);
    span.rounding = Math.max(span.rounding, Math.abs(Math.fround(value) - value));
  }
  return span;
}

/** A number of few digits near the middle, or 0 where not all coordinates are near it. @param {Span} span */
function wholeNumber({ low, high }) {
  const step = 10 ** Math.max(0, Math.floor(Math.log10(high - low || 1)));
  const middle = Math.round((low + high) / 2 / step) * step;
  const [least, most] = middle < 0 ? [-high, -low] : [low, high];
  const size = Math.abs(middle);
  return size > 0 && size / 2 <= least && most <= 2 * size ? middle : 0;
}
