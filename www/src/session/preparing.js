import { createEngine } from 'pointweave';

/**
 * @import { PointCloud, Prepared, Step } from 'pointweave'
 * @typedef {{ signal?: AbortSignal, onProgress?: (progress: import('pointweave').Progress) => void }} Watch
 */

/** What recipes made last stays, so that undo and redo are at once. */
const MOST = 4;

/** What recipes leave of a scan. In an engine of its own: a look at what would go does not wait for a mesh that is being made. */
export class Preparing {
  /** @type {PointCloud | null} */
  #cloud = null;
  /** By recipe, the newest last. @type {Map<string, Prepared<any>>} */
  #known = new Map();
  /** @type {Promise<import('pointweave').Engine> | null} */
  #engine = null;

  /**
   * @param {PointCloud} cloud
   * @param {Step[]} steps
   * @param {Watch} [watch]
   * @returns {Promise<Prepared<any>>}
   */
  async of(cloud, steps, watch = {}) {
    if (cloud !== this.#cloud) this.#known.clear();
    this.#cloud = cloud;
    // Which way is up tells what a floor is.
    const key = JSON.stringify([steps, cloud.up]);
    const known = this.#known.get(key);
    if (known) this.#known.delete(key);
    const prepared = known ?? await this.once(cloud, steps, watch);
    if (cloud !== this.#cloud) return prepared;
    this.#known.set(key, prepared);
    for (const old of this.#known.keys()) if (this.#known.size > MOST) this.#known.delete(old);
    return prepared;
  }

  /** The same of a cloud that is forgotten. @param {PointCloud} cloud @param {Step[]} steps @param {Watch} [watch] */
  async once(cloud, steps, watch = {}) {
    this.#engine ??= createEngine();
    return (await this.#engine).prepare(cloud, steps, watch);
  }
}
