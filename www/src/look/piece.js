import { announce } from '../dom.js';
import { say } from '../words/say.js';

/** A pointer that moves farther than this, in CSS pixels, turns the picture and chooses nothing. */
const STILL = 4;

/**
 * What is told of a choice: the triangle, and the direction of the plane around it that is seen.
 * @typedef {(triangle: number, normal: [number, number, number]) => void} Chosen
 */

/** Lets a person choose a triangle of the mesh: by a click, or by Enter for the one in the middle. */
export class PieceChoice {
  #canvas;
  /** @type {Chosen | null} */
  #chosen = null;
  #down = { x: 0, y: 0 };

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {import('pointweave/viewer').Viewer['pick']} pick
   * @param {() => Pick<import('pointweave/viewer').Insets, 'left' | 'right'>} insets  beside the middle of the picture
   */
  constructor(canvas, pick, insets) {
    this.#canvas = canvas;
    const choose = (/** @type {number} */ x, /** @type {number} */ y) => {
      const found = pick(x, y);
      if (found?.layer === 'mesh') this.#chosen?.(found.triangle, found.normal);
      else announce(say('There is no mesh at this place'));
    };
    canvas.addEventListener('pointerdown', ({ clientX, clientY }) => (this.#down = { x: clientX, y: clientY }));
    canvas.addEventListener('click', ({ clientX, clientY }) => {
      if (!this.#chosen || Math.hypot(clientX - this.#down.x, clientY - this.#down.y) > STILL) return;
      const { left, top } = canvas.getBoundingClientRect();
      choose(clientX - left, clientY - top);
    });
    canvas.addEventListener('keydown', (event) => {
      if (!this.#chosen || event.key !== 'Enter') return;
      event.preventDefault();
      const { left, right } = insets();
      choose((canvas.clientWidth + left - right) / 2, canvas.clientHeight / 2);
    });
  }

  /** @param {Chosen | null} chosen  null: nothing is to be chosen */
  ask(chosen) {
    this.#chosen = chosen;
    this.#canvas.classList.toggle('choosing', chosen !== null);
    if (chosen) this.#canvas.focus();
  }
}
