import { Emitter } from './emitter.js';

/**
 * @import { Step, Unit } from 'pointweave'
 * @import { Axis } from 'pointweave/viewer'
 * @import { SampleName } from '../controls/samples.js'
 * @import { Part } from '../session/parts.js'
 * @import { Target } from '../controls/settings.js'
 *
 * Where a scan comes from: a sample, a file beside the page, or one of the person's that the browser keeps under a key.
 * Of several files as one scan, `parts` says which are shown.
 * @typedef {{ model: SampleName } | { src: string } | { key: string, columns?: string[], parts?: Part[] }} From
 * A step of the recipe that tidies a scan, which may be switched off. @typedef {Step & { off?: true }} Listed
 * What a person said of a scan or did to it: which way is up, the unit, how many times larger it is than its file says, what is cut off, and
 * triangles of its mesh whose pieces were turned over.
 * @typedef {{ up?: Axis | [number, number, number], unit?: Unit, scale?: number, recipe?: Listed[], turned?: number[] }} Edits
 * @typedef {{ target: Target | null, values: Record<string, string | number | boolean> }} Chosen
 * @typedef {{ view: string, paint: string }} Looked
 *
 * All that the page shows, as plain data. It can be kept, and shows the same again.
 * @typedef {{ scan: From | null, edits: Edits, settings: Chosen, look: Looked }} Value
 */

/** What each tab remembers of its newest step, so that it knows after a reload whether there is something to redo. */
const NEWEST = 'pointweave newest step';

/** The newest step of this tab; 0 where the browser keeps nothing for a page. */
function remembered() {
  try {
    return Number(sessionStorage.getItem(NEWEST) ?? 0);
  } catch {
    return 0;
  }
}

function remember(/** @type {number} */ step) {
  try {
    sessionStorage.setItem(NEWEST, String(step));
  } catch {
    // Without it, redo is not offered after a reload; all else works.
  }
}

/** @type {Value} */
export const NOTHING = { scan: null, edits: {}, settings: { target: null, values: {} }, look: { view: 'mesh', paint: 'natural' } };

/**
 * The one value that says what the page shows, with its history. The history is the browser's own: every step is an entry of it, so
 * that undo is Back, redo is Forward, and a reload finds all of it again.
 * @extends {Emitter<{ changed: Value, moved: Value | null }>}  `moved`: to another step, or to an address without one
 */
export class Shown extends Emitter {
  value = NOTHING;
  #step = 0;
  #newest = 0;
  #addressOf;

  /** @param {(value: Value) => string} addressOf what stands in the address bar for a value */
  constructor(addressOf) {
    super();
    this.#addressOf = addressOf;
    addEventListener('popstate', ({ state }) => {
      if (state?.value) this.#take(state);
      else this.#newest = ++this.#step;
      this.emit('moved', state?.value ?? null);
    });
  }

  /** What the browser still knows of this entry: after a reload, or when the tab comes back. @returns {Value | null} */
  recall() {
    // An entry that is new has nothing behind it.
    if (history.state?.value) this.#newest = remembered();
    this.#take(history.state);
    return history.state?.value ?? null;
  }

  /** Changes parts of the value: as a step that can be undone, or without one. @param {Partial<Value>} parts @param {{ step?: boolean }} [how] */
  change(parts, { step = true } = {}) {
    const value = { ...this.value, ...parts };
    const same = JSON.stringify(value) === JSON.stringify(this.value);
    const first = this.value.scan === null;
    this.value = value;
    // Until the first scan is there, the address says what is to be opened.
    if (value.scan) {
      const push = step && !same && !first;
      if (push) this.#newest = ++this.#step;
      history[push ? 'pushState' : 'replaceState']({ step: this.#step, value }, '', this.#addressOf(value));
      remember(this.#newest);
    }
    this.emit('changed', value);
  }

  get canUndo() {
    return this.#step > 0;
  }

  get canRedo() {
    return this.#step < this.#newest;
  }

  undo() {
    if (this.canUndo) history.back();
  }

  redo() {
    if (this.canRedo) history.forward();
  }

  #take(/** @type {{ step: number, value: Value } | null} */ state) {
    if (!state?.value) return;
    this.#step = state.step;
    this.#newest = Math.max(this.#newest, this.#step);
    this.value = state.value;
    this.emit('changed', this.value);
  }
}
