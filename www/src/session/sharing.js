import { page } from '../page.js';
import { copyText } from '../clipboard.js';
import { say } from '../words/say.js';

/** @import { Outcome, Scan } from './session.js' */

/** A link to the same settings, and a snippet that shows the saved mesh in any page. */
export class Sharing {
  #link = page.shareLink;
  #embed = page.shareEmbed;
  #note = page.shareNote;
  /** A saved poster, and the mesh that it is of. */
  #poster = { of: '', name: '' };
  #file = '';
  #title = '';

  constructor() {
    for (const [text, button] of /** @type {const} */ ([[this.#link, page.copyLink], [this.#embed, page.copyEmbed]])) {
      button.addEventListener('click', ({ currentTarget }) => {
        text.select();
        copyText(text.value, /** @type {HTMLButtonElement} */ (currentTarget));
      });
    }
  }

  /**
   * @param {string} address
   * @param {Scan | null} scan
   * @param {string} file  what the mesh is saved as
   */
  show(address, scan, file) {
    this.#link.value = address;
    this.#note.textContent = scan && !scan.model && !scan.src
      ? say('The link holds your settings. The scan itself stays on this device: send it yourself.')
      : say('Whoever opens it sees this scan with these settings.');
    this.#file = file;
    this.#title = scan?.title ?? 'A scan';
    this.#write();
  }

  /** A poster was saved: the snippet names it. */
  posted(/** @type {string} */ name) {
    this.#poster = { of: this.#file, name };
    this.#write();
  }

  #write() {
    this.#embed.value = snippet(this.#file, this.#title, this.#poster.of === this.#file ? this.#poster.name : '');
  }
}

/** The element with all that it needs is one file of the npm package, whose folder lies beside the page. */
const ELEMENT = '<script type="module" src="pointweave/element.min.js"></script>\n';

function snippet(/** @type {string} */ file, /** @type {string} */ title, /** @type {string} */ poster) {
  const text = (/** @type {string} */ words) => words.replaceAll('&', '&amp;').replaceAll('"', '&quot;').replaceAll('<', '&lt;');
  return `${ELEMENT}<point-weave src="${text(encodeURI(file))}" alt="${text(title)}, a 3D model"${poster && ` poster="${text(encodeURI(poster))}"`} controls></point-weave>`;
}
