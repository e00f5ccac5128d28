import { say } from '../words/say.js';

/** The engine's stages, in the words of the page. */
export const STAGES = /** @type {Record<string, string>} */ ({
  download: 'Fetching the scan',
  read: 'Reading the file',
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
});

export const stageWords = (/** @type {string} */ stage) => say(STAGES[stage] ?? stage);
