import { announce, byId, element } from '../dom.js';

/** @import { Axis } from 'pointweave/viewer' */
/** @import { Unit } from 'pointweave' */

/** What is kept with a scan. @typedef {{ up?: Axis, unit?: Unit }} Stand */

const SIDES = /** @type {Record<Axis, string>} */ ({ z: 'Z', y: 'Y', x: 'X', '-z': '−Z', '-y': '−Y', '-x': '−X' });
const UNITS = { mm: 'millimetres', cm: 'centimetres', m: 'metres', in: 'inches', ft: 'feet', 'us-ft': 'US survey feet', deg: 'degrees' };
/** Those that a person chooses from; a file may say others. */
const CHOICES = /** @type {const} */ (['mm', 'cm', 'm', 'in', 'ft']);

/** Says in words which way is up and what a coordinate is, and lets a person say it better. */
export class Standing {
  #words = byId('stand-words', HTMLElement);
  #side = byId('stand-up', HTMLSelectElement);
  #unit = byId('stand-unit', HTMLSelectElement);

  /** @param {(stand: Stand) => void} changed what a person chose */
  constructor(changed) {
    this.#side.append(...Object.entries(SIDES).map(([value, textContent]) => element('option', { value, textContent })));
    this.#side.addEventListener('change', () => {
      changed({ up: /** @type {Axis} */ (this.#side.value) });
      announce(this.#words.textContent ?? '');
    });
    this.#unit.addEventListener('change', () => {
      changed({ unit: /** @type {Unit} */ (this.#unit.value) });
      announce(this.#words.textContent ?? '');
    });
  }

  /** @param {{ up: Axis, unit?: Unit }} stand as the scan is shown */
  show({ up, unit }) {
    this.#words.textContent = `${SIDES[up]} is up, lengths in ${unit ? UNITS[unit] : 'file units'}`;
    const known = unit && !CHOICES.some((name) => name === unit) ? [unit] : [];
    const options = [...CHOICES, ...known].map((value) => element('option', { value, textContent: UNITS[value] }));
    this.#unit.replaceChildren(...(unit ? [] : [element('option', { value: '', textContent: 'not known', disabled: true })]), ...options);
    this.#side.value = up;
    this.#unit.value = unit ?? '';
  }
}
