/**
 * Points of tiles as files: blocks, one after the other. A block is the length of its head (u32, little-endian), the head as JSON, and
 * the columns: places (3 × u32 a point), colours (3 × u8) where the head says so, then one f32 a point for each name. All is aligned
 * to four bytes.
 */
import { PointweaveError } from '../engine/errors.js';

/**
 * @typedef {object} Columns
 * @property {Uint32Array} places on the root's lattice, three a point
 * @property {Uint8Array} [colors] three a point
 * @property {string[]} names of the scalars
 * @property {Float32Array[]} values
 * @property {any} [more] what else belongs to these points, as JSON takes it
 */

/** @param {Columns} columns */
export function encode({ places, colors, names, values, more }) {
  const points = places.length / 3;
  const head = new TextEncoder().encode(JSON.stringify({ points, colors: colors !== undefined, names, more }));
  const parts = [new Uint8Array(Uint32Array.of(head.length).buffer), head, places, ...(colors ? [colors] : []), ...values];
  const bytes = new Uint8Array(parts.reduce((sum, part) => sum + padded(part.byteLength), 0));
  let at = 0;
  for (const part of parts) {
    bytes.set(new Uint8Array(part.buffer, part.byteOffset, part.byteLength), at);
    at += padded(part.byteLength);
  }
  return bytes;
}

/**
 * The blocks of a file.
 * @param {Uint8Array} bytes at a multiple of four in its buffer
 * @returns {Columns[]}
 */
export function decode(bytes) {
  const blocks = [];
  let at = 0;
  /** @param {number} length in bytes */
  const take = (length) => {
    const from = bytes.byteOffset + at;
    at += padded(length);
    if (at > bytes.length) throw new PointweaveError({ code: 'bad-file', message: `a tile's points end at byte ${bytes.length}: expected ${at}`, expected: at, found: bytes.length });
    return from;
  };
  const { buffer } = bytes;
  while (at < bytes.length) {
    const [length] = new Uint32Array(buffer, take(4), 1);
    const { points, colors, names, more } = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, take(length), length)));
    blocks.push({
      places: new Uint32Array(buffer, take(12 * points), 3 * points),
      ...(colors && { colors: new Uint8Array(buffer, take(3 * points), 3 * points) }),
      names,
      values: names.map(() => new Float32Array(buffer, take(4 * points), points)),
      more,
    });
  }
  return blocks;
}

/**
 * Several as one, with these scalars. What one of them lacks is white (colours) or 0.
 * @param {Columns[]} blocks
 * @param {string[]} names
 * @returns {Columns}
 */
export function joined(blocks, names) {
  const points = blocks.reduce((sum, { places }) => sum + places.length / 3, 0);
  const places = new Uint32Array(3 * points);
  const colors = blocks.some((block) => block.colors) ? new Uint8Array(3 * points).fill(255) : undefined;
  const values = names.map(() => new Float32Array(points));
  let at = 0;
  for (const block of blocks) {
    places.set(block.places, 3 * at);
    if (block.colors) colors?.set(block.colors, 3 * at);
    block.names.forEach((name, i) => values[names.indexOf(name)]?.set(block.values[i], at));
    at += block.places.length / 3;
  }
  return { places, ...(colors && { colors }), names, values };
}

/**
 * Some of the points.
 * @param {Columns} columns
 * @param {Uint32Array} indices
 * @returns {Columns}
 */
export function selected({ places, ...others }, indices) {
  return { places: triples(places, indices), ...belonging(others, indices) };
}

/**
 * What belongs to some of the points, or to all in another order.
 * @param {Omit<Columns, 'places'>} columns
 * @param {Uint32Array} indices
 */
export function belonging({ colors, names, values }, indices) {
  return {
    ...(colors && { colors: triples(colors, indices) }),
    names,
    values: values.map((scalars) => Float32Array.from(indices, (i) => scalars[i])),
  };
}

/**
 * Points that follow each other.
 * @param {Columns} columns
 * @param {number} from
 * @param {number} to
 * @returns {Columns}
 */
export function between({ places, colors, names, values }, from, to) {
  return {
    places: places.subarray(3 * from, 3 * to),
    ...(colors && { colors: colors.subarray(3 * from, 3 * to) }),
    names,
    values: values.map((scalars) => scalars.subarray(from, to)),
  };
}

/**
 * The box of places on a lattice.
 * @param {ArrayLike<number>} places three a point, one point at least
 * @param {number} step of the lattice
 */
export function boxOf(places, step) {
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (let i = 0; i < places.length; i++) {
    low[i % 3] = Math.min(low[i % 3], places[i]);
    high[i % 3] = Math.max(high[i % 3], places[i]);
  }
  return { low: low.map((x) => x * step), high: high.map((x) => x * step) };
}

/**
 * @template {Uint8Array | Uint32Array} T
 * @param {T} values three a point
 * @param {Uint32Array} indices
 * @returns {T}
 */
function triples(values, indices) {
  const some = /** @type {T} */ (new /** @type {any} */ (values.constructor)(3 * indices.length));
  indices.forEach((i, to) => {
    for (let axis = 0; axis < 3; axis++) some[3 * to + axis] = values[3 * i + axis];
  });
  return some;
}

/** @param {number} length */
function padded(length) {
  return Math.ceil(length / 4) * 4;
}
