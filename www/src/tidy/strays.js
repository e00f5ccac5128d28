import { page } from '../page.js';
import * as format from '../results/format.js';
import { say } from '../words/say.js';

/** @import { Step } from 'pointweave' */
/** @import { Bench } from './bench.js' */

/** Removes points that belong to nothing: isolated ones, and those that fly at the edges of things. */
export class Strays {
  #bench;
  #box = page.tidyStrays;
  #kinds = /** @type {['outliers' | 'flying', HTMLInputElement][]} */ ([
    ['outliers', page.tidyOutliers], ['flying', page.tidyFlying],
  ]);

  constructor(/** @type {Bench} */ bench) {
    this.#bench = bench;
    for (const [, check] of this.#kinds) check.addEventListener('change', () => this.begin());
  }

  async begin() {
    this.#box.hidden = false;
    const trial = await this.#bench.try(this.steps());
    if (!trial) return;
    const count = await this.#bench.show(trial.gone);
    if (count === null) return;
    this.#bench.say(count ? say('{points} would go.', { points: format.points(count) }) : say('There are no such points in this scan.'), count > 0);
  }

  end() {
    this.#box.hidden = true;
  }

  /** @returns {Step[]} */
  steps() {
    return this.#kinds.filter(([, check]) => check.checked).map(([step]) => ({ step }));
  }
}
