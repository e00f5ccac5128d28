import { page } from '../page.js';
import * as format from '../results/format.js';
import { say } from '../words/say.js';

/** @import { Look } from './look.js' */
/** @typedef {[number, number, number]} Triple */

/** Around the bar, in CSS pixels. */
const MARGIN = 24;
/** @type {Record<string, Triple>} */
const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

/** A plane through what is shown: only what is behind it is drawn. It can be measured there. */
export class Section {
  #look;
  #began;
  #root = page.app;
  #bar = page.sectionBar;
  #button = page.section;
  #along = page.sectionAlong;
  #place = page.sectionPlace;
  #words = page.sectionWords;
  #flipped = false;
  /** Of the line of sight when it was chosen. @type {Triple} */
  #sight = AXES.z;

  /** @param {Look} look @param {() => void} began */
  constructor(look, began) {
    this.#look = look;
    this.#began = began;
    this.#button.addEventListener('click', () => this.toggle());
    this.#place.addEventListener('input', () => this.#show());
    this.#along.addEventListener('change', () => this.#turn());
    page.sectionFlip.addEventListener('click', () => {
      this.#flipped = !this.#flipped;
      this.#show();
    });
    page.sectionClose.addEventListener('click', () => this.stop());
  }

  get open() {
    return !this.#bar.hidden;
  }

  toggle() {
    if (this.open) return this.stop();
    if (!this.#look.aim?.dimensions) return;
    this.#began();
    page.cameraMenu.open = false;
    this.#root.dataset.section = '';
    this.#button.ariaPressed = 'true';
    this.#bar.hidden = false;
    this.#flipped = false;
    this.#turn();
    this.#look.leave(this.#bar.offsetHeight + MARGIN);
    this.#place.focus({ preventScroll: true });
    page.stage.scrollIntoView({ block: 'nearest' });
  }

  stop() {
    if (!this.open) return;
    if (this.#bar.contains(document.activeElement)) page.canvas.focus({ preventScroll: true });
    delete this.#root.dataset.section;
    this.#button.ariaPressed = 'false';
    this.#bar.hidden = true;
    const { aim } = this.#look;
    if (aim) aim.section = null;
    this.#look.leave();
  }

  /** Another scan, or another part of it, is shown. */
  refit() {
    if (this.open) this.#show();
  }

  /** Along another direction, through the middle. */
  #turn() {
    const { aim } = this.#look;
    if (aim) this.#sight = sightOf(aim.sight());
    this.#place.value = '50';
    this.#show();
  }

  #show() {
    const { aim } = this.#look;
    const frame = this.#look.frame;
    if (!aim || !frame) return;
    const chosen = /** @type {HTMLInputElement} */ (this.#along.querySelector('input:checked')).value;
    const normal = AXES[chosen] ?? this.#sight;
    const half = normal.reduce((sum, x, k) => sum + Math.abs(x) * frame.size[k], 0) / 2;
    const off = (2 * this.#place.valueAsNumber / 100 - 1) * half;
    const side = this.#flipped ? 1 : -1;
    const triple = (/** @type {(k: number) => number} */ value) => /** @type {Triple} */ ([0, 1, 2].map(value));
    const point = triple((k) => frame.center[k] + off * normal[k]);
    aim.section = { point, normal: triple((k) => side * normal[k]) };
    const words = format.length(AXES[chosen] ? point.reduce((sum, x, k) => sum + x * normal[k], 0) : off);
    this.#words.textContent = chosen in AXES ? `${chosen} = ${words}` : say('{length} from the middle', { length: words });
    this.#place.setAttribute('aria-valuetext', this.#words.textContent);
  }
}

/** The direction from the picture to the eye, of the product of projection and view. @param {number[]} m by columns @returns {Triple} */
function sightOf(m) {
  // Depth grows along the last row, or in parallel projection along the third.
  const row = [3, 7, 11].some((k) => m[k] !== 0) ? [m[3], m[7], m[11]] : [m[2], m[6], m[10]];
  const length = Math.hypot(...row);
  return /** @type {Triple} */ (row.map((x) => -x / length));
}
