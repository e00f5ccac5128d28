/** What lies over the picture: the poster, the progress of a job, what went wrong, and the toolbar. */
import { setIcon } from './parts.js';

/** @import { View, Words } from '../element.js' */
/** @typedef {ReturnType<typeof import('./parts.js').buildParts>} Parts */

/** A job this short shows no bar: it would only flash. */
const PATIENCE_MS = 200;
/** Between toolbar and picture, in CSS pixels. */
const GAP = 4;
/** A part of the toolbar without a button is no higher. */
const BARE = 10;

export class Panels {
  #parts;
  #timer = 0;

  /** @param {Parts} parts */
  constructor(parts) {
    this.#parts = parts;
  }

  /** Puts the words where they belong. @param {Words} words */
  label(words) {
    const { keys, legend, choices, reset, fullscreen, ar, cancel, retry, errorMore } = this.#parts;
    keys.textContent = words.keys;
    legend.textContent = words.viewsLabel;
    for (const { view, words: place } of choices) place.textContent = words.views[view];
    for (const [button, label] of /** @type {const} */ ([[reset, words.reset], [fullscreen, words.fullscreen], [ar, words.ar]])) {
      button.setAttribute('aria-label', label);
      button.title = label;
    }
    cancel.textContent = words.cancel;
    retry.textContent = words.retry;
    errorMore.textContent = words.details;
  }

  /** @param {string} src '' for none */
  setPoster(src) {
    const { image } = this.#parts;
    image.hidden = !src;
    if (src) image.src = src;
    else image.removeAttribute('src');
  }

  get hasPoster() {
    const { image, poster } = this.#parts;
    const slot = /** @type {HTMLSlotElement} */ (poster.firstElementChild);
    return !image.hidden || slot.assignedNodes().length > 0;
  }

  /** @param {boolean} shown */
  showPoster(shown) {
    this.#parts.poster.classList.toggle('gone', !shown);
  }

  /** A job has begun. */
  begin() {
    const { bar, progress } = this.#parts;
    this.end();
    this.hideError();
    bar.removeAttribute('value');
    this.#timer = window.setTimeout(() => (progress.hidden = false), PATIENCE_MS);
  }

  /** @param {string} words @param {number} share */
  progress(words, share) {
    this.#parts.progressText.textContent = words;
    if (share > 0) this.#parts.bar.value = share;
  }

  /** The focus does not get lost with the button that had it. */
  end() {
    const { canvas, cancel, progress } = this.#parts;
    clearTimeout(this.#timer);
    if (cancel.matches(':focus')) canvas.focus();
    progress.hidden = true;
  }

  /** @param {string} title @param {string} [text] */
  showError(title, text = '') {
    const { error, errorTitle, errorText, errorDetails } = this.#parts;
    errorTitle.textContent = title;
    errorText.textContent = text;
    errorDetails.hidden = !text;
    errorDetails.open = false;
    error.hidden = false;
  }

  hideError() {
    this.#parts.error.hidden = true;
  }

  /** What the toolbar takes of the picture's upper and lower half, in CSS pixels. */
  get room() {
    const { frame, toolbar, views, tools } = this.#parts;
    const { top, bottom } = frame.getBoundingClientRect();
    const boxes = toolbar.hidden ? [] : [views, tools].map((part) => part.getBoundingClientRect()).filter(({ height }) => height > BARE);
    const [above, below] = [true, false].map((wanted) => boxes.filter((box) => (box.top + box.bottom < top + bottom) === wanted));
    return {
      top: Math.max(0, ...above.map((box) => box.bottom - top + GAP)),
      bottom: Math.max(0, ...below.map((box) => bottom - box.top + GAP)),
    };
  }

  /**
   * @param {{ present: boolean, controls: boolean, turns: boolean, paused: boolean, views: View[], view: View }} state
   *   present: there is something to handle
   * @param {Words} words
   */
  showToolbar({ present, controls, turns, paused, views, view }, words) {
    const parts = this.#parts;
    parts.toolbar.hidden = !present || (!controls && !turns);
    for (const part of [parts.toolbar, parts.progress]) part.classList.toggle('bare', !controls);
    parts.views.hidden = !controls || views.length < 2;
    for (const choice of parts.choices) {
      choice.label.hidden = !views.includes(choice.view);
      choice.input.checked = choice.view === view;
    }
    parts.reset.hidden = !controls;
    parts.fullscreen.hidden = !controls || !document.fullscreenEnabled;
    parts.pause.hidden = !turns;
    setIcon(parts.pause, paused ? 'play' : 'pause');
    const label = paused ? words.play : words.pause;
    parts.pause.setAttribute('aria-label', label);
    parts.pause.title = label;
  }
}
