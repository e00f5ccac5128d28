import * as format from '../results/format.js';

/**
 * @import { Target } from './settings.js'
 * @import { Scan } from '../session/session.js'
 */

/** What a target means for the open scan, in a sentence. */
export function meaningOf(/** @type {Target} */ { kind, value }, /** @type {Scan | null} */ scan) {
  if (!scan) return 'Curved places keep more, flat places fewer.';
  const counted = (/** @type {number} */ kept) => kept < scan.count
    ? `${format.count(kept)} of ${format.points(scan.count)}. Curved places keep more.`
    : `All of ${format.points(scan.count)}.`;
  switch (kind) {
    case 'ratio': return counted(Math.max(1, Math.round(scan.count * value)));
    case 'count': return counted(value);
    case 'tolerance': return `The fewest points that stay within ${format.length(value * scan.frame.diagonal)} of the scan.`;
    case 'flatness': return 'Flat places are thinned, all others kept as they are.';
  }
}
