/**
 * Every option with its default and what it accepts, and the checks at the border. The ranges and
 * defaults are those of `src/base/params.rs`; a test compares the two.
 */
import { PointweaveError } from './errors.js';

/** @import { ReconstructOptions, ReduceOptions } from '../types.js' */

/**
 * @typedef {object} Rule
 * @property {unknown} [fallback] the default; missing where it depends on other options
 * @property {string} expected in words
 * @property {string[]} [names] all that are accepted, of a choice
 * @property {(value: unknown, path: string) => boolean | void} accepts may throw an error that says more
 */

/**
 * @param {string} expected
 * @param {Rule['accepts']} accepts
 * @param {unknown} [fallback]
 * @returns {Rule}
 */
const rule = (expected, accepts, fallback) => ({ expected, accepts, fallback });

/** @param {unknown} value @returns {value is number} */
const isNumber = (value) => typeof value === 'number' && Number.isFinite(value);
/** @param {unknown} value @returns {value is Record<string, unknown>} */
const isObject = (value) => typeof value === 'object' && value !== null && !Array.isArray(value) && !ArrayBuffer.isView(value);

/** A number from `low` to `high`; the ends count unless they are named in `open`. */
const number = (/** @type {number} */ low, /** @type {number} */ high, /** @type {{ open?: '' | '(' | ')' | '()', or?: 'auto', fallback?: unknown }} */ { open = '', or, fallback } = {}) => {
  const range = `a number in ${open.includes('(') ? '(' : '['}${low}, ${high}${open.includes(')') ? ')' : ']'}`;
  return rule(
    or ? `'${or}' or ${range}` : range,
    (value) =>
      (or !== undefined && value === or) ||
      (isNumber(value) &&
        (open.includes('(') ? value > low : value >= low) &&
        (open.includes(')') ? value < high : value <= high)),
    fallback,
  );
};
/** @param {number} low @param {number} high @param {unknown} [fallback] */
const integer = (low, high, fallback) =>
  rule(
    high === Number.MAX_SAFE_INTEGER ? `an integer of at least ${low}` : `an integer from ${low} to ${high}`,
    (value) => Number.isSafeInteger(value) && Number(value) >= low && Number(value) <= high,
    fallback,
  );
/** The first is the default. @param {string[]} names */
const choice = (...names) => ({
  ...rule(`one of ${names.map((name) => `'${name}'`).join(', ')}`, (value) => names.includes(/** @type {string} */ (value)), names[0]),
  names,
});
/** @param {boolean} [fallback] */
const flag = (fallback) => rule('true or false', (value) => typeof value === 'boolean', fallback);

export const TARGETS = {
  ratio: number(0, 1, { open: '(' }),
  count: integer(1, 0xffffffff),
  tolerance: number(0, 1, { open: '()' }),
  flatness: number(0, 1, { open: '(' }),
};

const CARRY = choice('mean', 'majority', 'nearest');

const REDUCE = {
  target: rule('an object with one of ratio, count, tolerance, flatness', acceptsTarget, { ratio: 1 / 3 }),
  method: choice('adaptive', 'paper'),
  fuzzifier: number(1, 100, { open: '(' }),
  epsilon: number(0, 1, { open: '(' }),
  maxIterations: integer(1, 100_000),
  norm: choice('euclidean', 'diagonal', 'mahalanobis'),
  clusters: choice('proportional', 'validity'),
  curvatureWeight: number(0, 1, { fallback: 0.5 }),
  placement: choice('implicit', 'mesh', 'center', 'sample'),
  seed: integer(0, Number.MAX_SAFE_INTEGER, 0),
  cellPoints: integer(8, 65_536),
  maxDepth: integer(1, 21, 21),
  attributes: rule(`an object of attribute names, each with ${CARRY.expected}`, acceptsAttributes, {}),
  assignment: flag(false),
  cells: flag(false),
  outliers: choice('keep', 'drop'),
};

const RECONSTRUCT = {
  reduce: rule('false or an object of reduce options', acceptsReduce, defaultsOf(REDUCE)),
  accuracy: number(0, 1, { open: '()', fallback: 6e-4 }),
  kernel: choice('triharmonic', 'biharmonic', 'thin-plate'),
  smoothing: number(0, 1e6, { or: 'auto', fallback: 'auto' }),
  orient: flag(true),
  propagation: choice('global', 'paper'),
  resolution: number(1e-4, 0.25, { or: 'auto', fallback: 'auto' }),
  sharp: flag(true),
  boundary: choice('auto', 'closed', 'open'),
  distances: flag(false),
  keep: flag(false),
};

const READ = {
  name: rule('a file name', (value) => typeof value === 'string'),
  format: { ...choice('ply', 'xyz', 'pcd', 'obj', 'off', 'stl', 'glb', 'las', 'e57', 'ptx', 'grid', 'tif', '3mf', 'splat', 'spz'), fallback: undefined },
  columns: rule('an array of column names with x, y and z', (value) => Array.isArray(value) && value.every((name) => typeof name === 'string')),
  delimiter: rule("one character, ' ' for blanks", (value) => typeof value === 'string' && value.length === 1),
  decimal: { ...choice('.', ','), fallback: undefined },
  skip: integer(0, Number.MAX_SAFE_INTEGER, 0),
  sentinels: choice('drop', 'keep'),
};

const WRITE = {
  format: choice('ply', 'xyz', 'glb', 'obj', 'stl'),
  encoding: choice('binary', 'ascii'),
  quantize: flag(false),
  meshopt: rule("true, false or compress of 'pointweave/meshopt'", (value) => typeof value === 'boolean' || typeof value === 'function', false),
};

const MODEL = choice('duck', 'pig', 'part');

const SAMPLE = {
  count: integer(1, 10_000_000),
  seed: integer(0, Number.MAX_SAFE_INTEGER, 0),
  noise: number(0, 0.01, { fallback: 5e-4 }),
};

export const ENGINE = {
  threads: rule("'auto' or an integer from 1 to 64", (value) => value === 'auto' || integer(1, 64).accepts(value, ''), 'auto'),
  worker: flag(),
  workerUrl: rule("the URL of the worker's script", isUrl),
  idleMs: rule('a number of at least 0', (value) => typeof value === 'number' && value >= 0),
  wasmUrl: rule(
    'the URL of the folder that holds single/, threads/, files/, las/, e57/ and packed/, or an object { single, threads, files, las, e57, packed } of file URLs',
    (value) => isUrl(value) || (isObject(value) && Object.keys(value).every((key) => ['single', 'threads', 'files', 'las', 'e57', 'packed'].includes(key) && isUrl(value[key]))),
  ),
};

const CALL = {
  signal: rule('an AbortSignal', (value) => value instanceof AbortSignal),
  onProgress: rule('a function', (value) => typeof value === 'function'),
  transfer: flag(false),
};

/** The command line has its flags from here. */
export const TABLES = { reduce: REDUCE, reconstruct: RECONSTRUCT, inspect: {}, read: READ, write: WRITE, sample: SAMPLE };

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
  const { signal, onProgress, transfer, ...own } = checkTable({ ...TABLES[call], ...CALL }, options, '');
  if (call === 'write') checkCompression(own);
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

/**
 * The options that are given (not `undefined`), once each of them is accepted.
 * @param {Record<string, Rule>} table
 * @param {unknown} options
 * @param {string} path where they are, as a prefix: '' or 'reduce.'
 * @returns {Record<string, unknown>}
 */
function checkTable(table, options, path) {
  if (!isObject(options)) throw badOption(path.slice(0, -1) || 'options', 'an object', options);
  const given = Object.entries(options).filter(([, value]) => value !== undefined);
  for (const [key, value] of given) {
    if (!Object.hasOwn(table, key)) throw unknownOption(path + key, key, Object.keys(table));
    if (!table[key].accepts(value, path + key)) throw badOption(path + key, table[key].expected, value);
  }
  return Object.fromEntries(given.map(([key, value]) => [key, withoutUndefined(value)]));
}

/** An object of options in options, without those that are not given; whatever else as it is. @param {unknown} value @returns {unknown} */
function withoutUndefined(value) {
  if (Object.prototype.toString.call(value) !== '[object Object]') return value;
  const given = Object.entries(/** @type {object} */ (value)).filter(([, inner]) => inner !== undefined);
  return Object.fromEntries(given.map(([key, inner]) => [key, withoutUndefined(inner)]));
}

/** @param {Record<string, unknown>} options of `write` */
function checkCompression({ format = WRITE.format.fallback, quantize, meshopt }) {
  for (const [option, value] of Object.entries({ quantize, meshopt })) {
    if (value && format !== 'glb') throw badOption(option, "false, unless format is 'glb'", value);
  }
}

/** @type {Rule['accepts']} */
function acceptsTarget(value, path) {
  if (!isObject(value)) return false;
  const given = checkTable(TARGETS, value, `${path}.`);
  return Object.keys(given).length === 1;
}

/** Whether the cloud has these attributes is found out in Rust. @type {Rule['accepts']} */
function acceptsAttributes(value, path) {
  if (!isObject(value)) return false;
  for (const [name, how] of Object.entries(value)) {
    if (!CARRY.accepts(how, '')) throw badOption(`${path}.${name}`, CARRY.expected, how);
  }
  return true;
}

/** @type {Rule['accepts']} */
function acceptsReduce(value, path) {
  if (value === false) return true;
  checkTable(REDUCE, value, `${path}.`);
  return true;
}

/** @param {unknown} value */
function isUrl(value) {
  return value instanceof URL || (typeof value === 'string' && value !== '');
}

/** @param {string} option @param {string} expected @param {unknown} found */
function badOption(option, expected, found) {
  return new PointweaveError({ code: 'bad-option', message: `option ${option} is ${show(found)}: expected ${expected}`, expected, found });
}

/** @param {string} option @param {string} key @param {string[]} names */
function unknownOption(option, key, names) {
  const near = nearest(key, names);
  const hint = Object.hasOwn(TARGETS, key) && names.includes('target') ? `target: { ${key} }` : near;
  return new PointweaveError({
    code: 'bad-option',
    message: `there is no option ${option}${hint ? `: did you mean ${hint}?` : `: expected one of ${names.join(', ')}`}`,
    expected: hint ?? names,
    found: option,
  });
}

/** @param {unknown} value */
function show(value) {
  if (typeof value === 'string') return `'${value}'`;
  if (typeof value === 'function') return 'a function';
  if (Array.isArray(value) || ArrayBuffer.isView(value)) return `an ${value.constructor.name}`;
  if (isObject(value)) return `an object with ${Object.keys(value).join(', ') || 'no keys'}`;
  return String(value);
}

/**
 * The name that is the fewest edits away, if that is near enough to be a typo.
 * @param {string} word
 * @param {string[]} names
 * @returns {string | undefined}
 */
export function nearest(word, names) {
  const ranked = names.map((name) => ({ name, distance: editDistance(word.toLowerCase(), name.toLowerCase()) }));
  ranked.sort((a, b) => a.distance - b.distance);
  return ranked[0]?.distance <= Math.max(2, word.length / 3) ? ranked[0].name : undefined;
}

/** Levenshtein's distance, one row at a time. @param {string} a @param {string} b */
function editDistance(a, b) {
  let row = Array.from({ length: b.length + 1 }, (_, j) => j);
  for (let i = 1; i <= a.length; i++) {
    const next = [i];
    for (let j = 1; j <= b.length; j++) {
      next[j] = Math.min(row[j] + 1, next[j - 1] + 1, row[j - 1] + (a[i - 1] === b[j - 1] ? 0 : 1));
    }
    row = next;
  }
  return row[b.length];
}

/** @param {Record<string, Rule>} table @returns {Record<string, any>} */
function defaultsOf(table) {
  return Object.fromEntries(Object.entries(table).map(([key, { fallback }]) => [key, fallback]));
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
