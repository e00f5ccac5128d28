/** Hotspots: what stands in slots `hotspot-…` is kept at a place of the model, by `data-position` and `data-normal`. */
import { placeOf } from './camera.js';

/** @import { Viewer } from '../viewer.js' */
/** @typedef {[number, number, number]} Place */

const SLOT = /^hotspot-?/;

export class Hotspots {
  #host;
  #layer;
  /** Each slot, and what holds it. @type {Map<string, HTMLElement>} */
  #holders = new Map();
  /** What is in them, and where it belongs. @type {{ child: HTMLElement, holder: HTMLElement, place: Place | null, normal?: Place }[]} */
  #spots = [];
  #observer = new MutationObserver(() => this.#gather());
  /** @type {Viewer | undefined} */
  #viewer;

  /** @param {HTMLElement} host the element @param {HTMLElement} layer over the picture */
  constructor(host, layer) {
    this.#host = host;
    this.#layer = layer;
  }

  /** @param {Viewer} viewer that they lie over */
  follow(viewer) {
    this.#viewer = viewer;
    viewer.addEventListener('draw', () => this.#place());
    this.#observer.observe(this.#host, { childList: true, subtree: true, attributeFilter: ['slot', 'data-position', 'data-normal'] });
    this.#gather();
  }

  #gather() {
    const names = [...this.#host.children].map(({ slot }) => slot).filter((name) => SLOT.test(name));
    for (const [name, holder] of this.#holders) {
      if (names.includes(name)) continue;
      holder.remove();
      this.#holders.delete(name);
    }
    for (const name of names) if (!this.#holders.has(name)) this.#hold(name);
    this.#spots = [];
    for (const child of /** @type {Iterable<HTMLElement>} */ (this.#host.children)) {
      const holder = this.#holders.get(child.slot);
      const { position, normal } = child.dataset;
      if (holder) this.#spots.push({ child, holder, place: placeOf(position), normal: placeOf(normal) ?? undefined });
    }
    this.#place();
  }

  /** @param {string} name */
  #hold(name) {
    const holder = document.createElement('div');
    holder.className = 'hotspot';
    const slot = document.createElement('slot');
    slot.name = name;
    holder.append(slot);
    this.#layer.append(holder);
    this.#holders.set(name, holder);
  }

  #place() {
    if (!this.#viewer || this.#spots.length === 0) return;
    const shown = this.#viewer.layers.length > 0;
    for (const { child, holder, place, normal } of this.#spots) {
      holder.hidden = !place || !shown;
      if (!place || !shown) continue;
      const { x, y, visible } = this.#viewer.project(place, normal);
      const { visibilityAttribute } = child.dataset;
      holder.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
      holder.classList.toggle('behind', !visible);
      if (visibilityAttribute) child.toggleAttribute(`data-${visibilityAttribute}`, visible);
    }
  }
}
