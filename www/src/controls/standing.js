import { announce, element } from '../dom.js';
import { page } from '../page.js';
import * as format from '../results/format.js';
import { say } from '../words/say.js';

/** @import { Axis } from 'pointweave/viewer' */
/** @import { Unit } from 'pointweave' */

/** What is kept with a scan: the axis that is up or the direction, the unit, and the size. @typedef {{ up?: Axis | [number, number, number], unit?: Unit, scale?: number }} Stand */

const SIDES = /** @type {Record<Axis, string>} */ ({ z: 'Z', y: 'Y', x: 'X', '-z': '−Z', '-y': '−Y', '-x': '−X' });
export const UNITS = { mm: 'millimetres', cm: 'centimetres', m: 'metres', in: 'inches', ft: 'feet', 'us-ft': 'US survey feet', deg: 'degrees' };
/** Of a direction between the axes. */
const PICKED = 'picked';
/** Those that a person chooses from; a file may say others. */
const CHOICES = /** @type {const} */ (['mm', 'cm', 'm', 'in', 'ft']);

/** Says in words which way is up and what a coordinate is, and lets a person say it better. */
export class Standing {
  #words = page.standWords;
  #side = page.standUp;
  #unit = page.standUnit;
  #pick = page.standPick;
  #stale = page.standStale;
  #scale = page.scaleNote;
  #ask;

  /**
   * @param {(stand: Stand) => void} changed what a person chose
   * @param {(chosen: import('../look/piece.js').Chosen | null) => void} ask has the person choose a place of the mesh; null: no more
   */
  constructor(changed, ask) {
    this.#ask = ask;
    this.#pick.addEventListener('click', () => {
      if (this.picking) return this.stop();
      this.#pick.ariaPressed = 'true';
      announce(say('Click the floor, or the side that is up, in the picture'));
      ask((_, normal) => {
        this.stop();
        changed({ up: normal });
        announce(this.#words.textContent ?? '');
      });
    });
    this.#side.append(...Object.entries(SIDES).map(([value, textContent]) => element('option', { value, textContent })));
    this.#side.addEventListener('change', () => {
      changed({ up: /** @type {Axis} */ (this.#side.value) });
      announce(this.#words.textContent ?? '');
    });
    page.scaleReset.addEventListener('click', () => changed({ scale: undefined }));
    this.#unit.addEventListener('change', () => {
      changed({ unit: /** @type {Unit} */ (this.#unit.value) });
      announce(this.#words.textContent ?? '');
    });
  }

  /** A side is to be picked in the picture. */
  get picking() {
    return this.#pick.ariaPressed === 'true';
  }

  /** No side is to be picked any more. */
  stop() {
    if (!this.picking) return;
    this.#pick.ariaPressed = 'false';
    this.#ask(null);
  }

  /**
   * @param {{ up: Axis, unit?: Unit, scale: number }} stand as the scan is shown
   * @param {{ picked: boolean, mesh: boolean, stale: boolean }} how whether a plane was picked, there is a mesh to pick on, and the result was
   *   made when another side was up
   */
  show({ up, unit, scale }, { picked, mesh, stale }) {
    this.#scale.hidden = scale === 1;
    page.scaleWords.textContent = say('Everything is shown and saved {factor} as large as the file says.', { factor: format.times(scale) });
    this.#stale.hidden = !stale;
    this.#pick.hidden = !mesh;
    if (!mesh) this.stop();
    this.#side.querySelector(`[value=${PICKED}]`)?.remove();
    if (picked) this.#side.append(element('option', { value: PICKED, textContent: say('the side that was picked') }));
    this.#words.textContent = say('{side} is up, lengths in {unit}', { side: picked ? say('The picked side') : SIDES[up], unit: say(unit ? UNITS[unit] : 'file units') });
    const known = unit && !CHOICES.some((name) => name === unit) ? [unit] : [];
    const options = [...CHOICES, ...known].map((value) => element('option', { value, textContent: say(UNITS[value]) }));
    this.#unit.replaceChildren(...(unit ? [] : [element('option', { value: '', textContent: say('not known'), disabled: true })]), ...options);
    this.#side.value = picked ? PICKED : up;
    this.#unit.value = unit ?? '';
  }
}
