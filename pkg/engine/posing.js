/** What a poster shows and from where: options as wasm takes them. The camera is written as `camera-orbit` of the element is. */
import { frameOf } from '../viewer/frame.js';
import { likelyUp } from '../viewer/upright.js';
import { direction } from './axes.js';
import { resultArgument } from './clouds.js';
import { ANGLES, LENGTHS, WHOLE, quantity } from './quantities.js';

/** @type {[number, number]} */
const SIZE = [800, 600];

/** @typedef {{ azimuth?: number, polar?: number, share?: number, length?: number }} Orbit */

/**
 * The three words of an orbit, apart by blanks or commas, each `auto` or a quantity; undefined where one is wrong.
 * @param {unknown} text
 * @returns {Orbit | undefined}
 */
export function orbitOf(text) {
  if (typeof text !== 'string') return undefined;
  const words = text.trim().toLowerCase().split(/\s*,\s*|\s+/);
  if (words.length !== 3) return undefined;
  const [azimuth, polar] = words.slice(0, 2).map((word) => (word === 'auto' ? undefined : quantity(word, ANGLES)));
  const [, , far] = words;
  const share = quantity(far, { '%': 1 / WHOLE });
  const length = quantity(far, LENGTHS);
  const right = [azimuth, polar, share ?? length].every((value, i) => (words[i] === 'auto') === (value === undefined));
  return right && (share ?? length ?? 1) > 0 ? { azimuth, polar, share, length } : undefined;
}

/** Red, green and blue of `#rrggbb`. @param {unknown} text @returns {[number, number, number] | undefined} */
export function colorOf(text) {
  const [, digits] = /^#([0-9a-f]{6})$/i.exec(String(text)) ?? [];
  return digits ? /** @type {[number, number, number]} */ ([0, 2, 4].map((at) => parseInt(digits.slice(at, at + 2), 16))) : undefined;
}

/**
 * What wasm takes.
 * @param {any} what a cloud or a mesh
 * @param {Record<string, any>} own options that were checked
 * @param {boolean} [transfer]
 * @returns {[any, any]}
 */
export function posterArguments(what, own, transfer) {
  const shown = resultArgument(what, transfer);
  return [shown, settingsOf(shown, own)];
}

/** @param {any} what @param {Record<string, any>} own */
function settingsOf(what, { size: [width, height] = SIZE, camera = 'auto auto auto', background }) {
  const up = direction(what.up ?? likelyUp(what, frameOf(what).size));
  return { width, height, ...orbitOf(camera), up, background: colorOf(background) };
}

/** @param {Uint8Array} data @param {{ width: number, height: number }} settings @returns {import('../types.js').Texture} */
export function posterOf(data, { width, height }) {
  return { width, height, data, type: 'image/png' };
}
