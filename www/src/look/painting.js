import { size } from './paint-words.js';

/**
 * @import { Paint, PaintName, Scale, Subject } from 'pointweave/viewer'
 * @typedef {Float32Array | Float64Array | Uint32Array | Uint16Array | Uint8Array} Numbers
 */

/** @type {Paint} */
const NONE = { colors: null, legend: null };
/** What no colours are made from. */
const UNUSED = new Set(['attributes', 'cells', 'colors', 'cloud', 'report', 'viewpoints', 'crs', 'file']);

/** Has colours made beside the page, which goes on meanwhile. */
export class Painting {
  /** @type {Worker | null} */
  #worker = null;
  /** Its program is there: what is sent before might be lost. @type {Promise<unknown>} */
  #ready = Promise.resolve();
  /** Arrays that the worker has. @type {Map<Numbers, number>} */
  #sent = new Map();
  #last = 0;
  /** Those who wait, by job. @type {Map<number, (made: any) => void>} */
  #waiting = new Map();
  /** Ends when all that was asked for is made. @type {Promise<unknown>} */
  #before = Promise.resolve();

  /** Forgets all of a scan. What was not made yet is never made. */
  reset() {
    this.#worker?.terminate();
    this.#worker = null;
    this.#sent.clear();
    this.#waiting.clear();
    this.#before = Promise.resolve();
  }

  /**
   * One after the other. Where they cannot be made there are none.
   * @param {PaintName} name
   * @param {'points' | 'reduced' | 'mesh'} layer
   * @param {Subject} subject
   * @param {() => boolean} wanted  whether they still are, when it is their turn
   * @returns {Promise<Paint | null>} null for those that are wanted no more
   */
  paint(name, layer, subject, wanted) {
    const made = this.#before.then(() => (wanted() ? this.#paint(name, layer, subject) : null)).catch(() => NONE);
    this.#before = made;
    return made;
  }

  /** @param {PaintName} name @param {'points' | 'reduced' | 'mesh'} layer @param {Subject} subject @returns {Promise<Paint>} */
  async #paint(name, layer, subject) {
    const worker = (this.#worker ??= this.#start());
    await this.#ready;
    /** @type {Map<Numbers, number>} */
    const live = new Map();
    const { cloud, ...rest } = subject;
    const plain = { ...this.#outline(rest, live), cloud: this.#outline(cloud, live) };
    for (const [array, id] of live) {
      if (this.#sent.get(array) === id) continue;
      this.#sent.set(array, id);
      // Each is copied in a task of its own, so that none is long.
      await new Promise((next) => setTimeout(next));
      if (worker !== this.#worker) return new Promise(() => {});
      worker.postMessage({ id, array });
    }
    for (const array of this.#sent.keys()) if (!live.has(array)) this.#sent.delete(array);
    const job = ++this.#last;
    const made = new Promise((/** @type {(made: any) => void} */ done) => this.#waiting.set(job, done));
    worker.postMessage({ job, name, layer, subject: plain, live: [...live.values()], scale: size.scale });
    const { colors, legend, texts } = await made;
    if (!texts) return { colors, legend };
    const words = new Map(texts);
    return { colors, legend: /** @type {Scale} */ ({ ...legend, words: (value) => words.get(value) }) };
  }

  #start() {
    const worker = new Worker(new URL('./paint-worker.js', import.meta.url), { type: 'module' });
    this.#ready = new Promise((ready, fail) => {
      worker.addEventListener('message', ready, { once: true });
      worker.addEventListener('error', fail, { once: true });
    });
    worker.addEventListener('error', () => {
      for (const done of this.#waiting.values()) done(NONE);
      this.reset();
    });
    worker.addEventListener('message', ({ data }) => {
      this.#waiting.get(data.job)?.(data);
      this.#waiting.delete(data.job);
    });
    return worker;
  }

  /** The same with the number of each array in its place. @param {any} value @param {Map<Numbers, number>} live @returns {any} */
  #outline(value, live) {
    if (ArrayBuffer.isView(value)) {
      const array = /** @type {Numbers} */ (value);
      const arrayId = live.get(array) ?? this.#sent.get(array) ?? ++this.#last;
      live.set(array, arrayId);
      return { arrayId };
    }
    if (typeof value !== 'object' || value === null || Array.isArray(value)) return value;
    return Object.fromEntries(Object.entries(value).filter(([key]) => !UNUSED.has(key)).map(([key, part]) => [key, this.#outline(part, live)]));
  }
}
