import { announce } from '../dom.js';
import { page } from '../page.js';
import { say } from '../words/say.js';
import { Bench, refusal } from './bench.js';
import { Crop } from './crop.js';
import { Floor } from './floor.js';
import { Pieces } from './pieces.js';
import { stepsOf } from './recipe.js';
import { Select } from './select.js';
import { StepsList } from './steps-list.js';
import { Strays } from './strays.js';

/**
 * @import { Look } from '../look/look.js'
 * @import { Session } from '../session/session.js'
 * @import { Listed } from '../state/shown.js'
 * @import { Tool } from './bench.js'
 * @typedef {'floor' | 'pieces' | 'strays' | 'crop' | 'rectangle' | 'lasso'} ToolName
 */

/** What stands on the buttons over the picture; those with two can keep or delete. @type {Record<ToolName, { apply: string, cut?: string }>} */
export const ACTIONS = {
  floor: { apply: 'Remove' },
  pieces: { apply: 'Keep these' },
  strays: { apply: 'Remove' },
  crop: { apply: 'Keep inside', cut: 'Delete inside' },
  rectangle: { apply: 'Keep', cut: 'Delete' },
  lasso: { apply: 'Keep', cut: 'Delete' },
};

/** Around the bar, in CSS pixels. */
const MARGIN = 24;

/** The step before the reduction: what is not the object is cut off, by tools that first show what would go. */
export class Tidy {
  #root = page.app;
  #bar = page.tidyBar;
  #apply = page.tidyApply;
  #cut = page.tidyCut;
  #buttons = /** @type {HTMLButtonElement[]} */ ([...document.querySelectorAll('[data-tool]')]);
  #session;
  #look;
  #changed;
  #began;
  #bench;
  /** @type {Record<ToolName, Tool>} */
  #tools;
  /** @type {ToolName | null} */
  #on = null;
  /** @type {Listed[]} */
  #recipe = [];
  #list;

  /**
   * @param {Session} session
   * @param {Look} look
   * @param {(recipe: Listed[]) => void} changed  what a person made of the recipe
   * @param {() => void} began  a tool was taken up
   */
  constructor(session, look, changed, began) {
    this.#began = began;
    this.#session = session;
    this.#look = look;
    this.#changed = changed;
    const bench = new Bench(session, look, () => stepsOf(this.#recipe));
    this.#bench = bench;
    this.#tools = {
      floor: new Floor(bench), pieces: new Pieces(bench), strays: new Strays(bench), crop: new Crop(bench),
      rectangle: new Select(bench, 'rectangle'), lasso: new Select(bench, 'lasso'),
    };
    this.#list = new StepsList((recipe) => this.#take(recipe));
    for (const button of this.#buttons) {
      const name = /** @type {ToolName} */ (button.dataset.tool);
      button.addEventListener('click', () => (this.#on === name ? this.stop() : this.start(name)));
    }
    this.#apply.addEventListener('click', () => this.#do(false));
    this.#cut.addEventListener('click', () => this.#do(true));
    page.tidyCancel.addEventListener('click', () => this.stop());
  }

  /** A tool is shown. */
  get open() {
    return this.#on !== null;
  }

  /** The steps that there are. @param {Listed[]} recipe */
  show(recipe) {
    this.#recipe = recipe;
    this.#list.show(recipe, this.#session.reports);
  }

  /** Another scan is open. */
  opened() {
    this.stop();
    for (const button of this.#buttons) button.disabled = false;
  }

  /** Something else is left of the scan: a tool that is open looks at that. */
  left() {
    this.#list.show(this.#recipe, this.#session.reports);
    if (!this.#on) return;
    const tool = this.#tools[this.#on];
    this.#bench.stop();
    tool.end();
    tool.begin();
  }

  /** Takes up a tool. */
  start(/** @type {ToolName} */ name) {
    if (!this.#session.scan) return;
    this.stop();
    this.#began();
    this.#on = name;
    this.#root.dataset.tidy = name;
    for (const button of this.#buttons) button.ariaPressed = String(button.dataset.tool === name);
    const { apply, cut } = ACTIONS[name];
    this.#apply.textContent = say(apply);
    this.#cut.textContent = say(cut ?? '');
    this.#cut.hidden = !cut;
    this.#bar.hidden = false;
    this.#bar.focus({ preventScroll: true });
    page.stage.scrollIntoView({ block: 'nearest' });
    this.#bench.say('', false);
    this.#bench.show(() => {});
    this.#tools[name].begin();
    this.#look.leave(this.#bar.offsetHeight + MARGIN);
  }

  /** Puts the tool away; nothing is cut. */
  stop() {
    if (!this.#on) return;
    const button = this.#buttons.find(({ dataset }) => dataset.tool === this.#on);
    if (this.#bar.contains(document.activeElement)) button?.focus({ preventScroll: true });
    this.#bench.stop();
    this.#tools[this.#on].end();
    this.#on = null;
    delete this.#root.dataset.tidy;
    for (const one of this.#buttons) one.ariaPressed = 'false';
    this.#bar.hidden = true;
    this.#look.leave();
    this.#look.mark(null);
  }

  /** Does what is shown. @param {boolean} cut the second way of the tool */
  async #do(cut) {
    const name = this.#on;
    if (!name) return;
    const steps = this.#tools[name].steps(cut);
    // The same computation as for the picture of it, which is remembered where there was one.
    const trial = await this.#bench.try(steps);
    if (!trial || this.#on !== name) return;
    this.stop();
    this.#take([...this.#recipe, ...steps]);
  }

  /** Goes on with another recipe, unless it leaves nothing. @param {Listed[]} recipe */
  async #take(recipe) {
    try {
      const steps = stepsOf(recipe);
      if (steps.length) await this.#session.tried(steps, new AbortController().signal);
      this.#changed(recipe);
    } catch (error) {
      this.#list.show(this.#recipe, this.#session.reports);
      announce(refusal(error));
      this.#list.refuse(refusal(error));
    }
  }
}
