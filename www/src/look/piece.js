import { announce } from '../dom.js';
import { say } from '../words/say.js';
import { Still } from './still.js';

/**
 * What is told of a choice: the triangle, and the direction of the plane around it that is seen.
 * @typedef {(triangle: number, normal: [number, number, number]) => void} Chosen
 */

/** Lets a person choose a triangle of the mesh: by a click, or by Enter for the one in the middle. */
export class PieceChoice {
  #canvas;
  #click;
  /** @type {Chosen | null} */
  #chosen = null;

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {import('pointweave/viewer').Viewer['pick']} pick
   * @param {() => Pick<import('pointweave/viewer').Insets, 'left' | 'right'>} insets  beside the middle of the picture
   */
  constructor(canvas, pick, insets) {
    this.#canvas = canvas;
    this.#click = new Still(canvas, (x, y) => {
      const found = pick(x, y);
      if (found?.layer === 'mesh') this.#chosen?.(found.triangle, found.normal);
      else announce(say('There is no mesh at this place'));
    }, insets);
  }

  /** @param {Chosen | null} chosen  null: nothing is to be chosen */
  ask(chosen) {
    this.#chosen = chosen;
    this.#click.listen(chosen !== null);
    if (chosen) this.#canvas.focus();
  }
}
