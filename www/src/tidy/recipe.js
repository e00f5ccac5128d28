import * as format from '../results/format.js';
import { say } from '../words/say.js';

/** @import { Step } from 'pointweave' */
/** @import { Listed } from '../state/shown.js' */

/** The package takes no more. */
const MOST = 255;

/** The steps that are switched on, as the package takes them. @param {Listed[]} [recipe] @returns {Step[]} */
export function stepsOf(recipe = []) {
  return recipe.filter(({ off }) => !off);
}

/** A recipe as a word of the address: its JSON. @param {Listed[]} recipe */
export function recipeWord(recipe) {
  return JSON.stringify(recipe);
}

/** The recipe that an address says; none where it makes no sense. What its steps hold is checked by the package. @param {string | null} word @returns {Listed[]} */
export function recipeOf(word) {
  try {
    const steps = JSON.parse(word ?? '[]');
    return Array.isArray(steps) && steps.length <= MOST && steps.every((step) => typeof step?.step === 'string') ? steps : [];
  } catch {
    return [];
  }
}

/** The recipe without the step that an error is about; null where it is about none. @param {Listed[] | undefined} recipe @param {any} error @returns {Listed[] | null} */
export function switchedOff(recipe = [], { code, message }) {
  const at = code === 'bad-option' && /prepare\[(\d+)\]/.exec(message);
  const step = at && stepsOf(recipe)[Number(at[1])];
  return step ? recipe.map((one) => (one === step ? { ...one, off: true } : one)) : null;
}

/** What a step does, in words. @param {Step} step */
export function stepWords(step) {
  switch (step.step) {
    case 'register': return say('Scans registered');
    case 'outliers': return say('Isolated points removed');
    case 'flying': return say('Flying pixels removed');
    case 'plane': return planeWords(step.drop);
    case 'pieces': return piecesWords(step.keep);
    case 'box': return step.keep === false ? say('Inside of the box deleted') : say('Cropped to the box');
    case 'polygon': return step.keep === false ? say('Selection deleted') : say('Selection kept');
    case 'half-space': return say('Cut above the floor');
    default: return step.step;
  }
}

/** @param {Extract<Step, { step: 'plane' }>['drop']} drop */
function planeWords(drop = 'floor') {
  if (drop === 'floor') return say('Floor removed');
  return Array.isArray(drop) && drop.length === 1 ? say('A flat plane removed') : say('Flat planes removed');
}

/** @param {Extract<Step, { step: 'pieces' }>['keep']} keep */
function piecesWords(keep = 'largest') {
  if (keep === 'largest') return say('Main piece kept');
  return Array.isArray(keep) && keep.length !== 1 ? say('{count} pieces kept', { count: format.count(keep.length) }) : say('A piece kept');
}

/** A number with so many digits as make no difference, which are fewer to read and to send. @param {number} value @param {number} [digits] */
export function rounded(value, digits = 7) {
  return Number(value.toPrecision(digits));
}
