/** The points of a file, which come in blocks, as the arrays of a cloud. */
import { PointweaveError } from '../engine/errors.js';
import { kept, leftOutOf } from './left-out.js';

/** @import { FileCloud, Format } from '../types.js' */

/**
 * The points that came with a slice; see `src/js/wasm_read.rs`.
 * @typedef {object} Block
 * @property {Float32Array | Float64Array} positions
 * @property {Float32Array} [normals]
 * @property {Uint8Array | Float32Array} [colors]
 * @property {string[]} names of the attributes
 * @property {Float32Array[]} values
 * @property {number} [most] points that the file has room for
 */

/**
 * What only the whole file tells.
 * @typedef {object} Summary
 * @property {Format} format
 * @property {number} dropped
 * @property {number} replaced
 * @property {number} faces
 * @property {boolean} narrow single precision suffices for the positions
 * @property {number} colorScale from colours that are no bytes to 0-255
 * @property {boolean} hasColors
 * @property {boolean} hasNormals
 * @property {Stations} [stations] where the points were seen from
 * @property {[number, number, number]} [up]
 * @property {boolean} seenFromAbove
 * @property {import('../types.js').Unit} [unit]
 * @property {import('../types.js').Crs} [crs]
 * @property {number} sampled points that were taken from faces
 * @property {string[]} missing files that the faces name and that were not there
 * @property {string[]} attributes their names, in order
 * @property {import('./left-out.js').LeftOut} leftOut
 * @property {Record<string, number>} skipped
 * @property {string[]} columns
 * @property {string[]} notes
 * @property {FileCloud['file']['table']} [preview]
 */

/**
 * A scanner's positions; of each run of points the first, and the index of the position that saw it.
 * @typedef {{ positions: Float64Array, starts: Float64Array, of: Uint32Array }} Stations
 */

export class PointColumns {
  /** Of positions, normals, colours; then of the attributes. @type {Map<string, Column>} */
  #columns = new Map();
  /** @type {Map<string, Column>} */
  #attributes = new Map();
  points = 0;

  /**
   * @param {Block} block
   * @param {number} expected points in all, as far as can be told
   */
  add({ positions, normals, colors, names, values }, expected) {
    const before = this.points;
    this.points += positions.length / 3;
    this.#append('positions', positions, 3 * expected);
    if (normals) this.#append('normals', normals, 3 * expected);
    if (colors) this.#append('colors', colors, 3 * expected);
    values.forEach((array, i) => {
      let column = this.#attributes.get(names[i]);
      if (!column) {
        this.#attributes.set(names[i], (column = new Column(array)));
        // What comes later than the first points was 0 before.
        if (before > 0) column.append(convert(Float32Array, before), expected);
      }
      column.append(array, expected);
    });
  }

  /**
   * @param {Summary} summary
   * @returns {FileCloud}
   */
  finish({ format, dropped, replaced, faces, narrow, colorScale, hasColors, hasNormals, leftOut, skipped, columns, notes, preview, stations, up, seenFromAbove, unit, crs, sampled, missing, ...rest }) {
    let positions = this.#take('positions') ?? new Float32Array(0);
    const out = leftOutOf(/** @type {Float32Array | Float64Array} */ (positions), leftOut);
    /** @template {Values} T @param {T} values */
    const left = (values, each = 3) => (out ? kept(values, out, each) : values);
    const views = stations && viewpointsOf(stations, positions.length / 3);
    positions = left(positions);
    const normals = this.#take('normals');
    const colors = hasColors ? this.#take('colors') : undefined;
    const attributes = rest.attributes.map((name) => [name, left(this.#attribute(name), 1)]);
    const why = { ...skipped };
    for (const [key, count] of Object.entries(out?.skipped ?? {})) why[key] = (why[key] ?? 0) + count;
    return /** @type {FileCloud} */ ({
      positions: narrow && positions instanceof Float64Array ? convert(Float32Array, positions) : positions,
      ...(normals && hasNormals && { normals: left(normals) }),
      ...(colors && { colors: left(colors instanceof Uint8Array ? colors : toBytes(/** @type {Float32Array} */ (colors), colorScale)) }),
      ...(attributes.length > 0 && { attributes: Object.fromEntries(attributes) }),
      ...(views && { viewpoints: views.of ? { positions: views.positions, of: left(views.of, 1) } : views }),
      ...(up && { up }),
      ...(seenFromAbove && { seenFromAbove }),
      ...(unit && { unit }),
      ...(crs && { crs }),
      ...(sampled > 0 && { faces }),
      ...(columns.length > 0 && { columns }),
      skipped: why,
      file: {
        format, dropped, replaced, faces, notes,
        ...(sampled > 0 && { sampled }),
        ...(missing.length > 0 && { missing }),
        ...(preview && { table: preview }),
      },
    });
  }

  /** @param {string} name */
  #attribute(name) {
    const column = this.#attributes.get(name);
    this.#attributes.delete(name);
    return column?.take() ?? new Float32Array(this.points);
  }

  /** @param {string} name @param {Values} values @param {number} expected */
  #append(name, values, expected) {
    let column = this.#columns.get(name);
    if (!column) this.#columns.set(name, (column = new Column(values)));
    column.append(values, expected);
  }

  /** @param {string} name */
  #take(name) {
    const column = this.#columns.get(name);
    this.#columns.delete(name);
    return column?.take();
  }
}

/** @typedef {Uint8Array | Uint32Array | Float32Array | Float64Array} Values */

/** An array that grows. */
class Column {
  #array;
  #length = 0;

  /** @param {Values} like of the type that it is to have */
  constructor(like) {
    this.#array = create(like, 0);
  }

  /**
   * @param {Values} values
   * @param {number} expected values in all
   */
  append(values, expected) {
    const length = this.#length + values.length;
    if (length > this.#array.length) {
      const larger = create(values, Math.max(length, Math.min(expected, 2 ** 32), expected < length ? 1.5 * length : 0));
      larger.set(this.#array.subarray(0, this.#length));
      this.#array = larger;
    }
    this.#array.set(values, this.#length);
    this.#length = length;
  }

  /** The values, in a buffer of just their length. */
  take() {
    return this.#length === this.#array.length ? this.#array : this.#array.slice(0, this.#length);
  }
}

/** @param {Values} like @param {number} length */
function create(like, length) {
  const type = /** @type {new (length: number) => Values} */ (like.constructor);
  return convert(type, Math.ceil(length));
}

/**
 * @template {Values} T
 * @param {new (from: any) => T} type
 * @param {number | Values} from
 */
function convert(type, from) {
  try {
    return new type(from);
  } catch (error) {
    const length = typeof from === 'number' ? from : from.length;
    throw new PointweaveError({ code: 'out-of-memory', message: `there is no memory for ${length} values of the file's points`, found: String(error) });
  }
}

/** As `src/formats/stations.rs` does it. @param {Stations} stations @param {number} points */
function viewpointsOf({ positions, starts, of: stations }, points) {
  if (stations.every((station) => station === 0)) return { positions };
  const of = convert(Uint32Array, points);
  stations.forEach((station, i) => of.fill(station, starts[i], starts[i + 1]));
  return { positions, of };
}

/** As `src/formats/table.rs` does it, in single precision. @param {Float32Array} colors @param {number} scale */
export function toBytes(colors, scale) {
  const bytes = convert(Uint8Array, colors.length);
  for (let i = 0; i < colors.length; i++) {
    bytes[i] = Math.min(255, Math.max(0, Math.floor(Math.fround(colors[i] * scale) + 0.5)));
  }
  return bytes;
}
