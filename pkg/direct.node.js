/** `pointweave/core` in Node. */
import { makeLoad } from './engine/direct-api.js';
import { platform } from './engine/platform.node.js';

export { autoCount } from './engine/amount.js';
export { PointweaveError } from './engine/errors.js';
export { flip } from './engine/flip.js';
export { DEFAULTS } from './engine/options.js';
export { sideInWords } from './engine/side.js';
export { splitOrigin } from './files/origin.js';
export const load = makeLoad(platform);
