/** What the command line says of how a file is read. */
import { TABLES } from '../engine/options.js';
import { parseValue } from './flags.js';
import { UsageError } from './usage.js';

/** @typedef {{ columns?: string[], delimiter?: string, decimal?: '.' | ',', skip?: number, sentinels?: 'drop' | 'keep' }} ReadSaid */

/** How `parseArgs` is told of them. */
export const READ_FLAGS = /** @type {const} */ ({
  columns: { type: 'string' },
  delimiter: { type: 'string' },
  decimal: { type: 'string' },
  skip: { type: 'string' },
  sentinels: { type: 'string' },
});

/** For the help. */
export const READ_ROWS = [
  ['--columns x,y,z,…', 'what the columns of a table of text hold: x y z, nx ny nz, red green blue, rgb (packed), - (passed over), or a name'],
  ['--delimiter MARK', 'what stands between its values: a character, tab or blank; default: told from its first lines'],
  ['--decimal MARK', 'its decimal mark: . or ,; default: told from its first lines'],
  ['--skip N', 'lines that are passed over before it; default: 0'],
  ['--sentinels NAME', 'points that stand for a missing measurement (-9999, many 0 0 0): drop, keep; default: drop'],
];

/** @type {Record<string, string>} */
const MARKS = { tab: '\t', blank: ' ', space: ' ', comma: ',', semicolon: ';' };

/**
 * @param {Record<string, string | undefined>} values of `parseArgs`
 * @returns {ReadSaid}
 */
export function readSaid({ columns, delimiter, decimal, skip, sentinels }) {
  const value = (/** @type {keyof ReadSaid} */ name, /** @type {string | undefined} */ text) =>
    text === undefined ? {} : { [name]: parseValue(name, TABLES.read[name], text) };
  const names = columns?.split(',').map((name) => name.trim());
  const axes = ['x', 'y', 'z'].every((axis) => names?.some((name) => name.toLowerCase() === axis));
  if (names && !axes) throw new UsageError(`--columns is '${columns}': expected names with x, y and z among them`);
  return {
    ...(names && { columns: names }),
    ...value('delimiter', delimiter && (MARKS[delimiter] ?? delimiter)),
    ...value('decimal', decimal),
    ...value('skip', skip),
    ...value('sentinels', sentinels),
  };
}
