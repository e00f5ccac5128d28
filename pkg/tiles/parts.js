/**
 * Parts of a LAS or LAZ file, each of which is read as a file of its own: several jobs share a large one, and none has more of it in memory
 * than its part. A LAZ file is parted between chunks, as the table behind them tells.
 */
import { byteSourceOf } from '../files/byte-source.js';
import { openInput } from '../files/disk.js';
import { withModule } from './modules.js';

/** @import { ByteSource } from '../files/byte-source.js' */

/**
 * @typedef {object} Part
 * @property {number} index among the parts of the file
 * @property {number} points
 * @property {number} from its first byte in the file
 * @property {number} to the first byte behind it
 */

/** Bytes of a part, about: four million points of a LAZ file. */
const PART = 32 << 20;
/** Records behind the points that are longer than this are left out. */
const MOST_BEHIND = 1 << 24;
/** Places in a header: version, start of the points, format, bytes a point, points, records behind them, and points as 1.4 counts them. */
const AT = { minor: 25, start: 96, format: 104, record: 105, points: 107, behind: 235, behindCount: 243, many: 247 };
const HEADER = 375;

/**
 * The parts of a file; none of one that is read whole.
 * @param {string} path
 * @param {AbortSignal} signal
 * @param {number} [bytes] of a part
 * @returns {Promise<Part[]>}
 */
export async function partsOf(path, signal, bytes = PART) {
  const file = await openInput(path, signal);
  if (!(file instanceof Blob) || file.size < 2 * bytes || !(await isLas(file))) return [];
  const header = await headerOf(file);
  if (!header) return [];
  const each = header.packed ? await chunksOf(file, header, signal) : recordsOf(header, bytes);
  /** @type {Part[]} */
  const parts = [];
  let from = header.start + (header.packed ? 8 : 0);
  for (let i = 0; i < each.length; i += 2) {
    let last = parts.at(-1);
    if (!last || last.to - last.from >= bytes) parts.push((last = { index: parts.length, points: 0, from, to: from }));
    last.points += each[i];
    last.to = from += each[i + 1];
  }
  return parts.length > 1 && from <= file.size ? parts : [];
}

/**
 * A part as a file: the header with as many points, those, and the records behind all points.
 * @param {string} path @param {Part} part @param {AbortSignal} signal
 * @returns {Promise<ByteSource>}
 */
export async function openPart(path, { points, from, to }, signal) {
  const file = /** @type {Blob} */ (await openInput(path, signal));
  const { start, packed, behind } = /** @type {Header} */ (await headerOf(file));
  const head = await bytesOf(file, 0, start);
  const view = new DataView(head.buffer);
  if (view.getUint32(AT.points, true) > 0 || head[AT.minor] < 4) view.setUint32(AT.points, points, true);
  else view.setBigUint64(AT.many, BigInt(points), true);
  // The place of the chunks' table is one that no table has: a chunk says itself where it ends.
  const place = packed ? [new Uint8Array(8).fill(255)] : [];
  const before = start + 8 * place.length + to - from;
  if (behind) view.setBigUint64(AT.behind, BigInt(before), true);
  const records = behind ? [file.slice(behind)] : [];
  return byteSourceOf(new Blob([head, ...place, file.slice(from, to), ...records, new Uint8Array(8)]));
}

/** @typedef {{ start: number, packed: boolean, record: number, points: number, behind: number }} Header */

/** @param {Blob} file */
async function isLas(file) {
  return new TextDecoder().decode(await bytesOf(file, 0, 4)) === 'LASF';
}

/** What of the header matters here; nothing of one that is damaged, of which the reader tells. @param {Blob} file @returns {Promise<Header | undefined>} */
async function headerOf(file) {
  const bytes = await bytesOf(file, 0, HEADER);
  const view = new DataView(bytes.buffer);
  const start = view.getUint32(AT.start, true);
  if (start < 227 || start > file.size) return undefined;
  const many = bytes[AT.minor] >= 4;
  const few = view.getUint32(AT.points, true);
  const behind = many && view.getUint32(AT.behindCount, true) > 0 ? Number(view.getBigUint64(AT.behind, true)) : 0;
  return {
    start,
    packed: bytes[AT.format] > 63,
    record: view.getUint16(AT.record, true),
    points: few > 0 || !many ? few : Number(view.getBigUint64(AT.many, true)),
    behind: behind > start && behind < file.size && file.size - behind <= MOST_BEHIND ? behind : 0,
  };
}

/** Points and bytes of each chunk. @param {Blob} file @param {Header} header @param {AbortSignal} signal @returns {Promise<ArrayLike<number>>} */
async function chunksOf(file, { start }, signal) {
  const numberAt = async (/** @type {number} */ at) => Number(new DataView((await bytesOf(file, at, at + 8)).buffer).getBigInt64(0, true));
  let table = await numberAt(start);
  // A writer that could not go back has put the place at the end.
  if (table <= start) table = await numberAt(file.size - 8);
  if (!(table > start && table < file.size)) return [];
  const place = new Uint8Array(new BigInt64Array([BigInt(start + 8)]).buffer);
  const head = await bytesOf(new Blob([file.slice(0, start), place, file.slice(table)]), 0, Infinity);
  // What cannot be parted is read whole, and that says what is wrong with it.
  return withModule('las', signal, (ask) => ask({ call: 'lazChunks', args: [head, file.size] })).then((found) => found ?? [], () => []);
}

/** Records as chunks of about so many bytes, a tenth of a part. @param {Header} header @param {number} bytes */
function recordsOf({ record, points }, bytes) {
  const each = Math.max(1, Math.floor(bytes / 10 / record));
  const counts = Array.from({ length: Math.ceil(points / each) }, (_, i) => Math.min(each, points - i * each));
  return counts.flatMap((count) => [count, count * record]);
}

/** @param {Blob} file @param {number} from @param {number} to */
async function bytesOf(file, from, to) {
  return new Uint8Array(await file.slice(from, Math.min(to, file.size)).arrayBuffer());
}
