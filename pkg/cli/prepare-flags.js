/** What the command line says is done to a scan before anything else. */
import { readFile } from 'node:fs/promises';
import { checkRecipe } from '../engine/preparing.js';
import { UsageError } from './usage.js';

/** @import { Step } from '../types.js' */

/** How `parseArgs` is told of them. */
export const PREPARE_FLAGS = /** @type {const} */ ({
  prepare: { type: 'string' },
  crop: { type: 'string' },
  'drop-strays': { type: 'boolean' },
  'drop-floor': { type: 'boolean' },
  'drop-planes': { type: 'boolean' },
  'keep-largest': { type: 'boolean' },
});

/** Of `merge` alone. */
export const MERGE_FLAGS = /** @type {const} */ ({ register: { type: 'boolean' } });

/** @type {string[][]} */
export const MERGE_ROWS = [['--register', 'the scans lie in frames of their own: put them together first; what fits no other is left out']];

/** For the help, in the order in which they are done. */
export const PREPARE_ROWS = [
  ['--prepare FILE', 'the steps of a recipe, a JSON array as prepare of the package takes it'],
  ['--crop X0,Y0,Z0,X1,Y1,Z1', 'keep what is in a box, from its lowest to its highest corner'],
  ['--drop-strays', 'drop isolated points and flying pixels'],
  ['--drop-floor', 'drop the plane that the object stands on, with what is behind it'],
  ['--drop-planes', 'drop all planes that carry what was scanned: floors, tables, walls'],
  ['--keep-largest', 'keep the largest connected piece'],
];

/** @typedef {{ register: boolean, recipe?: string, steps: Step[] }} Preparation whether scans are registered before all else, the file of a recipe, and the steps after it */

/**
 * @param {Record<string, any>} values of `parseArgs`
 * @returns {Preparation}
 */
export function preparation(values) {
  /** @type {Step[]} */
  const steps = [];
  if (values.crop !== undefined) steps.push({ step: 'box', ...corners(values.crop) });
  if (values['drop-strays']) steps.push({ step: 'outliers' }, { step: 'flying' });
  if (values['drop-planes']) steps.push({ step: 'plane', drop: 'all' });
  if (values['drop-floor']) steps.push({ step: 'plane', drop: 'floor' });
  if (values['keep-largest']) steps.push({ step: 'pieces', keep: 'largest' });
  return { register: Boolean(values.register), recipe: values.prepare, steps };
}

/** Whether there is anything to do. @param {Preparation} preparation */
export const isEmpty = ({ recipe, steps }) => recipe === undefined && steps.length === 0;

/** All steps. @param {Preparation} preparation @returns {Promise<Step[]>} */
export async function stepsOf({ register, recipe, steps }) {
  /** @type {Step[]} */
  const first = register ? [{ step: 'register' }] : [];
  return [...first, ...(recipe === undefined ? [] : await recipeOf(recipe)), ...steps];
}

/** @param {string} file */
async function recipeOf(file) {
  let text;
  try {
    text = await readFile(file, 'utf8');
  } catch (error) {
    throw new UsageError(`--prepare '${file}' cannot be read: ${error instanceof Error ? error.message : error}`);
  }
  try {
    return checkRecipe(JSON.parse(text));
  } catch (error) {
    throw new UsageError(`--prepare '${file}' is no recipe: ${error instanceof Error ? error.message : error}`);
  }
}

/** @param {string} text @returns {{ min: [number, number, number], max: [number, number, number] }} */
function corners(text) {
  const numbers = text.split(',').map((word) => (word.trim() === '' ? NaN : Number(word)));
  const [a, b, c, d, e, f] = numbers;
  if (numbers.length !== 6 || !numbers.every(Number.isFinite) || a > d || b > e || c > f) {
    throw new UsageError(`--crop is '${text}': expected six numbers X0,Y0,Z0,X1,Y1,Z1, the lowest corner first`);
  }
  return { min: [a, b, c], max: [d, e, f] };
}
