import { announce } from '../dom.js';
import { page } from '../page.js';
import { stageWords } from './stages.js';

/** A job this short shows no bar: it would only flash. */
const PATIENCE_MS = 180;

/** The bar over the picture: which stage, how far, how long, and Cancel. */
export class ProgressBar {
  #box = page.progress;
  #stage = page.progressStage;
  #time = page.progressTime;
  #bar = page.progressBar;
  #started = 0;
  #timers = [0, 0];

  constructor(/** @type {() => void} */ cancel) {
    page.cancel.addEventListener('click', cancel);
  }

  start(/** @type {string} */ words) {
    this.stop();
    this.#started = performance.now();
    this.#say(words);
    this.#bar.value = 0;
    this.#tick();
    this.#timers = [
      window.setTimeout(() => (this.#box.hidden = false), PATIENCE_MS),
      window.setInterval(() => this.#tick(), 1000),
    ];
  }

  update(/** @type {{ stage: string, overall: number }} */ { stage, overall }) {
    this.#bar.value = overall;
    this.#say(stageWords(stage));
  }

  stop() {
    clearTimeout(this.#timers[0]);
    clearInterval(this.#timers[1]);
    this.#box.hidden = true;
  }

  #say(/** @type {string} */ words) {
    if (this.#stage.textContent === words) return;
    this.#stage.textContent = words;
    if (!this.#box.hidden) announce(words);
  }

  #tick() {
    const seconds = Math.floor((performance.now() - this.#started) / 1000);
    this.#time.textContent = seconds ? `${seconds} s` : '';
  }
}
