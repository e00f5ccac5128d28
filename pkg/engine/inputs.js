/** Arguments of the wrong type, and arrays whose memory belongs to somebody else now. */
import { PointweaveError } from './errors.js';

/**
 * @param {string} name
 * @param {unknown} value
 * @param {(Function & { name: string })[]} types any of them
 */
export function expectArray(name, value, ...types) {
  if (!types.some((type) => value instanceof type)) throw badInput(name, `a ${types.map((type) => type.name).join(' or ')}`, value);
  expectAttached(name, /** @type {ArrayBufferView} */ (value).buffer);
}

/** @param {string} name @param {ArrayBufferLike} buffer */
export function expectAttached(name, buffer) {
  if (!(buffer instanceof ArrayBuffer)) return; // shared memory is never handed over
  try {
    new Uint8Array(buffer); // Node 20 has no `buffer.detached`
  } catch {
    throw new PointweaveError({
      code: 'detached',
      message: `the memory of ${name} was handed over, by transfer: true or postMessage: keep a copy, or leave transfer out`,
      expected: 'an array whose memory was not handed over',
      found: 'a detached buffer',
    });
  }
}

/** @param {string} name @param {string} expected @param {unknown} found */
export function badInput(name, expected, found) {
  const kind = found === null ? 'null' : typeof found === 'object' ? found.constructor?.name ?? 'object' : typeof found;
  return new PointweaveError({ code: 'bad-input', message: `${name} is of type ${kind}: expected ${expected}`, expected, found: kind });
}
