import { DEFAULTS } from 'pointweave';

/**
 * @import { ReconstructOptions, ReduceOptions } from 'pointweave'
 *
 * What a control looks like; what its option is by default is the package's to say.
 * @typedef {{ label: string, hint: string, in: 'reduce' | 'reconstruct' }} Common
 * @typedef {Common & { kind: 'choice', choices: Record<string, string> }} Choice
 * @typedef {Common & { kind: 'flag' }} Flag
 * @typedef {Common & Range & { kind: 'number', follows?: (settings: Settings) => number, auto?: boolean }} Amount
 * @typedef {Choice | Flag | Amount} Control
 *
 * A number's slider and field. The slider's steps multiply, so that small values have as much room as large ones.
 * @typedef {object} Range
 * @property {number} low  the slider's ends
 * @property {number} high
 * @property {number} [least]  what the field takes, where that is more
 * @property {number} [most]
 * @property {number} [times]  what is shown is the value times this: 100 for percentages
 * @property {string} unit  behind the field
 * @property {boolean} [whole]
 */

/** Options that have a control, by their name in the package's table of defaults. */
export const CONTROLS = /** @type {Record<string, Control>} */ ({
  method: {
    in: 'reduce', kind: 'choice', label: 'Method', choices: { adaptive: 'Adaptive', paper: 'As in the paper' },
    hint: 'Adaptive keeps more points where the surface bends. The other is fuzzy c-means to the letter.',
  },
  fuzzifier: {
    in: 'reduce', kind: 'number', label: 'Fuzzifier m', low: 1.05, high: 4, least: 1.001, most: 100, unit: '',
    follows: ({ values }) => (values.method === 'paper' ? 2 : 1.5),
    hint: 'How softly points belong to more than one cluster.',
  },
  accuracy: {
    in: 'reconstruct', kind: 'number', label: 'Accuracy of the fit', low: 5e-5, high: 5e-3, least: 1e-6, most: 0.5, times: 100, unit: '%',
    hint: 'Patches are divided until they are this close to the points, in per cent of the diagonal.',
  },
  smoothing: {
    in: 'reconstruct', kind: 'number', label: 'Smoothing', low: 1e-4, high: 10, least: 0, most: 1e6, unit: '', auto: true,
    hint: 'Left empty, it follows the noise that was measured.',
  },
  sharp: { in: 'reconstruct', kind: 'flag', label: 'Keep creases sharp', hint: 'Edges and corners stay; without it they are rounded.' },
  boundary: {
    in: 'reconstruct', kind: 'choice', label: 'Holes', choices: { auto: 'Close small ones', closed: 'Close all', open: 'Leave open' },
    hint: 'What happens where nothing was scanned.',
  },
});

/** The ways to say how much is kept; `start` is where a change to it begins. */
export const TARGETS = {
  ratio: { label: 'Share of the points', low: 0.005, high: 1, least: 0.001, most: 1, times: 100, unit: '%', start: /** @type {{ ratio: number }} */ (DEFAULTS.reduce.target).ratio },
  count: { label: 'Number of points', low: 64, high: 1e6, least: 1, most: 1e8, unit: '', whole: true, start: 10_000 },
  tolerance: { label: 'Tolerance', low: 1e-4, high: 0.02, least: 1e-6, most: 0.5, times: 100, unit: '%', start: 1e-3 },
  flatness: { label: 'Flatness λ', low: 1e-5, high: 0.01, least: 1e-9, most: 1, unit: '', start: 6e-4 },
};

/** @typedef {keyof typeof TARGETS} TargetKind */
/** @typedef {{ kind: TargetKind, value: number }} Target */

for (const [key, { in: table }] of Object.entries(CONTROLS)) {
  if (!(key in DEFAULTS[table])) throw new Error(`the package has no option ${table}.${key}`);
}

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

  /** As in an address: only what was chosen. @returns {[string, string][]} */
  entries() {
    const target = /** @type {[string, number][]} */ (this.target ? [[this.target.kind, this.target.value]] : []);
    return [...target, ...Object.entries(this.values)].map(([key, value]) => [key, String(value)]);
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

/** The package's default; undefined where that follows from other options. */
export function defaultOf(/** @type {string} */ key) {
  const table = /** @type {Record<string, any>} */ (DEFAULTS[CONTROLS[key].in]);
  return table[key];
}

/** Whether the field takes this value. */
export function isInside(/** @type {Range} */ { low, high, least = low, most = high, whole }, /** @type {number} */ value) {
  return value >= least && value <= most && (!whole || Number.isInteger(value));
}

function valueOf(/** @type {Control} */ control, /** @type {string} */ word) {
  if (control.kind === 'choice') return Object.hasOwn(control.choices, word) ? word : undefined;
  if (control.kind === 'flag') return word === 'true' || word === 'false' ? word === 'true' : undefined;
  return word !== '' && isInside(control, Number(word)) ? Number(word) : undefined;
}
