/**
 * How many points suit a scan and a device: what `target: 'auto'` keeps. A surface through them is smooth where the scan is, is there
 * in seconds, and has triangles that a phone can turn.
 */

/** The share that is kept between the bounds: the package's default. */
const SHARE = 1 / 3;
/** Fewer lose the shape of small scans. */
const ENOUGH = 2_000;
/** More are more than a visitor waits for; a surface has about three triangles a point. */
const AMPLE = 60_000;
/** The same for a phone, whose processor and memory are smaller. */
const AMPLE_ON_PHONE = 20_000;
const PHONE = '(pointer: coarse) and (max-width: 900px)';

/** @param {number} points of the scan */
export function autoCount(points) {
  const ample = isPhone() ? AMPLE_ON_PHONE : AMPLE;
  return Math.min(points, ample, Math.max(ENOUGH, Math.round(points * SHARE)));
}

/** A worker has no screen to ask. */
function isPhone() {
  if (typeof matchMedia === 'function') return matchMedia(PHONE).matches;
  return Boolean(/** @type {any} */ (globalThis.navigator)?.userAgentData?.mobile);
}

/**
 * The options of a call with a count in the place of `'auto'`.
 * @param {Record<string, any>} options of a reduction, or of a reconstruction
 * @param {{ positions: ArrayLike<number> }} cloud
 * @returns {Record<string, any>}
 */
export function counted(options, { positions }) {
  const { target, reduce } = options;
  const points = positions.length / 3;
  if (target === 'auto') return { ...options, target: { count: Math.max(1, autoCount(points)) } };
  return reduce ? { ...options, reduce: counted(reduce, { positions }) } : options;
}
