import { PAINT_WORDS } from 'pointweave/viewer';
import * as format from '../results/format.js';

/** Paints and their legends, in the page's numbers. @type {import('pointweave/viewer').PaintWords} */
export const WORDS = { ...PAINT_WORDS, length: format.length, percent: format.percent };
