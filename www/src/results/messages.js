import { page } from '../page.js';
import { say } from '../words/say.js';
import { MESSAGES } from './error-messages.js';

/** The card over the picture; it leaves everything else usable. */
export class MessageCard {
  #box = page.message;
  #choose = page.messageChoose;

  constructor(/** @type {() => void} */ choose) {
    this.#choose.addEventListener('click', choose);
    page.messageClose.addEventListener('click', () => this.hide());
  }

  get open() {
    return !this.#box.hidden;
  }

  /**
   * @param {any} error
   * @param {string} about  what the person had opened
   * @param {{ standIn?: boolean }} [how]  whether a sample is shown in its place
   */
  showError(error, about, { standIn = false } = {}) {
    const code = typeof error?.code === 'string' ? error.code : 'internal';
    this.show(code, `${about}: ${error?.message ?? error} [${code}]`, { standIn });
  }

  /** @param {string} code @param {string} detail @param {{ standIn?: boolean }} [how] */
  show(code, detail, { standIn = false } = {}) {
    const { title, text, advice } = MESSAGES[code] ?? MESSAGES.internal;
    page.messageTitle.textContent = say(title);
    page.messageText.textContent = say(text);
    page.messageAdvice.textContent = standIn ? `${say(advice)} ${say('A sample is shown instead.')}` : say(advice);
    page.messageDetail.textContent = detail;
    this.#box.hidden = false;
  }

  hide() {
    this.#box.hidden = true;
  }
}
