/** The steps of tiles, each by its stage: what it reads from the folder and what it writes there. They hold nothing between them. */
import { appendFile, mkdir, readFile, rename, stat } from 'node:fs/promises';
import { basename } from 'node:path';
import { compressorFor } from '../files/compressor.js';
import { version } from '../files/version.js';
import { PointweaveError } from '../engine/errors.js';
import { belonging, between, boxOf, decode, encode, joined, selected } from './columns.js';
import { sha256 } from './folder.js';
import { withModule } from './modules.js';
import { meshLevel } from './meshing.js';
import { SCRIPTS, pageOf } from './page.js';
import { DENSITY, MANIFEST, PAGE, PLAN, TILESET, countsPath, cutOf, deepest, factsPath, glbPath, madePath, meshPath, samplePath, sortedPath, tasksOf } from './plan.js';
import { columnsOf, leavesOut, positionsOf, readScan, toldOf } from './scan.js';
import { tilesetOf } from './tileset.js';

/** @import { Columns } from './columns.js' */
/** @import { Folder } from './folder.js' */
/** @import { Plan, Planned, TileOptions } from './plan.js' */

const VERSION = 1;
/** Scalars that are kept if a file has them. */
const COMMON = ['intensity', 'classification'];
/** Groups of points that are measured, at least. */
const SAMPLES = 128;
/** Bytes of sorted points that are kept before they are written. */
const BUFFER = 64 << 20;

/**
 * Counts an input's points.
 * @param {Folder} folder
 * @param {number} index
 * @param {string} path
 * @param {Record<string, any>} read
 */
export async function count(folder, index, path, read) {
  const name = basename(path);
  await withModule('tiles', folder.signal, async (ask) => {
    let points = 0;
    /** @param {import('./scan.js').Told} [told] */
    const pass = async (told) => {
      points = 0;
      await ask({ call: 'takeCounts', args: [] });
      return toldOf(await readScan(path, read, folder.signal, async (block) => {
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
    const { size } = await stat(path);
    await folder.writeJson(countsPath(index), { name, bytes: size, points, told, counts: Buffer.from(counts).toString('base64') });
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
    inputs: counted.map(({ name, bytes, points }) => ({ name, bytes, points })),
    names,
    unit: options.unit ?? unit,
    ...(seenFromAbove && { seenFromAbove }),
    octree,
    ...(finest !== undefined && { finest }),
    tasks: tasksOf(octree, finest),
  };
  await folder.writeJson(PLAN, made);
  return made;
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
  const { octree, options, names } = await planOf(folder);
  const { told } = await folder.json(countsPath(index));
  const leaves = octree.leaves.map(({ tile }) => tile);
  const part = `work/sorted/${index}.part`;
  await folder.remove(part);
  await mkdir(folder.at(part), { recursive: true });
  /** @type {Map<string, Uint8Array[]>} */
  const waiting = new Map();
  let held = 0;
  const flush = async () => {
    for (const [tile, blocks] of waiting) await appendFile(folder.at(`${part}/${tile}.bin`), Buffer.concat(blocks));
    waiting.clear();
    held = 0;
  };
  await withModule('tiles', folder.signal, async (ask) => {
    await ask({ call: 'openLeaves', args: [octree, leaves] });
    await readScan(path, options.read, folder.signal, async (block) => {
      const { places, order, tiles, counts } = await ask({ call: 'splitPoints', args: [positionsOf(block, told)] });
      const columns = { places, ...belonging(columnsOf(block, told, names), order) };
      let from = 0;
      tiles.forEach((/** @type {string} */ tile, /** @type {number} */ i) => {
        const to = from + counts[i];
        const bytes = encode(between(columns, from, to));
        const blocks = waiting.get(tile);
        if (blocks) blocks.push(bytes);
        else waiting.set(tile, [bytes]);
        held += bytes.length;
        from = to;
      });
      if (held > BUFFER) await flush();
    });
  });
  await flush();
  await folder.remove(`work/sorted/${index}`);
  await rename(folder.at(part), folder.at(`work/sorted/${index}`));
}

/**
 * Takes samples of a leaf.
 * @param {Folder} folder
 * @param {string} tile
 */
export async function measure(folder, tile) {
  const { octree, tasks } = await planOf(folder);
  const { files } = found(octree.leaves, tile);
  const { places } = joined(await blocksOf(folder, files.map(([input]) => sortedPath(input, tile))), []);
  const count = Math.ceil(SAMPLES / tasks.filter(({ stage }) => stage === 'measure').length);
  /** @type {{ indices: Uint32Array, range: number[] }[]} */
  const samples = await withModule('tiles', folder.signal, (ask) => ask({ call: 'sampleTile', args: [tile, places, count] }));
  const blocks = samples.map(({ indices, range }) => {
    const { places: some } = selected({ places, names: [], values: [] }, indices);
    const points = places.length / 3 / samples.length;
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
  const { around } = found(made.octree.leaves, tile);
  const files = around.flatMap((other) => found(made.octree.leaves, other).files.map(([input]) => sortedPath(input, other)));
  await reduced(folder, made, found(made.octree.leaves, tile), files);
}

/**
 * Reduces a tile above leaves from the reduced points below it.
 * @param {Folder} folder
 * @param {string} tile
 */
export async function level(folder, tile) {
  const made = await planOf(folder);
  const planned = found(made.octree.inner, tile);
  await reduced(folder, made, planned, planned.around.map(madePath));
}

/** @param {Folder} folder @param {Plan} plan @param {Planned} planned @param {string[]} files */
async function reduced(folder, { octree, options, names }, { tile, level: of }, files) {
  const measures = await folder.json(DENSITY);
  const carried = Object.fromEntries(names.map((name) => [name, options.attributes[name] ?? (name === 'classification' ? 'majority' : 'mean')]));
  const result = await withModule('tiles', folder.signal, async (ask) => {
    /** @type {number[]} */
    const range = await ask({ call: 'tileSurroundings', args: [tile, of, octree, measures] });
    const given = joined(await blocksOf(folder, files, range), names);
    return ask({ call: 'reduceTile', args: [given, tile, of, octree, measures, { attributes: carried }] });
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
    inputs,
    points: inputs.reduce((sum, { points }) => sum + points, 0),
    strays: octree.strays,
    reduced: leaves.reduce((sum, { points }) => sum + points, 0),
    tiles: facts.length,
    ...(levels.length > 0 && { triangles: facts.filter(({ level }) => level === made.finest).reduce((sum, { triangles = 0 }) => sum + triangles, 0) }),
    spacing: measures.target,
    noise: measures.noise,
    files,
  });
}

/**
 * The points of files; where a range is given, those in it.
 * @param {Folder} folder @param {string[]} files @param {ArrayLike<number>} [range] lower corner, and the first place beyond
 */
async function blocksOf(folder, files, range) {
  const blocks = [];
  for (const file of files) {
    const read = decode(await folder.read(file));
    blocks.push(...(range ? read.map((block) => inRange(block, range)) : read));
  }
  return blocks;
}

/** @param {Columns} columns @param {ArrayLike<number>} range @returns {Columns} */
function inRange(columns, range) {
  const { places } = columns;
  const [x0, y0, z0, x1, y1, z1] = Array.from(range);
  const indices = new Uint32Array(places.length / 3);
  let inside = 0;
  for (let i = 0; i < places.length; i += 3) {
    const [x, y, z] = [places[i], places[i + 1], places[i + 2]];
    if (x >= x0 && x < x1 && y >= y0 && y < y1 && z >= z0 && z < z1) indices[inside++] = i / 3;
  }
  return inside === indices.length ? columns : selected(columns, indices.subarray(0, inside));
}

/** @param {Planned[]} tiles @param {string} tile */
function found(tiles, tile) {
  const planned = tiles.find((other) => other.tile === tile);
  if (!planned) throw new PointweaveError({ code: 'bad-option', message: `there is no tile ${tile} of that stage`, expected: 'a tile of the plan', found: tile });
  return planned;
}
