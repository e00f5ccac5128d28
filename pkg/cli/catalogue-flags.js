/** What the command line says of a catalogue. */
import { integer } from '../engine/rules.js';
import { parseValue } from './flags.js';
import { UsageError } from './usage.js';

/** How `parseArgs` is told of them. */
export const CATALOGUE_FLAGS = /** @type {const} */ ({ jobs: { type: 'string' }, title: { type: 'string' } });

/** For the help. */
export const CATALOGUE_ROWS = [
  ['-o, --out FOLDER', 'where the site goes; what is there already and did not change stays'],
  ['--jobs N', 'scans at a time, 1 to 64; each takes its share of the threads, and memory of its own; default: 1'],
  ['--title TEXT', "the page's; default: Catalogue"],
];

/** @typedef {{ sources: string[], site: string, jobs: number, title: string }} CatalogueSaid */

/**
 * @param {Record<string, any>} values of `parseArgs`
 * @param {string[]} sources folders and files
 * @returns {CatalogueSaid}
 */
export function catalogueSaid({ out, jobs, title = 'Catalogue' }, sources) {
  if (out === undefined) throw new UsageError('where should the site go? -o FOLDER');
  if (out === '-' || sources.includes('-')) throw new UsageError('a catalogue is made of files, into a folder');
  return { sources, site: out, jobs: jobs === undefined ? 1 : /** @type {number} */ (parseValue('jobs', integer(1, 64), jobs)), title };
}
