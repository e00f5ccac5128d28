import { announce, byId, element } from '../dom.js';
import { saveFile } from './files.js';
import * as format from '../results/format.js';

/**
 * @import { OutputFormat } from 'pointweave'
 * @import { Outcome, Session } from './session.js'
 * @typedef {'mesh' | 'reduced'} What
 */

/** What each kind of file is good for; the first that the package writes is the one on the button. */
const FORMATS = /** @type {Record<What, Record<string, string>>} */ ({
  mesh: {
    glb: 'for the web, phones and viewers',
    ply: 'keeps everything',
    obj: 'for modelling programs',
    stl: 'for 3D printing',
    '3mf': 'for 3D printing, in colour',
    usdz: 'for iPhone and iPad',
  },
  reduced: {
    ply: 'keeps everything',
    glb: 'for the web and viewers',
    xyz: 'plain text',
    las: 'for surveyors',
    pcd: 'for robots',
  },
});
const NAMES = { mesh: 'Mesh', reduced: 'Reduced points' };

/** Saves what was made: one button for most people, and every format with its size. */
export class Saving {
  #session;
  #fail;
  #button = byId('save', HTMLButtonElement);
  #what = byId('save-what', HTMLElement);
  #detail = byId('save-detail', HTMLElement);
  #menu = byId('formats', HTMLDetailsElement);
  #list = byId('format-list', HTMLElement);
  /** What is offered now; files of an earlier one are not waited for. @type {Outcome | null} */
  #outcome = null;
  /** Written files of the outcome. @type {Map<string, Promise<Blob | null>>} */
  #files = new Map();
  /** What the button saves. @type {[What, string] | null} */
  #first = null;

  /**
   * @param {Session} session
   * @param {(error: unknown, name: string) => void} fail
   */
  constructor(session, fail) {
    this.#session = session;
    this.#fail = fail;
    this.#button.addEventListener('click', () => this.#first && this.#save(...this.#first));
    this.#menu.addEventListener('toggle', () => this.#menu.open && this.#listAll());
  }

  /** Offers what was made; null while there is nothing. */
  async offer(/** @type {Outcome | null} */ outcome) {
    this.#outcome = outcome;
    this.#files.clear();
    this.#list.replaceChildren();
    this.#first = null;
    this.#button.disabled = true;
    this.#menu.hidden = !outcome;
    this.#detail.textContent = '';
    if (!outcome) return;
    const what = outcome.mesh ? 'mesh' : 'reduced';
    this.#what.textContent = outcome.mesh ? 'Save the mesh' : 'Save the points';
    for (const name of Object.keys(FORMATS[what])) {
      const file = await this.#file(what, name);
      if (outcome !== this.#outcome) return;
      if (!file) continue;
      this.#first = [what, name];
      this.#detail.textContent = `${name.toUpperCase()} · ${format.bytes(file.size)}`;
      this.#button.disabled = false;
      break;
    }
    if (this.#menu.open) await this.#listAll();
  }

  /** A row for each format that the package writes; sizes appear as the files are made. */
  async #listAll() {
    const outcome = this.#outcome;
    if (!outcome || this.#list.childElementCount) return;
    for (const what of /** @type {What[]} */ (outcome.mesh ? ['mesh', 'reduced'] : ['reduced'])) {
      const rows = element('ul');
      this.#list.append(element('h3', { textContent: NAMES[what] }), rows);
      for (const [name, use] of Object.entries(FORMATS[what])) {
        const file = await this.#file(what, name);
        if (outcome !== this.#outcome) return;
        if (file) rows.append(this.#row(what, name, use, file.size));
      }
    }
  }

  #row(/** @type {What} */ what, /** @type {string} */ name, /** @type {string} */ use, /** @type {number} */ size) {
    const row = element('li');
    const button = element('button', { type: 'button', className: 'format', id: `save-${what}-${name}` });
    button.append(
      element('span', { className: 'visually-hidden', textContent: `Save the ${NAMES[what].toLowerCase()} as ` }),
      element('strong', { textContent: name.toUpperCase() }),
      element('span', { textContent: use }),
      element('data', { textContent: format.bytes(size), value: String(size) }),
    );
    button.addEventListener('click', () => this.#save(what, name));
    row.append(button);
    return row;
  }

  /** The file, written once; null where the package does not write this format. */
  #file(/** @type {What} */ what, /** @type {string} */ name) {
    const key = `${what} ${name}`;
    let file = this.#files.get(key);
    if (!file) {
      file = this.#session.file(what, /** @type {OutputFormat} */ (name)).then(
        (bytes) => new Blob([/** @type {Uint8Array<ArrayBuffer>} */ (bytes)], { type: 'application/octet-stream' }),
        (error) => {
          if (error?.code !== 'bad-option') this.#fail(error, name.toUpperCase());
          return null;
        },
      );
      this.#files.set(key, file);
    }
    return file;
  }

  async #save(/** @type {What} */ what, /** @type {string} */ name) {
    const title = `${this.#outcome?.scan.file}-${what}.${name}`;
    const file = await this.#file(what, name);
    if (!file) return;
    saveFile(file, title);
    announce(`${title} saved`);
  }
}
