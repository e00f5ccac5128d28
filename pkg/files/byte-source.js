/** Bytes that are read slice by slice: of a Blob, which may lie on a disk, or of the caller's array. */
import { own } from '../engine/arrays.js';
import { badInput, expectAttached } from '../engine/inputs.js';

/** Slice size: small against large files, large enough that per-call overhead does not show. */
const SLICE = 4 << 20;

/**
 * @typedef {object} ByteSource
 * @property {number} size in bytes
 * @property {(at: number) => Promise<Uint8Array>} read the bytes from `at` on, in memory of their own
 */

/**
 * The first slice of bytes is copied before this returns, the others when they are read.
 * @param {unknown} data
 * @param {boolean} [transfer] take the caller's buffer
 * @returns {ByteSource}
 */
export function byteSourceOf(data, transfer) {
  if (typeof Blob !== 'undefined' && data instanceof Blob) {
    return { size: data.size, read: async (at) => new Uint8Array(await data.slice(at, at + SLICE).arrayBuffer()) };
  }
  const given = viewOf(data);
  const bytes = transfer ? own(given, true) : given;
  const first = bytes.slice(0, SLICE);
  return { size: bytes.length, read: async (at) => (at === 0 ? first : bytes.slice(at, at + SLICE)) };
}

/** Of a `File`. @param {unknown} data @returns {string | undefined} */
export function nameOf(data) {
  return typeof File !== 'undefined' && data instanceof File ? data.name : undefined;
}

/** @param {unknown} data */
function viewOf(data) {
  const view = ArrayBuffer.isView(data);
  if (!view && !(data instanceof ArrayBuffer)) throw badInput('data', 'a File, Blob, ArrayBuffer or Uint8Array', data);
  expectAttached('data', view ? data.buffer : data);
  return view ? new Uint8Array(data.buffer, data.byteOffset, data.byteLength) : new Uint8Array(data);
}
