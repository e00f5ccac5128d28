import { say, words } from '../words/say.js';
import * as format from './format.js';

/** @import { Doubt, DoubtCode } from 'pointweave' */

/** What may be wrong, without the numbers that the package's English sentences have. @type {Record<DoubtCode, string>} */
export const DOUBTS = {
  'side-guessed': 'Which side is out is a guess for {share} of the surface.',
  'sources-disagree': 'What is known of the outer side contradicts itself or the surface over {share} of it.',
  'contradicts-sensor': '{share} of what the scanner saw shows its inner side.',
  'weak-tie': 'Next to nothing ties {share} of the surface to the rest: it may be inside out.',
  'far-from-points': 'The mesh is not close to the points: there are too few of them to tell where the surface is, or some lie far from the rest.',
  steps: 'The coordinates were rounded to steps: detail as fine as they are is smoothed away.',
  'degrees-as-lengths': 'x and y look like degrees of longitude and latitude, and z like metres: convert the scan to a projected coordinate system first.',
  lines: '{share} of the points are on scan lines much farther apart than the points of a line: the surface between lines is drawn from one to the next.',
  'sampled-from-faces': 'The file is a mesh: its points were taken from its faces, evenly over their area.',
  scatter: '{share} of the points lie as in foliage, dust or a filled volume, with no surface through them.',
  thin: '{share} of the surface belongs to walls that are about as thin as the points are apart, or as the noise: their shape is not known there.',
  'far-area': '{share} of the area is far from any point.',
  tunnels: 'The surface has many tunnels: the points do not tell well what is inside.',
  'self-intersections': 'Some triangles cross others.',
  'islands-dropped': 'Pieces too small to be a surface were left out: {share} of the points.',
};

/** A doubt in the person's language; one that this page does not know in the package's words. @param {Doubt} doubt */
export function doubtWords({ code, message, share }) {
  const text = DOUBTS[/** @type {DoubtCode} */ (code)];
  return words.language === 'en' || !text ? message : say(text, { share: share === undefined ? '' : format.percent(share) });
}
