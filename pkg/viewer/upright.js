/** Which way is up, as far as the data say. */

/** @import { Axis, Drawable } from '../viewer.js' */

const AXES = /** @type {const} */ (['x', 'y', 'z']);
/** Less high than this share of its shorter side, a scan is flat. */
const FLAT = 0.25;

/**
 * The axis that is most likely up: nearest to the direction that the data name; z on maps, and of what is wide and flat as land
 * and rooms are; else y, as of most objects.
 * @param {Pick<Drawable, 'up' | 'seenFromAbove' | 'origin'>} what
 * @param {[number, number, number]} size edge lengths of its bounding box
 * @returns {Axis}
 */
export function likelyUp({ up, seenFromAbove, origin }, [x, y, z]) {
  if (up) return nearestAxis(up);
  return seenFromAbove || origin !== undefined || z < FLAT * Math.min(x, y) ? 'z' : 'y';
}

/** @param {[number, number, number]} direction @returns {Axis} */
export function nearestAxis(direction) {
  const axis = [0, 1, 2].reduce((best, next) => (Math.abs(direction[next]) > Math.abs(direction[best]) ? next : best));
  return direction[axis] < 0 ? `-${AXES[axis]}` : AXES[axis];
}
