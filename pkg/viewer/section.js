/** A plane that cuts what is drawn: the side that its normal points into is seen. */
import { Plane, Vector3 } from 'three';
import { badInput } from '../engine/inputs.js';

/** @import { Frame, Section } from '../viewer.js' */

/** A section of the caller's, checked and copied. @param {Section | null} section @returns {Section | null} */
export function sectionOf(section) {
  if (!section) return null;
  const { point, normal } = section;
  for (const [name, triple] of Object.entries({ point, normal })) {
    if (!Array.isArray(triple) || triple.length !== 3 || !triple.every(Number.isFinite)) throw badInput(`section.${name}`, 'three finite numbers', triple);
  }
  if (!normal.some(Boolean)) throw badInput('section.normal', 'a direction', normal);
  return { point: [...point], normal: [...normal] };
}

/**
 * The plane as it stands before the camera.
 * @param {Section} section
 * @param {Frame} frame
 * @param {import('three').Quaternion} turned
 */
export function planeOf({ point, normal }, { center, diagonal }, turned) {
  const at = new Vector3(...point).sub(new Vector3(...center)).divideScalar(diagonal).applyQuaternion(turned);
  return new Plane().setFromNormalAndCoplanarPoint(new Vector3(...normal).normalize().applyQuaternion(turned), at);
}
