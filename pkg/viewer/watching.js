/** What all viewers of a page watch together: who is in the viewport, and whether motion is wanted. */

/** @typedef {(seen: boolean) => void} Hear */

/** One observer for many elements. */
export class Watch {
  /** @type {WeakMap<Element, Hear>} */
  #heard = new WeakMap();
  #observer;

  /** @param {IntersectionObserverInit} [options] */
  constructor(options) {
    this.#observer = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) this.#heard.get(target)?.(isIntersecting);
    }, options);
  }

  /** @param {Element} element @param {Hear} hear */
  add(element, hear) {
    this.#heard.set(element, hear);
    this.#observer.observe(element);
  }

  /** @param {Element} element */
  delete(element) {
    this.#heard.delete(element);
    this.#observer.unobserve(element);
  }
}

/** @type {Watch | undefined} */
let seen;

/** Who is in the viewport. */
export function inSight() {
  return (seen ??= new Watch());
}

/**
 * Whether the person has asked for less motion. The browser is asked once and then listened to: one that is asked in every
 * frame has been seen to swallow the event.
 */
class Calm extends EventTarget {
  #query = matchMedia('(prefers-reduced-motion: reduce)');
  wanted = this.#query.matches;

  constructor() {
    super();
    this.#query.addEventListener('change', ({ matches }) => {
      this.wanted = matches;
      this.dispatchEvent(new Event('change'));
    });
  }
}

/** @type {Calm | undefined} */
let shared;

export function calm() {
  return (shared ??= new Calm());
}
