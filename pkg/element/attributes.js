/** The element's own attributes as properties, as HTML does it: a property reads what its attribute says and writes it there. */

import { readChoice, readNumber, write } from './reflection.js';
import { SWITCHED, Switching, propertyOf } from './switching.js';

/** @import { Loading, Up, View } from '../element.js' */
/** @import { Orientation } from '../types.js' */

/** The first is what an attribute means that is missing or wrong. */
const VIEWS = /** @type {const} */ (['mesh', 'reduced', 'points']);
const LOADINGS = /** @type {const} */ (['lazy', 'eager']);
const UPS = /** @type {const} */ (['auto', 'y', 'z', '-y', '-z', 'x', '-x']);
const ORIENTATIONS = /** @type {const} */ (['auto', 'normals', 'viewpoints', 'up', 'outward', 'inward']);
const MOST_POINTS = 0xffffffff;
const MOST_THREADS = 64;

export class Reflecting extends Switching {
  static observedAttributes = ['src', 'alt', 'ratio', 'count', 'view', 'poster', 'threads', 'auto-rotate', 'controls', 'camera-controls', 'loading', 'up', 'orientation', 'flip', ...SWITCHED];

  /** For use at the end of a constructor: what a page has set before the element was defined goes where it belongs. */
  upgrade() {
    for (const attribute of Reflecting.observedAttributes) {
      const name = /** @type {'src'} */ (propertyOf(attribute));
      if (!Object.hasOwn(this, name)) continue;
      const value = this[name];
      delete /** @type {Partial<this>} */ (this)[name];
      this[name] = value;
    }
  }

  get src() {
    return this.getAttribute('src') ?? '';
  }

  set src(value) {
    write(this, 'src', value);
  }

  get alt() {
    return this.getAttribute('alt') ?? '';
  }

  set alt(value) {
    write(this, 'alt', value);
  }

  get poster() {
    return this.getAttribute('poster') ?? '';
  }

  set poster(value) {
    write(this, 'poster', value);
  }

  /** @returns {number | null} */
  get ratio() {
    return readNumber(this, 'ratio', (value) => value > 0 && value <= 1);
  }

  set ratio(value) {
    write(this, 'ratio', value);
  }

  /** @returns {number | null} */
  get count() {
    return readNumber(this, 'count', (value) => Number.isInteger(value) && value >= 1 && value <= MOST_POINTS);
  }

  set count(value) {
    write(this, 'count', value);
  }

  /** @returns {number | 'auto'} */
  get threads() {
    return readNumber(this, 'threads', (value) => Number.isInteger(value) && value >= 1 && value <= MOST_THREADS) ?? 'auto';
  }

  set threads(value) {
    write(this, 'threads', value);
  }

  /** @returns {View} */
  get view() {
    return readChoice(this, 'view', VIEWS);
  }

  set view(value) {
    write(this, 'view', value);
  }

  /** @returns {Loading} */
  get loading() {
    return readChoice(this, 'loading', LOADINGS);
  }

  set loading(value) {
    write(this, 'loading', value);
  }

  /** @returns {Up} */
  get up() {
    return readChoice(this, 'up', UPS);
  }

  set up(value) {
    write(this, 'up', value);
  }

  /** @returns {Orientation} */
  get orientation() {
    return readChoice(this, 'orientation', ORIENTATIONS);
  }

  set orientation(value) {
    write(this, 'orientation', value);
  }

  get flip() {
    return this.hasAttribute('flip');
  }

  set flip(value) {
    this.toggleAttribute('flip', Boolean(value));
  }

  get autoRotate() {
    return this.hasAttribute('auto-rotate');
  }

  set autoRotate(value) {
    this.toggleAttribute('auto-rotate', Boolean(value));
  }

  /** `camera-controls`, as model-viewer calls it, is the same. */
  get controls() {
    return this.hasAttribute('controls') || this.hasAttribute('camera-controls');
  }

  set controls(value) {
    this.toggleAttribute('controls', Boolean(value));
    if (!value) this.removeAttribute('camera-controls');
  }

  get cameraControls() {
    return this.controls;
  }

  set cameraControls(value) {
    this.controls = value;
  }
}
