/** The steps of tiles, each by its stage: what it reads from the folder and what it writes there. They hold nothing between them. */
import { mkdir, readFile, rename, stat } from 'node:fs/promises';
import { basename } from 'node:path';
import { compressorFor } from '../files/compressor.js';
import { version } from '../files/version.js';
import { PointweaveError } from '../engine/errors.js';
import { CellWriter, around, inRange, readCells } from './cells.js';
import { belonging, between, boxOf, decode, encode, joined, selected } from './columns.js';
import { sha256 } from './folder.js';
import { withModule } from './modules.js';
import { meshLevel } from './meshing.js';
import { SCRIPTS, pageOf } from './page.js';
import { DENSITY, MANIFEST, PAGE, PLAN, TILESET, countsPath, cutOf, deepest, factsPath, glbPath, madePath, meshPath, samplePath, sortedPath, tasksOf } from './plan.js';
import { columnsOf, leavesOut, positionsOf, readScan, toldOf, toldTogether } from './scan.js';
import { tilesetOf } from './tileset.js';

/** @import { Columns } from './columns.js' */
/** @import { Folder } from './folder.js' */
/** @import { Plan, Planned, TileOptions } from './plan.js' */

const VERSION = 1;
/** Scalars that are kept if a file has them. */
const COMMON = ['intensity', 'classification'];
/** Groups of points that are measured, at least, and points of each, at least. */
const SAMPLES = { count: 128, points: 500 };
/** Of those that are reduced until they keep a tolerance: larger, so that they hold some reduced points. */
const TOLERANCE_SAMPLES = { count: 32, points: 8000 };
/** Share of a leaf's side around it that is sampled, too: `src/tiles/samples.rs`. */
const AROUND = 1 / 4;
/** Bytes of sorted points that are kept before they are written. */
const BUFFER = 64 << 20;

/**
 * Counts an input's points.
 * @param {Folder} folder
 * @param {number} index
 * @param {string} path
 * @param {{ read: Record<string, any>, part?: import('./parts.js').Part }} what how it is read, and which part
 */
export async function count(folder, index, path, { read, part }) {
  const name = basename(path);
  await withModule('tiles', folder.signal, async (ask) => {
    let points = 0;
    /** @param {import('./scan.js').Told} [told] */
    const pass = async (told) => {
      points = 0;
      await ask({ call: 'takeCounts', args: [] });
      return toldOf(await readScan(path, part, read, folder.signal, async (block) => {
        const positions = positionsOf(block, told);
        points += positions.length / 3;
        await ask({ call: 'countPoints', args: [positions] });
      }));
    };
    let told = await pass();
    // Which points are none is known now.
    if (leavesOut(told)) told = await pass(told);
    /** @type {Uint8Array} */
    const counts = await ask({ call: 'takeCounts', args: [] });
    const size = part ? part.to - part.from : (await stat(path)).size;
    await folder.writeJson(countsPath(index), { name, bytes: size, points, part, told, counts: Buffer.from(counts).toString('base64') });
  });
}

/**
 * Makes the plan of inputs that are counted.
 * @param {Folder} folder
 * @param {number} inputs how many
 * @param {TileOptions} options
 * @returns {Promise<Plan>}
 */
export async function plan(folder, inputs, options) {
  /** @type {(Plan['inputs'][number] & { told: import('./scan.js').Told, counts: string })[]} */
  const counted = [];
  for (let i = 0; i < inputs; i++) counted.push(await folder.json(countsPath(i)));
  for (const parts of byFile(counted)) {
    const told = toldTogether(parts.map((part) => part.told));
    if (parts.length > 1) for (const part of parts) part.told = told;
  }
  const counts = counted.map(({ counts: text }) => new Uint8Array(Buffer.from(text, 'base64')));
  /** @type {import('./plan.js').Octree} */
  const octree = await withModule('tiles', folder.signal, (ask) => ask({ call: 'planTiles', args: [counts, options.tilePoints] }));
  const kept = [...COMMON, ...Object.keys(options.attributes)];
  const names = kept.filter((name, i) => kept.indexOf(name) === i && counted.some(({ told }) => told.attributes.includes(name)));
  const given = counted.reduce((sum, { points }) => sum + points, 0);
  const finest = options.meshPoints === undefined ? undefined : finestMesh(octree, keptOf(options.target, given), options.meshPoints);
  const seenFromAbove = counted.every(({ told }) => told.seenFromAbove);
  const units = new Set(counted.map(({ told }) => told.unit));
  const [unit] = units.size === 1 ? units : [];
  /** @type {Plan} */
  const made = {
    version: VERSION,
    made: `pointweave ${await version()}`,
    options,
    inputs: counted.map(({ name, bytes, points, part, told }) => ({ name, bytes, points, ...(part && { part, told }) })),
    names,
    unit: options.unit ?? unit,
    ...(seenFromAbove && { seenFromAbove }),
    octree,
    ...(finest !== undefined && { finest }),
    tasks: tasksOf(octree, options.target, finest),
  };
  await folder.writeJson(PLAN, made);
  return made;
}

/** Inputs that are parts of one file together. @template {Plan['inputs'][number]} T @param {T[]} inputs */
function byFile(inputs) {
  /** @type {T[][]} */
  const files = [];
  for (const input of inputs) {
    if (input.part && input.part.index > 0) files.at(-1)?.push(input);
    else files.push([input]);
  }
  return files;
}

/** Points of the finest tiles, about. @param {TileOptions['target']} target @param {number} points of the scan */
function keptOf(target, points) {
  return 'count' in target ? target.count : 'ratio' in target ? target.ratio * points : points;
}

/** The finest level that has no more points than that, each a quarter of those of the one below. @param {import('./plan.js').Octree} octree @param {number} points @param {number} most */
function finestMesh(octree, points, most) {
  const level = Math.max(0, Math.ceil(Math.log2(points / most) / 2));
  return Math.min(level, deepest(octree));
}

/** @param {Folder} folder @returns {Promise<Plan>} */
export async function planOf(folder) {
  const found = await folder.json(PLAN);
  if (found.version !== VERSION) throw new PointweaveError({ code: 'bad-file', message: `${folder.at(PLAN)} is of another version of pointweave: start anew in an empty folder`, expected: VERSION, found: found.version });
  return found;
}

/**
 * Puts an input's points into files, one a leaf.
 * @param {Folder} folder
 * @param {number} index
 * @param {string} path where it lies here
 */
export async function sort(folder, index, path) {
  const { octree, options, names, inputs } = await planOf(folder);
  const { part: some, told = (await folder.json(countsPath(index))).told } = inputs[index];
  const leaves = octree.leaves.map(({ tile }) => tile);
  const part = `work/sorted/${index}.part`;
  await folder.remove(part);
  await mkdir(folder.at(part), { recursive: true });
  const points = new Map(octree.leaves.flatMap(({ tile, files }) => files.filter(([input]) => input === index).map(([, count]) => [tile, count])));
  const cells = new CellWriter(folder.at(part), points);
  await withModule('tiles', folder.signal, async (ask) => {
    await ask({ call: 'openLeaves', args: [octree, leaves] });
    await readScan(path, some, options.read, folder.signal, async (block) => {
      const { places, order, tiles, counts } = await ask({ call: 'splitPoints', args: [positionsOf(block, told)] });
      const columns = { places, ...belonging(columnsOf(block, told, names), order) };
      let from = 0;
      tiles.forEach((/** @type {string} */ tile, /** @type {number} */ i) => {
        cells.add(tile, between(columns, from, from + counts[i]));
        from += counts[i];
      });
      if (cells.held > BUFFER) await cells.flush();
    });
  });
  await cells.end();
  await folder.remove(`work/sorted/${index}`);
  await rename(folder.at(part), folder.at(`work/sorted/${index}`));
}

/**
 * Takes samples of a leaf.
 * @param {Folder} folder
 * @param {string} tile
 */
export async function measure(folder, tile) {
  const { octree, options, tasks } = await planOf(folder);
  const { files, around: others } = found(octree.leaves, tile);
  const leaves = others.map((other) => found(octree.leaves, other));
  const { places } = joined(await sortedOf(folder, leaves, around(tile, AROUND)), []);
  const own = files.reduce((sum, [, points]) => sum + points, 0);
  const { count: most, points: each } = 'tolerance' in options.target ? TOLERANCE_SAMPLES : SAMPLES;
  const count = Math.ceil(most / tasks.filter(({ stage }) => stage === 'measure').length);
  /** @type {{ indices: Uint32Array, range: number[] }[]} */
  const samples = await withModule('tiles', folder.signal, (ask) => ask({ call: 'sampleTile', args: [tile, places, count, each] }));
  const blocks = samples.map(({ indices, range }) => {
    const { places: some } = selected({ places, names: [], values: [] }, indices);
    const points = own / samples.length;
    return encode({ places: some, names: [], values: [], more: { range, points } });
  });
  await folder.write(samplePath(tile), Buffer.concat(blocks));
}

/**
 * Measures the scan by the samples.
 * @param {Folder} folder
 */
export async function density(folder) {
  const { octree, options, tasks, inputs } = await planOf(folder);
  const blocks = await blocksOf(folder, tasks.filter(({ stage }) => stage === 'measure').map(({ tile = '' }) => samplePath(tile)));
  const samples = blocks.map(({ places, more }) => ({ places, range: more.range, points: more.points }));
  const measured = samples.reduce((sum, { points }) => sum + points, 0);
  const all = inputs.reduce((sum, { points }) => sum + points, 0) - octree.strays;
  // The leaves that are measured stand for all.
  const weighted = samples.map((sample) => ({ ...sample, points: (sample.points * all) / measured }));
  const args = [weighted, octree, options.target, { curvatureWeight: options.curvatureWeight }];
  await folder.writeJson(DENSITY, await withModule('tiles', folder.signal, (ask) => ask({ call: 'measureTiles', args })));
}

/**
 * Reduces a leaf.
 * @param {Folder} folder
 * @param {string} tile
 */
export async function make(folder, tile) {
  const made = await planOf(folder);
  const planned = found(made.octree.leaves, tile);
  const leaves = planned.around.map((other) => found(made.octree.leaves, other));
  await reduced(folder, made, planned, (range) => sortedOf(folder, leaves, range));
}

/**
 * Reduces a tile above leaves from the reduced points below it.
 * @param {Folder} folder
 * @param {string} tile
 */
export async function level(folder, tile) {
  const made = await planOf(folder);
  const planned = found(made.octree.inner, tile);
  await reduced(folder, made, planned, async (range) => (await blocksOf(folder, planned.around.map(madePath))).map((block) => inRange(block, range)));
}

/** @param {Folder} folder @param {Plan} plan @param {Planned} planned @param {(range: number[]) => Promise<Columns[]>} points those of a range of the root's lattice */
async function reduced(folder, { octree, options, names }, { tile, level: of }, points) {
  const measures = await folder.json(DENSITY);
  const carried = Object.fromEntries(names.map((name) => [name, options.attributes[name] ?? (name === 'classification' ? 'majority' : 'mean')]));
  const result = await withModule('tiles', folder.signal, async (ask) => {
    /** @type {number[]} */
    const range = await ask({ call: 'tileSurroundings', args: [tile, of, octree, measures] });
    const given = joined(await points(range), names);
    return ask({ call: 'reduceTile', args: [given, tile, of, octree, measures, { attributes: carried, outliers: options.outliers }] });
  });
  /** @type {Columns} */
  const made = { names, ...result };
  const { low, high } = boxOf(made.places, octree.size / 2 ** 32);
  const facts = { tile, level: of, points: made.places.length / 3, low, high };
  await folder.write(madePath(tile), encode(made));
  if (options.meshPoints !== undefined) return folder.writeJson(factsPath(tile), facts);
  const center = low.map((x, axis) => (x + high[axis]) / 2);
  const glb = await withModule('exports', folder.signal, (ask) => ask({ call: 'write', args: [cloudOf(made, octree.size, center), { format: 'glb', quantize: true }] }));
  const bytes = await (await compressorOf(options))(glb);
  await folder.write(glbPath(tile), bytes);
  await folder.writeJson(factsPath(tile), { ...facts, uri: glbPath(tile), bytes: bytes.length, sha256: sha256(bytes) });
}

/** @param {TileOptions} options @returns {Promise<(glb: Uint8Array) => Promise<Uint8Array>>} */
async function compressorOf({ meshopt }) {
  return (await compressorFor(meshopt)) ?? (async (glb) => glb);
}

/**
 * Meshes a level.
 * @param {Folder} folder
 * @param {number} of
 */
export async function mesh(folder, of) {
  const made = await planOf(folder);
  const blocks = await blocksOf(folder, cutOf(made.octree, of).map(madePath));
  await meshLevel(folder, made, of, blocks, await compressorOf(made.options));
}

/**
 * A cloud around a place in the root's cube, whose axes are written as those of a scan with z up: what shows tiles turns them back.
 * @param {Columns} columns @param {number} size @param {number[]} center
 */
function cloudOf({ places, colors, names, values }, size, center) {
  const step = size / 2 ** 32;
  return {
    positions: Float32Array.from(places, (x, i) => x * step - center[i % 3]),
    colors,
    attributes: Object.fromEntries(names.map((name, i) => [name, values[i]])),
    origin: center,
    up: [0, 0, 1],
  };
}

/**
 * Writes the tileset, and a page that shows it.
 * @param {Folder} folder
 */
export async function finish(folder) {
  const made = await planOf(folder);
  const { octree, inputs, options } = made;
  /** @type {import('./tileset.js').Facts[]} */
  const reducedTiles = [];
  for (const { tile } of [...octree.inner.toReversed(), ...octree.leaves]) reducedTiles.push(await folder.json(factsPath(tile)));
  /** @type {import('./tileset.js').Facts[]} */
  const facts = [];
  const levels = made.tasks.filter(({ stage }) => stage === 'mesh').toReversed();
  for (const { tile = '' } of levels) facts.push(...(await folder.json(meshPath(tile))));
  if (levels.length === 0) facts.push(...reducedTiles);
  const measures = await folder.json(DENSITY);
  const text = new TextEncoder();
  /** @type {[string, Uint8Array][]} */
  const written = [[TILESET, text.encode(`${JSON.stringify(tilesetOf(made, facts, measures))}\n`)], [PAGE, text.encode(pageOf(made))]];
  for (const script of SCRIPTS) written.push([script, await readFile(new URL(`../${script}`, import.meta.url))]);
  for (const [name, bytes] of written) await folder.write(name, bytes);
  const tiles = facts.map(({ uri, bytes, sha256: sum }) => [uri, { bytes, sha256: sum }]);
  const files = Object.fromEntries([...written.map(([name, bytes]) => [name, { bytes: bytes.length, sha256: sha256(bytes) }]), ...tiles]);
  const leaves = reducedTiles.filter((fact) => fact.level === 0);
  await folder.writeJson(MANIFEST, {
    version: VERSION,
    made: made.made,
    options,
    inputs: byFile(inputs).map((parts) => ({ name: parts[0].name, bytes: total(parts, 'bytes'), points: total(parts, 'points') })),
    points: inputs.reduce((sum, { points }) => sum + points, 0),
    strays: octree.strays,
    reduced: leaves.reduce((sum, { points }) => sum + points, 0),
    tiles: facts.length,
    ...(levels.length > 0 && { triangles: facts.filter(({ level }) => level === made.finest).reduce((sum, { triangles = 0 }) => sum + triangles, 0) }),
    spacing: measures.target,
    noise: measures.noise,
    ...(measures.tolerance && { tolerance: measures.tolerance }),
    files,
  });
}

/** @param {Plan['inputs']} parts @param {'bytes' | 'points'} what */
function total(parts, what) {
  return parts.reduce((sum, part) => sum + part[what], 0);
}

/** The points of files. @param {Folder} folder @param {string[]} files */
async function blocksOf(folder, files) {
  const blocks = [];
  for (const file of files) blocks.push(...decode(await folder.read(file)));
  return blocks;
}

/**
 * The sorted points of leaves, and where a range is given those in it.
 * @param {Folder} folder @param {Pick<Planned, 'tile' | 'files'>[]} leaves @param {ArrayLike<number>} [range]
 */
async function sortedOf(folder, leaves, range) {
  const blocks = [];
  for (const { tile, files } of leaves) {
    for (const [input] of files) {
      const path = sortedPath(input, tile);
      await folder.expect(path);
      blocks.push(...(await readCells(folder.at(path), tile, range)));
    }
  }
  return blocks;
}

/** @param {Planned[]} tiles @param {string} tile */
function found(tiles, tile) {
  const planned = tiles.find((other) => other.tile === tile);
  if (!planned) throw new PointweaveError({ code: 'bad-option', message: `there is no tile ${tile} of that stage`, expected: 'a tile of the plan', found: tile });
  return planned;
}
