/** How one moves it is shown to whoever has not, some time after it is there. */

const PATIENCE_MS = 3000;

export class Prompt {
  #part;
  #timer = 0;
  #handled = false;

  /** @param {HTMLElement} part */
  constructor(part) {
    this.#part = part;
  }

  /** Something new is there. @param {() => boolean} wanted whether it is, when the time has come */
  wait(wanted) {
    this.hide();
    if (!this.#handled) this.#timer = window.setTimeout(() => (this.#part.hidden = !wanted()), PATIENCE_MS);
  }

  /** Somebody has moved it. */
  done() {
    this.#handled = true;
    this.hide();
  }

  hide() {
    clearTimeout(this.#timer);
    this.#part.hidden = true;
  }
}
