import { PAINT_WORDS } from 'pointweave/viewer';
import * as format from '../results/format.js';
import { say } from '../words/say.js';

const { names, density, error, sharp } = PAINT_WORDS;
const inUnit = (/** @type {import('pointweave').Unit | undefined} */ unit) => unit ?? say('file units');

/** How many times larger the scan is than its file says. */
export const size = { scale: 1 };

/**
 * Paints and their legends, in the page's words and numbers.
 * @type {import('pointweave/viewer').PaintWords}
 */
export const WORDS = {
  names: /** @type {typeof names} */ (Object.fromEntries(Object.entries(names).map(([name, words]) => [name, say(words)]))),
  density: { title: say(density.title), note: (unit) => say('about, in {unit}', { unit: inUnit(unit) }) },
  error: {
    titles: { points: say(error.titles.points), reduced: say(error.titles.reduced), mesh: say(error.titles.mesh) },
    note: (unit) => say('in {unit} and of the diagonal; 1 % of the points are beyond', { unit: inUnit(unit) }),
    unknown: `; ${say('grey: no points there')}`,
  },
  sharp: {
    title: say(sharp.title),
    sharp: say(sharp.sharp),
    smooth: say(sharp.smooth),
    note: (share, layer) => (layer === 'mesh' ? say('{share} of the vertices are on edges, corners and tight curves', { share })
      : say('{share} of the points are on edges, corners and tight curves', { share })),
  },
  length: (value) => format.length(size.scale * value),
  percent: format.percent,
};
