/**
 * Attributes as properties, as HTML does it: a property reads what its attribute says and writes it there. What is not valid
 * counts as not given; null and undefined take the attribute away.
 */

/** @import { Loading, Up, View } from '../element.js' */
/** @import { Orientation } from '../types.js' */

/** There is none on a server, where the class is never made. @type {typeof HTMLElement} */
const Base = globalThis.HTMLElement ?? /** @type {any} */ (class {});

/** The first is what an attribute means that is missing or wrong. */
const VIEWS = /** @type {const} */ (['mesh', 'reduced', 'points']);
const LOADINGS = /** @type {const} */ (['lazy', 'eager']);
const UPS = /** @type {const} */ (['auto', 'y', 'z', '-y', '-z', 'x', '-x']);
const ORIENTATIONS = /** @type {const} */ (['auto', 'normals', 'viewpoints', 'up', 'outward', 'inward']);
const MOST_POINTS = 0xffffffff;
const MOST_THREADS = 64;

export class Reflecting extends Base {
  static observedAttributes = ['src', 'alt', 'ratio', 'count', 'view', 'poster', 'threads', 'auto-rotate', 'controls', 'loading', 'up', 'orientation', 'flip'];

  /** For use at the end of a constructor: what a page has set before the element was defined goes where it belongs. */
  upgrade() {
    for (const attribute of Reflecting.observedAttributes) {
      const name = /** @type {'src'} */ (attribute.replace(/-(.)/g, (_, letter) => letter.toUpperCase()));
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

  get controls() {
    return this.hasAttribute('controls');
  }

  set controls(value) {
    this.toggleAttribute('controls', Boolean(value));
  }
}

/** @param {HTMLElement} element @param {string} name @param {unknown} value */
function write(element, name, value) {
  if (value === null || value === undefined) element.removeAttribute(name);
  else element.setAttribute(name, String(value));
}

/** @param {HTMLElement} element @param {string} name @param {(value: number) => boolean} valid */
function readNumber(element, name, valid) {
  const text = element.getAttribute(name)?.trim();
  const value = text ? Number(text) : NaN;
  return valid(value) ? value : null;
}

/**
 * In any case of letters, as HTML's own.
 * @template {string} Choice
 * @param {HTMLElement} element
 * @param {string} name
 * @param {readonly Choice[]} choices
 */
function readChoice(element, name, choices) {
  const text = element.getAttribute(name)?.trim().toLowerCase();
  return choices.find((choice) => choice === text) ?? choices[0];
}
