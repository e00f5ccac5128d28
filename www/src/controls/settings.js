import { DEFAULTS } from 'pointweave';
import { FIELDS, TARGETS } from './fields-table.js';

/**
 * @import { ReconstructOptions, ReduceOptions } from 'pointweave'
 *
 * What a control looks like; what its option is by default is the package's to say.
 * @typedef {{ label: string, hint: string, in: 'reduce' | 'reconstruct' }} Common
 * @typedef {Common & { kind: 'choice', choices: Record<string, string> }} Choice
 * @typedef {Common & { kind: 'flag' }} Flag
 * @typedef {Common & Range & { kind: 'number', follows?: Record<string, number>, auto?: boolean }} Amount  `follows`: the default by method
 * @typedef {Choice | Flag | Amount} Control
 *
 * A number's slider and field. The slider's steps multiply, so that small values have as much room as large ones.
 * @typedef {object} Range
 * @property {number} low  the slider's ends
 * @property {number} high
 * @property {number} least  what the field takes
 * @property {number} most
 * @property {string} open  the ends that it does not take: '(' the lower, ')' the upper
 * @property {number} [times]  what is shown is the value times this: 100 for percentages
 * @property {string} unit  behind the field
 * @property {boolean} [whole]
 */

/** Options that have a control, by name. */
export const CONTROLS = /** @type {Record<string, Control>} */ (FIELDS);

/** Where each is found: beside the points to keep, among more settings, or with those for experts. */
export const PLACES = {
  plain: ['boundary', 'outliers'],
  more: ['orientation', 'flip', 'sharp', 'fairing', 'smoothing'],
  expert: ['method', 'fuzzifier', 'accuracy'],
};

export { TARGETS };

/** @typedef {keyof typeof TARGETS} TargetKind */
/** @typedef {{ kind: TargetKind, value: number }} Target */

/** The options that the person has chosen; what is not chosen is the package's default. */
export class Settings {
  /** Null until the person chooses: the scan decides. @type {Target | null} */
  target = null;
  /** By the names of {@link CONTROLS}. @type {Record<string, string | number | boolean>} */
  values = {};

  /** What is in force: the choice or the default. */
  get(/** @type {string} */ key) {
    return this.values[key] ?? defaultOf(key);
  }

  /** Chooses a value; undefined goes back to the default. */
  set(/** @type {string} */ key, /** @type {string | number | boolean | undefined} */ value) {
    if (value === undefined || value === defaultOf(key)) delete this.values[key];
    else this.values[key] = value;
  }

  get changed() {
    return this.target !== null || Object.keys(this.values).length > 0;
  }

  /** What was chosen, as plain data. @returns {import('../state/shown.js').Chosen} */
  get chosen() {
    return { target: this.target, values: { ...this.values } };
  }

  /** Takes what was chosen before. */
  take(/** @type {import('../state/shown.js').Chosen} */ { target, values }) {
    this.target = target;
    this.values = { ...values };
  }

  reset() {
    this.target = null;
    this.values = {};
  }

  /** @param {Target} target  what is kept @returns {{ reduce: ReduceOptions, surface: ReconstructOptions }} */
  options({ kind, value }) {
    const chosen = (/** @type {string} */ table) =>
      Object.fromEntries(Object.entries(this.values).filter(([key]) => CONTROLS[key].in === table));
    const target = /** @type {import('pointweave').Target} */ ({ [kind]: value });
    return { reduce: { target, ...chosen('reduce') }, surface: chosen('reconstruct') };
  }

  /** Takes what an address says; what makes no sense there is left out. */
  read(/** @type {URLSearchParams} */ words) {
    this.reset();
    for (const [key, word] of words) {
      if (Object.hasOwn(TARGETS, key)) this.#readTarget(/** @type {TargetKind} */ (key), Number(word));
      else if (Object.hasOwn(CONTROLS, key)) this.set(key, valueOf(CONTROLS[key], word));
    }
  }

  #readTarget(/** @type {TargetKind} */ kind, /** @type {number} */ value) {
    if (isInside(TARGETS[kind], value)) this.target = { kind, value };
  }
}

/** What was chosen, as in an address. @param {import('../state/shown.js').Chosen} chosen @returns {[string, string][]} */
export function entriesOf({ target, values }) {
  const amount = /** @type {[string, number][]} */ (target ? [[target.kind, target.value]] : []);
  return [...amount, ...Object.entries(values)].map(([key, value]) => [key, String(value)]);
}

/** The package's default; undefined where that follows from other options. */
export function defaultOf(/** @type {string} */ key) {
  const table = /** @type {Record<string, any>} */ (DEFAULTS[CONTROLS[key].in]);
  return table[key];
}

/** Whether the field takes this value. */
export function isInside(/** @type {Range} */ { least, most, open, whole }, /** @type {number} */ value) {
  const above = open.includes('(') ? value > least : value >= least;
  const below = open.includes(')') ? value < most : value <= most;
  return above && below && (!whole || Number.isInteger(value));
}

function valueOf(/** @type {Control} */ control, /** @type {string} */ word) {
  if (control.kind === 'choice') return Object.hasOwn(control.choices, word) ? word : undefined;
  if (control.kind === 'flag') return word === 'true' || word === 'false' ? word === 'true' : undefined;
  return word !== '' && isInside(control, Number(word)) ? Number(word) : undefined;
}
