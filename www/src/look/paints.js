import { colorize } from './colormap.js';
import { creases, sharpPoints } from './sharp.js';
import { localSpacing } from '../session/density.js';
import { toFrame } from '../frame.js';
import * as format from '../results/format.js';

/**
 * @import { Outcome, Scan } from '../session/session.js'
 * @import { View } from '../viewer.js'
 *
 * How measured values are read from colours: the values at both ends, or two kinds.
 * @typedef {{ title: string, note: string, low: number, high: number, words: (value: number) => string }} Scale
 * @typedef {{ title: string, note: string, kinds: [string, string][] }} Kinds  CSS colours and their names
 *
 * What a layer's colours are, none for the theme's, and how they are read, where that needs saying.
 * @typedef {{ colors: Uint8Array | null, legend: Scale | Kinds | null }} Paint
 *
 * @typedef {{ scan: Scan, outcome: Outcome | null }} Subject
 */

/** What can be shown in colour, in the order of the menu. */
export const PAINTS = /** @type {const} */ ({
  natural: 'As scanned',
  plain: 'Plain',
  normals: 'Direction of the surface',
  density: 'Density of the points',
  error: 'Distance between scan and mesh',
  sharp: 'Sharp places',
});

/** @typedef {keyof typeof PAINTS} PaintName */

const SHARP = /** @type {const} */ ([222, 94, 12]);
const SMOOTH = /** @type {const} */ ([142, 160, 170]);

/** Whether there is something to paint. */
export function isPossible(/** @type {PaintName} */ name, /** @type {Subject} */ { scan, outcome }) {
  if (name === 'plain') return Boolean(scan.cloud.colors);
  if (name === 'normals') return Boolean(outcome || scan.cloud.normals);
  if (name === 'sharp') return Boolean(outcome);
  if (name === 'error') return Boolean(outcome?.mesh?.distances);
  return true;
}

/**
 * The paint of one layer; what is not possible is natural.
 * @param {PaintName} name
 * @param {View} view
 * @param {Subject} subject
 * @returns {Paint}
 */
export function paintOf(name, view, subject) {
  if (!isPossible(name, subject)) name = 'natural';
  return PAINTERS[name](view, subject);
}

/** @type {Record<PaintName, (view: View, subject: Subject) => Paint>} */
const PAINTERS = {
  natural: (view, subject) => ({ colors: sourceOf(view, subject)?.colors ?? null, legend: null }),

  plain: () => ({ colors: null, legend: null }),

  normals(view, subject) {
    const { scan, outcome } = subject;
    const own = sourceOf(view, subject)?.normals;
    const normals = own ?? (outcome && spread(outcome, 3, (i, axis) => outcome.reduced.normals[3 * i + axis]));
    if (!normals) return PAINTERS.natural(view, { scan, outcome });
    return { colors: Uint8Array.from(normals, (value) => 127.5 * (value + 1)), legend: null };
  },

  density(view, subject) {
    const source = sourceOf(view, subject);
    if (!source) return PAINTERS.natural(view, subject);
    const { frame } = subject.scan;
    const spacing = localSpacing(toFrame(source, frame)).map((distance) => distance * frame.diagonal);
    const [low, high] = [quantile(spacing, 0.02), quantile(spacing, 0.98)];
    const legend = { title: 'Distance between neighbours', note: 'about, in file units', low, high, words: format.length };
    return { colors: colorize(spacing, low, high), legend };
  },

  error(view, { scan, outcome }) {
    const distances = /** @type {NonNullable<import('pointweave').SurfaceMesh['distances']>} */ (outcome?.mesh?.distances);
    const values = {
      points: () => distances.points,
      reduced: () => meanOfMembers(/** @type {Outcome} */ (outcome), distances.points),
      mesh: () => filled(distances.vertices, /** @type {import('pointweave').SurfaceMesh} */ (outcome?.mesh).indices),
    }[view]();
    // One scale for all views; the few points beyond it take its end.
    const high = Math.max(quantile(distances.points, 0.99), 1e-9);
    const words = (/** @type {number} */ share) => `${format.length(share * scan.frame.diagonal)}\n${format.percent(share)}`;
    const bare = view === 'mesh' && values.some(Number.isNaN) ? '; grey: no points there' : '';
    const note = `in file units and of the diagonal; 1 % of the points are beyond${bare}`;
    const title = { points: 'Distance to the mesh', reduced: 'Distance of its points to the mesh', mesh: 'Distance to the scan' }[view];
    return { colors: colorize(values, 0, high), legend: { title, note, low: 0, high, words } };
  },

  sharp(view, { scan, outcome: made }) {
    const outcome = /** @type {Outcome} */ (made);
    const sharp = /** @type {Record<View, () => ArrayLike<number>>} */ ({
      reduced: () => sharpPoints(outcome.reduced, scan),
      points: () => {
        const reduced = sharpPoints(outcome.reduced, scan);
        return spread(outcome, 1, (i) => reduced[i]) ?? new Uint8Array(scan.count);
      },
      mesh: () => (outcome.mesh ? creases(outcome.mesh) : new Uint8Array(0)),
    })[view]();
    const colors = new Uint8Array(3 * sharp.length);
    let count = 0;
    for (let i = 0; i < sharp.length; i++) {
      colors.set(sharp[i] ? SHARP : SMOOTH, 3 * i);
      count += sharp[i];
    }
    const share = count / Math.max(1, sharp.length);
    const css = (/** @type {readonly number[]} */ color) => `rgb(${color.join(' ')})`;
    const note = `${format.percent(share)} of the ${view === 'mesh' ? 'vertices' : 'points'} are on edges, corners and tight curves`;
    return { colors, legend: { title: 'Sharp places', note, kinds: [[css(SHARP), 'sharp'], [css(SMOOTH), 'smooth']] } };
  },
};

/** What a view draws. */
function sourceOf(/** @type {View} */ view, /** @type {Subject} */ { scan, outcome }) {
  return view === 'points' ? scan.cloud : outcome?.[view] ?? null;
}

/**
 * For every input point the value of the reduced point that it belongs to; null where nobody knows which that is.
 * @param {Outcome} outcome
 * @param {number} size values a point
 * @param {(reduced: number, part: number) => number} value
 */
function spread({ reduced: { assignment, weights } }, size, value) {
  if (!assignment) return null;
  const out = new Float32Array(size * assignment.length);
  for (let i = 0; i < assignment.length; i++) {
    if (assignment[i] >= weights.length) continue; // an outlier that was dropped
    for (let part = 0; part < size; part++) out[size * i + part] = value(assignment[i], part);
  }
  return out;
}

/** For every reduced point the mean over the input points that belong to it. */
function meanOfMembers(/** @type {Outcome} */ { reduced: { assignment, weights } }, /** @type {Float32Array} */ values) {
  const out = new Float32Array(weights.length);
  assignment?.forEach((reduced, i) => (out[reduced] += values[i] / weights[reduced]));
  return out;
}

/**
 * Values of vertices to which no point was nearest, from their neighbours: a few lie between points everywhere. What is
 * further from any point stays unknown.
 */
function filled(/** @type {Float32Array} */ values, /** @type {Uint32Array} */ indices) {
  let known = values;
  for (let pass = 0; pass < 2; pass++) {
    const sums = new Float32Array(values.length);
    const counts = new Uint16Array(values.length);
    for (let i = 0; i < indices.length; i++) {
      const [from, to] = [indices[i], indices[i % 3 === 2 ? i - 2 : i + 1]];
      if (Number.isNaN(known[from])) continue;
      sums[to] += known[from];
      counts[to]++;
    }
    known = known.map((value, i) => (Number.isNaN(value) && counts[i] ? sums[i] / counts[i] : value));
  }
  return known;
}

/** The value that a share of the others are under. */
function quantile(/** @type {Float32Array} */ values, /** @type {number} */ share) {
  const known = values.filter((value) => !Number.isNaN(value)).sort();
  return known[Math.floor(share * (known.length - 1))] ?? 0;
}
