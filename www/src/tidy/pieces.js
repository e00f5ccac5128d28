import { announce, element } from '../dom.js';
import { page } from '../page.js';
import * as format from '../results/format.js';
import { say } from '../words/say.js';
import { among } from './bench.js';
import { Still } from '../look/still.js';
import { pieceColor, pieced } from './tint.js';

/** @import { PieceReport, Step } from 'pointweave' */
/** @import { Bench } from './bench.js' */

/** So many are in the list; those behind are small. */
const LISTED = 24;

/** Keeps pieces that a person chooses, by a click on one or in a list. At first that is the largest. */
export class Pieces {
  #bench;
  #box = page.tidyPieces;
  #list = page.tidyPiecesList;
  #rest = page.tidyPiecesRest;
  #gap = page.tidyGap;
  #click;
  /** @type {PieceReport[]} */
  #pieces = [];
  /** Of a point that is shown. @type {(point: number) => number} */
  #pieceOf = () => 0;
  #kept = new Set([0]);
  /** Of pieces, listed or not. */
  #count = 0;

  constructor(/** @type {Bench} */ bench) {
    this.#bench = bench;
    this.#click = new Still(page.canvas, (x, y) => this.#clicked(x, y));
    this.#gap.addEventListener('change', () => this.begin());
    this.#list.addEventListener('change', ({ target }) => this.#toggle(Number(/** @type {HTMLInputElement} */ (target).value)));
  }

  async begin() {
    this.#gap.setAttribute('aria-valuetext', say('{count} times the distance between neighbours', { count: this.#gap.value }));
    const trial = await this.#bench.try([{ step: 'pieces', keep: 'all', ...this.#apart }]);
    const report = trial?.reports[0];
    if (!report) return;
    this.#pieces = report.pieces ?? [];
    const [{ labels = new Uint32Array() }, { indexOf }] = [report, this.#bench];
    this.#pieceOf = (point) => labels[indexOf(point)];
    this.#kept = new Set([0]);
    this.#list.replaceChildren(...this.#pieces.slice(0, LISTED).map((piece, i) => this.#option(piece, i)));
    this.#count = Number(report.count);
    const more = this.#count - LISTED;
    this.#rest.textContent = more > 0 ? say('{count} smaller ones are not listed.', { count: format.count(more) }) : '';
    this.#box.hidden = false;
    this.#click.listen(true);
    this.#show();
  }

  end() {
    this.#box.hidden = true;
    this.#click.listen(false);
  }

  /** @returns {Step[]} */
  steps() {
    const numbers = [...this.#kept].sort((a, b) => a - b);
    return [{ step: 'pieces', keep: numbers.length === 1 && numbers[0] === 0 ? 'largest' : numbers, ...this.#apart }];
  }

  /** What is not as usual. */
  get #apart() {
    const gap = this.#gap.valueAsNumber;
    return gap === Number(this.#gap.defaultValue) ? {} : { gap };
  }

  #clicked(/** @type {number} */ x, /** @type {number} */ y) {
    const found = this.#bench.aim?.pickPoint(x, y);
    if (!found) return;
    const piece = this.#pieceOf(found.index);
    this.#toggle(piece);
    announce(this.#kept.has(piece) ? say('Piece {number} stays', { number: piece + 1 }) : say('Piece {number} goes', { number: piece + 1 }));
  }

  #toggle(/** @type {number} */ piece) {
    if (!this.#kept.delete(piece)) this.#kept.add(piece);
    const check = /** @type {HTMLInputElement | null} */ (this.#list.querySelector(`[value="${piece}"]`));
    if (check) check.checked = this.#kept.has(piece);
    this.#show();
  }

  async #show() {
    const { count, cloud } = this.#bench.scan;
    const staying = await this.#bench.show(among(this.#pieceOf, this.#kept, this.#count), pieced(cloud, this.#pieceOf));
    if (staying === null) return;
    if (this.#pieces.length === 1) this.#bench.say(say('All of it is one piece.'), false);
    else if (staying === 0) this.#bench.say(say('Nothing would be left.'), false);
    else this.#bench.say(say('{share} of the points stay. Click a piece to keep or drop it.', { share: format.percent(staying / count) }), staying < count);
  }

  #option(/** @type {PieceReport} */ { points, share }, /** @type {number} */ i) {
    const label = element('label', { className: 'check' });
    const color = element('i');
    color.style.background = `rgb(${pieceColor(i).join(' ')})`;
    label.append(element('input', { type: 'checkbox', value: String(i), checked: this.#kept.has(i) }), color,
      element('span', { textContent: say('Piece {number}', { number: i + 1 }) }),
      element('span', { className: 'detail', textContent: `${format.percent(share)}, ${format.points(points)}` }));
    const row = element('li');
    row.append(label);
    return row;
  }
}
