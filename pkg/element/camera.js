/** Camera attributes in model-viewer's syntax, in a viewer's terms. What is not valid counts as not given. */
import { ANGLES, LENGTHS, WHOLE, quantity } from '../engine/quantities.js';

/** @import { Distance, Viewer } from '../viewer.js' */
/** @import { Switched } from './switching.js' */

/** @param {Viewer} viewer @param {Switched} asked */
export function aim(viewer, asked) {
  const [azimuth, polar, distance] = orbit(asked.cameraOrbit);
  const [fieldOfView] = words(asked.fieldOfView, [angle]);
  const target = /** @type {[number | null, number | null, number | null]} */ (words(asked.cameraTarget, [length, length, length]).map((x) => x ?? null));
  viewer.firstLook = { azimuth, polar, distance, target, fieldOfView };
}

/** @param {Viewer} viewer @param {Switched} asked */
export function confine(viewer, asked) {
  const [least, most] = [orbit(asked.minCameraOrbit), orbit(asked.maxCameraOrbit)];
  viewer.limits = {
    azimuth: [least[0] ?? null, most[0] ?? null],
    polar: [least[1] ?? null, most[1] ?? null],
    distance: [least[2] ?? null, most[2] ?? null],
    fieldOfView: [words(asked.minFieldOfView, [angle])[0] ?? null, words(asked.maxFieldOfView, [angle])[0] ?? null],
  };
  viewer.zoomable = !asked.disableZoom;
  viewer.pannable = !asked.disablePan;
  viewer.autoRotateDelay = asked.autoRotateDelay;
}

/** A place, `0.1m 0.2m 0.3m` or three numbers. @param {string | undefined} text @returns {[number, number, number] | null} */
export function placeOf(text) {
  const place = words(text ?? '', [length, length, length]);
  return place.every((x) => x !== undefined) && place.length === 3 ? /** @type {[number, number, number]} */ (place) : null;
}

/** @param {string} text @returns {[number | undefined, number | undefined, Distance | undefined]} */
function orbit(text) {
  const [azimuth, polar, distance] = words(text, [angle, angle, reach]);
  return [/** @type {number | undefined} */ (azimuth), /** @type {number | undefined} */ (polar), distance];
}

/**
 * As many words as there are readers, each `auto` or what its reader takes; undefined for all where one is wrong.
 * @template T
 * @param {string} text
 * @param {((word: string) => T | undefined)[]} readers
 * @returns {(T | undefined)[]}
 */
function words(text, readers) {
  const given = text.trim().toLowerCase().split(/\s+/);
  const read = readers.map((reader, i) => (given[i] === 'auto' ? undefined : reader(given[i] ?? '')));
  const right = given.length === readers.length && given.every((word, i) => word === 'auto' || read[i] !== undefined);
  return right ? read : readers.map(() => undefined);
}

/** @param {string} word */
function angle(word) {
  return quantity(word, ANGLES);
}

/** @param {string} word */
function length(word) {
  return quantity(word, { ...LENGTHS, '': 1 });
}

/** @param {string} word @returns {Distance | undefined} */
function reach(word) {
  const share = quantity(word, { '%': 1 / WHOLE });
  return share === undefined ? quantity(word, LENGTHS) : { share };
}
