import { page } from '../page.js';
import * as format from '../results/format.js';
import { say } from '../words/say.js';

/** @import { View } from './look.js' */
/** @import { Outcome } from '../session/session.js' */

const STEP = 0.02;

/** The divider between two views beside each other: it is dragged, or moved with the arrows. */
export class Split {
  #stage = page.stage;
  #box = page.split;
  #handle = page.splitHandle;
  #left = page.splitLeft;
  #right = page.splitRight;
  #words = [page.splitLeftWords, page.splitRightWords];
  #moved;
  /** Where it is, as a share of the width. */
  at = 0.5;

  /**
   * @param {() => void} changed  other views are beside each other
   * @param {(view: import('pointweave/viewer').Split) => void} moved
   */
  constructor(changed, moved) {
    this.#moved = moved;
    for (const select of [this.#left, this.#right]) select.addEventListener('change', changed);
    this.#handle.addEventListener('pointerdown', (event) => {
      event.preventDefault();
      this.#handle.focus();
      this.#handle.setPointerCapture(event.pointerId);
    });
    this.#handle.addEventListener('pointermove', (event) => {
      if (!this.#handle.hasPointerCapture(event.pointerId)) return;
      const { left, width } = this.#stage.getBoundingClientRect();
      this.#move((event.clientX - left) / width);
    });
    this.#handle.addEventListener('keydown', (event) => {
      const to = { ArrowLeft: this.at - STEP, ArrowRight: this.at + STEP, Home: 0, End: 1 }[event.key];
      if (to === undefined) return;
      event.preventDefault();
      this.#move(to);
    });
  }

  get sides() {
    return { left: /** @type {View} */ (this.#left.value), right: /** @type {View} */ (this.#right.value) };
  }

  /** What stands at either side of it, for a viewer. */
  get view() {
    return { ...this.sides, at: this.at };
  }

  show(/** @type {boolean} */ shown) {
    this.#box.hidden = !shown;
  }

  /** Without a mesh there is none to compare with. */
  offerMesh(/** @type {boolean} */ possible) {
    for (const select of [this.#left, this.#right]) {
      for (const option of select.options) if (option.value === 'mesh') option.disabled = !possible;
    }
    if (!possible && this.#right.value === 'mesh') this.#right.value = 'reduced';
    if (possible && this.#right.value === 'reduced' && this.#left.value === 'points') this.#right.value = 'mesh';
  }

  /** A mesh was kept, to be put beside another; or there is none. */
  offerKept(/** @type {boolean} */ possible) {
    this.#offer('kept', possible);
  }

  /** @param {'kept' | 'light'} view @param {boolean} possible */
  #offer(view, possible) {
    for (const select of [this.#left, this.#right]) {
      for (const option of select.options) if (option.value === view) option.hidden = option.disabled = !possible;
      if (!possible && select.value === view) select.value = select === this.#left ? 'points' : 'mesh';
    }
  }

  /** A light model is put beside the scan; or there is none. @param {boolean} possible */
  offerLight(possible) {
    this.#offer('light', possible);
    if (possible) this.#right.value = 'light';
  }

  /** The kept mesh at the left, the mesh of now at the right. */
  putBeside() {
    this.#left.value = 'kept';
    this.#right.value = 'mesh';
  }

  /** What meshes at either side are made of, and how far from the scan they are. @param {(view: View) => Outcome | null} outcomeOf */
  describe(outcomeOf) {
    [this.#left, this.#right].forEach((select, i) => {
      const report = select.value === 'mesh' || select.value === 'kept' ? outcomeOf(/** @type {View} */ (select.value))?.mesh?.report : undefined;
      this.#words[i].textContent = report
        ? say('{points} points, {triangles} triangles, RMS {error}', {
          points: format.short(report.outputPoints), triangles: format.short(report.triangles), error: format.percent(report.distance.rms),
        })
        : '';
    });
  }

  #move(/** @type {number} */ to) {
    this.at = Math.min(1, Math.max(0, to));
    this.#box.style.setProperty('--at', String(this.at));
    this.#handle.ariaValueNow = String(Math.round(100 * this.at));
    this.#moved(this.view);
  }
}
