import * as format from '../results/format.js';
import { say } from '../words/say.js';

/**
 * @import { Target } from './settings.js'
 * @import { Scan } from '../session/session.js'
 */

/** What a target means for the open scan, in a sentence. */
export function meaningOf(/** @type {Target} */ { kind, value }, /** @type {Scan | null} */ scan) {
  if (!scan) return say('Curved places keep more, flat places fewer.');
  const counted = (/** @type {number} */ kept) => kept < scan.count
    ? say('{kept} of {points}. Curved places keep more.', { kept: format.count(kept), points: format.points(scan.count) })
    : say('All of {points}.', { points: format.points(scan.count) });
  switch (kind) {
    case 'ratio': return counted(Math.max(1, Math.round(scan.count * value)));
    case 'count': return counted(value);
    case 'tolerance': return say('The fewest points that stay within {distance} of the scan.', { distance: format.length(value * scan.frame.diagonal) });
    case 'flatness': return say('Flat places are thinned, all others kept as they are.');
  }
}
