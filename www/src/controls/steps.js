import { announce } from '../dom.js';
import { page } from '../page.js';
import { say } from '../words/say.js';

/** @import { Key } from '../keys.js' */
/** @import { Shown } from '../state/shown.js' */

/** Undo and redo: of the scan, the settings and what was said of it. */
export class Steps {
  #shown;
  #undo = page.undo;
  #redo = page.redo;

  constructor(/** @type {Shown} */ shown) {
    this.#shown = shown;
    this.#undo.addEventListener('click', () => shown.undo());
    this.#redo.addEventListener('click', () => shown.redo());
    shown.on('changed', () => {
      this.#undo.disabled = !shown.canUndo;
      this.#redo.disabled = !shown.canRedo;
    });
    shown.on('moved', () => announce(say('Another step is shown')));
  }

  /** @returns {Key[]} */
  get keys() {
    const [undo, redo] = [() => this.#shown.undo(), () => this.#shown.redo()];
    return [
      { key: 'z', ctrl: true, shown: 'Ctrl+Z', does: say('Undo'), act: undo },
      { key: 'shift z', ctrl: true, shown: 'Ctrl+Shift+Z', does: say('Redo'), act: redo },
    ];
  }
}
