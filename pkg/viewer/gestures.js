/** Pointers, fingers and wheels: one turns, two move and pinch. A mouse moves with its right button, or with a key held. */

/** Held by the middle button, or turned by a wheel, so many CSS pixels come nearer by a twentieth. */
const PIXELS_A_STEP = 70;
/** A pinch on a touch pad comes as a wheel with small steps. */
const PINCH = 10;
const LARGEST_STEP = 100;
/** CSS pixels of a wheel's step, which may be counted in pixels, lines or pages. */
const WHEEL_UNITS = [1, 16, 100];

/**
 * What is moved. Ways are shares of the element's height.
 * @typedef {object} Hands
 * @property {() => void} begin somebody takes hold of it
 * @property {(x: number, y: number) => void} drag turns it
 * @property {(x: number, y: number) => void} shift moves it
 * @property {(factor: number) => void} pinch under 1 comes nearer
 *
 * @typedef {{ x: number, y: number }} Point
 */

export class Gestures {
  enabled = false;
  /** Whether it comes nearer, and moves aside. */
  zooms = true;
  pans = true;
  #element;
  #hands;
  #embedded;
  /** Where the pointers are that hold it. @type {Map<number, Point>} */
  #held = new Map();
  /** @type {'drag' | 'shift' | 'pinch'} */
  #grip = 'drag';

  /**
   * @param {HTMLElement} element
   * @param {Hands} hands
   * @param {boolean} embedded a wheel scrolls the page, until the element has the focus
   */
  constructor(element, hands, embedded) {
    this.#element = element;
    this.#hands = hands;
    this.#embedded = embedded;
  }

  /** Listens, or no longer. @param {boolean} on */
  listen(on) {
    const change = on ? this.#element.addEventListener : this.#element.removeEventListener;
    for (const [type, hear] of Object.entries(this.#heard)) change.call(this.#element, type, /** @type {EventListener} */ (hear), { passive: false });
    this.#held.clear();
  }

  /** @param {PointerEvent} event */
  #take = (event) => {
    if (!this.enabled || this.#held.size === 2) return;
    const { pointerId, pointerType, button, ctrlKey, metaKey, shiftKey } = event;
    const other = this.pans && pointerType !== 'touch' && (button === 2 || ctrlKey || metaKey || shiftKey);
    this.#grip = other ? 'shift' : button === 1 && this.zooms ? 'pinch' : 'drag';
    this.#element.setPointerCapture(pointerId);
    this.#held.set(pointerId, pointOf(event));
    this.#hands.begin();
  };

  /** @param {PointerEvent} event */
  #move = (event) => {
    if (!this.#held.has(event.pointerId)) return;
    const before = this.#grasp;
    this.#held.set(event.pointerId, pointOf(event));
    const now = this.#grasp;
    const [x, y] = [now.x - before.x, now.y - before.y].map((way) => way / this.#element.clientHeight);
    if (this.#held.size === 2) {
      if (this.pans) this.#hands.shift(x, y);
      if (this.zooms && before.spread && now.spread) this.#hands.pinch(before.spread / now.spread);
    } else if (this.#grip === 'pinch') this.#hands.pinch(factor(now.y - before.y));
    else this.#hands[this.#grip](x, y);
  };

  /** @param {PointerEvent} event */
  #release = ({ pointerId }) => void this.#held.delete(pointerId);

  /** A wheel over the picture scrolls the page, unless one has taken hold of the picture, or pinches. @param {WheelEvent} event */
  #wheel = (event) => {
    const { deltaY, deltaMode, ctrlKey } = event;
    const { activeElement } = /** @type {Document | ShadowRoot} */ (this.#element.getRootNode());
    if (!this.enabled || !this.zooms || (this.#embedded && !ctrlKey && activeElement !== this.#element)) return;
    event.preventDefault();
    const way = deltaY * WHEEL_UNITS[deltaMode];
    this.#hands.begin();
    this.#hands.pinch(factor(ctrlKey ? Math.max(-LARGEST_STEP, Math.min(LARGEST_STEP, PINCH * way)) : way));
  };

  /** The right button moves the picture. @param {Event} event */
  #menu = (event) => this.enabled && event.preventDefault();

  #heard = {
    pointerdown: this.#take, pointermove: this.#move, pointerup: this.#release, pointercancel: this.#release,
    wheel: this.#wheel, contextmenu: this.#menu,
  };

  /** The middle of the pointers, and how far apart they are. */
  get #grasp() {
    const [first, second = first] = this.#held.values();
    return { x: (first.x + second.x) / 2, y: (first.y + second.y) / 2, spread: Math.hypot(first.x - second.x, first.y - second.y) };
  }
}

/** @param {PointerEvent} event @returns {Point} */
function pointOf({ clientX, clientY }) {
  return { x: clientX, y: clientY };
}

/** @param {number} way CSS pixels */
function factor(way) {
  return 0.95 ** (-way / PIXELS_A_STEP);
}
