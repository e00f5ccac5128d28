/** A file that is a scan, or an archive of scans: these are read one after the other, and are one cloud. */
import { PointweaveError } from '../engine/errors.js';
import { among, finder } from './beside.js';
import { merged } from './merging.js';
import { byteSourceOf } from './byte-source.js';
import { readFile, readerOf } from './reading.js';

/** @import { FileCloud, Format, Progress } from '../types.js' */
/** @import { Request } from '../engine/core.js' */
/** @import { Reader, ReadingOptions } from './reading.js' */
/** @import { ByteSource } from './byte-source.js' */

/**
 * Does something with the wasm of a reader, or of pictures.
 * @typedef {<T>(build: Reader | 'pictures', job: (ask: (request: Request) => Promise<any>) => Promise<T>) => Promise<T>} Open
 */

/** Names of what may be a scan; text may be one where nothing else is. */
const SCAN = /\.(ply|pcd|las|laz|e57|ptx|obj|off|coff|noff|cnoff|stl|glb|xyz|pts|xyzn|xyzrgb|asc|grid|agr|grd|tif|tiff|3mf|splat|spz)$/i;
const TEXT = /\.(txt|csv)$/i;
/** Whether a file of that name is likely to be a scan. @param {string} name */
export const isScan = (name) => SCAN.test(name) && !HIDDEN.test(name);

/** What systems put beside. */
const HIDDEN = /(^|\/)(__MACOSX\/|\.)/;

/**
 * @param {Open} open
 * @param {ByteSource} file
 * @param {ReadingOptions & { beside?: import('../types.js').Beside }} options
 * @param {{ signal: AbortSignal, onProgress?: (progress: Progress) => void }} watch
 * @returns {Promise<FileCloud>}
 */
export async function readScan(open, file, { beside, ...options }, watch) {
  const find = finder(beside);
  if (options.format !== undefined || !(await isArchive(file))) return readOne(open, file, options, watch, find);
  const read = await open('packed', async (ask) => {
    /** @type {string[]} */
    const names = await ask({ call: 'openArchive', args: [await wholeOf(file, watch.signal), options.name ?? ''] });
    if (names.some((name) => /^3D\/.*\.model$/i.test(name))) return undefined;
    const chosen = scansOf(names);
    if (chosen.length === 0) throw noScan(names);
    const unpack = (/** @type {number} */ part) => ask({ call: 'unpack', args: [part] });
    // What a mesh names is in the archive, too.
    const inside = async (/** @type {string} */ name) => {
      const found = among(names.map((other, part) => ({ name: other, part })), name);
      return found ? unpack(found.part) : find(name);
    };
    const clouds = [];
    for (const [i, at] of chosen.entries()) {
      const content = byteSourceOf(await unpack(at), true);
      const inner = { ...options, name: names[at] || undefined };
      const part = { ...watch, onProgress: watch.onProgress && partOf(watch.onProgress, i, chosen.length) };
      // Its error is that of its own reader.
      const outcome = await readOne(open, content, inner, part, inside).catch((error) => ({ error }));
      if ('error' in outcome) return outcome;
      clouds.push(outcome);
    }
    return merged(clouds, chosen.map((at) => names[at]));
  });
  if (!read) return readOne(open, file, { ...options, format: '3mf' }, watch, find);
  if ('error' in read) throw read.error;
  return read;
}

/**
 * @param {Open} open
 * @param {ByteSource} file
 * @param {ReadingOptions} options
 * @param {Parameters<typeof readScan>[3]} watch
 * @param {(name: string) => Promise<Uint8Array | undefined>} find
 * @returns {Promise<FileCloud>}
 */
async function readOne(open, file, options, watch, find) {
  const reader = await readerOf(file, options.format);
  const decode = (/** @type {Uint8Array} */ bytes) => open('pictures', (ask) => ask({ call: 'decodePicture', args: [bytes] })).catch(orNothing);
  return open(reader, (ask) => readFile(ask, file, options, watch, { find, decode }));
}

/** A picture that its decoder gives up is one that is missing. @param {unknown} error */
function orNothing(error) {
  if (error instanceof PointweaveError && ['internal', 'out-of-memory'].includes(error.code)) return undefined;
  throw error;
}

/** Whether a file is a ZIP or gzip archive; a 3MF file is one, too. @param {ByteSource} file */
export async function isArchive(file) {
  const [a, b, c] = (await file.read(0)).subarray(0, 4);
  return (a === 0x50 && b === 0x4b && (c === 3 || c === 5)) || (a === 0x1f && b === 0x8b);
}

/** @param {ByteSource} file @param {AbortSignal} signal */
async function wholeOf(file, signal) {
  const whole = new Uint8Array(file.size);
  for (let at = 0; at < file.size; ) {
    const slice = await file.read(at);
    signal.throwIfAborted();
    if (slice.length === 0) break;
    whole.set(slice, at);
    at += slice.length;
  }
  return whole;
}

/** Which of the parts are scans. @param {string[]} names */
function scansOf(names) {
  if (names.length === 1) return [0];
  const matching = (/** @type {RegExp} */ wanted) => names.flatMap((name, i) => (wanted.test(name) && !HIDDEN.test(name) ? [i] : []));
  const scans = matching(SCAN);
  return scans.length > 0 ? scans : matching(TEXT);
}

/** @param {string[]} names */
function noScan(names) {
  const isUsd = names.some((name) => /\.usd[ac]?$/i.test(name));
  const found = isUsd ? 'a USD scene (USDZ)' : names.length === 0 ? 'no file' : names.slice(0, 5).join(', ') + (names.length > 5 ? ' …' : '');
  const expected = 'an archive with a scan in it';
  return new PointweaveError({ code: 'unsupported-file', message: `this archive cannot be read: it holds ${found}; expected a scan`, expected, found });
}

/**
 * The progress of one of several files.
 * @param {(progress: Progress) => void} tell
 * @param {number} i
 * @param {number} count
 * @returns {(progress: Progress) => void}
 */
function partOf(tell, i, count) {
  return ({ stage, fraction }) => {
    const overall = (i + fraction) / count;
    tell({ stage, fraction: overall, overall });
  };
}
