/** What all elements of a page watch together: who is near the viewport, who is in it, and whether motion is wanted. */

/** Near: at most one viewport away. */
const NEAR = { rootMargin: '100%', scrollMargin: '100%' };

/** @typedef {(seen: boolean) => void} Hear */

/** One observer for many elements. */
class Watch {
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

/** @type {{ near: Watch, seen: Watch } | undefined} */
let watches;

export function viewport() {
  return (watches ??= { near: new Watch(NEAR), seen: new Watch() });
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
