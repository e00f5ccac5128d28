/**
 * The page where its address names a tileset: it streams and is looked at. It is too large to be reduced or saved here, so what does that is
 * away; a scan that a person opens takes the page back to all of it.
 */
import 'pointweave/tiles';
import { announce } from '../dom.js';
import { page } from '../page.js';
import { helpDialog } from '../help.js';
import { describeKeys, listenToKeys } from '../keys.js';
import { Look } from '../look/look.js';
import { Measure } from '../measure/measure.js';
import { tendMenus } from '../menus.js';
import * as format from '../results/format.js';
import { MessageCard } from '../results/messages.js';
import { sortOut } from '../session/dropped.js';
import { ownAddress } from '../session/fetching.js';
import { acceptFiles } from '../session/files.js';
import { offerPictures } from '../session/pictures.js';
import { NOTHING } from '../state/shown.js';
import { keep, keyOf } from '../state/keeping.js';
import { say } from '../words/say.js';

/** @import { Viewer } from 'pointweave/viewer' */
/** @import { Key } from '../keys.js' */

/** What of the picture's keys has a meaning here. */
const KEYS = new Set(['f', 'Double click', 'u', 'v', 'r', 't', 'p', '+', '-', 'Arrows', 'Home']);

/** Numbers that are shown when they are 0, too. */
const ALWAYS = new Set(['tiles', 'loading', 'bytes']);

/** Whether an address names a tileset. @param {string | null} src @returns {src is string} */
export function isTileset(src) {
  return src !== null && /\.json$/i.test(src.split(/[?#]/)[0]);
}

export class Streamed {
  #root = page.app;
  #look = new Look(this.#root, () => {}, () => {});
  #measure = new Measure(this.#look, () => {}, () => {});
  #choose = acceptFiles((files) => this.#leave(files));
  #message = new MessageCard(this.#choose);
  #src;
  #title;

  /** @param {string} src */
  constructor(src) {
    this.#src = src;
    // A tileset.json is called as its folder is.
    const [file = '', folder = ''] = src.split(/[?#]/)[0].split('/').reverse();
    this.#title = file === 'tileset.json' && folder ? folder : file.replace(/\.json$/i, '');
    this.#root.dataset.streams = '';
    page.streamed.hidden = false;
    page.choose.addEventListener('click', this.#choose);
    page.streamMeasure.addEventListener('click', () => this.#measure.toggle());
    page.skip.addEventListener('click', (event) => {
      event.preventDefault();
      page.panel.focus();
    });
    tendMenus();
    this.#listen();
  }

  async start() {
    const viewer = this.#look.aim;
    if (!viewer) return;
    document.title = `${this.#title} · Pointweave`;
    page.captionTitle.textContent = this.#title;
    viewer.addEventListener('stream', () => this.#tell(viewer));
    try {
      await viewer.stream(ownAddress(this.#src).href);
      this.#root.dataset.state = 'ready';
      this.#root.dataset.view = viewer.layers[0];
      page.captionSize.textContent = (viewer.dimensions ?? []).map(format.length).join(' × ');
      this.#tell(viewer);
      announce(say('{name} is shown', { name: this.#title }));
    } catch (error) {
      this.#root.dataset.state = 'ready';
      const code = /** @type {{ code?: string }} */ (error).code;
      this.#message.showError(code === 'load-failed' ? Object.assign(/** @type {Error} */ (error), { code: 'not-found' }) : error, this.#src);
    }
  }

  /** Says what is shown of how much, and what that takes. @param {Viewer} viewer */
  #tell(viewer) {
    const state = viewer.streamed;
    if (!state) return;
    const { points, triangles, total, bytes, budget, tiles, loading, failed } = state;
    const [shown, of] = [format.count(points), total ? format.count(total) : ''];
    const words = triangles && !points ? say('{count} triangles shown', { count: format.count(triangles) })
      : of ? say('{shown} of {total} points shown', { shown, total: of }) : say('{shown} points shown', { shown });
    page.captionDetail.textContent = words;
    const held = say('{held} of {budget}', { held: format.bytes(bytes), budget: format.bytes(budget) });
    for (const [name, value] of Object.entries({ points, total: total ?? 0, triangles, tiles, loading, failed, bytes })) {
      const cell = /** @type {HTMLDataElement} */ (document.querySelector(`data[data-stream="${name}"]`));
      cell.textContent = name === 'bytes' ? held : format.count(value);
      cell.value = String(value);
      /** @type {HTMLElement} */ (cell.closest('div')).hidden = value === 0 && !ALWAYS.has(name);
    }
  }

  #listen() {
    const look = this.#look;
    const save = offerPictures((type, quality) => look.picture(type, quality), () => this.#title || 'tileset', () => {});
    /** @type {Key[]} */
    const keys = [
      ...look.keys.filter(({ key }) => KEYS.has(key)),
      { key: 'm', does: say('Measure in the picture'), act: () => this.#measure.toggle() },
      { key: 's', does: say('Save the picture'), act: save },
      { key: 'o', does: say('Open a scan from this device'), act: this.#choose },
      { key: '?', does: say('This list'), act: () => help() },
      { key: 'Escape', shown: 'Esc', does: say('Close a message or menu, cancel the work'), act: () => (this.#message.open ? this.#message.hide() : this.#measure.stop()) },
    ];
    const help = helpDialog(describeKeys(keys));
    page.helpOpen.addEventListener('click', help);
    listenToKeys(keys);
  }

  /** A person opens a scan: the page begins anew, and finds it as after a reload. @param {{ file: File, path: string }[]} files */
  async #leave(files) {
    if (!files.length) return this.#message.show('empty-folder', '');
    const { first, all } = sortOut(files);
    await keep(first.file, all.filter(({ kind }) => kind === 'beside').map(({ file }) => file));
    history.pushState({ step: 0, value: { ...NOTHING, scan: { key: keyOf(first.file) } } }, '', location.pathname);
    location.reload();
  }
}
