/** What an option may be: a rule for each kind, and the check of a whole table of them. */
import { PointweaveError } from './errors.js';

/**
 * @typedef {object} Rule
 * @property {unknown} [fallback] the default; missing where it depends on other options
 * @property {string} expected in words
 * @property {string[]} [names] all that are accepted, of a choice
 * @property {Table} [parts] what the option's object may hold
 * @property {(value: unknown, path: string) => boolean | void} accepts may throw an error that says more
 */

/** @typedef {Record<string, Rule>} Table */

/**
 * @param {string} expected
 * @param {Rule['accepts']} accepts
 * @param {unknown} [fallback]
 * @returns {Rule}
 */
export const rule = (expected, accepts, fallback) => ({ expected, accepts, fallback });

/** @param {unknown} value @returns {value is number} */
const isNumber = (value) => typeof value === 'number' && Number.isFinite(value);
/** @param {unknown} value @returns {value is Record<string, unknown>} */
export const isObject = (value) => typeof value === 'object' && value !== null && !Array.isArray(value) && !ArrayBuffer.isView(value);

/** A number from `low` to `high`; the ends count unless they are named in `open`. */
export const number = (/** @type {number} */ low, /** @type {number} */ high, /** @type {{ open?: '' | '(' | ')' | '()', or?: 'auto', fallback?: unknown }} */ { open = '', or, fallback } = {}) => {
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
export const integer = (low, high, fallback) =>
  rule(
    high === Number.MAX_SAFE_INTEGER ? `an integer of at least ${low}` : `an integer from ${low} to ${high}`,
    (value) => Number.isSafeInteger(value) && Number(value) >= low && Number(value) <= high,
    fallback,
  );

/** The first is the default. @param {string[]} names */
export const choice = (...names) => ({
  ...rule(`one of ${names.map((name) => `'${name}'`).join(', ')}`, (value) => names.includes(/** @type {string} */ (value)), names[0]),
  names,
});

/** @param {boolean} [fallback] */
export const toggle = (fallback) => rule('true or false', (value) => typeof value === 'boolean', fallback);

/** An object with exactly one of these. @param {Table} parts @param {unknown} fallback @returns {Rule} */
export const oneOf = (parts, fallback) => ({
  ...rule(
    `an object with one of ${Object.keys(parts).join(', ')}`,
    (value, path) => isObject(value) && Object.keys(checkTable(parts, value, `${path}.`)).length === 1,
    fallback,
  ),
  parts,
});

/** An object of any names, each with a value that is accepted. Whether the cloud has them is found out in Rust. @param {Rule} each */
export const named = (each) =>
  rule(
    `an object of attribute names, each with ${each.expected}`,
    (value, path) => {
      if (!isObject(value)) return false;
      for (const [name, inner] of Object.entries(value)) {
        if (!each.accepts(inner, '')) throw badOption(`${path}.${name}`, each.expected, inner);
      }
      return true;
    },
    {},
  );

/** An object of options, or false for none. @param {string} what they are of @param {Table} table */
export const nested = (what, table) => ({
  ...rule(`false or an object of ${what} options`, (value, path) => value === false || Boolean(checkTable(table, value, `${path}.`)), defaultsOf(table)),
  parts: table,
});

/** @param {Table} table @returns {Record<string, any>} */
export function defaultsOf(table) {
  return Object.fromEntries(Object.entries(table).map(([key, { fallback }]) => [key, fallback]));
}

/**
 * The options that are given (not `undefined`), once each of them is accepted.
 * @param {Table} table
 * @param {unknown} options
 * @param {string} path where they are, as a prefix: '' or 'reduce.'
 * @returns {Record<string, unknown>}
 */
export function checkTable(table, options, path) {
  if (!isObject(options)) throw badOption(path.slice(0, -1) || 'options', 'an object', options);
  const given = Object.entries(options).filter(([, value]) => value !== undefined);
  for (const [key, value] of given) {
    if (!Object.hasOwn(table, key)) throw unknownOption(path + key, key, table);
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

/** @param {string} option @param {string} expected @param {unknown} found */
export function badOption(option, expected, found) {
  return new PointweaveError({ code: 'bad-option', message: `option ${option} is ${show(found)}: expected ${expected}`, expected, found });
}

/** @param {string} option @param {string} key @param {Table} table */
function unknownOption(option, key, table) {
  const names = Object.keys(table);
  const hint = within(table, key) ?? nearest(key, names);
  return new PointweaveError({
    code: 'bad-option',
    message: `there is no option ${option}${hint ? `: did you mean ${hint}?` : `: expected one of ${names.join(', ')}`}`,
    expected: hint ?? names,
    found: option,
  });
}

/** Where an option is that stands in another, as one writes it: `reduce: { target }`. @param {Table} table @param {string} key @returns {string | undefined} */
function within(table, key) {
  for (const [name, { parts }] of Object.entries(table)) {
    if (!parts) continue;
    const inner = Object.hasOwn(parts, key) ? key : within(parts, key);
    if (inner) return `${name}: { ${inner} }`;
  }
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
