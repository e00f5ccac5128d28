/** From "so much of this stage" to "so much of the whole": about how the time of a call divides into stages. */

/** @import { Progress, Stage } from '../types.js' */

/** @type {Record<string, [Stage, number][]>} */
const SHARES = {
  prepare: [['octree', 3], ['features', 57], ['prepare', 40]],
  reduce: [['octree', 3], ['features', 38], ['cluster', 44], ['place', 3], ['report', 12]],
  reconstruct: [
    ['octree', 1], ['features', 22], ['cluster', 25], ['place', 3],
    ['cells', 9], ['fit', 12], ['orient', 3], ['extract', 22], ['report', 3],
  ],
  simplify: [['simplify', 100]],
  texture: [['simplify', 25], ['texture', 75]],
  poster: [['texture', 100]],
  inspect: [['octree', 10], ['features', 90]],
};

/**
 * Turns a call's stages into progress that never decreases and that {@link finish} ends at 1.
 * @param {string} call
 * @param {(progress: Progress) => boolean} listener
 */
export function track(call, listener) {
  const shares = SHARES[call] ?? [];
  const whole = shares.reduce((sum, [, share]) => sum + share, 0);
  /** @type {Progress} */
  let latest = { stage: shares[0]?.[0] ?? 'report', fraction: 0, overall: 0 };

  return {
    /** @type {(stage: Stage, fraction: number) => boolean} */
    update(stage, fraction) {
      const at = shares.findIndex(([name]) => name === stage);
      const before = shares.slice(0, Math.max(at, 0)).reduce((sum, [, share]) => sum + share, 0);
      const overall = at < 0 ? 0 : (before + shares[at][1] * fraction) / whole;
      latest = { stage, fraction, overall: Math.max(latest.overall, overall) };
      return listener(latest);
    },
    finish() {
      if (latest.overall < 1) listener({ stage: latest.stage, fraction: 1, overall: 1 });
    },
  };
}
