import { byId } from './dom.js';

/**
 * What a person reads when something went wrong: what happened, in one sentence, and what to do.
 * @typedef {{ title: string, text: string, advice: string }} Words
 */

const READABLE = 'Pointweave reads PLY, LAS, LAZ, E57, PCD, OBJ, OFF, STL, GLB, and text with x y z on each line.';

/** For each of the package's codes. The engine's own sentence, with byte or line, is shown below it. */
const WORDS = /** @type {Record<string, Words>} */ ({
  'empty-cloud': {
    title: 'There are no points in this file',
    text: 'The file can be read, but it holds no points.',
    advice: 'Export the scan again, as a point cloud.',
  },
  'too-few-points': {
    title: 'Too few points for a surface',
    text: 'A surface needs more points than there are.',
    advice: 'Keep a larger share, or take a denser scan.',
  },
  'non-finite': {
    title: 'A point is nowhere',
    text: 'One of the values is not a finite number, so the point has no place.',
    advice: 'Remove invalid points in the program that made the scan, and export it again.',
  },
  degenerate: {
    title: 'These points span no surface',
    text: 'They all lie on one line or at one place. The reduced points are shown.',
    advice: 'Try another scan.',
  },
  'unknown-format': {
    title: 'This is not a scan that can be read',
    text: READABLE,
    advice: 'Convert the file to PLY in the program that made it.',
  },
  'bad-file': {
    title: 'This file breaks the rules of its format',
    text: 'Something else was found at the place below than belongs there, so nothing of the file was used.',
    advice: 'Mend that place if the file is text, or export it again. If it was downloaded, check that all of it arrived.',
  },
  'unsupported-file': {
    title: 'This kind of file is not supported yet',
    text: READABLE,
    advice: 'Convert the file to PLY in the program that made it.',
  },
  'load-failed': {
    title: 'The engine could not be loaded',
    text: 'Pointweave computes with a WebAssembly program that belongs to this page, and it did not arrive.',
    advice: 'Check the connection and reload the page.',
  },
  'out-of-memory': {
    title: 'Not enough memory for this scan',
    text: 'The browser gives a page a limited amount of memory, and this scan needs more.',
    advice: 'Keep fewer points, close other tabs, or try a computer with more memory.',
  },
});

const UNEXPECTED = {
  title: 'Something went wrong',
  text: 'That should not have happened, and your scan was not changed.',
  advice: 'Try again. If it happens once more, please report the line below.',
};

/** The card over the picture; it leaves everything else usable. */
export class MessageCard {
  #box = byId('message', HTMLElement);
  #choose = byId('message-choose', HTMLButtonElement);

  constructor(/** @type {() => void} */ choose) {
    this.#choose.addEventListener('click', choose);
    byId('message-close', HTMLButtonElement).addEventListener('click', () => this.hide());
  }

  /** @param {any} error  @param {string} about  what the person had opened */
  showError(error, about) {
    const code = typeof error?.code === 'string' ? error.code : 'internal';
    const { title, text, advice } = WORDS[code] ?? UNEXPECTED;
    byId('message-title', HTMLElement).textContent = title;
    byId('message-text', HTMLElement).textContent = text;
    byId('message-advice', HTMLElement).textContent = advice;
    byId('message-detail', HTMLElement).textContent = `${about}: ${error?.message ?? error} [${code}]`;
    this.#box.hidden = false;
  }

  hide() {
    this.#box.hidden = true;
  }
}
