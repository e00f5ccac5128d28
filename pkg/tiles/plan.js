/** What is to be done: every task with the files that it needs and makes. A task may run when all that it needs is there. */
import { SCRIPTS } from './page.js';

/**
 * @typedef {'sort' | 'measure' | 'density' | 'make' | 'level' | 'mesh' | 'finish'} Stage
 *
 * @typedef {object} PlannedTask
 * @property {string} id
 * @property {Stage} stage
 * @property {string} [tile] a tile as `L-X-Y-Z`, or of `sort` the input's index, of `mesh` the level
 * @property {number} [input] its index, of `sort`
 * @property {string[]} needs paths in the folder
 * @property {string[]} makes paths in the folder
 * @property {number} [weight] points that go in
 *
 * @typedef {object} Planned a tile of the octree: see `src/js/wasm_tiles.rs`
 * @property {string} tile
 * @property {number} level
 * @property {[number, number][]} files
 * @property {string[]} around
 *
 * @typedef {{ corner: [number, number, number], size: number, strays: number, leaves: Planned[], inner: Planned[] }} Octree
 *
 * @typedef {object} TileOptions
 * @property {{ ratio: number } | { count: number } | { spacing: number } | { tolerance: number }} target
 * @property {number} tilePoints
 * @property {number} [curvatureWeight]
 * @property {Record<string, string>} attributes how scalars are carried, and which others than the common ones are kept
 * @property {'keep' | 'drop'} outliers
 * @property {boolean} meshopt
 * @property {number} [meshPoints] the tiles are meshes, the finest through about so many points at most
 * @property {import('../types.js').Unit} [unit]
 * @property {Record<string, any>} read
 *
 * @typedef {object} Plan
 * @property {number} version
 * @property {string} made by which package
 * @property {TileOptions} options
 * @property {{ name: string, bytes: number, points: number, part?: import('./parts.js').Part, told?: import('./scan.js').Told }[]} inputs files, or parts that follow each other and what the file tells
 * @property {string[]} names of the scalars
 * @property {import('../types.js').Unit} [unit]
 * @property {boolean} [seenFromAbove] all inputs are
 * @property {Octree} octree
 * @property {number} [finest] the level of the finest meshes
 * @property {PlannedTask[]} tasks
 */

/** The stages, in the order in which they run. @type {Stage[]} */
export const STAGES = ['sort', 'measure', 'density', 'make', 'level', 'mesh', 'finish'];

/** Leaves that are measured, at most; and where their samples are reduced for a tolerance. */
const SAMPLES = 256;
const TOLERANCE_SAMPLES = 32;

export const PLAN = 'work/plan.json';
export const DENSITY = 'work/density.json';
export const TILESET = 'tileset.json';
export const PAGE = 'index.html';
export const MANIFEST = 'manifest.json';
/** @param {number} input */
export const countsPath = (input) => `work/counts/${input}.json`;
/** @param {number | string} input @param {string} tile */
export const sortedPath = (input, tile) => `work/sorted/${input}/${tile}.bin`;
/** @param {string} tile */
export const samplePath = (tile) => `work/measured/${tile}.bin`;
/** @param {string} tile */
export const madePath = (tile) => `work/made/${tile}.bin`;
/** @param {string} tile */
export const factsPath = (tile) => `work/facts/${tile}.json`;
/** @param {string} tile */
export const glbPath = (tile) => `points/${tile}.glb`;

/** What was cut of a level's mesh. @param {number | string} level */
export const meshPath = (level) => `work/meshes/${level}.json`;
/** @param {string} tile */
export const meshGlbPath = (tile) => `mesh/${tile}.glb`;

/** @param {Octree} octree */
export function deepest({ leaves }) {
  return Math.max(...leaves.map(({ tile }) => placeOf(tile).depth));
}

/**
 * The tiles that are all of the scan on a level: those of its depth, and the leaves above.
 * @param {Octree} octree @param {number} level
 */
export function cutOf(octree, level) {
  const depth = deepest(octree) - level;
  const inner = octree.inner.filter(({ tile }) => placeOf(tile).depth === depth);
  const leaves = octree.leaves.filter(({ tile }) => placeOf(tile).depth <= depth);
  return [...inner, ...leaves].map(({ tile }) => tile);
}

/**
 * Those of {@link cutOf} whose mesh is that level's: leaves have that of the finest.
 * @param {Octree} octree @param {number} level @param {number} finest
 */
export function meshedOn(octree, level, finest) {
  const depth = deepest(octree) - level;
  return level === finest ? cutOf(octree, level) : octree.inner.flatMap(({ tile }) => (placeOf(tile).depth === depth ? [tile] : []));
}

/**
 * @param {Octree} octree
 * @param {TileOptions['target']} target
 * @param {number} [finest] level of meshes
 * @returns {PlannedTask[]}
 */
export function tasksOf(octree, target, finest) {
  const { leaves, inner } = octree;
  const files = new Map(leaves.map((leaf) => [leaf.tile, leaf.files.map(([input]) => sortedPath(input, leaf.tile))]));
  const neighbours = new Map(leaves.map((leaf) => [leaf.tile, leaf.around]));
  const weights = new Map(leaves.map((leaf) => [leaf.tile, leaf.files.reduce((sum, [, points]) => sum + points, 0)]));
  /** @type {Map<number, PlannedTask>} */
  const sorts = new Map();
  for (const { tile, files: parts } of leaves) {
    for (const [input, points] of parts) {
      const task = sorts.get(input) ?? { id: `sort-${input}`, stage: 'sort', tile: `${input}`, input, needs: [PLAN, countsPath(input)], makes: [], weight: 0 };
      task.makes.push(sortedPath(input, tile));
      task.weight = (task.weight ?? 0) + points;
      sorts.set(input, task);
    }
  }
  const stride = Math.ceil(leaves.length / ('tolerance' in target ? TOLERANCE_SAMPLES : SAMPLES));
  const sampled = leaves.filter((_, i) => i % stride === 0).map(({ tile }) => tile);
  const of = (/** @type {Map<string, any>} */ map, /** @type {string} */ tile) => map.get(tile) ?? [];
  /** @type {PlannedTask[]} */
  const measures = sampled.map((tile) => ({ id: `measure-${tile}`, stage: 'measure', tile, needs: [PLAN, ...of(neighbours, tile).flatMap((/** @type {string} */ other) => of(files, other))], makes: [samplePath(tile)], weight: weights.get(tile) }));
  const makes = (/** @type {string} */ tile) => [madePath(tile), factsPath(tile), ...(finest === undefined ? [glbPath(tile)] : [])];
  /** @type {PlannedTask[]} */
  const made = leaves.map(({ tile, around }) => ({
    id: `make-${tile}`, stage: 'make', tile, needs: [PLAN, DENSITY, ...around.flatMap((other) => of(files, other))], makes: makes(tile), weight: weights.get(tile),
  }));
  /** @type {PlannedTask[]} */
  const levels = inner.map(({ tile, around }) => ({ id: `level-${tile}`, stage: 'level', tile, needs: [PLAN, DENSITY, ...around.map(madePath)], makes: makes(tile) }));
  /** @type {PlannedTask[]} */
  const meshes = finest === undefined ? [] : Array.from({ length: deepest(octree) - finest + 1 }, (_, i) => {
    const level = finest + i;
    const makes = [meshPath(level), ...meshedOn(octree, level, finest).map(meshGlbPath)];
    return { id: `mesh-${level}`, stage: 'mesh', tile: `${level}`, needs: [PLAN, ...cutOf(octree, level).map(madePath)], makes };
  });
  const facts = [...leaves, ...inner].map(({ tile }) => factsPath(tile));
  return [
    ...[...sorts.values()].sort((a, b) => Number(a.input) - Number(b.input)),
    ...measures,
    { id: 'density', stage: 'density', needs: [PLAN, ...sampled.map(samplePath)], makes: [DENSITY] },
    ...made,
    ...levels,
    ...meshes,
    { id: 'finish', stage: 'finish', needs: [PLAN, DENSITY, ...facts, ...meshes.map(({ tile = '' }) => meshPath(tile))], makes: [TILESET, PAGE, ...SCRIPTS, MANIFEST] },
  ];
}

/** @param {string} tile */
export function placeOf(tile) {
  const [depth, ...at] = tile.split('-').map(Number);
  return { depth, at };
}

/** A tile's parent; the root's is `undefined`. @param {string} tile */
export function parentOf(tile) {
  const { depth, at } = placeOf(tile);
  return depth === 0 ? undefined : [depth - 1, ...at.map((x) => Math.floor(x / 2))].join('-');
}
