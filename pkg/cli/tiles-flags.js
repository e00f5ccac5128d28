/** What the command line says of tiles. */
import { availableParallelism } from 'node:os';
import { TARGETS } from '../engine/options-table.js';
import { TABLES } from '../engine/options.js';
import { integer, number } from '../engine/rules.js';
import { parseValue } from './flags.js';
import { UsageError } from './usage.js';

/** How `parseArgs` is told of them. */
export const TILES_FLAGS = /** @type {const} */ ({
  ratio: { type: 'string' },
  count: { type: 'string' },
  spacing: { type: 'string' },
  tolerance: { type: 'string' },
  outliers: { type: 'string' },
  'curvature-weight': { type: 'string' },
  attributes: { type: 'string', multiple: true },
  mesh: { type: 'boolean' },
  'mesh-points': { type: 'string' },
  meshopt: { type: 'boolean' },
  'tile-points': { type: 'string' },
  memory: { type: 'string' },
  jobs: { type: 'string' },
  resume: { type: 'boolean' },
  'keep-work': { type: 'boolean' },
  tile: { type: 'string' },
  input: { type: 'string' },
  stage: { type: 'string' },
});

/** For the help. */
export const TILES_ROWS = [
  ['-o, --out FOLDER', 'where the tileset goes, with a page that shows it'],
  ['--ratio N', 'about this share of the points in the finest tiles; default: 1/3'],
  ['--count N', 'about so many points in the finest tiles'],
  ['--spacing N', "the finest tiles' mean spacing of points, in the scan's unit"],
  ['--tolerance N', "as few points as keep 99 % of the surface within this distance, in the scan's unit"],
  ['--outliers HOW', 'keep or drop isolated points; default: keep'],
  ['--curvature-weight N', 'from even spacing to concentration on curved regions: 0 to 1; default: 0.5'],
  ['--attributes NAME=HOW', 'another scalar than intensity and classification that is kept, and how: mean, majority or nearest'],
  ['--mesh', 'tiles of a mesh instead of points; needs --ratio or --count'],
  ['--mesh-points N', 'points through which the finest mesh goes, at most; default: 1000000, or what --memory holds'],
  ['--meshopt', 'compressed tiles; needs @gltf-transform/core, @gltf-transform/extensions and meshoptimizer'],
  ['--tile-points N', 'points of the scan in a tile, at most; default: 2000000'],
  ['--memory SIZE', 'how much all jobs may take together, as 2GB or 900MB; default: 2GB'],
  ['--jobs N', 'tiles at a time, as far as memory goes; default: one a core'],
  ['--resume', 'go on where an earlier run of the same scan stopped'],
  ['--keep-work', 'leave the folder work/ with what the steps gave each other'],
];

/** Of a single step. */
export const STEP_ROWS = [
  ['--tile ID', "which: a tile of the plan, of count and sort an input's number from 0, of mesh a level"],
  ['--input FILE', 'where the input of sort lies, if it is another place than it had'],
  ['--stage NAME', 'of list: whose tiles are printed, one a line'],
];

/** The steps, in their order, and what tells of them. */
export const STEPS = /** @type {const} */ (['count', 'plan', 'sort', 'measure', 'density', 'make', 'level', 'mesh', 'finish', 'list']);

/** Bytes that a job takes, and for each point of a tile: measured, `docs/tiles.md`. */
const JOB = 250e6;
const POINT = 330;
/** For each point of a mesh. */
const MESH_POINT = 1500;

/**
 * @typedef {object} TilesSaid
 * @property {typeof STEPS[number]} [step] alone
 * @property {string[]} inputs
 * @property {string} folder
 * @property {import('../tiles/plan.js').TileOptions} options
 * @property {number} jobs
 * @property {{ memory: number, costOf: (stage: string) => number }} room
 * @property {boolean} resume
 * @property {boolean} keepWork
 * @property {string} [tile]
 * @property {string} [input]
 * @property {string} [stage]
 */

/**
 * @param {Record<string, any>} values of `parseArgs`
 * @param {string[]} positionals
 * @param {{ read: Record<string, any>, unit?: import('../types.js').Unit }} scan
 * @returns {TilesSaid}
 */
export function tilesSaid(values, positionals, { read, unit }) {
  const step = STEPS.find((name) => name === positionals[0]);
  const inputs = step ? positionals.slice(1) : positionals;
  const folder = values.out;
  if (folder === undefined) throw new UsageError('where should the tiles go? -o FOLDER');
  if (folder === '-' || inputs.includes('-')) throw new UsageError('tiles are made of files, into a folder');
  if (!step && inputs.length === 0) throw new UsageError('tiles needs a file or a folder of files');
  const tilePoints = value('tile-points', integer(1000, 20_000_000), values) ?? 2_000_000;
  const memory = values.memory === undefined ? 2e9 : bytesIn(values.memory);
  const most = Math.floor(memory / (JOB + POINT * tilePoints));
  if (most < 1 && !step) {
    const fits = Math.floor((memory - JOB) / POINT / 1000) * 1000;
    const why = `tiles of ${tilePoints} points take ${Math.round((JOB + POINT * tilePoints) / 1e6)} MB`;
    throw new UsageError(`--memory is ${values.memory ?? '2GB'}, and ${why}${fits >= 1000 ? `: --tile-points ${fits} fits` : ''}`);
  }
  const mesh = meshing(values, memory);
  const jobs = value('jobs', integer(1, 256), values) ?? availableParallelism();
  return {
    step, inputs, folder,
    options: { target: targetOf(values), tilePoints, ...curvature(values), attributes: carried(values), outliers: outliersOf(values), meshopt: Boolean(values.meshopt), ...mesh, unit, read },
    jobs: Math.max(1, Math.min(jobs, most)),
    room: { memory, costOf: (stage) => JOB + (stage === 'mesh' ? MESH_POINT * (mesh.meshPoints ?? 0) : POINT * tilePoints) },
    resume: Boolean(values.resume),
    keepWork: Boolean(values['keep-work']),
    tile: values.tile, input: values.input, stage: values.stage,
  };
}

/** @param {string} name @param {import('../engine/rules.js').Rule} rule @param {Record<string, any>} values @returns {number | undefined} */
function value(name, rule, values) {
  return values[name] === undefined ? undefined : /** @type {number} */ (parseValue(name, rule, values[name]));
}

/** @param {Record<string, any>} values @returns {import('../tiles/plan.js').TileOptions['target']} */
function targetOf(values) {
  const given = ['ratio', 'count', 'spacing', 'tolerance'].filter((name) => values[name] !== undefined);
  if (given.length > 1) throw new UsageError(`--${given[0]} and --${given[1]} exclude each other`);
  const [name = 'ratio'] = given;
  const length = number(0, Number.MAX_VALUE, { open: '(' });
  const rules = { ratio: TARGETS.ratio, count: TARGETS.count, spacing: length, tolerance: length };
  return /** @type {any} */ ({ [name]: value(name, rules[/** @type {keyof typeof rules} */ (name)], values) ?? 1 / 3 });
}

/** @param {Record<string, any>} values */
function curvature(values) {
  const weight = value('curvature-weight', TABLES.reduce.curvatureWeight, values);
  return weight === undefined ? {} : { curvatureWeight: weight };
}

/** @param {Record<string, any>} values @param {number} memory of all jobs */
function meshing(values, memory) {
  const points = value('mesh-points', integer(1000, 5_000_000), values);
  const fits = Math.floor((memory - JOB) / MESH_POINT / 1000) * 1000;
  if (!values.mesh && points !== undefined) throw new UsageError('--mesh-points is for --mesh');
  if (values.mesh && (values.spacing ?? values.tolerance) !== undefined) throw new UsageError('--mesh needs --ratio or --count, which tell how many points there will be');
  if (!values.mesh) return {};
  if (fits < 1000 || (points ?? 0) > fits) {
    const needed = `a mesh through ${points ?? 1000} points takes ${Math.round((JOB + MESH_POINT * (points ?? 1000)) / 1e6)} MB`;
    throw new UsageError(`--memory is ${values.memory ?? '2GB'}, and ${needed}${fits >= 1000 ? `: --mesh-points ${fits} fits` : ''}`);
  }
  return { meshPoints: points ?? Math.min(1_000_000, fits) };
}

/** @param {{ outliers?: string }} values @returns {'keep' | 'drop'} */
function outliersOf({ outliers = 'keep' }) {
  if (outliers !== 'keep' && outliers !== 'drop') throw new UsageError(`--outliers is '${outliers}': expected keep or drop`);
  return outliers;
}

/** @param {{ attributes?: string[] }} values */
function carried({ attributes = [] }) {
  return Object.fromEntries(attributes.map((text) => {
    const [name, how = 'mean'] = text.split('=');
    if (!name || !['mean', 'majority', 'nearest'].includes(how)) throw new UsageError(`--attributes is '${text}': expected NAME=mean, NAME=majority or NAME=nearest`);
    return [name, how];
  }));
}

/** @param {string} text */
function bytesIn(text) {
  const [, digits, unit] = /^(\d+(?:\.\d+)?)\s*(GB|MB|G|M)$/i.exec(text) ?? [];
  if (!digits) throw new UsageError(`--memory is '${text}': expected a size as 2GB or 900MB`);
  return Number(digits) * (/^G/i.test(unit) ? 1e9 : 1e6);
}
