/** `pointweave/core` in Node. */
import { makeLoad } from './direct-api.js';
import { platform } from './platform.node.js';

export { PointweaveError } from './errors.js';
export { DEFAULTS } from './options.js';
export const load = makeLoad(platform);
