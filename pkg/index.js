/** The package in a browser. Importing it touches no global; the first call starts a worker. */
import { makeApi } from './api.js';
import { platform } from './platform.web.js';

export { PointweaveError } from './errors.js';
export { DEFAULTS } from './options.js';
export const { createEngine, reduce, reconstruct, inspect, read, write, sample } = makeApi(platform);
