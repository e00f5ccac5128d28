/** The caller's clouds on their way in: of the right kind, and no longer the caller's memory. */
import { own } from './arrays.js';
import { UNITS } from './axes.js';
import { PointweaveError } from './errors.js';
import { badInput, expectArray } from './inputs.js';
import { MAPS, fileKey } from './pictures.js';
import { joinedCloud } from '../files/joining.js';

/** @import { PointCloud } from '../types.js' */

/**
 * A cloud's arrays as wasm takes them. Lengths and values are checked there.
 * @param {unknown} cloud
 * @param {boolean} [transfer] take the caller's buffers instead of copying them
 * @returns {PointCloud}
 */
export function cloudArgument(cloud, transfer) {
  return own(cloudFields(fields(cloud, 'cloud')), transfer);
}

/**
 * One cloud, or several of one frame as one.
 * @param {unknown} clouds
 * @param {boolean} [transfer]
 * @returns {PointCloud}
 */
export function cloudsArgument(clouds, transfer) {
  if (!Array.isArray(clouds)) return cloudArgument(clouds, transfer);
  if (clouds.length === 0) throw badInput('cloud', 'a cloud, or an array with one at least', clouds);
  if (clouds.length === 1) return cloudArgument(clouds[0], transfer);
  const each = clouds.map((cloud) => cloudFields(fields(cloud, 'cloud')));
  each.forEach(checkLengths);
  return joinedCloud(each);
}

/** What wasm checks of one cloud has to hold before several are put together. @param {PointCloud} cloud */
function checkLengths({ positions, colors, normals, attributes, viewpoints }) {
  if (positions.length % 3) throw badLength('positions', 'a multiple of 3', positions.length);
  const points = positions.length / 3;
  /** @type {[string, ArrayLike<number> | undefined, number][]} */
  const arrays = [['colors', colors, 3], ['normals', normals, 3], ['viewpoints.of', viewpoints?.of, 1]];
  for (const [name, values] of Object.entries(attributes ?? {})) arrays.push([`attributes.${name}`, values, 1]);
  for (const [name, values, each] of arrays) {
    if (values && values.length !== each * points) throw badLength(name, `${each * points} (${each} a point)`, values.length);
  }
}

/** @param {string} array @param {string} expected @param {number} found */
function badLength(array, expected, found) {
  return new PointweaveError({ code: 'bad-length', message: `${array} has ${found} values: expected ${expected}`, expected, found });
}

/**
 * What a writer needs of a result.
 * @param {unknown} result
 * @param {boolean} [transfer]
 */
export function resultArgument(result, transfer) {
  const given = fields(result, 'result');
  const { indices, uvs, tangents, textures } = given;
  if (indices !== undefined) expectArray('indices', indices, Uint32Array);
  for (const [name, values] of Object.entries({ uvs, tangents })) if (values !== undefined) expectArray(name, values, Float32Array);
  const pictures = MAPS.map((name) => [fileKey(name), textures?.[name]?.data]);
  for (const [i, [, data]] of pictures.entries()) if (data !== undefined) expectArray(`textures.${MAPS[i]}.data`, data, Uint8Array);
  return own({ indices, uvs, tangents, ...Object.fromEntries(pictures), ...cloudFields(given) }, transfer);
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

/** @param {Record<string, any>} cloud @returns {PointCloud} */
function cloudFields({ positions, colors, normals, attributes = {}, origin, viewpoints, up, seenFromAbove, floor, unit, crs, faces }) {
  expectArray('positions', positions, Float32Array, Float64Array);
  if (colors !== undefined) expectArray('colors', colors, Uint8Array);
  if (normals !== undefined) expectArray('normals', normals, Float32Array);
  for (const [name, values] of Object.entries(attributes)) expectArray(`attributes.${name}`, values, Float32Array);
  for (const [name, triple] of Object.entries({ origin, up })) if (triple !== undefined) expectTriple(name, triple);
  if (viewpoints !== undefined) expectViewpoints(viewpoints);
  if (seenFromAbove !== undefined && typeof seenFromAbove !== 'boolean') throw badInput('seenFromAbove', 'true or false', seenFromAbove);
  if (floor !== undefined) for (const name of ['point', 'normal']) expectTriple(`floor.${name}`, fields(floor, 'floor')[name]);
  if (unit !== undefined && !UNITS.includes(unit)) throw badInput('unit', `one of ${UNITS.join(', ')}`, unit);
  if (crs !== undefined) expectCrs(crs);
  if (faces !== undefined && !Number.isSafeInteger(faces)) throw badInput('faces', 'an integer', faces);
  return {
    positions, colors, normals, attributes: { ...attributes }, origin: origin && [...origin], up: up && [...up], seenFromAbove, unit, faces,
    floor: floor && { point: [...floor.point], normal: [...floor.normal] },
    viewpoints: viewpoints && { positions: viewpoints.positions, of: viewpoints.of },
    crs: crs && { wkt: crs.wkt, keys: crs.keys, doubles: crs.doubles, ascii: crs.ascii },
  };
}

/** @param {string} name @param {unknown} value */
function expectTriple(name, value) {
  if (!(Array.isArray(value) && value.length === 3 && value.every(Number.isFinite))) throw badInput(name, 'three finite numbers', value);
}

/** @param {unknown} crs */
function expectCrs(crs) {
  const { wkt, keys, doubles, ascii } = fields(crs, 'crs');
  for (const [name, text] of Object.entries({ wkt, ascii })) if (text !== undefined && typeof text !== 'string') throw badInput(`crs.${name}`, 'a text', text);
  if (keys !== undefined) expectArray('crs.keys', keys, Uint16Array);
  if (doubles !== undefined) expectArray('crs.doubles', doubles, Float64Array);
}

/** @param {unknown} viewpoints */
function expectViewpoints(viewpoints) {
  const { positions, of } = fields(viewpoints, 'viewpoints');
  expectArray('viewpoints.positions', positions, Float64Array);
  if (of !== undefined) expectArray('viewpoints.of', of, Uint32Array);
}
