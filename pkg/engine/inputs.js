/** Arguments of the wrong type. */
import { PointweaveError } from './errors.js';

/**
 * @param {string} name
 * @param {unknown} value
 * @param {Function & { name: string }} type
 * @param {string} [expected]
 */
export function expectArray(name, value, type, expected = `a ${type.name}`) {
  if (!(value instanceof type)) throw badInput(name, expected, value);
}

/** @param {string} name @param {string} expected @param {unknown} found */
export function badInput(name, expected, found) {
  const kind = found === null ? 'null' : typeof found === 'object' ? found.constructor?.name ?? 'object' : typeof found;
  return new PointweaveError({ code: 'bad-input', message: `${name} is of type ${kind}: expected ${expected}`, expected, found: kind });
}
