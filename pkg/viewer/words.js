/** What paints and their legends say, in English. */

/** @import { PaintWords } from '../viewer.js' */

const three = new Intl.NumberFormat('en', { maximumSignificantDigits: 3 });
const two = new Intl.NumberFormat('en', { maximumSignificantDigits: 2 });

/** @type {PaintWords} */
export const PAINT_WORDS = {
  names: {
    natural: 'As scanned',
    plain: 'Plain',
    normals: 'Direction of the surface',
    density: 'Density of the points',
    error: 'Distance between scan and mesh',
    sharp: 'Sharp places',
  },
  density: { title: 'Distance between neighbours', note: (unit) => `about, in ${unit ?? 'file units'}` },
  error: {
    titles: { points: 'Distance to the mesh', reduced: 'Distance of its points to the mesh', mesh: 'Distance to the scan' },
    note: (unit) => `in ${unit ?? 'file units'} and of the diagonal; 1 % of the points are beyond`,
    unknown: '; grey: no points there',
  },
  sharp: {
    title: 'Sharp places',
    sharp: 'sharp',
    smooth: 'smooth',
    note: (share, layer) => `${share} of the ${layer === 'mesh' ? 'vertices' : 'points'} are on edges, corners and tight curves`,
  },
  length: (value) => three.format(value),
  percent: (share) => `${two.format(100 * share)} %`,
};
