/** `pointweave/core` in a browser: the functions without engine and worker, for whoever has a worker of their own. */
import { makeLoad } from './direct-api.js';
import { platform } from './platform.web.js';

export { PointweaveError } from './errors.js';
export { DEFAULTS } from './options.js';
export const load = makeLoad(platform);
