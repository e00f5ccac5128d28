import { element } from '../dom.js';
import { page } from '../page.js';
import * as format from '../results/format.js';
import { say } from '../words/say.js';

/**
 * @import { StepReport } from 'pointweave'
 * @import { Part } from '../session/parts.js'
 */

const EYE = '<svg viewBox="0 0 20 20" aria-hidden="true"><path d="M2.5 10S5.2 5 10 5s7.5 5 7.5 5-2.7 5-7.5 5-7.5-5-7.5-5z"/><circle cx="10" cy="10" r="2.2"/></svg>';
const BIN = '<svg viewBox="0 0 20 20" aria-hidden="true"><path d="M4 6h12M8 6V4h4v2M5.5 6l.8 10.5h7.4L14.5 6M8.5 9v5M11.5 9v5"/></svg>';

/** The scans that are shown as one: each can be hidden and taken away, and they can be registered. */
export class PartsList {
  #box = page.parts;
  #rows = page.partsRows;
  #words = page.partsWords;
  #register = page.partsRegister;
  #changed;
  /** @type {File[]} */
  #files = [];
  /** @type {Part[]} */
  #parts = [];
  /** Files that cannot be read. @type {Set<File>} */
  #failed = new Set();

  /** @param {(parts: Part[]) => void} changed another choice of them @param {() => void} register */
  constructor(changed, register) {
    this.#changed = changed;
    this.#register.addEventListener('click', register);
  }

  /** Files of which nothing is known yet. @param {File[]} files */
  begin(files) {
    this.#files = files;
    this.#failed.clear();
  }

  /** @param {File} file */
  failed(file) {
    this.#failed.add(file);
  }

  /** @param {Part[] | undefined} parts of the scan that is open; undefined where it is one @param {boolean} registers @param {StepReport | undefined} report what registering them said */
  show(parts, registers, report) {
    this.#parts = parts ?? [];
    this.#box.hidden = !parts;
    const shown = this.#parts.filter((part) => !part.off && !this.#failed.has(this.#files[part.of]));
    this.#register.hidden = shown.length < 2 || registers;
    this.#words.textContent = shown.length < 2 ? ''
      : report?.scans ? placedWords(report.scans) : registers ? '' : say('They are shown as they lie in their files. If they do not fit together, register them.');
    const focused = this.#rows.contains(document.activeElement) ? document.activeElement?.id : undefined;
    this.#rows.replaceChildren(...this.#parts.map((part, i) => this.#row(part, i, report && fate(report, shown.indexOf(part)))));
    if (focused) document.getElementById(focused)?.focus();
  }

  /** @param {Part} part @param {number} i @param {string} [words] */
  #row(part, i, words) {
    const file = this.#files[part.of];
    const { name } = file;
    const eye = element('button', { type: 'button', className: 'tool', id: `part-eye-${i}`, innerHTML: EYE, ariaPressed: String(!part.off), title: say(part.off ? 'Show' : 'Hide'), ariaLabel: say('Shown: {name}', { name }) });
    eye.addEventListener('click', () => this.#changed(this.#parts.map((one) => (one === part ? { of: one.of, ...(!one.off && { off: /** @type {const} */ (true) }) } : one))));
    const bin = element('button', { type: 'button', className: 'tool', id: `part-bin-${i}`, innerHTML: BIN, title: say('Take away'), ariaLabel: say('Take away: {name}', { name }) });
    bin.addEventListener('click', () => this.#changed(this.#parts.filter((one) => one !== part)));
    const last = this.#parts.filter(({ off }) => !off).length < 2 && !part.off;
    eye.disabled = bin.disabled = last;
    const row = element('li');
    const said = this.#failed.has(file) ? say('cannot be read') : part.off ? say('hidden') : words ?? '';
    const text = element('span', { className: 'part-words' });
    text.append(element('span', { className: 'dropped-name', textContent: name, title: name }), element('span', { className: 'hint', textContent: said }));
    row.append(eye, text, bin);
    return row;
  }
}

/** @param {NonNullable<StepReport['scans']>} scans */
function placedWords(scans) {
  const [all, placed] = [scans.length, scans.filter(({ placed }) => placed).length];
  return placed === all ? say('All {count} scans are registered.', { count: all })
    : say('{placed} of {count} scans are registered; the others are left out.', { placed, count: all });
}

/** What became of a scan, and how far that is to be trusted. @param {StepReport} report @param {number} scan */
function fate({ scans = [], pairs = [] }, scan) {
  const one = scans[scan];
  if (!one) return '';
  if (!one.placed) return say('left out: {reason}', { reason: reasonWords(one.reason) });
  const own = pairs.filter((pair) => pair.scans.includes(scan));
  const share = format.percent(Math.max(0, ...own.map(({ overlap }) => overlap)));
  return own.some(({ trusted }) => trusted) ? say('fits, {share} overlap', { share })
    : say('placed by way of others, {share} overlap', { share });
}

/** @param {string} reason as the package says it */
function reasonWords(reason) {
  if (/^it fits/.test(reason)) return say('it fits a few of the others and not the most');
  if (/too few/.test(reason)) return say('too few of its points are on a surface');
  if (/too little/.test(reason)) return say('too little of it lies on another scan to be sure of its place');
  return say('nothing of it looks like a part of another scan');
}
