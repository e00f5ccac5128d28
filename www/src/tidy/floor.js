import { element } from '../dom.js';
import { page } from '../page.js';
import * as format from '../results/format.js';
import { say } from '../words/say.js';
import { among } from './bench.js';
import { rounded } from './recipe.js';

/** @import { PlaneReport, Step } from 'pointweave' */
/** @import { Bench, Fill } from './bench.js' */

/** The slider's end: a share of the diagonal above the plane. */
const HIGHEST = 0.1;

/** Removes the floor, or other planes that a person chooses, and what is close above it. */
export class Floor {
  #bench;
  #box = page.tidyFloor;
  #list = page.tidyPlanes;
  #height = page.tidyHeight;
  #row = page.tidyHeightRow;
  /** @type {PlaneReport[]} */
  #planes = [];
  /** Of a point that is shown. @type {(point: number) => number} */
  #planeOf = () => 0;
  /** What goes with the floor. @type {Fill} */
  #floor = () => {};
  /** Numbers of planes. @type {Set<number>} */
  #chosen = new Set();

  constructor(/** @type {Bench} */ bench) {
    this.#bench = bench;
    this.#height.addEventListener('input', () => this.#show());
    this.#list.addEventListener('change', ({ target }) => {
      const { value, checked } = /** @type {HTMLInputElement} */ (target);
      if (checked) this.#chosen.add(Number(value));
      else this.#chosen.delete(Number(value));
      this.#show();
    });
  }

  async begin() {
    this.#height.value = '0';
    const trial = await this.#bench.try([{ step: 'plane', drop: 'floor' }]);
    const report = trial?.reports[0];
    if (!trial || !report) return;
    this.#planes = report.planes ?? [];
    const [{ labels = new Uint32Array() }, { indexOf }] = [report, this.#bench];
    this.#planeOf = (point) => labels[indexOf(point)];
    this.#floor = trial.gone;
    this.#chosen = new Set(this.#planes.flatMap(({ dropped }, i) => (dropped ? [i] : [])));
    this.#list.replaceChildren(...this.#planes.map((plane, i) => this.#option(plane, i)));
    this.#box.hidden = this.#planes.length === 0;
    this.#row.hidden = this.#planes.length === 0;
    this.#show();
  }

  end() {
    this.#box.hidden = this.#row.hidden = true;
  }

  /** @returns {Step[]} */
  steps() {
    const numbers = [...this.#chosen].sort((a, b) => a - b);
    /** @type {Step} */
    const plane = this.#isFloor ? { step: 'plane', drop: 'floor' } : { step: 'plane', drop: numbers };
    const cut = this.#cut;
    return cut ? [plane, { step: 'half-space', ...cut }] : [plane];
  }

  /** What the package takes for the floor is chosen, and nothing else. */
  get #isFloor() {
    return this.#chosen.size > 0 && this.#planes.every(({ floor }, i) => floor === this.#chosen.has(i));
  }

  /** Where what is close above the plane ends. @returns {{ point: [number, number, number], normal: [number, number, number] } | null} */
  get #cut() {
    const plane = this.#planes[Math.min(...this.#chosen)];
    if (!plane || !this.#above) return null;
    const triple = (/** @type {(k: number) => number} */ value) => /** @type {[number, number, number]} */ ([0, 1, 2].map((k) => rounded(value(k))));
    return { point: triple((k) => plane.point[k] + this.#above * plane.normal[k]), normal: triple((k) => plane.normal[k]) };
  }

  /** A height in the scan's unit; the slider is finer near the plane. */
  get #above() {
    return HIGHEST * (this.#height.valueAsNumber / 100) ** 2 * this.#bench.scan.frame.diagonal;
  }

  async #show() {
    const planes = this.#isFloor ? this.#floor : among(this.#planeOf, this.#chosen, this.#planes.length);
    const cut = this.#cut;
    const { cloud: { positions, unit }, count } = this.#bench.scan;
    this.#height.setAttribute('aria-valuetext', `${format.length(this.#above)} ${unit ?? ''}`.trim());
    const going = await this.#bench.show((mask, from, to) => {
      planes(mask, from, to);
      if (!cut) return;
      const { point, normal: [x, y, z] } = cut;
      for (let i = from; i < to; i++) {
        if (x * (positions[3 * i] - point[0]) + y * (positions[3 * i + 1] - point[1]) + z * (positions[3 * i + 2] - point[2]) < 0) mask[i] = 1;
      }
    });
    if (going === null) return;
    if (!this.#planes.length) this.#bench.say(say('There is no large flat plane in this scan.'), false);
    else if (!going) this.#bench.say(say('No plane carries the rest, so none is taken for the floor. Choose one from the list if you know better.'), false);
    else if (going === count) this.#bench.say(say('Nothing would be left.'), false);
    else this.#bench.say(say('{share} of the points would go.', { share: format.percent(going / count) }), true);
  }

  #option(/** @type {PlaneReport} */ { share, floor }, /** @type {number} */ i) {
    const label = element('label', { className: 'check' });
    const name = floor ? say('Floor') : say('Plane {number}', { number: i + 1 });
    label.append(element('input', { type: 'checkbox', value: String(i), checked: this.#chosen.has(i) }),
      element('span', { textContent: name }), element('span', { className: 'detail', textContent: format.percent(share) }));
    const row = element('li');
    row.append(label);
    return row;
  }
}
