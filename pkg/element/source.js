/**
 * What a `src` holds, and what has been made of it so far. A GLB is shown as it is, a tileset streams; everything else is a scan, for
 * the package to read, and what a view needs of it is computed when the view is wanted.
 */
import { sharedEngine } from './engines.js';
import { fetchBytes } from '../viewer/fetching.js';
import { inTurn } from './turns.js';

/** @import { EngineOptions, Orientation, PointCloud, ReducedCloud, SurfaceMesh, Target } from '../types.js' */
/** @import { Stage, View } from '../element.js' */

/**
 * How work is done and watched.
 * @typedef {object} Work
 * @property {AbortSignal} signal
 * @property {(stage: Stage, share: number) => void} onProgress the share of the whole that is done
 * @property {() => boolean} seen
 * @property {EngineOptions} engine
 */

/** What is asked for. @typedef {{ target?: Target, orientation: Orientation, flip: boolean }} Wish */

/** @param {import('./attributes.js').Reflecting} asked @returns {Wish} */
export function wishOf({ count, ratio, orientation, flip }) {
  const target = count !== null ? { count } : ratio !== null ? { ratio } : undefined;
  return { target, orientation, flip };
}

/** What share of the whole each part takes, about. */
const FETCHED = { glb: 0.9, points: 0.7, computed: 0.2 };
const READ = { points: 1, computed: 0.3 };

/** @typedef {{ kind: 'glb', bytes: Uint8Array<ArrayBuffer> }} Glb */
/** The viewer fetches it. @typedef {{ kind: 'tiles' }} Tileset */

export class Scan {
  kind = /** @type {const} */ ('scan');
  /** @type {PointCloud} */
  cloud;
  /** @type {ReducedCloud | undefined} */
  reduced;
  /** @type {SurfaceMesh | undefined} */
  mesh;
  /** The share of the work that came before: all of it is 1. */
  #done;

  /** @param {PointCloud} cloud @param {number} done */
  constructor(cloud, done) {
    this.cloud = cloud;
    this.#done = done;
  }

  /** @param {View} view */
  of(view) {
    return view === 'points' ? this.cloud : this[view];
  }

  /** Another target, another result. */
  forget() {
    this.reduced = this.mesh = undefined;
  }

  /**
   * Computes what a view needs. A mesh brings its reduced cloud along.
   * @param {View} view
   * @param {Wish} wish
   * @param {Work} work
   */
  async make(view, { target = 'auto', ...side }, work) {
    const { signal, onProgress, seen } = work;
    const before = this.#done;
    this.#done = 0;
    const options = {
      signal,
      onProgress: (/** @type {import('../types.js').Progress} */ { stage, overall }) => onProgress(stage, before + (1 - before) * overall),
    };
    await inTurn({ seen, signal }, async () => {
      const engine = await sharedEngine(work.engine);
      signal.throwIfAborted();
      if (view === 'reduced') {
        this.reduced = await engine.reduce(this.cloud, { target, ...options });
      } else {
        this.mesh = await engine.reconstruct(this.cloud, { reduce: { target }, ...side, ...options });
        this.reduced = this.mesh.cloud;
      }
    });
  }
}

/**
 * Fetches and reads.
 * @param {string} src
 * @param {View} view what will be wanted of it
 * @param {Work} work
 * @returns {Promise<Glb | Tileset | Scan>}
 */
export async function openSource(src, view, { signal, onProgress, engine: options }) {
  if (/\.json$/i.test(nameOf(src))) return { kind: 'tiles' };
  const likely = isNamedGlb(src) ? 'glb' : view === 'points' ? 'points' : 'computed';
  onProgress('fetch', 0);
  const bytes = await fetchBytes(src, { signal, onProgress: (fraction) => onProgress('fetch', FETCHED[likely] * fraction) });
  if (isGlb(bytes)) {
    onProgress('read', FETCHED.glb);
    return { kind: 'glb', bytes: /** @type {Uint8Array<ArrayBuffer>} */ (bytes) };
  }
  if (bytes[0] === 0x7b) return { kind: 'tiles' }; // {: no format of scans begins so
  const kind = view === 'points' ? 'points' : 'computed';
  onProgress('read', FETCHED[kind]);
  const engine = await sharedEngine(options);
  signal.throwIfAborted();
  const cloud = await engine.read(bytes, {
    name: nameOf(src),
    signal,
    transfer: true,
    onProgress: ({ overall }) => onProgress('read', FETCHED[kind] + (READ[kind] - FETCHED[kind]) * overall),
  });
  return new Scan(cloud, READ[kind]);
}

/**
 * Puts it into the viewer; of a scan its points.
 * @param {import('../viewer.js').Viewer} viewer
 * @param {Glb | Tileset | Scan} source
 * @param {string} src
 * @param {Work} work
 */
export async function showSource(viewer, source, src, { signal, onProgress }) {
  if (source.kind === 'tiles') return viewer.stream(src, { signal, onProgress: (share) => onProgress('fetch', share) });
  const shown = source.kind === 'glb' ? await (await import('../viewer/glb.js')).readGlb(source.bytes) : { ...source.cloud, normals: undefined };
  signal.throwIfAborted();
  viewer.show(shown);
}

/** What is named so is likely to be one. @param {string} src */
export function isNamedGlb(src) {
  return /\.glb$/i.test(nameOf(src));
}

/** The four bytes that every GLB begins with. @param {Uint8Array} bytes */
function isGlb(bytes) {
  return bytes[0] === 0x67 && bytes[1] === 0x6c && bytes[2] === 0x54 && bytes[3] === 0x46;
}

/** The last part of the path, where a file's extension is. @param {string} src */
function nameOf(src) {
  const { pathname } = new URL(src, document.baseURI);
  const last = pathname.slice(pathname.lastIndexOf('/') + 1);
  try {
    return decodeURIComponent(last);
  } catch {
    return last; // a lone % is no escape
  }
}
