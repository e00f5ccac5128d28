/**
 * The options of every call, and the checks at the border. Those of a reduction and a reconstruction are written from the one
 * table in Rust; here stand those that are the package's own.
 */
import { AXES, UNITS, isDirection } from './axes.js';
import * as TABLE from './options-table.js';
import { MAPS } from './pictures.js';
import { colorOf, orbitOf } from './posing.js';
import { RECIPE } from './preparing.js';
import { badOption, checkTable, choice, defaultsOf, integer, isObject, nested, number, rule, toggle } from './rules.js';

/** @import { ReconstructOptions, ReduceOptions } from '../types.js' */

const { target } = TABLE.REDUCE;
const AUTO = 'auto';
/** The package makes a count of `'auto'` (amount.js). */
const REDUCE = {
  ...TABLE.REDUCE,
  target: { ...target, ...rule(`'${AUTO}' or ${target.expected}`, (value, path) => value === AUTO || target.accepts(value, path), target.fallback) },
};
const RECONSTRUCT = { ...TABLE.RECONSTRUCT, reduce: nested('reduce', REDUCE) };

const READ = {
  name: rule('a file name', (value) => typeof value === 'string'),
  format: { ...choice('ply', 'xyz', 'pcd', 'obj', 'off', 'stl', 'glb', 'las', 'e57', 'ptx', 'grid', 'tif', '3mf', 'splat', 'spz'), fallback: undefined },
  faces: choice('sample', 'vertices', 'mesh'),
  beside: rule('an array of Files, or a function that gives the data of a name', (value) => typeof value === 'function' || (Array.isArray(value) && value.every((file) => typeof file?.name === 'string'))),
  columns: rule('an array of column names with x, y and z', (value) => Array.isArray(value) && value.every((name) => typeof name === 'string')),
  delimiter: rule("one character, ' ' for blanks", (value) => typeof value === 'string' && value.length === 1),
  decimal: { ...choice('.', ','), fallback: undefined },
  skip: integer(0, Number.MAX_SAFE_INTEGER, 0),
  sentinels: choice('drop', 'keep'),
};

/** What pictures of a GLB file can be. */
const PICTURES = ['png', 'webp', 'ktx2'];

const WRITE = {
  format: choice('ply', 'xyz', 'glb', 'obj', 'stl', 'pcd', 'las', 'laz', '3mf', 'usdz', 'zip'),
  encoding: choice('binary', 'ascii'),
  quantize: toggle(false),
  up: { ...rule("'x', 'y', 'z', '-x', '-y', '-z' or three numbers", isDirection), names: Object.keys(AXES) },
  unit: { ...choice(...UNITS), fallback: undefined },
  pictures: { ...rule(`${PICTURES.map((name) => `'${name}'`).join(', ')} or a function that encodes`, (value) => PICTURES.includes(/** @type {any} */ (value)) || typeof value === 'function', 'png'), names: PICTURES },
  meshopt: rule("true, false or compress of 'pointweave/meshopt'", (value) => typeof value === 'boolean' || typeof value === 'function', false),
};

const SIMPLIFY = {
  triangles: integer(1, Number.MAX_SAFE_INTEGER),
  error: rule('a number in (0, 1]', (value) => typeof value === 'number' && value > 0 && value <= 1),
};

/** Budgets of several meshes, each less than the one before. */
export const LODS = rule('an array of 1 to 8 integers of at least 1, each less than the one before', (value) =>
  Array.isArray(value) && value.length > 0 && value.length <= 8 && value.every((n, i) => SIMPLIFY.triangles.accepts(n, '') && (i === 0 || n < value[i - 1])));

const TEXTURE = {
  size: integer(64, 8192),
  maps: rule(`an array of ${MAPS.map((name) => `'${name}'`).join(', ')}`, (value) => Array.isArray(value) && value.every((name) => MAPS.includes(name))),
  scalar: rule("'height' or the name of an attribute", (value) => typeof value === 'string' && value !== ''),
  range: rule('two finite numbers, the first less than the second', (value) => Array.isArray(value) && value.length === 2 && value.every(Number.isFinite) && value[0] < value[1]),
};

const side = integer(16, 4096);
const POSTER = {
  size: rule('a width and a height, integers from 16 to 4096', (value) => Array.isArray(value) && value.length === 2 && value.every((n) => side.accepts(n, ''))),
  camera: rule("'theta phi radius', each auto or with its unit: deg or rad, deg or rad, and % or m", (value) => orbitOf(value) !== undefined),
  background: rule("'transparent' or '#rrggbb'", (value) => value === 'transparent' || (typeof value === 'string' && colorOf(value) !== undefined)),
};

const MODEL = choice('duck', 'pig', 'part', 'desk');

const SAMPLE = {
  count: integer(1, 10_000_000),
  seed: integer(0, Number.MAX_SAFE_INTEGER, 0),
  noise: number(0, 0.01, { fallback: 5e-4 }),
};

/** Folders of `pkg/wasm`. */
const BUILDS = ['single', 'threads', 'files', 'las', 'e57', 'packed', 'pictures', 'exports', 'prepare', 'light', 'samples'];

export const ENGINE = {
  threads: rule("'auto' or an integer from 1 to 64", (value) => value === 'auto' || integer(1, 64).accepts(value, ''), 'auto'),
  worker: toggle(),
  workerUrl: rule("the URL of the worker's script", isUrl),
  idleMs: rule('a number of at least 0', (value) => typeof value === 'number' && value >= 0),
  wasmUrl: rule(
    `the URL of the folder that holds ${BUILDS.join('/, ')}/, or an object { ${BUILDS.join(', ')} } of file URLs`,
    (value) => (isUrl(value) ? !isWasm(value) : isObject(value) && Object.keys(value).every((key) => BUILDS.includes(key) && isUrl(value[key]))),
  ),
};

const CALL = {
  signal: rule('an AbortSignal', (value) => value instanceof AbortSignal),
  onProgress: rule('a function', (value) => typeof value === 'function'),
  transfer: toggle(false),
};

/** Of a reduction and a reconstruction: what is done to the scan before. */
const FIRST = { prepare: RECIPE };

/** Of a reconstruction: what is done to the mesh after. */
const LAST = { texture: nested('texture', TEXTURE), lods: LODS };

/** The command line has its flags from here. */
export const TABLES = { reduce: REDUCE, reconstruct: RECONSTRUCT, prepare: {}, simplify: SIMPLIFY, texture: { triangles: SIMPLIFY.triangles, ...TEXTURE }, poster: POSTER, inspect: {}, read: READ, write: WRITE, sample: SAMPLE };

/**
 * What is taken for each option that is not given. `undefined` means that it follows from others.
 * @type {{ readonly reduce: Readonly<ReduceOptions>, readonly reconstruct: Readonly<ReconstructOptions> }}
 */
export const DEFAULTS = deepFreeze({ reduce: defaultsOf(REDUCE), reconstruct: defaultsOf(RECONSTRUCT) });

/**
 * Checks a call's options and takes them apart: what wasm needs, and what the engine does itself.
 * @param {keyof typeof TABLES} call
 * @param {unknown} options
 * @returns {{ own: Record<string, any>, signal?: AbortSignal, onProgress?: (progress: any) => void, transfer?: boolean }}
 */
export function checkOptions(call, options = {}) {
  const table = call === 'reduce' || call === 'reconstruct' ? { ...TABLES[call], ...FIRST, ...(call === 'reconstruct' && LAST), ...CALL } : { ...TABLES[call], ...CALL };
  const { signal, onProgress, transfer, ...own } = checkTable(table, options, '');
  if (call === 'write') checkCompression(own);
  if (own.lods && own.triangles !== undefined) throw badOption('triangles', 'undefined where lods are given', own.triangles);
  const baked = /** @type {Record<string, any> | undefined} */ (call === 'texture' ? own : own.texture);
  if (baked?.range && baked.scalar === undefined) throw badOption('range', 'undefined, unless scalar says of what', baked.range);
  if (call === 'simplify' && own.triangles === undefined && own.error === undefined) throw badOption('triangles', 'a number of triangles, or error', undefined);
  return /** @type {any} */ ({ own, signal, onProgress, transfer });
}

/**
 * @param {unknown} model
 * @returns {import('../types.js').Model}
 */
export function checkModel(model) {
  if (!MODEL.accepts(model, '')) throw badOption('model', MODEL.expected, model);
  return /** @type {import('../types.js').Model} */ (model);
}

/**
 * @param {unknown} options
 * @returns {import('../types.js').EngineOptions}
 */
export function checkEngineOptions(options = {}) {
  return checkTable(ENGINE, options, '');
}

/**
 * @param {unknown} options
 * @returns {import('../types.core.js').CoreOptions}
 */
export function checkCoreOptions(options = {}) {
  return checkTable({ wasmUrl: ENGINE.wasmUrl }, options, '');
}

/** @param {Record<string, unknown>} options of `write` */
function checkCompression({ format = WRITE.format.fallback, quantize, meshopt, pictures }) {
  if (format === 'glb') return;
  for (const [option, value] of Object.entries({ quantize, meshopt })) if (value) throw badOption(option, "false, unless format is 'glb'", value);
  if (pictures !== undefined && pictures !== 'png') throw badOption('pictures', "'png', unless format is 'glb'", pictures);
}

/** One file, where a folder is expected. @param {unknown} value */
function isWasm(value) {
  return /\.wasm([?#]|$)/.test(String(value));
}

/** @param {unknown} value */
function isUrl(value) {
  return value instanceof URL || (typeof value === 'string' && value !== '');
}

/**
 * @template {object} T
 * @param {T} object
 * @returns {T}
 */
function deepFreeze(object) {
  for (const part of Object.values(object)) if (isObject(part)) deepFreeze(part);
  return Object.freeze(object);
}
