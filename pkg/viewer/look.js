/** Where one looks from at first, and how far one may turn, come near and go. In the picture's frame, angles in radians. */
import { MathUtils, Vector3 } from 'three';

/** @import { Distance, FirstLook, Frame, Limits } from '../viewer.js' */

/** From the front, a little from the right and above. */
const DIRECTION = new Vector3(0.55, 0.38, 1).normalize();
export const FIELD_OF_VIEW = 32;
export const NEAREST = 0.02;
/** How far one may go, in distances from which everything is seen. */
const FARTHEST = 6;
/** Not over the poles. */
export const POLE = 1e-4;

/**
 * A distance, or a share of that from which everything is seen.
 * @typedef {{ length: number } | { share: number }} Reach
 */

/** @param {Reach} reach @param {number} whole the distance from which everything is seen */
export function reached(reach, whole) {
  return 'share' in reach ? reach.share * whole : reach.length;
}

/**
 * @typedef {object} Look
 * @property {number} theta
 * @property {number} phi
 * @property {Reach} reach
 * @property {[number, number, number]} target in the frame, as the data stand in it
 * @property {number} fov degrees
 */

/** @param {FirstLook} look @param {Frame | null} frame @returns {Look} */
export function lookOf({ azimuth, polar, distance = { share: 1 }, target = [null, null, null], fieldOfView = FIELD_OF_VIEW }, frame) {
  const { center = [0, 0, 0], diagonal = 1 } = frame ?? {};
  return {
    theta: azimuth === undefined ? Math.atan2(DIRECTION.x, DIRECTION.z) : MathUtils.degToRad(azimuth),
    phi: within(polar === undefined ? Math.acos(DIRECTION.y) : MathUtils.degToRad(polar), [POLE, Math.PI - POLE]),
    reach: reachOf(distance, diagonal),
    target: /** @type {[number, number, number]} */ (target.map((x, axis) => (x === null ? 0 : (x - center[axis]) / diagonal))),
    fov: fieldOfView,
  };
}

/** @type {[null, null]} */
const NONE = [null, null];

/** @param {Limits} limits @param {Frame | null} frame @param {number} [nearest] in the frame, where nobody says */
export function boundsOf({ azimuth = NONE, polar = NONE, distance = NONE, fieldOfView = NONE }, frame, nearest = NEAREST) {
  const diagonal = frame?.diagonal ?? 1;
  return {
    theta: bounds(azimuth.map(radians), -Infinity, Infinity),
    phi: bounds(polar.map(radians), POLE, Math.PI - POLE),
    near: distance[0] ? reachOf(distance[0], diagonal) : { length: nearest },
    far: distance[1] ? reachOf(distance[1], diagonal) : { share: FARTHEST },
    fov: bounds(fieldOfView, 1, 170),
  };
}

/** @param {Distance} distance @param {number} diagonal @returns {Reach} */
function reachOf(distance, diagonal) {
  return typeof distance === 'number' ? { length: distance / diagonal } : distance;
}

/** @param {number | null | undefined} degrees */
function radians(degrees) {
  return typeof degrees === 'number' ? MathUtils.degToRad(degrees) : degrees;
}

/** @param {(number | null | undefined)[]} given @param {number} low @param {number} high @returns {[number, number]} */
function bounds([least, most], low, high) {
  return [Math.max(low, least ?? low), Math.min(high, most ?? high)];
}

/** @param {number} value @param {[number, number]} bounds */
export function within(value, [low, high]) {
  return Math.max(low, Math.min(high, value));
}
