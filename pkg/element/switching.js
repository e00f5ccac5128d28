/** The attributes that a page knows from `<model-viewer>`, as properties. Texts are in its syntax, which camera.js reads. */
import { readChoice, readNumber, write } from './reflection.js';

/** There is none on a server, where the class is never made. @type {typeof HTMLElement} */
const Base = globalThis.HTMLElement ?? /** @type {any} */ (class {});

/** @typedef {{ get: (element: HTMLElement) => unknown, set: (element: HTMLElement, value: any) => void }} Property */

/** @param {string} name @returns {Property} */
const text = (name) => ({ get: (element) => element.getAttribute(name) ?? '', set: (element, value) => write(element, name, value) });
/** @param {string} name @returns {Property} */
const toggle = (name) => ({ get: (element) => element.hasAttribute(name), set: (element, value) => void element.toggleAttribute(name, Boolean(value)) });
/** At least 0. @param {string} name @param {number} fallback @returns {Property} */
const number = (name, fallback) => ({
  get: (element) => readNumber(element, name, (value) => value >= 0 && value < Infinity) ?? fallback,
  set: (element, value) => write(element, name, value),
});
/** @param {string} name @param {readonly string[]} choices @returns {Property} */
const choice = (name, choices) => ({ get: (element) => readChoice(element, name, choices), set: (element, value) => write(element, name, value) });

/** Where the camera is, and where it may go, by attribute. @type {Record<string, (name: string) => Property>} */
const MOVING = {
  'camera-orbit': text, 'camera-target': text, 'field-of-view': text, 'min-camera-orbit': text, 'max-camera-orbit': text,
  'min-field-of-view': text, 'max-field-of-view': text, 'disable-zoom': toggle, 'disable-pan': toggle, 'auto-rotate-delay': (name) => number(name, 3000),
};
/** What it is lit by. @type {Record<string, (name: string) => Property>} */
const LIT = { 'environment-image': text, exposure: (name) => number(name, 1), 'shadow-intensity': (name) => number(name, 0) };
/** @type {Record<string, (name: string) => Property>} */
const SHOWN = { reveal: (name) => choice(name, ['auto', 'manual']), 'interaction-prompt': (name) => choice(name, ['auto', 'none']) };

export const CAMERA = Object.keys(MOVING);
export const LIGHT = Object.keys(LIT);
export const SWITCHED = [...CAMERA, ...LIGHT, ...Object.keys(SHOWN)];

/** @param {string} attribute */
export function propertyOf(attribute) {
  return attribute.replace(/-(.)/g, (_, letter) => letter.toUpperCase());
}

/**
 * @typedef {Pick<import('../element.js').PointWeaveElement, 'cameraOrbit' | 'cameraTarget' | 'fieldOfView' | 'minCameraOrbit' |
 *   'maxCameraOrbit' | 'minFieldOfView' | 'maxFieldOfView' | 'disableZoom' | 'disablePan' | 'autoRotateDelay' | 'environmentImage' |
 *   'exposure' | 'shadowIntensity' | 'reveal' | 'interactionPrompt'>} Switched
 */

class Plain extends Base {}
for (const [attribute, kind] of Object.entries({ ...MOVING, ...LIT, ...SHOWN })) {
  const { get, set } = kind(attribute);
  Object.defineProperty(Plain.prototype, propertyOf(attribute), {
    get() {
      return get(this);
    },
    set(value) {
      set(this, value);
    },
    configurable: true,
    enumerable: true,
  });
}

export const Switching = /** @type {{ new (): HTMLElement & Switched }} */ (/** @type {unknown} */ (Plain));
