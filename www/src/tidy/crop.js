import { element } from '../dom.js';
import { page } from '../page.js';
import * as format from '../results/format.js';
import { say } from '../words/say.js';
import { rounded } from './recipe.js';
import { axesOf, outside, placeIn, quaternionOf, withFace } from './turning.js';

/** @import { Step } from 'pointweave' */
/** @import { Bench } from './bench.js' */
/** @import { Box, Triple } from './turning.js' */

const AXES = ['x', 'y', 'z'];
/** A key moves a face by this share of the scan's diagonal, with Shift by ten times that. */
const KEY = 0.005;
/** Corners whose numbers differ in one bit are joined by an edge. */
const EDGES = [0, 1, 2].flatMap((axis) => Array.from({ length: 8 }, (_, corner) => [corner, corner | (1 << axis)]).filter(([a, b]) => a !== b));
/** Along an axis, which of the two faces. @typedef {{ axis: number, side: 1 | -1, handle: HTMLButtonElement }} Face */

/** Keeps, or deletes, what is inside of a box, whose faces are dragged in the picture, or set by numbers. */
export class Crop {
  #bench;
  #box = page.tidyCrop;
  #over = page.tidyBox;
  #lines;
  /** @type {Box} */
  #now = { center: [0, 0, 0], half: [1, 1, 1], turn: [0, 0, 0] };
  /** @type {Face[]} */
  #faces;
  #ends = /** @type {HTMLInputElement[]} */ ([...document.querySelectorAll('[data-crop]')]);
  #turns = /** @type {HTMLInputElement[]} */ ([...document.querySelectorAll('[data-crop-turn]')]);
  #draw = () => this.#place();

  constructor(/** @type {Bench} */ bench) {
    this.#bench = bench;
    this.#lines = /** @type {SVGPathElement} */ (this.#over.querySelector('path'));
    this.#faces = [0, 1, 2].flatMap((axis) => /** @type {const} */ ([-1, 1]).map((side) => this.#face(axis, side)));
    for (const input of this.#ends) input.addEventListener('input', () => this.#typed());
    for (const input of this.#turns) input.addEventListener('input', () => this.#typed());
  }

  begin() {
    const { frame, cloud: { origin = [0, 0, 0] } } = this.#bench.scan;
    const center = /** @type {Triple} */ (frame.center.map((value, k) => value - origin[k]));
    // A little larger than the scan, so that no point is on a face.
    const half = /** @type {Triple} */ (frame.size.map((size) => size / 2 + 0.002 * frame.diagonal));
    this.#now = { center, half, turn: [0, 0, 0] };
    this.#box.hidden = false;
    this.#over.hidden = !this.#bench.aim;
    this.#bench.aim?.addEventListener('draw', this.#draw);
    this.#fill();
    this.#show();
  }

  end() {
    this.#box.hidden = this.#over.hidden = true;
    this.#bench.aim?.removeEventListener('draw', this.#draw);
  }

  /** @returns {Step[]} */
  steps(/** @type {boolean} */ cut) {
    const { center, half, turn } = this.#now;
    const [min, max] = [-1, 1].map((side) => /** @type {Triple} */ (center.map((value, k) => rounded(value + side * half[k]))));
    const turned = turn.some(Boolean) && { turn: /** @type {[number, number, number, number]} */ (quaternionOf(turn).map((value) => rounded(value))) };
    return [{ step: 'box', min, max, ...turned, ...(cut && { keep: false }) }];
  }

  /** Of the box as it is now. */
  async #show() {
    this.#place();
    const { count, cloud: { positions } } = this.#bench.scan;
    const going = await this.#bench.show(outside(positions, this.#now));
    if (going === null) return;
    const words = say('{share} of the points are inside of the box.', { share: format.percent(1 - going / count) });
    this.#bench.say(words, going > 0 && going < count);
  }

  /** Numbers in the fields. */
  #fill() {
    const { center, half, turn } = this.#now;
    const { cloud: { origin = [0, 0, 0] }, frame } = this.#bench.scan;
    const digits = Math.max(0, 3 - Math.floor(Math.log10(frame.diagonal)));
    for (const input of this.#ends) {
      const [k, side] = [AXES.indexOf(String(input.dataset.crop)[0]), input.dataset.crop?.endsWith('min') ? -1 : 1];
      if (input !== document.activeElement) input.value = (origin[k] + center[k] + side * half[k]).toFixed(Math.min(20, digits));
    }
    this.#turns.forEach((input, k) => input !== document.activeElement && (input.value = String(turn[k])));
  }

  /** A number was typed. What makes no box is not taken. */
  #typed() {
    const { cloud: { origin = [0, 0, 0] } } = this.#bench.scan;
    const value = (/** @type {string} */ name) => this.#ends.find(({ dataset }) => dataset.crop === name)?.valueAsNumber ?? NaN;
    const [min, max] = ['min', 'max'].map((end) => AXES.map((axis, k) => value(`${axis}-${end}`) - origin[k]));
    const turn = this.#turns.map(({ valueAsNumber }) => valueAsNumber);
    const fits = [...min, ...max, ...turn].every(Number.isFinite) && min.every((low, k) => low < max[k]);
    for (const input of [...this.#ends, ...this.#turns]) input.toggleAttribute('aria-invalid', !fits && input === document.activeElement);
    if (!fits) return this.#bench.say(say('The box has no room: each lower end has to be below the upper one.'), false);
    const triple = (/** @type {(k: number) => number} */ at) => /** @type {Triple} */ ([0, 1, 2].map(at));
    this.#now = { center: triple((k) => (min[k] + max[k]) / 2), half: triple((k) => (max[k] - min[k]) / 2), turn: triple((k) => turn[k]) };
    this.#show();
  }

  /** Puts lines and handles where the box is in the picture. */
  #place() {
    const { aim, scan: { cloud: { origin = [0, 0, 0] } } } = this.#bench;
    if (!aim) return;
    const seen = (/** @type {Triple} */ share) => aim.project(/** @type {Triple} */ (placeIn(this.#now, share).map((value, k) => value + origin[k])));
    const corners = Array.from({ length: 8 }, (_, i) => seen([i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1]));
    this.#lines.setAttribute('d', EDGES.map(([a, b]) => `M${corners[a].x.toFixed(1)} ${corners[a].y.toFixed(1)}L${corners[b].x.toFixed(1)} ${corners[b].y.toFixed(1)}`).join(''));
    for (const { axis, side, handle } of this.#faces) {
      const { x, y } = seen(/** @type {Triple} */ ([0, 1, 2].map((k) => (k === axis ? side : 0))));
      handle.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    }
  }

  /** @param {number} axis @param {1 | -1} side @returns {Face} */
  #face(axis, side) {
    const name = side > 0 ? say('Upper face along {axis}', { axis: AXES[axis] }) : say('Lower face along {axis}', { axis: AXES[axis] });
    const handle = element('button', { type: 'button', className: 'tidy-handle', ariaLabel: name, title: name });
    const move = (/** @type {number} */ way) => {
      this.#now = withFace(this.#now, axis, side, way);
      this.#fill();
      this.#show();
    };
    let from = { x: 0, y: 0 };
    handle.addEventListener('pointerdown', (event) => {
      event.preventDefault();
      handle.focus({ preventScroll: true });
      handle.setPointerCapture(event.pointerId);
      from = { x: event.clientX, y: event.clientY };
    });
    handle.addEventListener('pointermove', (event) => {
      if (!handle.hasPointerCapture(event.pointerId)) return;
      const way = this.#along(axis, side, event.clientX - from.x, event.clientY - from.y);
      if (!way) return;
      from = { x: event.clientX, y: event.clientY };
      move(way);
    });
    handle.addEventListener('keydown', (event) => {
      const step = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1 }[event.key];
      if (!step) return;
      event.preventDefault();
      move(step * (event.shiftKey ? 10 : 1) * KEY * this.#bench.scan.frame.diagonal);
    });
    this.#over.append(handle);
    return { axis, side, handle };
  }

  /** How far a face goes outwards when its handle is dragged so many pixels. @param {number} axis @param {1 | -1} side @param {number} x @param {number} y */
  #along(axis, side, x, y) {
    const { aim, scan: { frame, cloud: { origin = [0, 0, 0] } } } = this.#bench;
    if (!aim) return 0;
    const middle = /** @type {Triple} */ (placeIn(this.#now, /** @type {Triple} */ ([0, 1, 2].map((k) => (k === axis ? side : 0)))).map((value, k) => value + origin[k]));
    const ahead = 0.01 * frame.diagonal;
    const direction = axesOf(this.#now.turn)[axis];
    const [a, b] = [aim.project(middle), aim.project(/** @type {Triple} */ (middle.map((value, k) => value + side * ahead * direction[k])))];
    const [u, v] = [b.x - a.x, b.y - a.y];
    // Seen end on, it does not follow the pointer.
    const long = Math.max(u * u + v * v, 0.25);
    return (ahead * (x * u + y * v)) / long;
  }
}
