/**
 * A level of tiles as one mesh, cut by its triangles. Its vertices lie on a lattice that all tiles have, so that those on both sides of
 * a cut are equal in every bit and the tiles together are the mesh.
 */
import { sha256 } from './folder.js';
import { boxOf, joined } from './columns.js';
import { withModule } from './modules.js';
import { cutOf, meshGlbPath, meshPath, meshedOn, placeOf } from './plan.js';

/** @import { Folder } from './folder.js' */
/** @import { Columns } from './columns.js' */
/** @import { Plan } from './plan.js' */

/** @typedef {{ positions: Float64Array, normals: Float32Array, colors?: Uint8Array, indices: Uint32Array }} Mesh */

/** Vertices lie at multiples of the root's side by so many: single precision holds them exactly, from whatever corner. */
const LATTICE = 2 ** 23;

/** A GLB of a tile through which no surface goes. */
const NOTHING = { asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{}] };

/**
 * Meshes a level, and writes the parts.
 * @param {Folder} folder
 * @param {Plan} plan
 * @param {number} level
 * @param {Columns[]} blocks the reduced points of the level's tiles
 * @param {(glb: Uint8Array) => Promise<Uint8Array>} compress
 */
export async function meshLevel(folder, plan, level, blocks, compress) {
  const { octree, octree: { size }, seenFromAbove, finest = level } = plan;
  const { places, colors } = joined(blocks, []);
  const positions = Float64Array.from(places, (x) => (x * size) / 2 ** 32);
  const cloud = { positions, colors, up: [0, 0, 1], ...(seenFromAbove && { seenFromAbove }) };
  /** @type {Mesh} */
  const mesh = await withModule('single', folder.signal, (ask) => ask({ call: 'reconstruct', args: [cloud, { reduce: false }] }));
  const step = size / LATTICE;
  const onLattice = mesh.positions.map((x) => Math.round(x / step));
  const tiles = cutOf(octree, level);
  const triangles = groupedBy(ownersOf(onLattice, mesh.indices, tiles), tiles.length);
  const facts = [];
  for (const tile of meshedOn(octree, level, finest)) {
    const part = partOf(mesh, onLattice, triangles[tiles.indexOf(tile)]);
    const glb = part.indices.length === 0 ? emptyGlb() : await glbOf(folder, part, tile, step);
    const bytes = part.indices.length === 0 ? glb : await compress(glb);
    await folder.write(meshGlbPath(tile), bytes);
    const { low, high } = boundsOf(part.lattice, step, tile);
    facts.push({ tile, level, uri: meshGlbPath(tile), triangles: part.indices.length / 3, points: part.lattice.length / 3, low, high, bytes: bytes.length, sha256: sha256(bytes) });
  }
  await folder.writeJson(meshPath(level), facts);
}

/**
 * The tile of each triangle: that in which its middle lies, or the nearest.
 * @param {Float64Array} lattice @param {Uint32Array} indices @param {string[]} tiles
 */
function ownersOf(lattice, indices, tiles) {
  const index = new Map(tiles.map((tile, i) => [tile, i]));
  const depths = [...new Set(tiles.map((tile) => placeOf(tile).depth))].sort((a, b) => b - a);
  const centers = tiles.map((tile) => {
    const { depth, at } = placeOf(tile);
    return at.map((x) => ((x + 0.5) * LATTICE) / 2 ** depth);
  });
  const middle = [0, 0, 0];
  const nearest = () => {
    const far = centers.map((center) => Math.hypot(...center.map((x, axis) => x - middle[axis])));
    return far.indexOf(Math.min(...far));
  };
  return Uint32Array.from({ length: indices.length / 3 }, (_, triangle) => {
    const corners = indices.subarray(3 * triangle, 3 * triangle + 3);
    for (let axis = 0; axis < 3; axis++) middle[axis] = (lattice[3 * corners[0] + axis] + lattice[3 * corners[1] + axis] + lattice[3 * corners[2] + axis]) / 3;
    for (const depth of depths) {
      const owner = index.get([depth, ...middle.map((x) => Math.floor((x * 2 ** depth) / LATTICE))].join('-'));
      if (owner !== undefined) return owner;
    }
    return nearest();
  });
}

/**
 * The triangles of each tile.
 * @param {Uint32Array} owners @param {number} tiles
 */
function groupedBy(owners, tiles) {
  /** @type {number[][]} */
  const groups = Array.from({ length: tiles }, () => []);
  owners.forEach((owner, triangle) => groups[owner].push(triangle));
  return groups;
}

/**
 * Some triangles, and the vertices that they use, in the mesh's order.
 * @param {Mesh} mesh @param {Float64Array} lattice @param {number[]} triangles
 */
function partOf({ normals, colors, indices }, lattice, triangles) {
  const corners = Uint32Array.from({ length: 3 * triangles.length }, (_, i) => indices[3 * triangles[Math.floor(i / 3)] + (i % 3)]);
  const used = Uint32Array.from(new Set(corners)).sort();
  const renamed = new Map(Array.from(used, (vertex, i) => [vertex, i]));
  const triples = (/** @type {any} */ values) => values && values.constructor.from({ length: 3 * used.length }, (/** @type {unknown} */ _, /** @type {number} */ i) => values[3 * used[Math.floor(i / 3)] + (i % 3)]);
  return { lattice: /** @type {Float64Array} */ (triples(lattice)), normals: triples(normals), colors: triples(colors), indices: corners.map((vertex) => renamed.get(vertex) ?? 0) };
}

/** @param {Folder} folder @param {ReturnType<typeof partOf>} part @param {string} tile @param {number} step */
async function glbOf(folder, { lattice, normals, colors, indices }, tile, step) {
  const { depth, at } = placeOf(tile);
  const corner = at.map((x) => (x * LATTICE) / 2 ** depth);
  const positions = Float32Array.from(lattice, (x, i) => (x - corner[i % 3]) * step);
  const mesh = { positions, normals, colors, indices, attributes: {}, origin: corner.map((x) => x * step), up: [0, 0, 1] };
  return withModule('exports', folder.signal, (ask) => ask({ call: 'write', args: [mesh, { format: 'glb' }] }));
}

function emptyGlb() {
  const json = new TextEncoder().encode(JSON.stringify(NOTHING).padEnd(Math.ceil(JSON.stringify(NOTHING).length / 4) * 4));
  const head = Uint32Array.of(0x46546c67, 2, 20 + json.length, json.length, 0x4e4f534a);
  return new Uint8Array([...new Uint8Array(head.buffer), ...json]);
}

/** The box of vertices; of none, the tile's. @param {Float64Array} lattice @param {number} step @param {string} tile */
function boundsOf(lattice, step, tile) {
  if (lattice.length > 0) return boxOf(lattice, step);
  const { depth, at } = placeOf(tile);
  const side = LATTICE / 2 ** depth;
  return boxOf([...at, ...at.map((x) => x + 1)].map((x) => x * side), step);
}
