/** @import { Scan } from '../session/session.js' */

/** Formats whose z points up, by their specifications. */
const SURVEYED = new Set(['las', 'e57']);

/**
 * Which axis of a scan is most likely up: z on maps, and of what is wide and flat as land and rooms are; objects come with
 * y up more often.
 * @param {Pick<Scan, 'cloud' | 'frame'>} scan
 */
export function likelyUp({ cloud: { file, origin }, frame: { size: [x, y, z] } }) {
  const onMap = SURVEYED.has(file?.format ?? '') || origin !== undefined;
  return onMap || z < 0.25 * Math.min(x, y) ? 'Z' : 'Y';
}
