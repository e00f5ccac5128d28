import { page } from '../page.js';
import { copyText } from '../clipboard.js';
import { doubtWords } from './doubt-words.js';
import * as format from './format.js';
import { stageWords } from './stages.js';
import { say } from '../words/say.js';
import { reasonWords } from './reasons.js';

/** @import { Outcome, Scan } from '../session/session.js' */

/**
 * The panel of results. Each number is a `data` element: what it shows is for people, its `value` attribute is
 * the number itself, in file units, fractions, bytes and milliseconds.
 */
export class Numbers {
  #box = page.numbers;
  #engine = page.engine;
  #reason = page.engineReason;
  #stages = page.stages;
  #summary = page.madeSummary;
  #doubt = page.doubt;
  #json = '';
  /** @type {import('pointweave').Unit | undefined} */
  #unit;
  #scale = 1;

  constructor() {
    const copy = page.copyJson;
    copy.addEventListener('click', () => copyText(this.#json, copy));
  }

  /** A new scan: only its size and its place are known. */
  opened(/** @type {Scan} */ { count, cloud: { origin, unit } }) {
    this.measure(unit, this.#scale);
    for (const cell of this.#box.querySelectorAll('data')) put(cell, undefined, String);
    this.#set('inputPoints', count, format.count);
    this.#doubt.hidden = true;
    page.origin.hidden = !origin;
    ['X', 'Y', 'Z'].forEach((axis, i) => this.#set(`origin${axis}`, origin?.[i], format.count));
    this.#engine.textContent = '–';
    this.#reason.textContent = '';
    this.#summary.textContent = '';
    this.#json = '';
    page.copyJson.disabled = true;
    this.#stages.replaceChildren();
    this.stale();
  }

  /** What lengths are said in, and how many times larger than in the file; those that are shown are said anew. @param {import('pointweave').Unit | undefined} unit @param {number} scale */
  measure(unit, scale) {
    this.#unit = unit;
    this.#scale = scale;
    page.errorUnit.textContent = say(unit ? 'length' : 'file units');
    for (const name of ['errorMean', 'errorRms', 'errorMax']) {
      const value = this.#box.querySelector(`data[data-number="${name}"]`)?.getAttribute('value');
      if (value !== null && value !== undefined) this.#set(name, Number(value), (length) => this.#length(length));
    }
  }

  #length(/** @type {number} */ value) {
    return `${format.length(this.#scale * value)}${this.#unit ? ` ${this.#unit}` : ''}`;
  }

  /** What is shown belongs to settings that have been changed since. */
  stale() {
    this.#box.dataset.fresh = 'false';
  }

  /** @param {Outcome} outcome @param {object} settings  what was asked for, to be copied with the numbers */
  made({ scan, reduced, mesh }, settings) {
    const report = mesh?.report ?? reduced.report;
    this.#set('inputPoints', report.inputPoints, format.count);
    this.#set('outputPoints', report.outputPoints, format.count);
    this.#set('triangles', mesh?.report.triangles, format.count);
    this.#set('reduction', report.outputPoints / report.inputPoints, format.percent);
    this.#set('boundaryEdges', mesh?.report.boundaryEdges, format.count);
    this.#set('holes', mesh?.report.holes.filter(({ closed }) => !closed).length, format.count);
    this.#set('components', mesh?.report.components, format.count);
    this.#set('peakMemoryBytes', report.peakMemoryBytes, format.bytes);
    this.#set('totalMs', report.totalMs, format.duration);
    this.#doubt.textContent = report.doubts.map(doubtWords).join(' ');
    this.#doubt.hidden = !this.#doubt.textContent;
    const { mean, rms, max } = report.distance;
    for (const [name, share] of Object.entries({ errorMean: mean, errorRms: rms, errorMax: max })) {
      this.#set(name, share * scan.frame.diagonal, (length) => this.#length(length));
      this.#set(`${name}Share`, share, format.percent);
    }
    this.#engine.textContent = engineWords(report);
    this.#reason.textContent = reasonWords(report.reason);
    this.#summary.textContent = format.duration(report.totalMs);
    const { title, count, frame: { size, diagonal }, cloud: { origin } } = scan;
    this.#json = JSON.stringify({ scan: { title, count, size, diagonal, origin }, settings, report }, null, 2);
    page.copyJson.disabled = false;
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
  return build === 'threads' ? say('{count} threads', { count: threads }) : say('one thread');
}

function put(/** @type {HTMLDataElement} */ cell, /** @type {number | undefined} */ value, /** @type {(n: number) => string} */ words) {
  cell.textContent = value === undefined ? '–' : words(value);
  if (value === undefined) cell.removeAttribute('value');
  else cell.value = String(value);
}
