/** One scan of a catalogue: read, cleaned, reconstructed, made light and textured, written, and drawn. */
import { stat } from 'node:fs/promises';
import { basename, join } from 'node:path';
import { frameOf } from '../viewer/frame.js';
import { likelyUp } from '../viewer/upright.js';
import { direction } from '../engine/axes.js';
import { withSaid } from './cloud-flags.js';
import { besideOf, levelName, openInput, writeOutput } from '../files/disk.js';
import { doubtLines, reasonLines } from './report-text.js';

/** @import { Engine, StepReport, SurfaceReport } from '../types.js' */

/** What a model gets where nobody says it. */
export const DEFAULTS = { triangles: 20_000, texture: { size: 1024 } };
/** @type {[number, number]} */
const POSTER = [800, 600];

/**
 * What was made, and the numbers that matter.
 * @typedef {object} Made
 * @property {string[]} files in the scan's folder
 * @property {string} format
 * @property {number} scanBytes
 * @property {number} points
 * @property {number} triangles
 * @property {number} bytes of the model
 * @property {number} rms distance of the points from the surface before it was made light, a share of the diagonal
 * @property {number} lost largest distance between that and the model, a share of the diagonal
 * @property {string[]} doubts
 * @property {number} seconds
 */

/**
 * @param {Engine} engine
 * @param {import('./run.js').Whole} task
 * @param {string} path
 * @param {string} folder that is there
 * @param {AbortSignal} signal
 * @returns {Promise<Made>}
 */
export async function make(engine, { read, own, cloud: said, steps, write }, path, folder, signal) {
  const start = performance.now();
  const given = await engine.read(await openInput(path, signal), { name: basename(path), beside: besideOf(path), ...read, signal, transfer: true });
  const { file } = given;
  const points = given.positions.length / 3;
  const scan = withSaid(given, said);
  // A model that lies on its side would be seen so by all.
  const up = scan.up ?? direction(likelyUp(scan, frameOf(scan).size));
  const prepare = steps.length > 0 ? { prepare: steps } : {};
  const mesh = await engine.reconstruct({ ...scan, up }, { ...own, ...prepare, signal, transfer: true });
  /** @type {import('../types.js').WriteOptions} */
  const options = { format: 'glb', quantize: true, ...write };
  const model = await engine.write(mesh, { ...options, signal });
  const usdz = await engine.write(mesh, { format: 'usdz', signal });
  /** @type {Record<string, Uint8Array>} */
  const levels = {};
  for (const [i, level] of (mesh.lods ?? []).entries()) levels[levelName('model.glb', i + 1)] = await engine.write(level, { ...options, signal });
  const poster = await engine.poster(mesh, { size: POSTER, signal });
  /** @type {SurfaceReport} */
  const report = mesh.report;
  const labelled = /** @type {{ prepared?: { steps: StepReport[] } }} */ (mesh).prepared?.steps ?? [];
  const told = labelled.map(({ labels, ...step }) => step);
  // That the file is a mesh is no fault of the model.
  const faults = { ...report, doubts: report.doubts.filter(({ code }) => code !== 'sampled-from-faces') };
  const doubts = [...reasonLines(told), ...doubtLines(faults)];
  const seconds = (performance.now() - start) / 1000;
  const whole = { source: basename(path), file, model: { bytes: model.length, triangles: report.triangles }, doubts, steps: told, report, seconds };
  const files = { 'model.glb': model, ...levels, 'model.usdz': usdz, 'poster.png': poster.data, 'report.json': new TextEncoder().encode(`${JSON.stringify(whole, null, 2)}\n`) };
  for (const [name, bytes] of Object.entries(files)) await writeOutput(join(folder, name), bytes, signal);
  return {
    files: Object.keys(files),
    format: file.format,
    scanBytes: (await stat(path)).size,
    points,
    triangles: report.triangles,
    bytes: model.length,
    rms: report.distance.rms,
    lost: report.simplified?.error.max ?? 0,
    doubts,
    seconds,
  };
}
