/** A line that shows how far a call is, on a terminal; anywhere else, nothing. */

/** @import { Progress } from '../types.js' */

const CELLS = 24;
/** Faster than anybody reads. */
const EVERY_MS = 50;

export class Bar {
  #stream;
  #label;
  #shown = 0;

  /**
   * @param {NodeJS.WriteStream} stream
   * @param {string} label
   */
  constructor(stream, label) {
    this.#stream = stream;
    this.#label = label;
  }

  /** @param {Progress} progress */
  update({ stage, overall }) {
    const now = performance.now();
    if (!this.#stream.isTTY || now - this.#shown < EVERY_MS) return;
    this.#shown = now;
    const full = Math.round(CELLS * overall);
    const percent = `${Math.floor(100 * overall)}`.padStart(3);
    const line = `${'█'.repeat(full)}${'░'.repeat(CELLS - full)} ${percent} %  ${stage.padEnd(8)}  ${this.#label}`;
    this.#stream.write(`\r${line.slice(0, (this.#stream.columns || 80) - 1)}\x1b[K`);
  }

  clear() {
    if (this.#shown) this.#stream.write('\r\x1b[K');
    this.#shown = 0;
  }
}
