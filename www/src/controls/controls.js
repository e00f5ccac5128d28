import { Amount } from './amount.js';
import { element } from '../dom.js';
import { page } from '../page.js';
import { CONTROLS, PLACES, TARGETS, defaultOf } from './settings.js';
import { say } from '../words/say.js';

/**
 * @import { Settings, Target, TargetKind } from './settings.js'
 */

/** Targets that say how many points there will be. */
const COUNTED = new Set(['ratio', 'count']);
/** Targets for those who know the paper. */
const EXPERT = new Set(['flatness']);

/** The controls of all options, made from the tables of settings.js and the package's defaults. */
export class Controls {
  #settings;
  #changed;
  #describe;
  #kind = page.targetKind;
  #count = page.keepCount;
  #reset = page.reset;
  #expert = page.expert;
  #keep;
  /** Each shows what the settings say. @type {(() => void)[]} */
  #refreshers = [];
  /** What is kept, chosen or not. @type {Target} */
  #target = { kind: 'ratio', value: TARGETS.ratio.start };
  /** Of the open scan. */
  #points = 0;

  /**
   * @param {Settings} settings
   * @param {() => void} changed  after a rest, to start the job
   * @param {(target: Target) => string} describe  what a target means for the open scan
   */
  constructor(settings, changed, describe) {
    this.#settings = settings;
    this.#changed = changed;
    this.#describe = describe;
    this.#keep = new Amount(
      page.keepSlider,
      page.keepField,
      page.keepError,
      (value) => this.#say({ kind: this.#target.kind, value: /** @type {number} */ (value) }),
      (value) => this.#choose({ kind: this.#target.kind, value: /** @type {number} */ (value) }),
    );
    this.#kind.addEventListener('change', () => this.#choose(this.#converted(/** @type {TargetKind} */ (this.#kind.value))));
    this.#reset.addEventListener('click', () => {
      settings.reset();
      this.#changed();
    });
    const places = { plain: page.optionsPlain, more: page.optionsMore, expert: page.optionsExpert };
    for (const [place, keys] of Object.entries(PLACES)) places[/** @type {keyof typeof places} */ (place)].append(...keys.map((key) => this.#make(key)));
    this.#expert.addEventListener('toggle', () => this.#offerKinds());
    this.#refresh();
  }

  /** Shows what is chosen, and what is kept of a scan of so many points. */
  show(/** @type {Target} */ target, /** @type {number} */ points) {
    this.#points = points;
    this.#target = target;
    const { label: named, ...range } = TARGETS[target.kind];
    const label = say(named);
    const high = target.kind === 'count' ? Math.max(range.low + 1, points) : range.high;
    this.#offerKinds();
    for (const input of [page.keepSlider, page.keepField]) input.ariaLabel = range.unit ? say('{name}, in per cent', { name: label }) : label;
    page.keepUnit.textContent = range.unit;
    page.keepTitle.textContent = COUNTED.has(target.kind) ? say('Points to keep') : label;
    this.#keep.set({ ...range, high }, target.value);
    this.#say(target);
    this.#refresh();
  }

  #say(/** @type {Target} */ target) {
    const words = this.#describe(target);
    this.#count.textContent = words;
    this.#keep.describe(words);
  }

  #choose(/** @type {Target} */ target) {
    this.#settings.target = target;
    this.#target = target;
    this.#changed();
  }

  /** The ways to decide; an expert's are offered to whoever looks at those, or has one. */
  #offerKinds() {
    const all = /** @type {TargetKind[]} */ (Object.keys(TARGETS));
    const offered = all.filter((kind) => !EXPERT.has(kind) || this.#expert.open || kind === this.#target.kind);
    this.#kind.replaceChildren(...offered.map((kind) => new Option(say(TARGETS[kind].label), kind)));
    this.#kind.value = this.#target.kind;
  }

  /** The same amount in another measure, where there is one. Shares have as many digits as are shown. */
  #converted(/** @type {TargetKind} */ kind) {
    const { kind: from, value } = this.#target;
    if (kind === 'count' && from === 'ratio') return { kind, value: Math.max(1, Math.round(value * this.#points)) };
    if (kind === 'ratio' && from === 'count') return { kind, value: Math.min(1, Number((value / Math.max(1, this.#points)).toPrecision(3))) };
    return { kind, value: TARGETS[kind].start };
  }

  #refresh() {
    for (const refresh of this.#refreshers) refresh();
    this.#reset.disabled = !this.#settings.changed;
  }

  #make(/** @type {string} */ key) {
    const control = CONTROLS[key];
    const id = `option-${key}`;
    const hint = element('p', { className: 'hint', id: `${id}-hint`, textContent: say(control.hint) });
    const label = element('label', { htmlFor: id, textContent: say(control.label) });
    const error = element('p', { className: 'invalid', id: `${id}-error`, role: 'alert', hidden: true });
    const input = this.#input(key, id, error);
    input.querySelector(`#${id}`)?.setAttribute('aria-describedby', hint.id);
    const row = element('div', { className: `option ${control.kind}` });
    row.append(label, input, ...(control.kind === 'number' ? [error] : []), hint);
    return row;
  }

  /** @param {string} key @param {string} id @param {HTMLElement} error @returns {HTMLElement} a box with what is labelled */
  #input(key, id, error) {
    const control = CONTROLS[key];
    const settings = this.#settings;
    const box = element('div', { className: 'option-input' });
    const take = (/** @type {string | number | boolean | undefined} */ value) => {
      settings.set(key, value);
      this.#changed();
    };
    if (control.kind === 'choice') {
      const select = element('select', { id });
      for (const [name, words] of Object.entries(control.choices)) select.append(new Option(say(words), name));
      select.addEventListener('change', () => take(select.value));
      this.#refreshers.push(() => (select.value = String(settings.get(key))));
      box.append(select);
    } else if (control.kind === 'flag') {
      const check = element('input', { id, type: 'checkbox' });
      check.addEventListener('change', () => take(check.checked));
      this.#refreshers.push(() => (check.checked = Boolean(settings.get(key))));
      box.append(check);
    } else {
      const slider = element('input', { type: 'range', ariaLabel: say('{name}, slider', { name: say(control.label) }) });
      const field = element('input', { id, type: 'number', step: 'any', inputMode: 'decimal' });
      const unit = element('span', { textContent: control.unit });
      const amount = new Amount(slider, field, error, () => {}, take);
      this.#refreshers.push(() => {
        const fallback = control.follows?.[String(settings.get('method'))] ?? defaultOf(key);
        const chosen = /** @type {number | undefined} */ (settings.values[key]);
        const number = typeof fallback === 'number' ? fallback : Math.sqrt(control.low * control.high);
        const shown = typeof fallback === 'number' ? String(Number((fallback * (control.times ?? 1)).toPrecision(3))) : String(fallback);
        amount.set(control, chosen, number, shown);
      });
      box.append(slider, field, unit);
    }
    return box;
  }
}
