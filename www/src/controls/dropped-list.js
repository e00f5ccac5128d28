import { announce, element } from '../dom.js';
import { page } from '../page.js';
import { say } from '../words/say.js';

/** @import { Dropped } from '../session/dropped.js' */

/** No more rows are shown; the others are counted. */
const ROWS = 40;

/** What becomes of each of several files that came in together, and a way to open another of them. */
export class DroppedList {
  #box = page.dropped;
  #rows = page.droppedRows;
  #open;
  /** @type {Dropped[]} */
  #all = [];
  /** Files that could not be read. @type {Set<File>} */
  #failed = new Set();
  /** @type {File | undefined} */
  #current;

  constructor(/** @type {(dropped: Dropped) => void} */ open) {
    this.#open = open;
  }

  /** Shows several files; one alone needs no list. */
  offer(/** @type {Dropped[]} */ all) {
    this.#all = all.length > 1 ? all : [];
    this.#failed.clear();
    this.#current = undefined;
    this.#draw();
    if (this.#all.length) announce(say('{count} files came in. One scan is open at a time; the list says what becomes of each.', { count: all.length }));
  }

  /** @param {File | undefined} file the one that is open now */
  opened(file) {
    this.#current = file;
    this.#draw();
  }

  failed(/** @type {File} */ file) {
    this.#failed.add(file);
    this.#draw();
  }

  #draw() {
    this.#box.hidden = !this.#all.length;
    this.#rows.replaceChildren(...this.#all.slice(0, ROWS).map((dropped) => this.#row(dropped)));
    const more = this.#all.length - ROWS;
    if (more > 0) this.#rows.append(element('li', { textContent: say('and {count} more, which are not opened', { count: more }) }));
  }

  #row(/** @type {Dropped} */ dropped) {
    const { file, path, kind } = dropped;
    const row = element('li');
    const open = file === this.#current;
    row.append(element('span', { className: 'dropped-name', textContent: path, title: path }));
    const words = open ? say('open') : this.#failed.has(file) ? say('cannot be read')
      : kind === 'beside' ? say('used by a mesh that names it') : kind === 'other' ? say('looks like no scan') : '';
    if (words) row.append(element('span', { className: 'hint', textContent: words }));
    if (!open && kind !== 'beside' && !this.#failed.has(file)) {
      const button = element('button', { type: 'button', className: 'button quiet', textContent: say('Open'), ariaLabel: say('Open {name}', { name: path }) });
      button.addEventListener('click', () => this.#open(dropped));
      row.append(button);
    }
    if (open) row.ariaCurrent = 'true';
    return row;
  }
}
