import { announce, element } from '../dom.js';
import { page } from '../page.js';
import { scaled } from '../measure/lengths.js';
import { compressAside } from './compressing.js';
import { WebSaving } from './web-saving.js';
import { saveFile } from './files.js';
import * as format from '../results/format.js';
import { printingWords, solidOf } from '../results/printing.js';
import { say } from '../words/say.js';

/**
 * @import { WriteOptions } from 'pointweave'
 * @import { Outcome, Session } from './session.js'
 * @typedef {'mesh' | 'reduced'} What
 */

/**
 * A kind of file: what it is called, what it is good for, and how it is written. `prints`: what it is good for where the mesh is
 * watertight.
 * @typedef {{ label: string, use: string, prints?: string, options: WriteOptions }} Kind
 */

/** The first that the package writes is the one on the button. @type {Record<What, Record<string, Kind>>} */
export const FORMATS = {
  mesh: {
    'glb-small': { label: 'GLB', use: 'small: for the web and phones', options: { format: 'glb', quantize: true, meshopt: compressAside } },
    glb: { label: 'GLB', use: 'plain: for every program', options: { format: 'glb' } },
    ply: { label: 'PLY', use: 'keeps everything', options: { format: 'ply' } },
    obj: { label: 'OBJ', use: 'for modelling programs', options: { format: 'obj' } },
    stl: { label: 'STL', use: 'triangles alone', prints: 'for 3D printing', options: { format: 'stl' } },
    '3mf': { label: '3MF', use: 'triangles and colours', prints: 'for 3D printing, in colour', options: { format: '3mf' } },
    usdz: { label: 'USDZ', use: 'for iPhone and iPad', options: { format: 'usdz' } },
  },
  reduced: {
    ply: { label: 'PLY', use: 'keeps everything', options: { format: 'ply' } },
    glb: { label: 'GLB', use: 'for the web and viewers', options: { format: 'glb' } },
    xyz: { label: 'XYZ', use: 'plain text', options: { format: 'xyz' } },
    las: { label: 'LAS', use: 'for surveyors', options: { format: 'las' } },
    pcd: { label: 'PCD', use: 'for robots', options: { format: 'pcd' } },
  },
};
export const NAMES = { mesh: 'Mesh', reduced: 'Reduced points' };

/** Saves what was made: one button for most people, and every format with its size. */
export class Saving {
  #session;
  #fail;
  #button = page.save;
  #what = page.saveWhat;
  #detail = page.saveDetail;
  #menu = page.formats;
  #list = page.formatList;
  #note = page.saveNote;
  #printing = page.printing;
  #close = page.closeHoles;
  /** The mesh can be printed. */
  #prints = false;
  #web;
  /** What is offered now; files of an earlier one are not waited for. @type {Outcome | null} */
  #outcome = null;
  /** Written files of the outcome. @type {Map<string, Promise<Blob | null>>} */
  #files = new Map();
  /** What the button saves. @type {[What, string] | null} */
  #first = null;

  /**
   * @param {Session} session
   * @param {import('../look/look.js').Look} look
   * @param {(error: unknown, name: string) => void} fail
   * @param {(how: 'closed' | 'base') => void} close  has all holes closed, or the mesh ended in a flat base where its floor was
   */
  constructor(session, look, fail, close) {
    this.#session = session;
    this.#web = new WebSaving(session, look, fail);
    this.#fail = fail;
    this.#button.addEventListener('click', () => this.#first && this.#save(...this.#first));
    this.#close.addEventListener('click', () => close(this.#closing));
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
    this.#note.textContent = '';
    this.#showPrinting(outcome);
    this.#web.offer(outcome);
    if (!outcome) return;
    const what = outcome.mesh ? 'mesh' : 'reduced';
    this.#what.textContent = outcome.mesh ? say('Save the mesh') : say('Save the points');
    for (const name of Object.keys(FORMATS[what])) {
      const file = await this.#file(what, name);
      if (outcome !== this.#outcome) return;
      if (!file) continue;
      this.#first = [what, name];
      this.#detail.textContent = `${FORMATS[what][name].label} · ${format.bytes(file.size)}`;
      this.#button.disabled = false;
      break;
    }
    if (this.#first?.[1] === 'glb-small') {
      const plain = await this.#file('mesh', 'glb');
      if (outcome !== this.#outcome) return;
      if (plain) this.#note.textContent = say('Compressed. The plain GLB for programs that cannot read that has {size}; it is among the other formats.', { size: format.bytes(plain.size) });
    }
    if (this.#menu.open) await this.#listAll();
  }

  /** Whether it can be printed and how large it is, or what is missing and what helps. */
  #showPrinting(/** @type {Outcome | null} */ outcome) {
    const mesh = outcome?.mesh;
    this.#printing.hidden = !mesh;
    this.#close.hidden = true;
    this.#prints = false;
    if (!mesh) return;
    const solid = solidOf(scaled(mesh, this.#session.scale));
    const { ready, words } = printingWords(solid, mesh.unit);
    this.#prints = ready;
    this.#printing.textContent = words;
    this.#close.textContent = this.#closing === 'base' ? say('Close it with a flat base') : say('Close all holes');
    this.#close.hidden = solid.closed || this.#session.settings.get('boundary') === this.#closing;
  }

  /** What helps a mesh that is open: what stood on a floor stands flat. @returns {'closed' | 'base'} */
  get #closing() {
    return this.#outcome?.scan.cloud.floor ? 'base' : 'closed';
  }

  /** A row for each format that the package writes; sizes appear as the files are made. */
  async #listAll() {
    const outcome = this.#outcome;
    if (!outcome || this.#list.childElementCount) return;
    for (const what of /** @type {What[]} */ (outcome.mesh ? ['mesh', 'reduced'] : ['reduced'])) {
      const rows = element('ul');
      this.#list.append(element('h3', { textContent: say(NAMES[what]) }), rows);
      for (const name of Object.keys(FORMATS[what])) {
        const file = await this.#file(what, name);
        if (outcome !== this.#outcome) return;
        if (file) rows.append(this.#row(what, name, file.size));
      }
    }
  }

  #row(/** @type {What} */ what, /** @type {string} */ name, /** @type {number} */ size) {
    const { label, use, prints } = FORMATS[what][name];
    const row = element('li');
    const button = element('button', { type: 'button', className: 'format', id: `save-${what}-${name}` });
    button.append(
      element('span', { className: 'visually-hidden', textContent: `${say(what === 'mesh' ? 'Save the mesh as' : 'Save the points as')} ` }),
      element('strong', { textContent: label }),
      element('span', { textContent: say((this.#prints && prints) || use) }),
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
      file = this.#session.file(what, FORMATS[what][name].options).then(
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
    const title = `${this.#outcome?.scan.file}-${what}.${FORMATS[what][name].options.format}`;
    const file = await this.#file(what, name);
    if (!file) return;
    saveFile(file, title);
    announce(say('{name} saved', { name: title }));
  }
}
