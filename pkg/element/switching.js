/** Attributes as properties, by tables. Texts for the camera are in model-viewer's syntax, which camera.js reads. */
import { readChoice, readNumber, write } from './reflection.js';

/** There is none on a server, where the class is never made. @type {typeof HTMLElement} */
const Base = globalThis.HTMLElement ?? /** @type {any} */ (class {});

/** @typedef {{ get: (element: HTMLElement) => unknown, set: (element: HTMLElement, value: any) => void }} Property */

/** @param {string} name @returns {Property} */
const text = (name) => ({ get: (element) => element.getAttribute(name) ?? '', set: (element, value) => write(element, name, value) });
/** @param {string} name @returns {Property} */
const toggle = (name) => ({ get: (element) => element.hasAttribute(name), set: (element, value) => void element.toggleAttribute(name, Boolean(value)) });
/** @param {string} name @param {unknown} fallback @param {(value: number) => boolean} valid @returns {Property} */
const number = (name, fallback, valid) => ({
  get: (element) => readNumber(element, name, valid) ?? fallback,
  set: (element, value) => write(element, name, value),
});
/** At least 0. @param {number} fallback @returns {(name: string) => Property} */
const amount = (fallback) => (name) => number(name, fallback, (value) => value >= 0 && value < Infinity);
/** From 1. @param {unknown} fallback @param {number} most @returns {(name: string) => Property} */
const count = (fallback, most) => (name) => number(name, fallback, (value) => Number.isInteger(value) && value >= 1 && value <= most);
/** The first is what an attribute means that is missing or wrong. @param {...string} choices @returns {(name: string) => Property} */
const choice = (...choices) => (name) => ({ get: (element) => readChoice(element, name, choices), set: (element, value) => write(element, name, value) });

const MOST_POINTS = 0xffffffff;
const MOST_THREADS = 64;
/** What it shows, and how that is computed. @type {Record<string, (name: string) => Property>} */
const OWN = {
  src: text, alt: text, poster: text, flip: toggle, 'auto-rotate': toggle,
  ratio: (name) => number(name, null, (value) => value > 0 && value <= 1),
  count: count(null, MOST_POINTS),
  threads: count('auto', MOST_THREADS),
  view: choice('mesh', 'reduced', 'points'),
  loading: choice('lazy', 'eager'),
  up: choice('auto', 'y', 'z', '-y', '-z', 'x', '-x'),
  orientation: choice('auto', 'normals', 'viewpoints', 'up', 'outward', 'inward'),
};

/** Where the camera is, and where it may go, by attribute. @type {Record<string, (name: string) => Property>} */
const MOVING = {
  'camera-orbit': text, 'camera-target': text, 'field-of-view': text, 'min-camera-orbit': text, 'max-camera-orbit': text,
  'min-field-of-view': text, 'max-field-of-view': text, 'disable-zoom': toggle, 'disable-pan': toggle, 'auto-rotate-delay': amount(3000),
};
/** What it is lit by. @type {Record<string, (name: string) => Property>} */
const LIT = { 'environment-image': text, exposure: amount(1), 'shadow-intensity': amount(0) };
/** How it is put into the room. @type {Record<string, (name: string) => Property>} */
const PLACED = { ar: toggle, 'ar-modes': text, 'ar-scale': choice('auto', 'fixed'), 'ar-placement': choice('floor', 'wall'), 'ios-src': text };
/** @type {Record<string, (name: string) => Property>} */
const SHOWN = { reveal: choice('auto', 'manual'), 'interaction-prompt': choice('auto', 'none') };

export const CAMERA = Object.keys(MOVING);
export const LIGHT = Object.keys(LIT);
export const AR = Object.keys(PLACED);
const ALL = { ...OWN, ...MOVING, ...LIT, ...PLACED, ...SHOWN };
export const SWITCHED = Object.keys(ALL);

/** @param {string} attribute */
export function propertyOf(attribute) {
  return attribute.replace(/-(.)/g, (_, letter) => letter.toUpperCase());
}

/**
 * @typedef {Pick<import('../element.js').PointWeaveElement, 'cameraOrbit' | 'cameraTarget' | 'fieldOfView' | 'minCameraOrbit' |
 *   'maxCameraOrbit' | 'minFieldOfView' | 'maxFieldOfView' | 'disableZoom' | 'disablePan' | 'autoRotateDelay' | 'environmentImage' |
 *   'exposure' | 'shadowIntensity' | 'reveal' | 'interactionPrompt' | 'src' | 'alt' | 'poster' | 'flip' | 'autoRotate' | 'ratio' |
 *   'count' | 'threads' | 'view' | 'loading' | 'up' | 'orientation' | 'ar' | 'arModes' | 'arScale' | 'arPlacement' | 'iosSrc'>} Switched
 */

class Plain extends Base {}
for (const [attribute, kind] of Object.entries(ALL)) {
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
