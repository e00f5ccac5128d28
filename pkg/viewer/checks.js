/** What is handed to a viewer: wrong types, lengths and corners are errors, not a picture of something else. */
import { PointweaveError } from '../engine/errors.js';
import { badInput, expectArray } from '../engine/inputs.js';

/** @import { Drawable } from '../viewer.js' */

/** @param {Drawable} what */
export function expectDrawable(what) {
  if (typeof what !== 'object' || what === null) throw badInput('what is shown', 'a cloud, a mesh, or a GLB that was read', what);
  const { positions, normals, colors, indices, uvs, tangents } = what;
  expectArray('positions', positions, Float32Array, Float64Array);
  if (positions.length === 0) throw new PointweaveError({ code: 'empty-cloud', message: 'there are no points to show' });
  const { length } = positions;
  expectLength('positions', length, length - (length % 3));
  if (normals) {
    expectArray('normals', normals, Float32Array);
    expectLength('normals', normals.length, length);
  }
  if (colors) {
    expectArray('colors', colors, Uint8Array);
    expectLength('colors', colors.length, length);
  }
  for (const [name, values, each] of /** @type {const} */ ([['uvs', uvs, 2], ['tangents', tangents, 4]])) {
    if (!values) continue;
    expectArray(name, values, Float32Array);
    expectLength(name, values.length, (each * length) / 3);
  }
  if (!indices) return;
  expectArray('indices', indices, Uint32Array);
  expectLength('indices', indices.length, indices.length - (indices.length % 3));
  const index = indices.findIndex((corner) => 3 * corner >= length);
  if (index < 0) return;
  const [found, expected] = [indices[index], length / 3 - 1];
  throw new PointweaveError({ code: 'bad-index', message: `indices[${index}] is ${found}: expected at most ${expected}`, index, found, expected });
}

/** @param {HTMLCanvasElement} canvas @returns {CanvasRenderingContext2D} */
export function contextOf(canvas) {
  const context = typeof canvas?.getContext === 'function' ? canvas.getContext('2d') : null;
  if (!context) throw badInput('canvas', "an HTMLCanvasElement without a context of another kind than '2d'", canvas);
  return context;
}

/** @param {string} name @param {number} found @param {number} expected */
function expectLength(name, found, expected) {
  if (found === expected) return;
  throw new PointweaveError({ code: 'bad-length', message: `${name} has ${found} values: expected ${expected}`, found, expected });
}
