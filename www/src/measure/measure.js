import { element } from '../dom.js';
import { page } from '../page.js';
import { Still } from '../look/still.js';
import { UNITS } from '../controls/standing.js';
import * as format from '../results/format.js';
import { say } from '../words/say.js';
import { angleAt, distance } from './lengths.js';

/**
 * @import { Unit } from 'pointweave'
 * @import { Look } from '../look/look.js'
 * @import { Triple } from './lengths.js'
 * How large the scan is: times what its file says, in which unit. @typedef {{ scale: number, unit?: Unit }} Size
 */

/** What a person measures in. */
const CHOICES = /** @type {const} */ (['mm', 'cm', 'm', 'in', 'ft']);
/** A number of digits that nobody measures beyond. */
const DIGITS = 9;
const MARGIN = 24;

/** Two places in the picture give a length, three an angle; and who knows the length says it, which says how large all of it is. */
export class Measure {
  #look;
  #changed;
  #began;
  #root = page.app;
  #button = page.measure;
  #bar = page.measureBar;
  #words = page.measureWords;
  #over = page.measureOver;
  #line = /** @type {SVGPathElement} */ (this.#over.querySelector('path'));
  #real = page.measureReal;
  #length = page.measureLength;
  #unit = page.measureUnit;
  #set = page.measureSet;
  #click;
  /** In the coordinates of the file. @type {Triple[]} */
  #places = [];
  /** @type {Size} */
  #size = { scale: 1 };
  #draw = () => this.#place();

  /** @param {Look} look @param {(size: { scale: number, unit: Unit }) => void} changed @param {() => void} began */
  constructor(look, changed, began) {
    this.#look = look;
    this.#changed = changed;
    this.#began = began;
    this.#click = new Still(page.canvas, (x, y) => this.#clicked(x, y), () => look.aim?.insets ?? { left: 0, right: 0 });
    this.#unit.append(...CHOICES.map((value) => element('option', { value, textContent: value, title: say(UNITS[value]) })));
    this.#button.addEventListener('click', () => this.toggle());
    page.measureClose.addEventListener('click', () => this.stop());
    this.#length.addEventListener('input', () => (this.#set.disabled = !(this.#length.valueAsNumber > 0)));
    this.#length.addEventListener('keydown', ({ key }) => key === 'Enter' && !this.#set.disabled && this.#correct());
    this.#set.addEventListener('click', () => this.#correct());
  }

  get open() {
    return !this.#bar.hidden;
  }

  toggle() {
    if (this.open) return this.stop();
    const { aim } = this.#look;
    if (!aim) return;
    this.#began();
    this.#root.dataset.measure = '';
    this.#button.ariaPressed = 'true';
    this.#bar.hidden = this.#over.hidden = false;
    this.#click.listen(true);
    aim.addEventListener('draw', this.#draw);
    this.#places = [];
    this.#show();
    this.#look.leave(this.#bar.offsetHeight + MARGIN);
    page.canvas.focus({ preventScroll: true });
    page.stage.scrollIntoView({ block: 'nearest' });
  }

  stop() {
    if (!this.open) return;
    if (this.#bar.contains(document.activeElement)) this.#button.focus({ preventScroll: true });
    delete this.#root.dataset.measure;
    this.#button.ariaPressed = 'false';
    this.#bar.hidden = this.#over.hidden = true;
    this.#click.listen(false);
    this.#look.aim?.removeEventListener('draw', this.#draw);
    this.#look.leave();
  }

  /** How large the scan is now. */
  set size(/** @type {Size} */ size) {
    this.#size = size;
    if (this.open) this.#show();
  }

  /** The first of a new length, or one more place. @param {number} x @param {number} y */
  #clicked(x, y) {
    const place = this.#look.placeAt(x, y);
    if (!place) {
      this.#words.textContent = say('There is nothing at this place.');
      return;
    }
    this.#places = this.#places.length < 3 ? [...this.#places, place] : [place];
    this.#show();
  }

  #show() {
    const { scale, unit } = this.#size;
    const [a, b, c] = this.#places;
    this.#real.hidden = this.#places.length !== 2;
    const long = a && b ? `${format.length(scale * distance(a, b))} ${unit ?? ''}`.trim() : '';
    if (!a) this.#words.textContent = say('Click two places for a length, a third one for an angle.');
    else if (!b) this.#words.textContent = say('Click a second place.');
    else if (!c) this.#words.textContent = say('Length: {length}', { length: long });
    else this.#words.textContent = say('Angle at the second place: {angle}°', { angle: format.length(angleAt(a, b, c)) });
    this.#unit.value = CHOICES.find((name) => name === unit) ?? 'mm';
    this.#length.placeholder = a && b ? format.length(scale * distance(a, b)) : '';
    this.#length.value = '';
    this.#set.disabled = true;
    this.#place();
  }

  /** The length is really what was typed: so all of it is larger or smaller than its file says. */
  #correct() {
    const [a, b] = this.#places;
    const real = this.#length.valueAsNumber;
    const now = distance(a, b);
    if (!(real > 0) || !(now > 0)) return;
    this.#changed({ scale: Number((real / now).toPrecision(DIGITS)), unit: /** @type {Unit} */ (this.#unit.value) });
  }

  /** Puts the places and the lines between them where they are in the picture. */
  #place() {
    const { aim } = this.#look;
    const seen = aim ? this.#places.map((place) => aim.project(place)) : [];
    const dots = seen.map(({ x, y }) => `M${x.toFixed(1)} ${y.toFixed(1)}m-5 0a5 5 0 1 0 10 0a5 5 0 1 0 -10 0`);
    const lines = seen.slice(1).map(({ x, y }, i) => `M${seen[i].x.toFixed(1)} ${seen[i].y.toFixed(1)}L${x.toFixed(1)} ${y.toFixed(1)}`);
    this.#line.setAttribute('d', [...dots, ...lines].join(''));
  }
}
