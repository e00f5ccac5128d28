/** Which way is up, as far as the data say. */

/** @import { Axis, Drawable } from '../viewer.js' */

const AXES = /** @type {const} */ (['x', 'y', 'z']);
/** Formats whose z points up, by their specifications. */
const SURVEYED = new Set(['las', 'e57']);
/** Less high than this share of its shorter side, a scan is flat. */
const FLAT = 0.25;

/**
 * The axis that is most likely up: nearest to the direction that the data name; z on maps, and of what is wide and flat as land
 * and rooms are; else y, as of most objects.
 * @param {Pick<Drawable, 'up' | 'seenFromAbove' | 'file' | 'origin'>} what
 * @param {[number, number, number]} size edge lengths of its bounding box
 * @returns {Axis}
 */
export function likelyUp({ up, seenFromAbove, file, origin }, [x, y, z]) {
  if (up) {
    const axis = [0, 1, 2].reduce((best, next) => (Math.abs(up[next]) > Math.abs(up[best]) ? next : best));
    return up[axis] < 0 ? `-${AXES[axis]}` : AXES[axis];
  }
  const onMap = seenFromAbove || SURVEYED.has(file?.format ?? '') || origin !== undefined;
  return onMap || z < FLAT * Math.min(x, y) ? 'z' : 'y';
}
