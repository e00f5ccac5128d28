/** A scan of any size as tiles that a page streams: all steps on this machine, or one of them for a scheduler. */
import { stat } from 'node:fs/promises';
import { basename, join } from 'node:path';
import { compressorFor } from '../files/compressor.js';
import { Folder } from '../tiles/folder.js';
import { partsOf } from '../tiles/parts.js';
import { MANIFEST, PLAN, STAGES, TILESET, countsPath } from '../tiles/plan.js';
import { runStep } from '../tiles/run-step.js';
import { Workers, runAll } from '../tiles/schedule.js';
import { plan, planOf } from '../tiles/steps.js';
import { makeFolder, sentence } from '../files/disk.js';
import { say } from './say.js';
import { scansAt } from './sources.js';
import { UsageError } from './usage.js';

/** @import { Plan } from '../tiles/plan.js' */
/** @import { TilesSaid } from './tiles-flags.js' */

/** Bytes a sorted point takes without its scalars, and a tile's point in files. */
const SORTED = 15;
const SHOWN = 18;

/**
 * @param {{ json: boolean }} task
 * @param {TilesSaid} said
 * @param {AbortSignal} signal
 * @returns {Promise<boolean>}
 */
export async function tiles({ json }, said, signal) {
  const folder = new Folder(said.folder, signal);
  if (said.step) {
    await step(folder, said);
    return true;
  }
  const start = performance.now();
  const inputs = await inputsOf(said.inputs);
  await compressorFor(said.options.meshopt); // that its packages are missing is known before the work
  await makeFolder(said.folder);
  const given = await givenOf(inputs);
  if (await isDone(folder, said, given)) {
    say(`${said.folder}: nothing to do`);
    return true;
  }
  const workers = new Workers(folder, said.jobs, said.room);
  try {
    const pieces = await piecesOf(inputs, said, signal);
    const made = await planned(workers, pieces, given, said);
    await runAll(workers, made.tasks, pieces.map(({ path }) => path), teller(made));
  } finally {
    await workers.end();
  }
  const manifest = await folder.json(MANIFEST);
  if (!said.keepWork) {
    await folder.remove('work/inputs.json'); // without it a stop in between leaves no work that is gone on with
    await folder.remove('work');
  }
  if (json) process.stdout.write(`${JSON.stringify(manifest, null, 2)}\n`);
  const { points, reduced, tiles: count, strays } = manifest;
  const left = strays ? `, ${strays} far from all others were left out` : '';
  say(`${said.folder}: ${grouped(points)} points to ${grouped(reduced)} in ${count} tiles, ${((performance.now() - start) / 1000).toFixed(1)} s${left}`);
  return true;
}

/** @typedef {{ path: string, part?: import('../tiles/parts.js').Part }} Piece a file, or a part of a large one */

/**
 * Files, and the parts of those that are read in parts.
 * @param {string[]} inputs @param {TilesSaid} said @param {AbortSignal} signal
 * @returns {Promise<Piece[]>}
 */
async function piecesOf(inputs, { options: { attributes } }, signal) {
  /** @type {Piece[]} */
  const pieces = [];
  for (const path of inputs) {
    // Times are counted from the first of a file.
    const parts = 'gps_time' in attributes ? [] : await partsOf(path, signal);
    pieces.push(...(parts.length > 0 ? parts.map((part) => ({ path, part })) : [{ path }]));
  }
  return pieces;
}

/** What tells whether the files are those of an earlier run. @param {string[]} inputs */
function givenOf(inputs) {
  return Promise.all(inputs.map(async (input) => ({ name: basename(input), bytes: (await stat(input)).size })));
}

/**
 * Counts what is not counted, and plans; or goes on with the plan that is there.
 * @param {Workers} workers @param {Piece[]} pieces @param {Awaited<ReturnType<typeof givenOf>>} given @param {TilesSaid} said
 */
async function planned(workers, pieces, given, { options, resume, folder: path }) {
  const { folder } = workers;
  const key = JSON.stringify({ options, given });
  const there = await folder.has('work/inputs.json');
  if (there && !resume) throw new UsageError(`'${path}' has the work of an earlier run: --resume goes on with it, or remove ${join(path, 'work')}`);
  if (there && JSON.stringify(await folder.json('work/inputs.json')) !== key) throw new UsageError(`'${path}' has the work of other scans or options: remove ${join(path, 'work')}`);
  await folder.writeJson('work/inputs.json', { options, given });
  if (await folder.has(PLAN)) return planOf(folder);
  let counted = 0;
  /** @type {Set<string>} */
  const bad = new Set();
  await inTurn(workers, pieces, async ({ path: input, part }, i) => {
    try {
      if (!(await folder.has(countsPath(i)))) await workers.run({ stage: 'count', tile: `${i}`, input, read: options.read, part });
      say(`counted ${++counted} of ${pieces.length}: ${input}${part ? `, part ${part.index + 1}` : ''}`);
    } catch (error) {
      folder.signal.throwIfAborted();
      // The other files are counted all the same, and all bad ones are known at once.
      if (!bad.has(input)) say(sentence(error));
      bad.add(input);
    }
  });
  if (bad.size > 0) throw new Error(`${bad.size} of ${given.length} files cannot be read: nothing was made of the others yet`);
  const made = await plan(folder, pieces.length, options);
  const points = made.inputs.reduce((sum, input) => sum + input.points, 0);
  const bytes = points * (SORTED + SHOWN / 3 + 4 * made.names.length);
  say(`${grouped(points)} points in ${made.octree.leaves.length} tiles and ${made.octree.inner.length} above them; the work takes about ${sized(bytes)} of disk`);
  return made;
}

/**
 * For each input, as many at a time as there are workers.
 * @param {Workers} workers @param {Piece[]} pieces @param {(piece: Piece, i: number) => Promise<void>} each
 */
async function inTurn({ most }, pieces, each) {
  let next = 0;
  const work = async () => {
    while (next < pieces.length) {
      const i = next++;
      await each(pieces[i], i);
    }
  };
  await Promise.all(Array.from({ length: Math.min(most, pieces.length) }, work));
}

/** Tells of every stage when it is done, and on a terminal of every task. @param {Plan} plan */
function teller({ tasks }) {
  const start = performance.now();
  const total = (/** @type {string} */ stage) => tasks.filter((task) => task.stage === stage).length;
  const heavy = tasks.reduce((sum, { weight = 0 }) => sum + weight, 0);
  /** @type {Map<string, number>} */
  const counts = new Map();
  let weight = 0;
  /** @param {import('../tiles/plan.js').PlannedTask} task @param {number} done @param {number} all */
  return (task, done, all) => {
    const count = (counts.get(task.stage) ?? 0) + 1;
    counts.set(task.stage, count);
    weight += task.weight ?? 0;
    const share = heavy > 0 ? weight / heavy : done / all;
    const left = share > 0 ? ((performance.now() - start) / 1000) * (1 / share - 1) : 0;
    const { stderr } = process;
    if (stderr.isTTY) stderr.write(`\r${task.stage} ${count}/${total(task.stage)}, about ${Math.ceil(left)} s left\x1b[K${done === all ? '\r\x1b[K' : ''}`);
    else if (count === total(task.stage)) say(`${task.stage}: ${count} of ${count}`);
  };
}

/**
 * Whether an earlier run made the same of the same.
 * @param {Folder} folder @param {TilesSaid} said @param {Awaited<ReturnType<typeof givenOf>>} given
 */
async function isDone(folder, { resume, options }, given) {
  if (!(await folder.has(MANIFEST)) || !(await folder.has(TILESET)) || (await folder.has('work/inputs.json'))) return false;
  const made = await folder.json(MANIFEST);
  const before = made.inputs.map((/** @type {{ name: string, bytes: number }} */ { name, bytes }) => ({ name, bytes }));
  const same = JSON.stringify([made.options, before]) === JSON.stringify([options, given]);
  if (resume && same) return true;
  throw new UsageError(`'${folder.path}' has a tileset${same ? '' : ' of other scans or options'}: remove it, or choose another folder`);
}

/** @param {Folder} folder @param {TilesSaid} said */
async function step(folder, { step: name, inputs, options, tile, input, stage }) {
  if (name === 'count') {
    const [path] = inputs;
    if (!path || inputs.length > 1 || tile === undefined) throw new UsageError('tiles count needs one file, and its number as --tile');
    return runStep(folder, { stage: 'count', tile, input: path, read: options.read });
  }
  if (name === 'plan') {
    if (inputs.length === 0) throw new UsageError('tiles plan needs the files, in the order of their numbers');
    for (const [i, path] of inputs.entries()) if (!(await folder.has(countsPath(i)))) await runStep(folder, { stage: 'count', tile: `${i}`, input: path, read: options.read });
    await plan(folder, inputs.length, options);
    return folder.writeJson('work/paths.json', inputs);
  }
  const { tasks } = await planOf(folder);
  if (name === 'list') {
    if (!STAGES.some((known) => known === stage)) throw new UsageError(`--stage is ${stage === undefined ? 'missing' : `'${stage}'`}: expected one of ${STAGES.join(', ')}`);
    const listed = tasks.filter((task) => task.stage === stage).map((task) => `${task.tile ?? task.id}\n`);
    return void process.stdout.write(listed.join(''));
  }
  const known = tasks.find((task) => task.stage === name && (task.tile === tile || task.tile === undefined));
  if (!known) throw new UsageError(`tiles ${name} needs --tile, one of those that tiles list --stage ${name} prints`);
  const path = name === 'sort' ? (input ?? (await folder.json('work/paths.json'))[Number(tile)]) : undefined;
  return runStep(folder, { stage: /** @type {any} */ (name), tile, input: path });
}

/** @param {string[]} sources files and folders */
async function inputsOf(sources) {
  const inputs = [];
  for (const source of sources) inputs.push(...(await scansAt(source)).paths);
  if (inputs.length === 0) throw new UsageError(`there are no scans in ${sources.join(', ')}`);
  return inputs;
}

/** @param {number} count */
function grouped(count) {
  return count.toLocaleString('en-US');
}

/** @param {number} bytes */
function sized(bytes) {
  return bytes < 1e9 ? `${Math.ceil(bytes / 1e6)} MB` : `${(bytes / 1e9).toFixed(1)} GB`;
}
