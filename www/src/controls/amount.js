import { say } from '../words/say.js';
import { isInside } from './settings.js';

/** @import { Range } from './settings.js' */

/** A person who drags rests at least this long before the job starts again. */
const PAUSE_MS = 250;
const STEPS = 1000;
/** A range that ends here or beyond has no end that a person would meet. */
const MANY = 0xffffffff;

/** A number: a slider for the feel and a field for the exact value. */
export class Amount {
  #slider;
  #field;
  #timer = 0;
  /** @type {Range} */
  #range = { low: 0.1, high: 1, least: 0.1, most: 1, open: '', unit: '' };
  #error;
  /** What holds while the field is empty; null where it may not be. @type {number | null} */
  #otherwise = null;

  /**
   * @param {HTMLInputElement} slider
   * @param {HTMLInputElement} field
   * @param {HTMLElement} error  says which numbers the field takes, when it holds another
   * @param {(value: number | undefined) => void} changing  at once, to show what it will be; undefined is the default
   * @param {(value: number | undefined) => void} settled   after a rest, to start the job
   */
  constructor(slider, field, error, changing, settled) {
    this.#slider = slider;
    this.#field = field;
    this.#error = error;
    field.setAttribute('aria-errormessage', error.id);
    const change = (/** @type {number | undefined} */ value, /** @type {number} */ pause) => {
      changing(value);
      clearTimeout(this.#timer);
      this.#timer = window.setTimeout(() => {
        this.#timer = 0;
        settled(value);
      }, pause);
    };
    slider.min = '0';
    slider.max = String(STEPS);
    slider.addEventListener('input', () => {
      const value = this.#valueAt(slider.valueAsNumber);
      field.value = this.#text(value);
      change(value, PAUSE_MS);
    });
    slider.addEventListener('change', () => change(this.#valueAt(slider.valueAsNumber), 0));
    field.addEventListener('input', () => {
      const empty = field.value === '' && !field.validity.badInput;
      if (empty && this.#otherwise !== null) {
        slider.valueAsNumber = this.#stepOf(this.#otherwise);
        this.#refuse('');
        return change(undefined, PAUSE_MS);
      }
      const value = this.#meant(field.valueAsNumber);
      const fits = isInside(this.#range, value);
      this.#refuse(fits ? '' : this.#accepted());
      if (!fits) return this.#forget();
      slider.valueAsNumber = this.#stepOf(value);
      change(value, 2 * PAUSE_MS);
    });
  }

  /**
   * What can be chosen, and what is. A change that rests is not overwritten: it comes by itself.
   * @param {Range} range
   * @param {number | undefined} value  undefined: the default
   * @param {number | null} otherwise   the default, as a number to show; null where a value has to be given
   * @param {string} [placeholder]      for the empty field
   */
  set(range, value, otherwise = null, placeholder = '') {
    if (this.#timer) return;
    this.#range = range;
    this.#otherwise = otherwise;
    this.#field.placeholder = placeholder;
    this.#refuse('');
    const text = value === undefined ? '' : this.#text(value);
    // Who types 12.50 finds it as it was typed.
    if (Number(this.#field.value) !== Number(text) || !text) this.#field.value = text;
    this.#slider.valueAsNumber = this.#stepOf(value ?? otherwise ?? range.low);
    this.describe('');
  }

  /** For the slider, in words: what the value means. */
  describe(/** @type {string} */ words) {
    const shown = this.#field.value || this.#field.placeholder;
    this.#slider.setAttribute('aria-valuetext', `${shown} ${this.#range.unit && say('per cent')} ${words}`.trim());
  }

  /** What the field takes, in words. */
  #accepted() {
    const { least, most, open, unit, whole } = this.#range;
    const ends = { least: `${this.#text(least)} ${unit}`.trim(), most: `${this.#text(most)} ${unit}`.trim() };
    if (whole) return most >= MANY ? say('This takes a whole number, {least} or more.', ends) : say('This takes a whole number from {least} to {most}.', ends);
    if (open === '()') return say('This takes a number above {least} and below {most}.', ends);
    return open === '(' ? say('This takes a number above {least}, up to {most}.', ends) : say('This takes a number from {least} to {most}.', ends);
  }

  /** Says why the number is not taken; empty where it is. */
  #refuse(/** @type {string} */ words) {
    this.#field.setCustomValidity(words);
    this.#error.textContent = words;
    this.#error.hidden = !words;
    if (words) this.#field.setAttribute('aria-invalid', 'true');
    else this.#field.removeAttribute('aria-invalid');
  }

  /** The value of a number that is shown, without the digits that binary fractions add: 33.3 % is 0.333. */
  #meant(/** @type {number} */ shown) {
    return Number((shown / (this.#range.times ?? 1)).toPrecision(12));
  }

  #forget() {
    clearTimeout(this.#timer);
    this.#timer = 0;
  }

  /** Equal steps multiply the value by an equal factor: 1 % to 2 % is as far as 30 % to 60 %. Rounded as shown. */
  #valueAt(/** @type {number} */ step) {
    const { low, high } = this.#range;
    const value = this.#meant(Number(this.#text(low * (high / low) ** (step / STEPS))));
    return Math.min(high, Math.max(low, value));
  }

  #stepOf(/** @type {number} */ value) {
    const { low, high } = this.#range;
    const inside = Math.min(high, Math.max(low, value));
    return Math.round((STEPS * Math.log(inside / low)) / Math.log(high / low));
  }

  /** Three digits, as the field shows them. */
  #text(/** @type {number} */ value) {
    const { times = 1, whole } = this.#range;
    return whole ? String(Math.round(value)) : String(Number((value * times).toPrecision(3)));
  }
}
