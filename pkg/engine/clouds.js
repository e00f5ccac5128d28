/** The caller's clouds on their way in: of the right kind, and no longer the caller's memory. */
import { own } from './arrays.js';
import { PointweaveError } from './errors.js';

/** @import { PointCloud } from '../types.js' */

/**
 * A cloud's arrays as wasm takes them. Lengths and values are checked there.
 * @param {unknown} cloud
 * @param {boolean} [transfer] take the caller's buffers instead of copying them
 * @returns {PointCloud}
 */
export function cloudArgument(cloud, transfer) {
  const { positions, colors, normals, attributes = {}, origin } = fields(cloud, 'cloud');
  if (!(positions instanceof Float64Array)) expectArray('positions', positions, Float32Array, 'a Float32Array or Float64Array');
  return own({ positions, ...optionalArrays({ colors, normals, attributes, origin }) }, transfer);
}

/**
 * What a writer needs of a result.
 * @param {unknown} result
 * @param {boolean} [transfer]
 */
export function resultArgument(result, transfer) {
  const { positions, colors, normals, attributes = {}, origin, indices } = fields(result, 'result');
  if (!(positions instanceof Float64Array)) expectArray('positions', positions, Float32Array, 'a Float32Array or Float64Array');
  if (indices !== undefined) expectArray('indices', indices, Uint32Array);
  return own({ positions, indices, ...optionalArrays({ colors, normals, attributes, origin }) }, transfer);
}

/**
 * @param {unknown} object
 * @param {string} name
 * @returns {Record<string, any>}
 */
function fields(object, name) {
  if (typeof object !== 'object' || object === null) throw badInput(name, 'an object with positions', object);
  return object;
}

/** @param {Record<string, any>} arrays */
function optionalArrays({ colors, normals, attributes, origin }) {
  if (colors !== undefined) expectArray('colors', colors, Uint8Array);
  if (normals !== undefined) expectArray('normals', normals, Float32Array);
  for (const [name, values] of Object.entries(attributes)) expectArray(`attributes.${name}`, values, Float32Array);
  if (origin !== undefined && !(Array.isArray(origin) && origin.length === 3 && origin.every(Number.isFinite))) {
    throw badInput('origin', 'three finite numbers', origin);
  }
  return { colors, normals, attributes: { ...attributes }, origin: origin && [...origin] };
}

/**
 * @param {string} name
 * @param {unknown} value
 * @param {Function & { name: string }} type
 * @param {string} [expected]
 */
function expectArray(name, value, type, expected = `a ${type.name}`) {
  if (!(value instanceof type)) throw badInput(name, expected, value);
}

/** @param {string} name @param {string} expected @param {unknown} found */
function badInput(name, expected, found) {
  const kind = found === null ? 'null' : typeof found === 'object' ? found.constructor?.name ?? 'object' : typeof found;
  return new PointweaveError({ code: 'bad-input', message: `${name} is of type ${kind}: expected ${expected}`, expected, found: kind });
}
