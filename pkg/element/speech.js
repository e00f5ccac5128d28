/** What a screen reader says while one waits and moves: little, and not too often. */

/** Progress is said again after so long. */
const PROGRESS_MS = 5000;
/** A movement is said when it has come to rest. */
const REST_MS = 500;

export class Speech {
  #region;
  #lastProgress = -Infinity;
  #timer = 0;

  /** @param {HTMLElement} region live */
  constructor(region) {
    this.#region = region;
  }

  /** @param {string} words */
  say(words) {
    clearTimeout(this.#timer);
    this.#region.textContent = words;
  }

  /** @param {string} words */
  progress(words) {
    const now = performance.now();
    if (now - this.#lastProgress < PROGRESS_MS) return;
    this.#lastProgress = now;
    this.say(words);
  }

  /** The next progress is said at once. */
  begin() {
    this.#lastProgress = -Infinity;
  }

  /** @param {() => string} words */
  atRest(words) {
    clearTimeout(this.#timer);
    this.#timer = window.setTimeout(() => this.say(words()), REST_MS);
  }

  hush() {
    clearTimeout(this.#timer);
  }
}
