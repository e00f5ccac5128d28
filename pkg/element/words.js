/** Every sentence that people see or hear. A page in another language assigns its own to `PointWeaveElement.words`. */

/** @import { Pose, Words } from '../element.js' */

/** @type {Words} */
export const WORDS = {
  untitled: '3D scan',
  keys: 'Arrow keys turn it, plus and minus zoom, Home starts over. 1, 2 and 3 show points, reduced points and mesh.',
  views: { points: 'Points', reduced: 'Reduced', mesh: 'Mesh' },
  viewsLabel: 'View',
  reset: 'Start over',
  pause: 'Pause turning',
  play: 'Turn',
  fullscreen: 'Full screen',
  ar: 'View in your room',
  cancel: 'Cancel',
  retry: 'Try again',
  details: 'Details',
  stopped: 'Stopped before it was done.',
  stages: {
    fetch: 'Loading',
    read: 'Reading the scan',
    octree: 'Sorting the points',
    features: 'Measuring curvature and noise',
    prepare: 'Cutting the object out',
    cluster: 'Choosing the points to keep',
    place: 'Placing them on the surface',
    cells: 'Dividing the surface into patches',
    fit: 'Fitting the patches',
    orient: 'Finding out what is inside',
    extract: 'Weaving the triangles',
    report: 'Measuring the result',
    simplify: 'Making it light',
    texture: 'Painting it',
  },
  errors: {
    'load-failed': 'This could not be loaded',
    'unknown-format': 'This is not a scan that can be read',
    'unsupported-file': 'This kind of file is not supported',
    'bad-file': 'This file breaks the rules of its format',
    'empty-cloud': 'There are no points in this file',
    'too-few-points': 'These are too few points for a surface',
    'non-finite': 'A point of this scan is nowhere',
    degenerate: 'These points span no surface',
    'out-of-memory': 'There is not enough memory for this scan',
    'missing-package': 'A part that this needs is not there',
    'no-webgl': '3D pictures need WebGL 2',
    other: 'Something went wrong',
  },
  progress: (stage, percent) => `${stage}, ${percent} per cent`,
  shown: ({ view, points, triangles }) =>
    view === 'mesh' ? `Mesh of ${grouped(triangles)} triangles` : `${grouped(points)} ${view === 'reduced' ? 'reduced points' : 'points'}`,
  doubt: ({ message }) => message,
  pose: describe,
};

/** From so many degrees up. @type {[number, string][]} */
const HEIGHTS = [[75, ', from the top'], [15, ', from above'], [-15, ''], [-75, ', from below']];

/** Where one looks from, an eighth of a turn at a time, then how high, then how near. @param {Pose} pose */
function describe({ azimuth, elevation, zoom }) {
  const sides = ['the front', 'the front right', 'the right', 'the back right', 'the back', 'the back left', 'the left', 'the front left'];
  const side = sides[((Math.round(azimuth / 45) % 8) + 8) % 8];
  const [, height] = HEIGHTS.find(([least]) => elevation > least) ?? [0, ', from the bottom'];
  return `Seen from ${side}${height}, zoom ${Math.round(100 * zoom)} per cent`;
}

/** @param {number} value */
function grouped(value) {
  return value.toLocaleString('en');
}
