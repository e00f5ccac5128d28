import { byId } from './dom.js';

/** A person who drags rests at least this long before the job starts again. */
const PAUSE_MS = 250;
/** The slider's ends: 0.5 % to 100 %, in equal steps of the ratio. */
const LEAST = 0.005;
const STEPS = 1000;

/** The share of the points to keep: a slider for the feel and a field for the exact value. */
export class KeepControl {
  #slider = byId('keep-slider', HTMLInputElement);
  #field = byId('keep-field', HTMLInputElement);
  #count = byId('keep-count', HTMLOutputElement);
  #timer = 0;

  /**
   * @param {(share: number) => void} changing  at once, to show what it will be
   * @param {(share: number) => void} settled   after a rest, to start the job
   */
  constructor(changing, settled) {
    const change = (/** @type {number} */ share, /** @type {number} */ pause) => {
      changing(share);
      clearTimeout(this.#timer);
      this.#timer = window.setTimeout(() => settled(share), pause);
    };
    this.#slider.addEventListener('input', () => {
      const share = shareAt(this.#slider.valueAsNumber);
      this.#field.value = fieldText(share);
      change(share, PAUSE_MS);
    });
    this.#slider.addEventListener('change', () => change(shareAt(this.#slider.valueAsNumber), 0));
    this.#field.addEventListener('input', () => {
      const percent = this.#field.valueAsNumber;
      if (!this.#field.checkValidity() || Number.isNaN(percent)) return;
      this.#slider.valueAsNumber = stepOf(percent / 100);
      change(percent / 100, 2 * PAUSE_MS);
    });
  }

  set(/** @type {number} */ share) {
    clearTimeout(this.#timer);
    this.#field.value = fieldText(share);
    this.#slider.valueAsNumber = stepOf(share);
  }

  /** The line below: what the share means for this scan. */
  describe(/** @type {string} */ words) {
    this.#count.textContent = words;
    this.#slider.setAttribute('aria-valuetext', `${this.#field.value} per cent. ${words}`);
  }
}

/** Equal steps multiply the share by an equal factor: 1 % to 2 % is as far as 30 % to 60 %. Rounded as shown. */
function shareAt(/** @type {number} */ step) {
  return Number(fieldText(LEAST ** (1 - step / STEPS))) / 100;
}

function stepOf(/** @type {number} */ share) {
  return Math.round(STEPS * (1 - Math.log(Math.max(share, LEAST)) / Math.log(LEAST)));
}

function fieldText(/** @type {number} */ share) {
  const percent = 100 * share;
  return percent.toFixed(percent < 10 ? 2 : 1).replace(/\.?0+$/, '');
}
