import { byId } from '../dom.js';
import { MESSAGES } from './error-messages.js';

/** The card over the picture; it leaves everything else usable. */
export class MessageCard {
  #box = byId('message', HTMLElement);
  #choose = byId('message-choose', HTMLButtonElement);

  constructor(/** @type {() => void} */ choose) {
    this.#choose.addEventListener('click', choose);
    byId('message-close', HTMLButtonElement).addEventListener('click', () => this.hide());
  }

  get open() {
    return !this.#box.hidden;
  }

  /** @param {any} error  @param {string} about  what the person had opened */
  showError(error, about) {
    const code = typeof error?.code === 'string' ? error.code : 'internal';
    const { title, text, advice } = MESSAGES[code] ?? MESSAGES.internal;
    byId('message-title', HTMLElement).textContent = title;
    byId('message-text', HTMLElement).textContent = text;
    byId('message-advice', HTMLElement).textContent = advice;
    byId('message-detail', HTMLElement).textContent = `${about}: ${error?.message ?? error} [${code}]`;
    this.#box.hidden = false;
  }

  hide() {
    this.#box.hidden = true;
  }
}
