/** The typed arrays in an object, however deep, and the memory that they lie in. */

/**
 * The same arrays in memory of their own, copied or taken over.
 *
 * Shared memory cannot be taken over and is copied in either case. A view takes its whole buffer along.
 * @template T
 * @param {T} value
 * @param {boolean} [transfer]
 * @returns {T}
 */
export function own(value, transfer) {
  return transfer ? structuredClone(copyArrays(value, isShared), { transfer: buffersOf(value) }) : copyArrays(value, () => true);
}

/** @param {ArrayBufferView} array */
function isShared(array) {
  return !(array.buffer instanceof ArrayBuffer);
}

/**
 * @template T
 * @param {T} value
 * @param {(array: ArrayBufferView) => boolean} chosen
 * @returns {T}
 */
function copyArrays(value, chosen) {
  if (ArrayBuffer.isView(value)) {
    const array = /** @type {Float32Array} */ (/** @type {unknown} */ (value));
    return chosen(value) ? /** @type {any} */ (array.slice()) : value;
  }
  if (typeof value !== 'object' || value === null || Array.isArray(value)) return value;
  return /** @type {any} */ (Object.fromEntries(Object.entries(value).map(([key, part]) => [key, copyArrays(part, chosen)])));
}

/**
 * The buffers of all typed arrays in a message, to hand over instead of copy.
 * @param {unknown} value
 * @param {Set<ArrayBuffer>} [found]
 * @returns {ArrayBuffer[]}
 */
export function buffersOf(value, found = new Set()) {
  if (ArrayBuffer.isView(value)) {
    if (value.buffer instanceof ArrayBuffer) found.add(value.buffer);
  } else if (typeof value === 'object' && value !== null) {
    for (const part of Object.values(value)) buffersOf(part, found);
  }
  return [...found];
}
