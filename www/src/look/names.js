/** @import { Side } from 'pointweave/viewer' */

/** As on the buttons. @type {Record<Side, string>} */
export const SIDES = { front: 'Front', back: 'Back', right: 'Right', left: 'Left', top: 'Top', bottom: 'Bottom' };
/** Views, in the help and when they are announced. */
export const NAMES = { points: 'Scan', reduced: 'Reduced points', mesh: 'Mesh', compare: 'Comparison' };
