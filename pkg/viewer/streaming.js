/** What of a viewer streams: a tileset, one at a time, in the place of what else it shows. */
import { Aimed } from './aimed.js';

/** @import { StreamOptions } from '../viewer.js' */
/** @import { Tiles } from './tiles.js' */

export class Streaming extends Aimed {
  /** @type {Tiles | null} */
  tiles = null;
  /** Whether anything in it has a material that is lit. */
  lit = false;
  #stage;
  /** Ends when something else is shown. */
  #turn = new AbortController();

  /**
   * @param {import('./stage.js').Stage} stage
   * @param {HTMLElement} element takes the pointer
   * @param {boolean} embedded
   * @param {(by: import('../viewer.js').Mover) => void} changed
   */
  constructor(stage, element, embedded, changed) {
    super(stage, element, embedded, changed);
    this.#stage = stage;
  }

  /** @param {string} url @param {StreamOptions} [options] */
  async stream(url, { signal, ...options } = {}) {
    this.clear();
    const turn = this.#turn;
    const end = () => turn === this.#turn && this.clear();
    signal?.addEventListener('abort', end);
    try {
      signal?.throwIfAborted();
      const { Tiles } = await import('./tiles.js');
      const hearer = { changed: () => this.#changed(), began: () => this.#begun(), told: () => this.dispatchEvent(new Event('stream')) };
      const tiles = await Tiles.open(url, { ...options, signal: turn.signal }, this.#stage, hearer);
      if (turn.signal.aborted) tiles.dispose();
      turn.signal.throwIfAborted();
      this.tiles = tiles;
      this.begin(tiles);
      await tiles.there;
      options.onProgress?.(1);
    } catch (error) {
      signal?.throwIfAborted();
      turn.signal.throwIfAborted();
      this.clear();
      throw error;
    } finally {
      signal?.removeEventListener('abort', end);
    }
  }

  /** Goes on with the next picture; what is not seen yet begins all the same. */
  #changed() {
    this.ask();
    if (!this.tiles?.kind) requestAnimationFrame(() => this.tiles?.kind ?? this.advance());
  }

  /** The first that came says more closely where all of it is, before it is drawn. */
  #begun() {
    if (!this.tiles) return;
    this.begin(this.tiles);
    this.orbit.update(performance.now());
  }

  /** Chooses what the next picture needs. */
  advance() {
    const { tiles } = this;
    if (!tiles) return;
    this.orbit.update(performance.now());
    tiles.update(this.camera, this);
    this.lit = tiles.lit;
  }

  get streamed() {
    return this.tiles?.state ?? null;
  }

  /** Something else is shown, or nothing. */
  endStream() {
    this.#turn.abort(new DOMException('the viewer shows something else', 'AbortError'));
    this.#turn = new AbortController();
    this.tiles?.dispose();
    this.tiles = null;
  }

  /** The viewer asks for a new picture. */
  ask() {}

  /** Looks at what begins to stream. @param {Tiles} tiles */
  begin(tiles) {
    void tiles;
  }

  clear() {
    this.endStream();
  }
}
