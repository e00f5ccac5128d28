/** The points of a file, block by block, as tiles take them. */
import { basename } from 'node:path';
import { besideOf, openInput } from '../files/disk.js';
import { PointweaveError } from '../engine/errors.js';
import { isArchive } from '../files/archive.js';
import { byteSourceOf } from '../files/byte-source.js';
import { kept, leftOutOf } from '../files/left-out.js';
import { toBytes } from '../files/point-columns.js';
import { readBlocks, readerError, readerOf } from '../files/reading.js';
import { withModule } from './modules.js';
import { openPart } from './parts.js';

/** @import { Block, Summary } from '../files/point-columns.js' */
/** @import { Part } from './parts.js' */

/** Coordinates of this size or more are none: `src/formats/sentinels.rs`. */
const HUGE = 1e30;

/**
 * What only the whole file tells, as far as its points need it.
 * @typedef {Pick<Summary, 'format' | 'colorScale' | 'hasColors' | 'leftOut' | 'attributes' | 'unit' | 'up' | 'seenFromAbove' | 'dropped'>} Told
 */

/**
 * @param {string} path
 * @param {Part | undefined} part of the file, where it is not all
 * @param {Record<string, any>} options of the reader
 * @param {AbortSignal} signal
 * @param {(block: Block) => Promise<void>} take
 * @returns {Promise<Summary>}
 */
export async function readScan(path, part, options, signal, take) {
  const file = part ? await openPart(path, part, signal) : byteSourceOf(await openInput(path, signal));
  if (!/\.3mf$/i.test(path) && (await isArchive(file))) {
    throw new PointweaveError({ code: 'unsupported-file', message: `${basename(path)} is an archive: tiles reads the files that are in it, once it is unpacked`, expected: 'a scan', found: 'an archive' });
  }
  const reader = await readerOf(file, options.format);
  const helpers = { find: besideOf(path), decode: async () => undefined };
  const read = (/** @type {import('./modules.js').Ask} */ ask) => readBlocks(ask, file, { name: basename(path), ...options }, { signal }, helpers, take);
  try {
    return (await withModule(reader, signal, read)).summary;
  } catch (error) {
    const told = readerError(error, reader);
    const { message, ...fields } = /** @type {any} */ (told);
    throw told instanceof PointweaveError ? new PointweaveError({ ...fields, code: told.code, message: `${basename(path)}: ${message}` }) : told;
  }
}

/** As JSON takes it. @param {Summary} summary @returns {Told} */
export function toldOf({ format, colorScale, hasColors, leftOut, attributes, unit, up, seenFromAbove, dropped }) {
  const noData = leftOut.noData.map((values) => Array.from(values));
  return { format, colorScale, hasColors, leftOut: /** @type {any} */ ({ ...leftOut, noData, noReturns: Array.from(leftOut.noReturns) }), attributes, unit, up, seenFromAbove, dropped };
}

/** What the parts of a file tell together. @param {Told[]} parts @returns {Told} */
export function toldTogether(parts) {
  const [first] = parts;
  const union = (/** @type {((told: Told) => ArrayLike<any>)} */ of) => [...new Set(parts.flatMap((told) => Array.from(of(told))))];
  const colored = parts.filter(({ hasColors }) => hasColors);
  return {
    ...first,
    hasColors: colored.length > 0,
    // The part with the largest values tells of how many bits all are.
    colorScale: Math.min(...(colored.length > 0 ? colored : parts).map(({ colorScale }) => colorScale)),
    attributes: union(({ attributes }) => attributes),
    leftOut: /** @type {any} */ ({
      huge: parts.some(({ leftOut }) => leftOut.huge),
      noData: [0, 1, 2].map((axis) => union(({ leftOut }) => leftOut.noData[axis] ?? [])),
      noReturns: parts.flatMap(({ leftOut }) => Array.from(leftOut.noReturns)),
    }),
  };
}

/** Whether some of the file's points stand for none. @param {Told} told */
export function leavesOut({ leftOut: { huge, noData, noReturns } }) {
  return huge || noReturns.length > 0 || noData.some((values) => values.length > 0);
}

/**
 * The positions of a block without those that stand for none; before the whole file has told which they are, without those that
 * are beyond all others.
 * @param {Block} block
 * @param {Told} [told]
 */
export function positionsOf({ positions }, told) {
  const leftOut = told?.leftOut ?? { huge: positions.some((x) => Math.abs(x) >= HUGE), noData: [], noReturns: new Float64Array(0) };
  const out = leftOutOf(positions, leftOut);
  return out ? kept(positions, out, 3) : positions;
}

/**
 * What belongs to the points of a block, in the order of {@link positionsOf}.
 * @param {Block} block
 * @param {Told} told
 * @param {string[]} wanted names of scalars
 * @returns {{ colors?: Uint8Array, names: string[], values: Float32Array[] }}
 */
export function columnsOf({ positions, colors, names, values }, told, wanted) {
  const out = leftOutOf(positions, told.leftOut);
  const bytes = told.hasColors && colors ? (colors instanceof Uint8Array ? colors : toBytes(colors, told.colorScale)) : undefined;
  const indices = names.flatMap((name, i) => (wanted.includes(name) && told.attributes.includes(name) ? [i] : []));
  return {
    ...(bytes && { colors: out ? kept(bytes, out, 3) : bytes }),
    names: indices.map((i) => names[i]),
    values: indices.map((i) => (out ? kept(values[i], out, 1) : values[i])),
  };
}
