import { createEngine, prepare } from 'pointweave';

/**
 * @import { PointCloud, Prepared, Step, StepReport } from 'pointweave'
 * @typedef {{ signal?: AbortSignal, onProgress?: (progress: import('pointweave').Progress) => void }} Watch
 * What a recipe is done to: a cloud, and the scans that it was put together of, where there are several.
 * @typedef {{ cloud: PointCloud, clouds?: PointCloud[] }} Whole
 */

/** What recipes made last stays, so that undo and redo are at once. */
const MOST = 4;
/** Stands for a point that a step did not see. */
const UNSEEN = 2 ** 32 - 1;

/** Several scans as they lie as one. @param {PointCloud[]} clouds @param {AbortSignal} signal */
export async function prepareTogether(clouds, signal) {
  return (await prepare(clouds, [], { signal })).cloud;
}

/** What recipes leave of a scan. In an engine of its own: a look at what would go does not wait for a mesh that is being made. */
export class Preparing {
  /** @type {PointCloud | null} */
  #cloud = null;
  /** By recipe, the newest last. @type {Map<string, Prepared<any>>} */
  #known = new Map();
  /** @type {Promise<import('pointweave').Engine> | null} */
  #engine = null;

  /**
   * @param {Whole} whole
   * @param {Step[]} steps
   * @param {Watch} [watch]
   * @returns {Promise<Prepared<any>>}
   */
  async of(whole, steps, watch = {}) {
    const { cloud } = whole;
    if (cloud !== this.#cloud) this.#known.clear();
    this.#cloud = cloud;
    // Which way is up tells what a floor is.
    const key = JSON.stringify([steps, cloud.up]);
    const known = this.#known.get(key);
    if (known) this.#known.delete(key);
    const prepared = known ?? await this.#make(whole, steps, watch);
    if (cloud !== this.#cloud) return prepared;
    this.#known.set(key, prepared);
    for (const old of this.#known.keys()) if (this.#known.size > MOST) this.#known.delete(old);
    return prepared;
  }

  /** Scans are registered once, whatever is done then. @param {Whole} whole @param {Step[]} steps @param {Watch} watch @returns {Promise<Prepared<any>>} */
  async #make(whole, steps, watch) {
    const { cloud, clouds } = whole;
    const [first, ...rest] = steps;
    if (!clouds || first?.step !== 'register') return this.once(cloud, steps, watch);
    if (!rest.length) return this.once(clouds, steps, watch);
    const registered = await this.of(whole, [first], watch);
    return oneAfterOther(registered, await this.once({ ...registered.cloud, up: cloud.up }, rest, watch));
  }

  /** The same of a cloud that is forgotten. @param {PointCloud | PointCloud[]} cloud @param {Step[]} steps @param {Watch} [watch] */
  async once(cloud, steps, watch = {}) {
    this.#engine ??= createEngine();
    return (await this.#engine).prepare(/** @type {PointCloud} */ (cloud), steps, watch);
  }
}

/** What two recipes did, the second to what the first left, told of the points that the first was given. @param {Prepared<any>} first @param {Prepared<any>} second @returns {Prepared<any>} */
function oneAfterOther({ kept, labels, steps }, second) {
  const all = labels.slice();
  second.labels.forEach((label, k) => (all[kept[k]] = label && label + steps.length));
  const spread = (/** @type {Uint32Array} */ own) => {
    const each = new Uint32Array(labels.length).fill(UNSEEN);
    own.forEach((value, k) => (each[kept[k]] = value));
    return each;
  };
  const told = (/** @type {StepReport} */ report) => ({ ...report, ...(report.labels && { labels: spread(report.labels) }) });
  return { cloud: second.cloud, kept: second.kept.map((k) => kept[k]), labels: all, steps: [...steps, ...second.steps.map(told)] };
}
