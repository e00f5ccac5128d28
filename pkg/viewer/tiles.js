/**
 * A tileset that streams: which of its tiles are drawn follows from the camera, by 3d-tiles-renderer. This file makes that renderer keep to
 * what a viewer promises: coordinates in the viewer's frame, its materials, at most so many bytes and so many draw calls. Where the error
 * that is asked for would need more of either, it is larger for as long as that lasts.
 */
import { Box3, Matrix4, Points } from 'three';
import { PointweaveError } from '../engine/errors.js';
import { badInput } from '../engine/inputs.js';
import { Fades } from './fade.js';
import { ITSELF, frameBetween, joined } from './frame.js';
import { placedPositions } from './glb.js';
import { bytesOf, dress, loading, objectsOf, texturesOf } from './tile-content.js';
import { tilesPackage } from './tiles-package.js';
import { fetchTileset, spacingOf } from './tileset.js';
import { calm } from './watching.js';

/**
 * @import { Mesh, PerspectiveCamera } from 'three'
 * @import { Frame, StreamOptions, StreamState } from '../viewer.js'
 * @import { Stage } from './stage.js'
 */

export const BUDGET = 2 ** 28;
/** Least budget: one tile has to fit. */
const LEAST_BUDGET = 2 ** 20;
/** Objects that are drawn at once; the depth pass and boxes are the rest of 200 draw calls. */
const MOST_OBJECTS = 190;
const DOWNLOADS = 6;
/** Tiles whose downloads are read at once. */
const PARSED = 4;
/** So often a download is tried, after so long; twice as long each time. */
const TRIES = 3;
const PAUSE_MS = 400;
/** In CSS pixels: between points, of meshes whose error is the distance of their vertices, and as most tilesets are made for. */
const ERRORS = { points: 2, mesh: 6, other: 16 };
/** So much coarser it becomes at a time, for lack of room. */
const STEP = 1.15;
/** Nearer than so many finest distances between points there is nothing to see. */
const NEAR_SPACINGS = 25;
const NEAREST = { least: 1e-5, most: 0.02 };
/** Enough vertices to know how large something looks. */
const OUTLINE = 4096;

/** Who hears that another picture is needed, that the first is there to be looked at, and of a new state. @typedef {{ changed: () => void, began: () => void, told: () => void }} Hearer */

export class Tiles {
  /** The box of the root, in the tileset's frame. @type {Frame} */
  frame = ITSELF;
  /** A few points of what is there, in the frame. */
  outline = new Float32Array();
  /** How near one may come, in the frame. */
  nearest = NEAREST.most;
  up = /** @type {[number, number, number]} */ ([0, 0, 1]);
  /** Something in it has a material that is lit. */
  lit = false;
  /** Of which kind the first is that came. @type {'points' | 'mesh' | undefined} */
  kind;
  #renderer;
  #stage;
  #fades = new Fades(calm().wanted);
  #tileset;
  #budget;
  /** @type {number | undefined} */
  #asked;
  /** How many times larger the error is than it should be, for lack of room. */
  #strain = 1;
  /** Bytes of the tiles that are here. @type {Map<object, number>} */
  #sizes = new Map();
  #held = 0;
  /** Bytes of the largest tile so far: so much is kept free for each that is under way. */
  #largest = 0;
  #seen = '';
  #said = '';
  #hearer;
  /** @type {{ resolve: () => void, reject: (error: unknown) => void }} */
  #waiting = { resolve() {}, reject() {} };

  /**
   * Fetches the tileset, not yet its tiles.
   * @param {string} url
   * @param {StreamOptions & { signal: AbortSignal }} options
   * @param {Stage} stage
   * @param {Hearer} hearer
   */
  static async open(url, { budget = BUDGET, errorTarget, onProgress = () => {}, signal }, stage, hearer) {
    if (!(budget >= LEAST_BUDGET)) throw badInput('budget', `at least ${LEAST_BUDGET} bytes`, budget);
    if (errorTarget !== undefined && !(errorTarget > 0)) throw badInput('errorTarget', 'a number of pixels above 0', errorTarget);
    const address = new URL(url, document.baseURI).href;
    const watch = { signal, onProgress: (/** @type {number} */ share) => onProgress(share / 2) };
    const [parts, manager, tileset] = await Promise.all([tilesPackage(), loading(), fetchTileset(address, watch)]);
    const tiles = new Tiles(parts, tileset, { address, manager, budget, errorTarget, stage, hearer });
    await tiles.#begin();
    return tiles;
  }

  /**
   * @param {import('./tiles-package.js').Package} parts
   * @param {import('./tileset.js').Tileset} tileset
   * @param {{ address: string, manager: import('three').LoadingManager, budget: number, errorTarget?: number, stage: Stage, hearer: Hearer }} options
   */
  constructor({ TilesRenderer, LRUCache, DownloadPriorityQueue, PriorityQueue }, tileset, { address, manager, budget, errorTarget, stage, hearer }) {
    const renderer = (this.#renderer = /** @type {any} */ (new TilesRenderer(address)));
    this.#tileset = tileset;
    this.#budget = budget;
    this.#asked = errorTarget;
    this.#stage = stage;
    this.#hearer = hearer;
    // By default all tilesets of a page share a cache and queues.
    const { lruCache, downloadQueue, parseQueue } = renderer;
    renderer.lruCache = Object.assign(new LRUCache(), { unloadPriorityCallback: lruCache.unloadPriorityCallback, minSize: 0, maxSize: Infinity, unloadPercent: 0.5 });
    renderer.downloadQueue = Object.assign(new DownloadPriorityQueue(), { priorityCallback: downloadQueue.priorityCallback, maxJobsPerOrigin: DOWNLOADS });
    renderer.parseQueue = Object.assign(new PriorityQueue(), { priorityCallback: parseQueue.priorityCallback, maxJobs: PARSED });
    renderer.manager = manager;
    renderer.calculateBytesUsed = (/** @type {any} */ tile) => this.#sizeOf(tile);
    // It warns of every tileset of version 1.1, and does no more.
    renderer.preprocessTileset = (/** @type {any} */ { root }, /** @type {string} */ url, parent = null) =>
      renderer.preprocessNode(root, new URL('.', url).href.replace(/\/$/, ''), parent);
    renderer.registerPlugin(this.#fades);
    renderer.registerPlugin({
      name: 'POINTWEAVE_TILES',
      fetchData: async (/** @type {string} */ url, /** @type {RequestInit} */ options) => (url === address ? tileset : fetchPatiently(url, options)),
      processTileModel: (/** @type {any} */ scene, /** @type {any} */ tile) => this.#receive(scene, tile),
      disposeTile: (/** @type {any} */ tile) => this.#forget(tile),
    });
    renderer.addEventListener('tile-visibility-change', (/** @type {any} */ { scene, visible }) => this.#show(scene, visible));
    renderer.addEventListener('load-model', (/** @type {any} */ { tile }) => this.#welcome(tile));
    renderer.addEventListener('load-error', (/** @type {any} */ { tile, error }) => this.#miss(tile, error));
    renderer.addEventListener('needs-update', () => this.#hearer.changed());
    this.#makeRoom();
  }

  /** Has the root's box found. */
  async #begin() {
    const renderer = this.#renderer;
    const there = new Promise((resolve, reject) => {
      renderer.addEventListener('load-root-tileset', resolve);
      renderer.addEventListener('load-error', (/** @type {any} */ { tile, error }) => tile ?? reject(error));
    });
    renderer.update();
    await there;
    const box = new Box3();
    renderer.getBoundingBox(box);
    const { min, max } = box;
    this.frame = frameBetween(/** @type {[number, number, number]} */ (min.toArray()), /** @type {[number, number, number]} */ (max.toArray()));
    const { center, size, diagonal } = this.frame;
    this.outline = Float32Array.from({ length: 24 }, (_, i) => ((Math.floor(i / 3) >> i % 3) & 1 ? 0.5 : -0.5) * size[i % 3] / diagonal);
    this.nearest = Math.min(NEAREST.most, Math.max(NEAREST.least, (NEAR_SPACINGS * spacingOf(this.#tileset)) / diagonal));
    // A region is a part of the Earth, which is told from its centre.
    if ('region' in (this.#tileset.root.boundingVolume ?? {})) this.up = /** @type {[number, number, number]} */ (center.map((x) => x / Math.hypot(...center)));
    const { group } = renderer;
    group.scale.setScalar(1 / diagonal);
    group.position.set(...center).divideScalar(-diagonal);
    this.#stage.root.add(group);
    group.updateWorldMatrix(true, false);
  }

  /** Resolves when something is there to be seen. @returns {Promise<void>} */
  get there() {
    return this.kind ? Promise.resolve() : new Promise((resolve, reject) => (this.#waiting = { resolve, reject }));
  }

  /** @returns {StreamState} */
  get state() {
    const { stats, lruCache } = this.#renderer;
    let [points, triangles] = [0, 0];
    for (const [name, { objects }] of this.#stage.layers) {
      for (const { geometry } of objects) {
        const vertices = geometry.getAttribute('position');
        if (name === 'points') points += vertices.count;
        else triangles += (geometry.index ?? vertices).count / 3;
      }
    }
    const { points: all = null, reduced: total = all } = this.#tileset.asset.extras?.pointweave ?? {};
    const loading = stats.queued + stats.downloading + stats.parsing;
    return {
      points, triangles, total, bytes: this.#held, budget: this.#budget, tiles: this.#renderer.visibleTiles.size, held: lruCache.loadedSet.size,
      loading, failed: stats.failed, error: this.#error,
    };
  }

  /** What is asked for, in CSS pixels. */
  get errorTarget() {
    const own = this.#tileset.asset.extras?.pointweave;
    return this.#asked ?? (own && this.kind ? ERRORS[this.kind] : ERRORS.other);
  }

  get #error() {
    return this.errorTarget * this.#strain;
  }

  /**
   * Chooses the tiles for the next picture.
   * @param {PerspectiveCamera} camera
   * @param {{ width: number, height: number, ratio: number }} size
   */
  update(camera, { width, height, ratio }) {
    if (!width || !height) return;
    const renderer = this.#renderer;
    camera.updateMatrixWorld();
    this.#stage.root.updateMatrixWorld();
    renderer.setCamera(camera);
    renderer.setResolution(camera, width / ratio, height / ratio);
    this.#relax(`${camera.matrixWorld.elements} ${camera.projectionMatrix.elements}`);
    const waits = !this.kind;
    this.#choose();
    if (waits && this.kind) {
      this.#look();
      this.#hearer.began();
    }
    for (let i = 0; i < 40 && this.#objects > MOST_OBJECTS; i++) {
      this.#fades.hurry();
      if (this.#objects <= MOST_OBJECTS) break;
      this.#strain *= STEP;
      this.#choose();
    }
    const { refused } = renderer.stats;
    if (refused && this.#largest && this.#used > 0.75 * this.#room) this.#strain *= STEP;
    // After the last step comes one more picture, which tells what is left.
    const fading = this.#fades.running;
    this.#fades.step();
    if (refused || fading) this.#hearer.changed();
    this.#tell();
  }

  #choose() {
    this.#renderer.errorTarget = this.#error;
    this.#renderer.update();
  }

  /** Elsewhere less may be needed. @param {string} view */
  #relax(view) {
    if (view === this.#seen) return;
    this.#seen = view;
    if (this.#strain > 1 && this.#used < 0.6 * this.#room && this.#objects < 0.6 * MOST_OBJECTS) this.#strain = Math.max(1, this.#strain / STEP);
  }

  get #objects() {
    return [...this.#stage.layers.values()].reduce((sum, { objects }) => sum + objects.length, 0);
  }

  /** Bytes of what the last choice needs, and of what is under way. */
  get #used() {
    const { usedSet, bytesMap } = this.#renderer.lruCache;
    let bytes = 0;
    for (const tile of usedSet) bytes += bytesMap.get(tile) ?? 0;
    return bytes;
  }

  /** Bytes up to which more is fetched. */
  get #room() {
    return Math.max(1, this.#budget - this.#largest);
  }

  #makeRoom() {
    Object.assign(this.#renderer.lruCache, { maxBytesSize: this.#room, minBytesSize: 0.7 * this.#room });
  }

  /** Of a tile; while it is under way, of the largest so far. @param {any} tile */
  #sizeOf(tile) {
    if (tile.internal.hasUnrenderableContent) return 0;
    return this.#sizes.get(tile) ?? (this.#largest || this.#budget / 64);
  }

  /** A tile was read. @param {import('three').Object3D} scene @param {any} tile */
  #receive(scene, tile) {
    const { spacing } = this.#tileset.asset.extras?.pointweave ?? {};
    dress(scene, this.frame.diagonal, spacing && (tile.geometricError || spacing));
    const bytes = bytesOf(scene);
    if (bytes > this.#largest) {
      this.#largest = bytes;
      this.#makeRoom();
      for (const other of this.#renderer.loadingTiles) this.#renderer.lruCache.setMemoryUsage(other, bytes);
    }
    if (bytes > this.#budget) throw new Error(`a tile has ${bytes} bytes, and the budget is ${this.#budget}`);
    if (this.#held + bytes > this.#budget) {
      this.#strain *= STEP;
      throw new DOMException('there is no room', 'AbortError'); // it is fetched again should it still be wanted
    }
    this.#sizes.set(tile, bytes);
    this.#held += bytes;
  }

  /** @param {any} tile */
  #forget(tile) {
    this.#held -= this.#sizes.get(tile) ?? 0;
    if (!this.#sizes.delete(tile)) this.#hearer.changed(); // it was under way, and may be wanted again
  }

  /** A tile is there. @param {any} tile */
  #welcome({ engineData }) {
    const objects = objectsOf(engineData.scene);
    // The studio's light is the page's: it stays when a tile goes.
    engineData.textures = objects.flatMap(({ material }) => texturesOf(material));
    this.lit ||= objects.some(({ material }) => [material].flat().some((one) => 'roughness' in one));
  }

  /** A tile does not load: the one that it is a part of stays as it is. @param {any} tile @param {unknown} error */
  #miss(tile, error) {
    if (!tile) return;
    this.#renderer.lruCache.setMemoryUsage(tile, 0);
    if (tile.parent) tile.parent.geometricError = 0;
    const { stats } = this.#renderer;
    if (this.kind || stats.queued + stats.downloading + stats.parsing > 0) return this.#hearer.changed();
    const why = error instanceof Error ? error.message : String(error);
    this.#waiting.reject(new PointweaveError({ code: 'load-failed', message: `no tile did load: ${why}` }));
  }

  /** @param {import('three').Object3D | null} scene @param {boolean} visible */
  #show(scene, visible) {
    if (!scene) return;
    for (const object of objectsOf(scene)) {
      const name = object instanceof Points ? 'points' : 'mesh';
      if (!visible) this.#stage.leave(name, object);
      else {
        if (!this.#stage.layers.has(name)) this.#stage.open(name, this.outline);
        this.#stage.enter(name, object);
        this.kind ??= name;
      }
    }
    if (visible && this.kind) this.#waiting.resolve();
  }

  /** A few of the vertices that are seen. */
  #look() {
    const objects = [...this.#stage.layers.values()].flatMap(({ objects }) => objects);
    const toFrame = new Matrix4().copy(this.#stage.root.matrixWorld).invert();
    this.outline = joined(objects.map((object) =>
      placedPositions(object, OUTLINE / objects.length, toFrame.clone().multiply(object.matrixWorld))));
  }

  /** Says what is shown, where that is something else than before. */
  #tell() {
    const said = JSON.stringify(this.state);
    if (said === this.#said) return;
    this.#said = said;
    this.#hearer.told();
  }

  /** Nothing stays on the GPU; it comes back with the next picture. */
  free() {
    this.#renderer.forEachLoadedModel((/** @type {import('three').Object3D} */ scene) => {
      for (const { geometry, material } of objectsOf(scene)) {
        geometry.dispose();
        for (const texture of texturesOf(material)) texture.dispose();
        for (const one of [material].flat()) one.dispose();
      }
    });
  }

  dispose() {
    this.#waiting.reject(new DOMException('the viewer shows something else', 'AbortError'));
    this.#renderer.dispose();
    for (const name of ['points', 'mesh']) if (this.#stage.layers.get(name)?.streamed) this.#stage.layers.delete(name);
  }
}

/** Not every failure lasts. @param {string} url @param {RequestInit} options */
async function fetchPatiently(url, options) {
  for (let left = TRIES - 1, pause = PAUSE_MS; ; left--, pause *= 2) {
    try {
      const response = await fetch(url, options);
      if (left === 0 || (response.status < 500 && response.status !== 429)) return response;
    } catch (error) {
      if (left === 0 || options.signal?.aborted) throw error;
    }
    await new Promise((next) => setTimeout(next, pause));
  }
}
