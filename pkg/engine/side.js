/** How a result knows which side is out, in words. */

/** @import { OrientationSource, SurfaceReport } from '../types.js' */

/** @type {Record<OrientationSource, string>} */
export const TOLD_BY = {
  normals: "the scan's own normals",
  viewpoints: 'where it was scanned from',
  above: 'it was scanned from above',
  camera: 'it was taken by a depth camera',
  shell: 'its shape, which encloses the inside',
  up: 'sheets look up',
  guess: 'nothing, so this is a guess',
};

export const TELLS = 'what tells the outer side: ';

/**
 * Which sources decided, the largest first; those that decided less than half a per cent are left out.
 * @param {Pick<SurfaceReport, 'orientation'>} report
 * @param {(text: string) => string} [say] each text in another language
 */
export function sideInWords({ orientation }, say = (text) => text) {
  const told = orientation.sources.filter(({ share }) => share >= 0.005).sort((a, b) => b.share - a.share);
  const parts = told.map(({ source, share }) => `${say(TOLD_BY[source])}${told.length > 1 ? ` (${Math.round(100 * share)} %)` : ''}`);
  return `${say(TELLS)}${parts.join(', ') || say(TOLD_BY.guess)}`;
}
