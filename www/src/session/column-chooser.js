import { element } from '../dom.js';
import { page } from '../page.js';
import { say } from '../words/say.js';

/** @import { FileCloud } from 'pointweave' */

/** What a column can hold, and how it is called on the page. */
export const ROLES = [
  ['x', 'x'], ['y', 'y'], ['z', 'z'],
  ['red', 'red'], ['green', 'green'], ['blue', 'blue'], ['rgb', 'colour in one value'],
  ['nx', 'normal x'], ['ny', 'normal y'], ['nz', 'normal z'],
  ['intensity', 'intensity'], ['-', 'nothing'],
];
const AXES = ['x', 'y', 'z'];

/** The first rows of a table of text, with a chooser over each column. */
export class ColumnChooser {
  #dialog = page.columns;
  #table = page.columnsTable;
  #say = page.columnsMissing;
  #open = page.columnsOpen;
  #read = page.columnsRead;
  /** @type {HTMLSelectElement[]} */
  #selects = [];
  /** @type {(columns: string[]) => void} */
  #chosen = () => {};

  constructor() {
    this.#open.addEventListener('click', () => this.#dialog.showModal());
    page.columnsClose.addEventListener('click', () => this.#dialog.close());
    this.#read.addEventListener('click', () => {
      this.#dialog.close();
      this.#chosen(this.#columns);
    });
  }

  /**
   * Offers the choice for a table; shows it at once where the columns are a guess. Without a table nothing is offered.
   * @param {Pick<FileCloud, 'columns' | 'file'> | null} cloud
   * @param {(columns: string[]) => void} chosen is told what the columns are
   */
  offer(cloud, chosen) {
    const table = cloud?.file.table;
    this.#open.hidden = !table;
    if (!table) return;
    this.#chosen = chosen;
    const width = Math.max(...table.rows.map((row) => row.length), table.names.length);
    this.#selects = Array.from({ length: width }, (_, i) => chooser(i, cloud.columns?.[i] ?? '-', table.names[i]));
    this.#selects.forEach((select) => select.addEventListener('change', () => this.#check()));
    this.#table.replaceChildren(
      row(this.#selects, 'th'),
      ...(table.names.length ? [row(texts(table.names, width), 'th')] : []),
      ...table.rows.map((values) => row(texts(values, width), 'td')),
    );
    this.#check();
    if (table.weak && !this.#dialog.open) this.#dialog.showModal();
  }

  get #columns() {
    return this.#selects.map(({ value }) => value);
  }

  /** Each axis has one column, and no two columns are the same. */
  #check() {
    const columns = this.#columns;
    const missing = AXES.filter((axis) => !columns.includes(axis));
    const twice = columns.find((name, i) => name !== '-' && columns.indexOf(name) !== i);
    this.#say.textContent = missing.length > 0 ? say('No column is {axes} yet.', { axes: missing.join(', ') }) : twice ? say('Two columns are {role}.', { role: say(twice) }) : '';
    this.#read.disabled = missing.length > 0 || twice !== undefined;
  }
}

/** @param {number} i @param {string} taken what the column was taken for @param {string} [name] what the file calls it */
function chooser(i, taken, name) {
  const select = element('select', { ariaLabel: say('Column {number} holds', { number: i + 1 }) });
  const own = ROLES.some(([role]) => role === taken) ? name : taken;
  const free = own && !ROLES.some(([role]) => role === own) ? [[own, own]] : [];
  select.append(...[...ROLES, ...free].map(([value, text]) => element('option', { value, textContent: say(text), selected: value === taken })));
  return select;
}

/** @param {string[]} values @param {number} width */
function texts(values, width) {
  return Array.from({ length: width }, (_, i) => document.createTextNode(values[i] ?? ''));
}

/** @param {Node[]} cells @param {'td' | 'th'} tag */
function row(cells, tag) {
  const line = element('tr');
  line.append(...cells.map((cell) => {
    const place = element(tag);
    place.append(cell);
    return place;
  }));
  return line;
}
