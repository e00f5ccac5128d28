import { byId } from './dom.js';
import * as format from './format.js';
import { stageWords } from './stages.js';

/** @import { Outcome } from './session.js' */

/**
 * The panel of results. Each number is a `data` element: what it shows is for people, its `value` attribute is
 * the number itself, in file units, fractions, bytes and milliseconds.
 */
export class Numbers {
  #box = byId('numbers', HTMLElement);
  #engine = byId('engine', HTMLElement);
  #reason = byId('engine-reason', HTMLElement);
  #stages = byId('stages', HTMLUListElement);

  /** A new scan: only its size is known. */
  opened(/** @type {number} */ inputPoints) {
    for (const cell of this.#box.querySelectorAll('data')) put(cell, undefined, String);
    this.#set('inputPoints', inputPoints, format.count);
    this.#engine.textContent = '–';
    this.#reason.textContent = '';
    this.#stages.replaceChildren();
    this.stale();
  }

  /** What is shown belongs to settings that have been changed since. */
  stale() {
    this.#box.dataset.fresh = 'false';
  }

  made(/** @type {Outcome} */ { scan, reduced, mesh }) {
    const report = mesh?.report ?? reduced.report;
    this.#set('inputPoints', report.inputPoints, format.count);
    this.#set('outputPoints', report.outputPoints, format.count);
    this.#set('triangles', mesh?.report.triangles, format.count);
    this.#set('boundaryEdges', mesh?.report.boundaryEdges, format.count);
    this.#set('components', mesh?.report.components, format.count);
    this.#set('peakMemoryBytes', report.peakMemoryBytes, format.bytes);
    this.#set('totalMs', report.totalMs, format.duration);
    const { mean, rms, max } = report.distance;
    for (const [name, share] of Object.entries({ errorMean: mean, errorRms: rms, errorMax: max })) {
      this.#set(name, share * scan.frame.diagonal, format.length);
      this.#set(`${name}Share`, share, format.percent);
    }
    this.#engine.textContent = engineWords(report);
    this.#reason.textContent = report.build === 'single' ? `One thread, because ${report.reason}.` : '';
    this.#showStages(report.ms);
    this.#box.dataset.fresh = 'true';
  }

  #set(/** @type {string} */ name, /** @type {number | undefined} */ value, /** @type {(n: number) => string} */ words) {
    const cell = this.#box.querySelector(`data[data-number="${name}"]`);
    if (!cell) throw new Error(`the page has no number ${name}`);
    put(/** @type {HTMLDataElement} */ (cell), value, words);
  }

  #showStages(/** @type {Record<string, number>} */ ms) {
    const longest = Math.max(...Object.values(ms));
    this.#stages.replaceChildren(
      ...Object.entries(ms).map(([stage, time]) => {
        const row = document.createElement('li');
        const name = document.createElement('span');
        name.textContent = stageWords(stage);
        const value = document.createElement('data');
        value.dataset.stage = stage;
        put(value, time, format.duration);
        row.append(name, value);
        row.style.setProperty('--share', String(time / longest));
        return row;
      }),
    );
  }
}

function engineWords(/** @type {{ build: string, threads: number }} */ { build, threads }) {
  return build === 'threads' ? `${threads} threads` : 'one thread';
}

function put(/** @type {HTMLDataElement} */ cell, /** @type {number | undefined} */ value, /** @type {(n: number) => string} */ words) {
  cell.textContent = value === undefined ? '–' : words(value);
  if (value === undefined) cell.removeAttribute('value');
  else cell.value = String(value);
}
