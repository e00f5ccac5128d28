/** The package in Node: computes in the caller's process, unless an engine is given a worker. */
import { makeApi } from './api.js';
import { platform } from './platform.node.js';

export { PointweaveError } from './errors.js';
export { DEFAULTS } from './options.js';
export const { createEngine, reduce, reconstruct, inspect, read, write, sample } = makeApi(platform);
