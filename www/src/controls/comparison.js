import { announce } from '../dom.js';
import { page } from '../page.js';
import { drawChart } from './chart.js';
import * as format from '../results/format.js';
import { say } from '../words/say.js';

/**
 * @import { Outcome, Session } from '../session/session.js'
 * @import { Dot } from './chart.js'
 */

/** Shares of the points that are tried. */
const SHARES = [0.01, 0.025, 0.06, 0.15, 0.4];
/** Fewer points than this make no surface to speak of. */
const FEWEST = 200;

/** Error against count for this scan, so that one can choose by looking; made only when it is asked for. */
export class Comparison {
  #session;
  #choose;
  #fail;
  #box = page.comparison;
  #chart = page.chart;
  #note = page.chartNote;
  /** @type {Dot[]} */
  #dots = [];
  /** What the dots belong to. @type {import('../session/session.js').Scan | null} */
  #scan = null;
  #settings = '';
  #current = 0;

  /**
   * @param {Session} session
   * @param {(count: number) => void} choose
   * @param {(error: unknown) => void} fail
   */
  constructor(session, choose, fail) {
    this.#session = session;
    this.#choose = choose;
    this.#fail = fail;
    this.#box.addEventListener('toggle', () => (this.#box.open ? this.#fill() : session.stopComparing()));
  }

  /** A new result: its own dot is known for nothing. Dots of another scan, or of other settings, are forgotten. */
  made(/** @type {Outcome} */ outcome) {
    this.#box.hidden = !outcome.mesh;
    const settings = JSON.stringify(this.#session.settings.values);
    if (this.#scan !== outcome.scan || this.#settings !== settings) this.#dots = [];
    this.#scan = outcome.scan;
    this.#settings = settings;
    if (!outcome.mesh) return;
    const { outputPoints, distance } = outcome.mesh.report;
    this.#current = outputPoints;
    this.#add({ count: outputPoints, error: distance.rms });
    if (this.#box.open) this.#fill();
  }

  async #fill() {
    if (!this.#scan) return;
    const scan = this.#scan;
    const wanted = SHARES.map((share) => Math.round(share * scan.count))
      .filter((count) => count >= FEWEST && this.#dots.every((dot) => Math.abs(Math.log(dot.count / count)) > 0.4));
    this.#draw();
    let left = wanted.length;
    const note = () => (this.#note.textContent = left
      ? say('Meshes to compare that are still being made: {count}', { count: left })
      : say('Each dot is a mesh made from that many points. Choose one to see it.'));
    note();
    try {
      const all = await this.#session.compare(wanted, (count, { rms }) => {
        if (scan !== this.#scan) return;
        left--;
        this.#add({ count, error: rms });
        note();
      });
      if (all && wanted.length) announce(say('{count} counts can be compared', { count: format.count(this.#dots.length) }));
    } catch (error) {
      this.#fail(error);
    }
  }

  #add(/** @type {Dot} */ dot) {
    this.#dots = [...this.#dots.filter(({ count }) => count !== dot.count), dot].sort((a, b) => a.count - b.count);
    this.#draw();
  }

  #draw() {
    drawChart(this.#chart, this.#dots, this.#current, this.#choose);
  }
}
