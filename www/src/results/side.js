import { sideInWords } from 'pointweave';
import { announce } from '../dom.js';
import { page } from '../page.js';
import { say } from '../words/say.js';

/** @import { SurfaceMesh } from 'pointweave' */

/** Which side is out: what told it, and a button that turns it over. */
export class SideCard {
  #box = page.side;
  #words = page.sideWords;
  #flip = page.flip;
  #piece = page.flipPiece;
  #ask;

  /**
   * @param {(triangle?: number) => void} flip  turns the piece of a triangle, or all
   * @param {(chosen: ((triangle: number) => void) | null) => void} ask  has the person choose a triangle; null: no more
   */
  constructor(flip, ask) {
    this.#ask = ask;
    this.#flip.addEventListener('click', () => flip());
    this.#piece.addEventListener('click', () => {
      if (this.choosing) return this.stop();
      this.#piece.ariaPressed = 'true';
      announce(say('Choose the piece: click it in the picture'));
      ask((triangle) => flip(triangle));
    });
  }

  /** A piece is to be chosen in the picture. */
  get choosing() {
    return this.#piece.ariaPressed === 'true';
  }

  /** No piece is to be chosen any more. */
  stop() {
    if (!this.choosing) return;
    this.#piece.ariaPressed = 'false';
    this.#ask(null);
  }

  /** While something is made, there is nothing to turn. */
  set busy(/** @type {boolean} */ busy) {
    this.stop();
    this.#flip.disabled = this.#piece.disabled = busy;
  }

  /** @param {SurfaceMesh | null} mesh @param {{ all: boolean, piece: boolean }} byHand  what a person has turned */
  show(mesh, { all, piece }) {
    this.stop();
    this.#box.hidden = !mesh;
    if (!mesh) return;
    const [first, ...rest] = sideInWords(mesh.report, say);
    this.#words.textContent = `${first.toUpperCase()}${rest.join('')}${all ? `; ${say('all of it was turned by hand')}` : ''}${piece ? `; ${say('a piece was turned by hand')}` : ''}.`;
    this.#piece.hidden = mesh.report.components < 2;
  }
}
