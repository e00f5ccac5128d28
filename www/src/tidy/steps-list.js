import { copyText } from '../clipboard.js';
import { element } from '../dom.js';
import { page } from '../page.js';
import * as format from '../results/format.js';
import { say } from '../words/say.js';
import { stepWords, stepsOf } from './recipe.js';

/** @import { StepReport } from 'pointweave' */
/** @import { Listed } from '../state/shown.js' */

/** What was cut off, step by step: each can be switched off and on again, and removed. */
export class StepsList {
  #box = page.tidyDone;
  #rows = page.tidySteps;
  #note = page.tidyNote;
  #changed;
  /** @type {Listed[]} */
  #recipe = [];

  /** @param {(recipe: Listed[]) => void} changed */
  constructor(changed) {
    this.#changed = changed;
    const copy = page.tidyCopy;
    copy.addEventListener('click', () => copyText(JSON.stringify(stepsOf(this.#recipe), null, 2), copy));
  }

  /** @param {Listed[]} recipe @param {StepReport[]} reports of the steps that are on, where they were done */
  show(recipe, reports) {
    this.#recipe = recipe;
    this.#note.textContent = '';
    this.#box.hidden = !recipe.length;
    const focused = this.#rows.contains(document.activeElement) ? document.activeElement?.id : undefined;
    let at = 0;
    const rows = recipe.map((step, i) => this.#row(step, i, step.off ? undefined : reports[at++]));
    this.#rows.replaceChildren(...rows);
    if (focused) document.getElementById(focused)?.focus();
  }

  /** Why the last change was not made. @param {string} words */
  refuse(words) {
    this.#note.textContent = words;
  }

  /** @param {Listed} step @param {number} i @param {StepReport} [report] */
  #row(step, i, report) {
    const words = stepWords(step);
    const label = element('label', { className: 'check' });
    const check = element('input', { type: 'checkbox', id: `tidy-step-${i}`, checked: !step.off });
    check.addEventListener('change', () => this.#changed(this.#recipe.map((one, k) => (k === i ? switched(one) : one))));
    // Registering drops nothing but what fits no other.
    const says = report?.step === step.step && (report.dropped > 0 || step.step !== 'register');
    const detail = says ? `−${format.count(report.dropped)}` : '';
    label.append(check, element('span', { textContent: words }), element('span', { className: 'detail', textContent: detail }));
    const remove = element('button', { type: 'button', className: 'tool', id: `tidy-remove-${i}`, ariaLabel: say('Remove this step: {step}', { step: words }), title: say('Remove this step: {step}', { step: words }) });
    remove.innerHTML = '<svg viewBox="0 0 20 20" aria-hidden="true"><path d="M5 5l10 10M15 5 5 15"/></svg>';
    remove.addEventListener('click', () => this.#changed(this.#recipe.filter((_, k) => k !== i)));
    const row = element('li');
    row.append(label, remove);
    return row;
  }
}

/** @param {Listed} step @returns {Listed} */
function switched({ off, ...step }) {
  return /** @type {Listed} */ (off ? step : { ...step, off: true });
}
