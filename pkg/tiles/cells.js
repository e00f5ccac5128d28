/**
 * A leaf's points in a file of its own, by the cells of a lattice in the leaf: a neighbour reads those at its border alone. Blocks
 * ({@link encode}) of a cell each are followed by an index, as JSON, and its length (u32, little-endian).
 */
import { appendFile, open } from 'node:fs/promises';
import { PointweaveError } from '../engine/errors.js';
import { between, decode, encode, joined, selected } from './columns.js';
import { placeOf } from './plan.js';

/** @import { Columns } from './columns.js' */

/**
 * @typedef {object} Index
 * @property {number} cells along an axis of the leaf
 * @property {[number, number, number][]} blocks a cell, (x · cells + y) · cells + z, and where its block begins and ends in the file
 */

/** Points that a cell of a surface should have: enough that their block's head is little beside them. */
const FEWEST = 512;
/** Cells along an axis, at most. */
const MOST = 16;
/** Blocks that are nearer than this are read at once. */
const NEAR = 1 << 16;
/** Bytes that the end of a file is looked at for its index. */
const TAIL = 1 << 16;

/** Writes points of leaves, each into a file of its own in a folder. */
export class CellWriter {
  /** @type {Map<string, Columns[]>} */
  #waiting = new Map();
  /** @type {Map<string, Index & { size: number }>} */
  #files = new Map();
  /** Bytes that wait. */
  held = 0;

  /** @param {string} folder @param {Map<string, number>} leaves how many points each will have */
  constructor(folder, leaves) {
    this.folder = folder;
    this.leaves = leaves;
  }

  /** @param {string} tile @param {Columns} columns */
  add(tile, columns) {
    const blocks = this.#waiting.get(tile);
    if (blocks) blocks.push(columns);
    else this.#waiting.set(tile, [columns]);
    this.held += sizeOf(columns);
  }

  /** Writes what waits. */
  async flush() {
    for (const [tile, blocks] of this.#waiting) {
      const file = this.#files.get(tile) ?? { cells: cellsFor(this.leaves.get(tile) ?? 0), blocks: [], size: 0 };
      this.#files.set(tile, file);
      const parts = [];
      for (const { cell, columns } of byCell(joined(blocks, blocks[0].names), tile, file.cells)) {
        const bytes = encode(columns);
        file.blocks.push([cell, file.size, file.size + bytes.length]);
        file.size += bytes.length;
        parts.push(bytes);
      }
      await appendFile(this.#path(tile), Buffer.concat(parts));
    }
    this.#waiting.clear();
    this.held = 0;
  }

  async end() {
    await this.flush();
    for (const [tile, { cells, blocks }] of this.#files) {
      const index = Buffer.from(JSON.stringify({ cells, blocks }));
      await appendFile(this.#path(tile), Buffer.concat([index, new Uint8Array(Uint32Array.of(index.length).buffer)]));
    }
  }

  /** @param {string} tile */
  #path(tile) {
    return `${this.folder}/${tile}.bin`;
  }
}

/**
 * The points of a leaf's file, and where a range is given those in it.
 * @param {string} path @param {string} tile
 * @param {ArrayLike<number>} [range] on the root's lattice: lower corner, and the first place beyond
 * @returns {Promise<Columns[]>}
 */
export async function readCells(path, tile, range) {
  const file = await open(path);
  try {
    const index = await indexOf(file, path);
    const wanted = range ? index.blocks.filter(([cell]) => meets(cell, tile, index.cells, range)) : index.blocks;
    const blocks = [];
    for (const [from, to] of spans(wanted)) {
      const bytes = await part(file, path, from, to);
      const within = wanted.filter(([, start]) => start >= from && start < to);
      for (const [, start, end] of within) blocks.push(...decode(bytes.subarray(start - from, end - from)));
    }
    return range ? blocks.map((block) => inRange(block, range)) : blocks;
  } finally {
    await file.close();
  }
}

/** @param {import('node:fs/promises').FileHandle} file @param {string} path @returns {Promise<Index>} */
async function indexOf(file, path) {
  const { size } = await file.stat();
  const tail = await part(file, path, Math.max(0, size - TAIL), size);
  const length = tail.length < 4 ? Infinity : new DataView(tail.buffer, tail.byteOffset).getUint32(tail.length - 4, true);
  if (length > size - 4) throw damaged(path);
  const bytes = length <= tail.length - 4 ? tail.subarray(tail.length - 4 - length, -4) : await part(file, path, size - 4 - length, size - 4);
  try {
    return JSON.parse(new TextDecoder().decode(bytes));
  } catch {
    throw damaged(path);
  }
}

/** @param {import('node:fs/promises').FileHandle} file @param {string} path @param {number} from @param {number} to */
async function part(file, path, from, to) {
  const bytes = new Uint8Array(to - from);
  const { bytesRead } = await file.read(bytes, 0, bytes.length, from);
  if (bytesRead < bytes.length) throw damaged(path);
  return bytes;
}

/** @param {string} path */
function damaged(path) {
  return new PointweaveError({ code: 'bad-file', message: `${path} is damaged: remove its folder, and run the step that makes it`, expected: 'sorted points' });
}

/** Blocks as stretches of the file: those near each other are one. @param {Index['blocks']} blocks in their order in the file */
function spans(blocks) {
  /** @type {[number, number][]} */
  const found = [];
  for (const [, from, to] of blocks) {
    const last = found.at(-1);
    if (last && from - last[1] < NEAR) last[1] = to;
    else found.push([from, to]);
  }
  return found;
}

/** A leaf with so large a share of its side around it, as a range. @param {string} tile @param {number} share */
export function around(tile, share) {
  const { corner, side } = latticeOf(tile, 1);
  return [...corner.map((x) => x - share * side), ...corner.map((x) => x + (1 + share) * side)];
}

/** Whether a cell of a leaf meets a range. @param {number} cell @param {string} tile @param {number} cells @param {ArrayLike<number>} range */
function meets(cell, tile, cells, range) {
  const { corner, side } = latticeOf(tile, cells);
  const at = [Math.floor(cell / (cells * cells)), Math.floor(cell / cells) % cells, cell % cells];
  return at.every((x, axis) => corner[axis] + x * side < range[3 + axis] && corner[axis] + (x + 1) * side > range[axis]);
}

/** The corner of a leaf and the side of its cells, on the root's lattice. @param {string} tile @param {number} cells */
function latticeOf(tile, cells) {
  const { depth, at } = placeOf(tile);
  const side = 2 ** (32 - depth);
  return { corner: at.map((x) => x * side), side: side / cells };
}

/** A power of two. @param {number} points of the leaf, on a surface */
function cellsFor(points) {
  return Math.min(MOST, 2 ** Math.max(0, Math.floor(Math.log2(points / FEWEST) / 2)));
}

/**
 * Points by their cells, those of a cell in their order.
 * @param {Columns} columns @param {string} tile @param {number} cells along an axis
 */
function byCell(columns, tile, cells) {
  const { places } = columns;
  const points = places.length / 3;
  const { corner: [x0, y0, z0], side } = latticeOf(tile, cells);
  const cellOf = new Uint16Array(points);
  const ends = new Uint32Array(cells ** 3);
  for (let i = 0; i < points; i++) {
    const [x, y, z] = [(places[3 * i] - x0) / side, (places[3 * i + 1] - y0) / side, (places[3 * i + 2] - z0) / side];
    const cell = (Math.floor(x) * cells + Math.floor(y)) * cells + Math.floor(z);
    cellOf[i] = cell;
    ends[cell]++;
  }
  let sum = 0;
  for (let cell = 0; cell < ends.length; cell++) [ends[cell], sum] = [sum, sum + ends[cell]];
  const starts = ends.slice();
  const order = new Uint32Array(points);
  for (let i = 0; i < points; i++) order[ends[cellOf[i]]++] = i;
  const sorted = selected(columns, order);
  const found = [];
  for (let cell = 0; cell < ends.length; cell++) if (ends[cell] > starts[cell]) found.push({ cell, columns: between(sorted, starts[cell], ends[cell]) });
  return found;
}

/** @param {Columns} columns */
function sizeOf({ places, colors, values }) {
  return places.byteLength + (colors?.byteLength ?? 0) + values.reduce((sum, { byteLength }) => sum + byteLength, 0);
}

/** The points of a range. @param {Columns} columns @param {ArrayLike<number>} range @returns {Columns} */
export function inRange(columns, range) {
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
