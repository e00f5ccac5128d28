import { page } from '../page.js';
import * as format from '../results/format.js';
import { say } from '../words/say.js';
import { cornersOf, coveredBy, insideOf, joinedShape, simplified, without } from './shapes.js';
import { rounded } from './recipe.js';
import { tinted } from './tint.js';

/** @import { Step } from 'pointweave' */
/** @import { Bench } from './bench.js' */
/** @import { Corner, Shape } from './shapes.js' */

/** Corners of a lasso are at least so far apart, in CSS pixels. */
const APART = 4;
/** `turn`: the picture is turned, and nothing is drawn. @typedef {'new' | 'add' | 'less' | 'turn'} Mode */

/** Selects what is inside of a shape that is drawn over the picture. One for the lasso, one for the rectangle. */
export class Select {
  #bench;
  #kind;
  #over = page.tidyDraw;
  #box = page.tidySelect;
  #modes = page.tidyModes;
  #sides = /** @type {HTMLInputElement[]} */ ([...document.querySelectorAll('[data-select]')]);
  #outline;
  /** What is selected: x from -1 at the left to 1, y from -1 at the bottom. @type {Shape} */
  #shape = [];
  /** What is being drawn, in CSS pixels. @type {Corner[]} */
  #line = [];
  /** The camera that the shape is of. @type {number[]} */
  #camera = [];
  #on = false;
  #draw = () => this.#follow();

  /** @param {Bench} bench @param {'lasso' | 'rectangle'} kind */
  constructor(bench, kind) {
    this.#bench = bench;
    this.#kind = kind;
    this.#outline = /** @type {SVGPathElement} */ (this.#over.querySelector('path'));
    this.#over.addEventListener('pointerdown', (event) => this.#on && event.button === 0 && this.#start(event));
    this.#over.addEventListener('pointermove', (event) => this.#on && this.#over.hasPointerCapture(event.pointerId) && this.#go(event));
    this.#over.addEventListener('pointerup', (event) => this.#on && this.#over.hasPointerCapture(event.pointerId) && this.#finish(event));
    this.#modes.addEventListener('change', () => this.#on && this.#let());
    for (const input of this.#sides) input.addEventListener('input', () => this.#on && this.#typed());
  }

  begin() {
    this.#on = true;
    this.#box.hidden = this.#modes.hidden = false;
    this.#mode = 'new';
    this.#shape = [];
    this.#let();
    this.#bench.aim?.addEventListener('draw', this.#draw);
    this.#show();
  }

  end() {
    this.#on = false;
    this.#box.hidden = this.#modes.hidden = this.#over.hidden = true;
    this.#bench.aim?.removeEventListener('draw', this.#draw);
  }

  /** @returns {Step[]} */
  steps(/** @type {boolean} */ cut) {
    const points = cornersOf(this.#shape).flat().map((value) => rounded(value, 5));
    return [{ step: 'polygon', points, camera: this.#camera, ...(cut && { keep: false }) }];
  }

  get #mode() {
    return /** @type {Mode} */ (/** @type {HTMLInputElement} */ (this.#modes.querySelector(':checked')).value);
  }

  set #mode(mode) {
    /** @type {HTMLInputElement} */ (this.#modes.querySelector(`[value="${mode}"]`)).checked = true;
  }

  /** Draws, or lets the picture be turned. */
  #let() {
    this.#over.hidden = this.#mode === 'turn' || !this.#bench.aim;
  }

  #start(/** @type {PointerEvent} */ event) {
    this.#over.setPointerCapture(event.pointerId);
    this.#line = [[event.offsetX, event.offsetY]];
  }

  #go(/** @type {PointerEvent} */ { offsetX, offsetY }) {
    const [first] = this.#line;
    const last = this.#line[this.#line.length - 1];
    if (this.#kind === 'rectangle') this.#line = [first, [offsetX, first[1]], [offsetX, offsetY], [first[0], offsetY]];
    else if (Math.hypot(offsetX - last[0], offsetY - last[1]) >= APART) this.#line.push([offsetX, offsetY]);
    this.#trace();
  }

  async #finish(/** @type {PointerEvent} */ { pointerId, shiftKey, altKey }) {
    this.#over.releasePointerCapture(pointerId);
    const line = this.#kind === 'lasso' ? simplified(this.#line) : this.#line;
    this.#line = [];
    const mode = shiftKey ? 'add' : altKey ? 'less' : this.#mode;
    if (line.length > 2) await this.#take(line.map(([x, y]) => this.#placed(x, y)), mode);
    this.#trace();
  }

  /** A shape was drawn. @param {Corner[]} ring @param {Mode} mode */
  async #take(ring, mode) {
    const drawn = [ring];
    if (mode === 'new' || !this.#shape.length) this.#shape = mode === 'less' ? [] : drawn;
    else this.#shape = await (mode === 'add' ? joinedShape : without)(this.#shape, drawn);
    this.#camera = this.#sight;
    this.#show();
  }

  /** Sides of a rectangle were typed, in per cent of the picture. */
  #typed() {
    const [left, top, right, bottom] = this.#sides.map(({ valueAsNumber }) => valueAsNumber / 50 - 1);
    if (!(left < right) || !(top < bottom)) return;
    this.#take([[left, -top], [right, -top], [right, -bottom], [left, -bottom]], 'new').then(() => this.#trace());
  }

  /** The picture has moved: what was drawn over it is of another. */
  #follow() {
    if (!this.#shape.length || String(this.#sight) === String(this.#camera)) return;
    this.#shape = [];
    this.#trace();
    this.#show();
  }

  get #sight() {
    return this.#bench.aim?.sight(this.#bench.scan.cloud.origin).map((value) => rounded(value, 9)) ?? [];
  }

  #placed(/** @type {number} */ x, /** @type {number} */ y) {
    const { clientWidth, clientHeight } = this.#over;
    return /** @type {Corner} */ ([(2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight]);
  }

  /** The outline of what is selected, and of what is being drawn. */
  #trace() {
    const { clientWidth, clientHeight } = page.canvas;
    const rings = this.#shape.map((ring) => ring.map(([x, y]) => [((x + 1) * clientWidth) / 2, ((1 - y) * clientHeight) / 2]));
    this.#outline.setAttribute('d', [...rings, this.#line].filter(({ length }) => length > 1).map((ring) => `M${ring.map((corner) => corner.map((value) => value.toFixed(1)).join(' ')).join('L')}Z`).join(''));
  }

  async #show() {
    const { cloud, count: all } = this.#bench.scan;
    if (!this.#shape.length) {
      this.#bench.show(() => {});
      const how = this.#kind === 'lasso' ? say('Draw around points in the picture.') : say('Drag over points in the picture.');
      return this.#bench.say(matchMedia('(hover: none)').matches ? how : `${how} ${say('Shift adds to the selection, Alt takes away.')}`, false);
    }
    const count = await this.#bench.show(insideOf(cloud.positions, coveredBy(this.#shape), this.#camera), tinted(cloud, 'chosen'));
    if (count === null) return;
    this.#bench.say(say('{points} selected, with what lies behind.', { points: format.points(count) }), count > 0 && count < all);
  }
}
