import { page } from '../page.js';
import { say } from '../words/say.js';
import { tinted } from './tint.js';

/**
 * @import { PointCloud, Step, StepReport } from 'pointweave'
 * @import { Look } from '../look/look.js'
 * @import { Scan, Session } from '../session/session.js'
 * @import { Tint } from './tint.js'
 *
 * Writes for the shown points from … to … which are meant: 1, the others stay 0. @typedef {(mask: Uint8Array, from: number, to: number) => void} Fill
 * What steps would do: what each saw, and which points would go. @typedef {{ reports: StepReport[], gone: Fill }} Trial
 * A tool of the page. `begin` shows what it would do, `steps` says it as steps of a recipe: `cut` is the second way, where a tool has two.
 * @typedef {{ begin: () => void, end: () => void, steps: (cut: boolean) => Step[] }} Tool
 */

/** Points that are coloured without a look at the clock. */
const SLICE = 1 << 15;
/** A task that takes longer, in milliseconds, lets others come between. */
const LONG = 10;

/** What a tool works with: the scan, a look at what steps would do, colours, and words over the picture. */
export class Bench {
  #session;
  #look;
  /** @type {() => Step[]} */
  #before;
  #words = page.tidyWords;
  #buttons = [page.tidyApply, page.tidyCut];
  /** @type {AbortController | null} */
  #trial = null;
  /** The colours that were asked for last. @type {object | null} */
  #wanted = null;
  /** Ends with the colours that are being made. @type {Promise<unknown>} */
  #making = Promise.resolve();
  /** Goes up when a tool is put away. */
  #age = 0;

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

  /** The index in the file of a point that is shown. */
  get indexOf() {
    const { kept } = this.scan;
    return (/** @type {number} */ i) => (kept ? kept[i] : i);
  }

  /** What the steps would do after those of the recipe; null where another look has begun, or they would leave nothing. @param {Step[]} steps @returns {Promise<Trial | null>} */
  async try(steps) {
    this.#trial?.abort();
    const { signal } = (this.#trial = new AbortController());
    const before = this.#before();
    this.say(say('Looking…'), false);
    try {
      const { labels, steps: all } = await this.#session.tried([...before, ...steps], signal);
      if (signal.aborted) return null;
      const { indexOf } = this;
      /** @type {Fill} */
      const gone = (mask, from, to) => {
        for (let i = from; i < to; i++) if (labels[indexOf(i)] > before.length) mask[i] = 1;
      };
      return { reports: all.slice(before.length), gone };
    } catch (error) {
      if (!signal.aborted) this.say(refusal(error), false);
      return null;
    }
  }

  /**
   * Colours the points that are meant, in short tasks, and says how many they are; null where that is not wanted any more. Of what is
   * asked for meanwhile, the last is done next.
   * @param {Fill} fill
   * @param {Tint} [tint] by default that of what would go
   * @returns {Promise<number | null>}
   */
  async show(fill, tint = tinted(this.scan.cloud, 'gone')) {
    const wanted = (this.#wanted = {});
    const age = this.#age;
    await this.#making;
    if (wanted !== this.#wanted || age !== this.#age) return null;
    const made = this.#color(fill, tint);
    this.#making = made;
    const { colors, count } = await made;
    if (age !== this.#age) return null;
    this.#look.mark(colors);
    return count;
  }

  /** @param {Fill} fill @param {Tint} tint */
  async #color(fill, tint) {
    const age = this.#age;
    const all = this.scan.count;
    const [mask, colors] = [new Uint8Array(all), new Uint8Array(3 * all)];
    let [count, since] = [0, performance.now()];
    for (let from = 0; from < all && age === this.#age; from += SLICE) {
      const to = Math.min(all, from + SLICE);
      fill(mask, from, to);
      for (let i = from; i < to; i++) count += mask[i];
      tint(colors, mask, from, to);
      if (performance.now() - since < LONG) continue;
      await new Promise((next) => setTimeout(next));
      since = performance.now();
    }
    return { colors, count };
  }

  /** Says what would happen, and whether that can be done. @param {string} words @param {boolean} ready */
  say(words, ready) {
    this.#words.textContent = words;
    for (const button of this.#buttons) button.disabled = !ready;
  }

  /** Nothing is looked at any more. */
  stop() {
    this.#trial?.abort();
    this.#age++;
  }
}

/** Why steps cannot be done, in words. @param {any} error */
export function refusal(error) {
  return error?.code === 'bad-option' ? say('Nothing would be left.') : String(error?.message ?? error);
}

/** What is labelled with one of these numbers, of so many. @param {(point: number) => number} labelOf @param {Set<number>} these @param {number} count @returns {Fill} */
export function among(labelOf, these, count) {
  const known = new Uint8Array(count);
  for (const label of these) known[label] = 1;
  return (mask, from, to) => {
    for (let i = from; i < to; i++) mask[i] = known[labelOf(i)] ?? 0;
  };
}
