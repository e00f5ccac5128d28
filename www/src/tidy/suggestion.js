import { page } from '../page.js';
import * as format from '../results/format.js';
import { say } from '../words/say.js';

/** @import { Scan, Session } from '../session/session.js' */

/** Planes that hold less are not worth a word. */
const WORTH = 0.2;
/** Of a large scan so many points are looked at: enough to see a floor. */
const MOST = 50_000;

/** Says that most of a scan is a floor, where it is so, and offers to remove it. Does nothing of itself. */
export class Suggestion {
  #session;
  #box = page.suggestion;
  #words = page.suggestionWords;
  /** @type {AbortController | null} */
  #look = null;

  /** @param {Session} session @param {() => void} accept */
  constructor(session, accept) {
    this.#session = session;
    page.suggestionYes.addEventListener('click', () => {
      this.hide();
      accept();
    });
    page.suggestionNo.addEventListener('click', () => this.hide());
  }

  /** Looks at a scan that was opened. */
  async opened(/** @type {Scan} */ scan) {
    this.hide();
    const { signal } = (this.#look = new AbortController());
    try {
      const plane = await this.#session.floor(scan, MOST, signal);
      if (signal.aborted || !plane || plane.share < WORTH) return;
      this.#words.textContent = say('{share} of these points are one flat plane. Remove the floor?', { share: format.percent(plane.share) });
      this.#box.hidden = false;
    } catch {
      // Who is not told can still look.
    }
  }

  hide() {
    this.#look?.abort();
    this.#box.hidden = true;
  }
}
