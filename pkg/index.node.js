/** The package in Node: computes in the caller's process, unless an engine is given a worker. */
import { makeApi } from './engine/api.js';
import { platform } from './engine/platform.node.js';

export { autoCount } from './engine/amount.js';
export { PointweaveError } from './engine/errors.js';
export { flip } from './engine/flip.js';
export { DEFAULTS } from './engine/options.js';
export { sideInWords } from './engine/side.js';
export { splitOrigin } from './files/origin.js';
export const { createEngine, prepare, simplify, texture, poster, reduce, reconstruct, inspect, read, write, sample } = makeApi(platform);
