/** Colours for layers, and how they are read. */
import { colorize } from './colormap.js';
import { localSpacing } from './density.js';
import { frameOf, toFrame } from './frame.js';
import { creases, sharpPoints } from './sharp.js';
import { PAINT_WORDS } from './words.js';

/**
 * @import { Paint, PaintName, PaintWords, Subject } from '../viewer.js'
 * @import { ReducedCloud, SurfaceMesh } from '../types.js'
 * @typedef {'points' | 'reduced' | 'mesh'} Name
 */

export { PAINT_WORDS };

/** @type {readonly PaintName[]} */
export const PAINTS = ['natural', 'plain', 'normals', 'density', 'error', 'sharp'];

const SHARP = /** @type {const} */ ([222, 94, 12]);
const SMOOTH = /** @type {const} */ ([142, 160, 170]);

/** @param {PaintName} name @param {Subject} subject */
export function canPaint(name, { cloud, reduced, mesh }) {
  if (name === 'plain') return Boolean(cloud.colors);
  if (name === 'normals') return Boolean(reduced || cloud.normals);
  if (name === 'sharp') return Boolean(reduced);
  if (name === 'error') return Boolean(reduced && mesh?.distances);
  return true;
}

/** @param {PaintName} name @param {Name} layer @param {Subject} subject @param {PaintWords} [words] @returns {Paint} */
export function paintOf(name, layer, subject, words = PAINT_WORDS) {
  return PAINTERS[canPaint(name, subject) ? name : 'natural'](layer, subject, words);
}

/** @type {Record<PaintName, (layer: Name, subject: Subject, words: PaintWords) => Paint>} */
const PAINTERS = {
  natural: (layer, subject) => ({ colors: sourceOf(layer, subject)?.colors ?? null, legend: null }),

  plain: () => ({ colors: null, legend: null }),

  normals(layer, subject, words) {
    const { reduced } = subject;
    const own = sourceOf(layer, subject)?.normals;
    const normals = own ?? (reduced && spread(reduced, 3, (i, axis) => reduced.normals[3 * i + axis]));
    if (!normals) return PAINTERS.natural(layer, subject, words);
    return { colors: Uint8Array.from(normals, (value) => 127.5 * (value + 1)), legend: null };
  },

  density(layer, subject, words) {
    const source = sourceOf(layer, subject);
    if (!source) return PAINTERS.natural(layer, subject, words);
    const frame = frameIn(subject);
    const spacing = localSpacing(toFrame(source, frame)).map((distance) => distance * frame.diagonal);
    const [low, high] = [quantile(spacing, 0.02), quantile(spacing, 0.98)];
    return { colors: colorize(spacing, low, high), legend: { title: words.density.title, note: noteOf(words.density.note, subject), low, high, words: words.length } };
  },

  error(layer, subject, { error, length, percent }) {
    const { diagonal } = frameIn(subject);
    const mesh = /** @type {SurfaceMesh} */ (subject.mesh);
    const distances = /** @type {NonNullable<SurfaceMesh['distances']>} */ (mesh.distances);
    const values = {
      points: () => distances.points,
      reduced: () => meanOfMembers(/** @type {ReducedCloud} */ (subject.reduced), distances.points),
      mesh: () => filled(distances.vertices, mesh.indices),
    }[layer]();
    // One scale for all layers; the few points beyond it take its end.
    const others = subject.beside?.distances?.points;
    const high = Math.max(quantile(distances.points, 0.99), others ? quantile(others, 0.99) : 0, 1e-9);
    const words = (/** @type {number} */ share) => `${length(share * diagonal)}\n${percent(share)}`;
    const bare = layer === 'mesh' && values.some(Number.isNaN) ? error.unknown : '';
    return { colors: colorize(values, 0, high), legend: { title: error.titles[layer], note: noteOf(error.note, subject) + bare, low: 0, high, words } };
  },

  sharp(layer, subject, { sharp: words, percent }) {
    const sharp = sharpIn(layer, subject);
    const colors = new Uint8Array(3 * sharp.length);
    let count = 0;
    for (let i = 0; i < sharp.length; i++) {
      colors.set(sharp[i] ? SHARP : SMOOTH, 3 * i);
      count += sharp[i];
    }
    const note = words.note(percent(count / Math.max(1, sharp.length)), layer);
    const css = (/** @type {readonly number[]} */ color) => `rgb(${color.join(' ')})`;
    return { colors, legend: { title: words.title, note, kinds: [[css(SHARP), words.sharp], [css(SMOOTH), words.smooth]] } };
  },
};

/** A note of lengths, in the scan's unit. @param {string | ((unit?: import('../types.js').Unit) => string)} note @param {Subject} subject */
function noteOf(note, { cloud: { unit } }) {
  return typeof note === 'string' ? note : note(unit);
}

/** What a layer draws. @param {Name} layer @param {Subject} subject */
function sourceOf(layer, { cloud, reduced, mesh }) {
  return { points: cloud, reduced, mesh }[layer] ?? null;
}

/** @param {Subject} subject */
function frameIn({ frame, cloud }) {
  return frame ?? frameOf(cloud);
}

/** Which points or vertices of a layer are on sharp features. @param {Name} layer @param {Subject} subject @returns {ArrayLike<number>} */
function sharpIn(layer, subject) {
  const { cloud, mesh } = subject;
  if (layer === 'mesh') return mesh ? creases(mesh) : new Uint8Array(0);
  const reduced = /** @type {ReducedCloud} */ (subject.reduced);
  const sharp = sharpPoints(reduced, cloud, frameIn(subject).diagonal);
  if (layer === 'reduced') return sharp;
  return spread(reduced, 1, (i) => sharp[i]) ?? new Uint8Array(cloud.positions.length / 3);
}

/**
 * For every input point the value of the reduced point that it belongs to; null where nobody knows which that is.
 * @param {ReducedCloud} reduced
 * @param {number} size values a point
 * @param {(reduced: number, part: number) => number} value
 */
function spread({ assignment, weights }, size, value) {
  if (!assignment) return null;
  const out = new Float32Array(size * assignment.length);
  for (let i = 0; i < assignment.length; i++) {
    if (assignment[i] >= weights.length) continue; // an outlier that was dropped
    for (let part = 0; part < size; part++) out[size * i + part] = value(assignment[i], part);
  }
  return out;
}

/** For every reduced point the mean over the input points that belong to it. @param {ReducedCloud} reduced @param {Float32Array} values */
function meanOfMembers({ assignment, weights }, values) {
  const out = new Float32Array(weights.length);
  assignment?.forEach((reduced, i) => (out[reduced] += values[i] / weights[reduced]));
  return out;
}

/**
 * Values of vertices to which no point was nearest, from their neighbours: a few lie between points everywhere. What is further from
 * any point stays unknown.
 * @param {Float32Array} values
 * @param {Uint32Array} indices
 */
function filled(values, indices) {
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

/** The value that a share of the others are under. @param {Float32Array} values @param {number} share */
function quantile(values, share) {
  const known = values.filter((value) => !Number.isNaN(value)).sort();
  return known[Math.floor(share * (known.length - 1))] ?? 0;
}
