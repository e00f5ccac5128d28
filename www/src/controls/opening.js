import { DroppedList } from './dropped-list.js';
import { PartsList } from './parts-list.js';
import { page } from '../page.js';
import { ColumnChooser } from '../session/column-chooser.js';
import { sortOut } from '../session/dropped.js';
import { areParts } from '../session/parts.js';
import { forget, keep, keepsSome, keyOf } from '../state/keeping.js';

/**
 * @import { MessageCard } from '../results/messages.js'
 * @import { Dropped } from '../session/dropped.js'
 * @import { Part } from '../session/parts.js'
 * @import { Scan, Session } from '../session/session.js'
 * @import { Kept } from '../state/keeping.js'
 * @import { From } from '../state/shown.js'
 */

/** Files of the person's: which of those that came in are opened, as one scan or as parts of one, and what is kept of them. */
export class Opening {
  #session;
  #message;
  #columns = new ColumnChooser();
  #dropped = new DroppedList((dropped) => this.#one(dropped.file));
  #list;
  /** The files that came in together last. @type {Dropped[]} */
  #together = [];
  /** Those that are parts of one scan. @type {File[]} */
  #files = [];

  /** @param {Session} session @param {MessageCard} message @param {(parts: Part[]) => void} chosen other parts @param {() => void} register */
  constructor(session, message, chosen, register) {
    this.#session = session;
    this.#message = message;
    this.#list = new PartsList(chosen, register);
    session.on('unread', (file) => this.#list.failed(file));
    page.forget.addEventListener('click', async () => {
      await forget();
      await this.#sayKept();
    });
  }

  /** Files that came in together. @param {{ file: File, path: string }[]} files */
  open(files) {
    if (!files.length) return this.#message.show('empty-folder', '');
    const { first, all } = sortOut(files);
    this.#together = all;
    const parts = areParts(all);
    this.#dropped.offer(parts ? [] : all);
    if (!parts) return this.#one(first.file);
    const scans = all.flatMap(({ kind, file }) => (kind === 'scan' ? [file] : []));
    this.#files = [...scans, ...this.#beside];
    this.#list.begin(this.#files);
    return this.parts(scans.map((_, of) => ({ of })));
  }

  /** Opens some of the files as parts of one scan. @param {Part[]} parts @param {string} [key] */
  parts(parts, key = setKey(this.#files)) {
    this.#message.hide();
    return this.#session.openParts(this.#files, parts, key);
  }

  /** Opens again what the browser has kept. @param {Kept} kept @param {Extract<From, { key: string }>} from */
  kept({ file, beside }, { key, columns, parts }) {
    if (!parts) return this.#session.openFile(file, { key, columns, beside });
    this.#files = [file, ...beside];
    this.#list.begin(this.#files);
    return this.parts(parts, key);
  }

  /** Opens a file of those that came in together; a mesh may name the others. @param {File} file @param {string[]} [columns] */
  #one(file, columns) {
    this.#message.hide();
    const beside = this.#together.map((other) => other.file).filter((other) => other !== file);
    return this.#session.openFile(file, { columns, beside, key: keyOf(file) });
  }

  /** What meshes among them may name. */
  get #beside() {
    return this.#together.flatMap(({ kind, file }) => (kind === 'beside' ? [file] : []));
  }

  /** A scan is open, which the browser is to keep where it is a new one of the person's. @param {Scan} scan @param {boolean} known */
  async opened(scan, known) {
    const { given, key, parts, cloud: { file, columns } } = scan;
    this.#dropped.opened(given);
    this.#columns.offer(given && file ? { file, columns } : null, (chosen) => given && this.#one(given, chosen));
    this.registered(scan);
    if (parts && key && !known) await keep(this.#files[0], this.#files.slice(1), key);
    else if (given && !known) await keep(given, this.#beside.filter((other) => other !== given));
    await this.#sayKept();
  }

  /** Says what became of the parts. @param {Scan} scan */
  registered({ parts }) {
    const { recipe, reports } = this.#session;
    this.#list.show(parts, recipe[0]?.step === 'register', reports[0]?.step === 'register' ? reports[0] : undefined);
  }

  /** A file could not be read. Whoever knows what the columns of a table are can still have it read. @param {File} given @param {any} error */
  failed(given, error) {
    this.#dropped.failed(given);
    if (error?.table) this.#columns.offer({ columns: [], file: { ...error, table: { ...error.table, weak: true } } }, (chosen) => this.#one(given, chosen));
  }

  /** Says whether the browser keeps scans of the person's. */
  async #sayKept() {
    page.kept.hidden = !(await keepsSome());
  }
}

/** Under which key files are kept together. @param {File[]} files */
function setKey([first, ...others]) {
  return `${keyOf(first)} +${others.map(keyOf).join(' +')}`;
}
