import { byId } from '../dom.js';
import { say } from '../words/say.js';
import { marked } from './tint.js';

/**
 * @import { PointCloud, Step, StepReport } from 'pointweave'
 * @import { Look } from '../look/look.js'
 * @import { Scan, Session } from '../session/session.js'
 *
 * What steps would do: what each saw, and which of the points that are shown would go (1) or stay (0).
 * @typedef {{ reports: StepReport[], gone: Uint8Array }} Trial
 * A tool of the page. `begin` shows what it would do, `steps` says it as steps of a recipe: `cut` is the second way, where a tool has two.
 * @typedef {{ begin: () => void, end: () => void, steps: (cut: boolean) => Step[] }} Tool
 */

/** What a tool works with: the scan, a look at what steps would do, colours, and words over the picture. */
export class Bench {
  #session;
  #look;
  /** @type {() => Step[]} */
  #before;
  #words = byId('tidy-words', HTMLElement);
  #buttons = [byId('tidy-apply', HTMLButtonElement), byId('tidy-cut', HTMLButtonElement)];
  /** @type {AbortController | null} */
  #trial = null;
  #frame = 0;

  /** @param {Session} session @param {Look} look @param {() => Step[]} before steps that are switched on */
  constructor(session, look, before) {
    this.#session = session;
    this.#look = look;
    this.#before = before;
  }

  /** What is left of the scan now. */
  get scan() {
    return /** @type {Scan} */ (this.#session.scan);
  }

  get aim() {
    return this.#look.aim;
  }

  /** What the steps would do after those of the recipe; null where another look has begun, or they would leave nothing. @param {Step[]} steps @returns {Promise<Trial | null>} */
  async try(steps) {
    this.stop();
    const { signal } = (this.#trial = new AbortController());
    const before = this.#before();
    this.say(say('Looking…'), false);
    try {
      const { labels, steps: all } = await this.#session.tried([...before, ...steps], signal);
      if (signal.aborted) return null;
      return { reports: all.slice(before.length), gone: this.shown(labels).map((by) => (by > before.length ? 1 : 0)) };
    } catch (error) {
      if (!signal.aborted) this.say(refusal(error), false);
      return null;
    }
  }

  /** Of values of all points of the file those of the points that are shown. @template {Uint8Array | Uint32Array} A @param {A} values @returns {A} */
  shown(values) {
    const { kept } = this.scan;
    return kept ? /** @type {A} */ (new /** @type {any} */ (values.constructor)(kept.length).map((/** @type {number} */ _, /** @type {number} */ i) => values[kept[i]])) : values;
  }

  /** Tints points that would go, or those that are chosen. @param {ArrayLike<number>} mask @param {'gone' | 'chosen'} [what] */
  mark(mask, what = 'gone') {
    this.color((cloud) => marked(cloud, mask, what));
  }

  /** Colours the points before the next picture. @param {(cloud: PointCloud) => Uint8Array} colors */
  color(colors) {
    cancelAnimationFrame(this.#frame);
    this.#frame = requestAnimationFrame(() => this.#look.mark(colors(this.scan.cloud)));
  }

  /** Says what would happen, and whether that can be done. @param {string} words @param {boolean} ready */
  say(words, ready) {
    this.#words.textContent = words;
    for (const button of this.#buttons) button.disabled = !ready;
  }

  /** Nothing is looked at any more. */
  stop() {
    this.#trial?.abort();
    cancelAnimationFrame(this.#frame);
  }
}

/** Why steps cannot be done, in words. @param {any} error */
export function refusal(error) {
  return error?.code === 'bad-option' ? say('Nothing would be left.') : String(error?.message ?? error);
}

/** How many of a mask. @param {Uint8Array} mask */
export function countOf(mask) {
  return mask.reduce((sum, value) => sum + value, 0);
}

/** For each label 1 where it is one of these, else 0. @param {Uint32Array} labels @param {Set<number>} these @param {number} count of labels that there are */
export function among(labels, these, count) {
  const known = new Uint8Array(count);
  for (const label of these) known[label] = 1;
  return new Uint8Array(labels.length).map((_, i) => known[labels[i]] ?? 0);
}
