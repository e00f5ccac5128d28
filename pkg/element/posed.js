/** What a page asks of an element's picture: where the camera is, how large things are, what is at a place, a copy of it. */
import { aim, confine } from './camera.js';
import { Reflecting } from './attributes.js';

/** @import { Viewer } from '../viewer.js' */

/** The element's viewer, once there is one. */
export const VIEWER = Symbol('viewer');

/** What model-viewer calls those who move the camera. */
const MOVERS = /** @type {const} */ ({ pointer: 'user-interaction', keys: 'user-interaction', program: 'none' });

export class Posed extends Reflecting {
  /** @type {Viewer | undefined} */
  [VIEWER];
  /** What lights it. */
  #surroundings = '';

  resetCamera() {
    this[VIEWER]?.home();
  }

  /** The camera has no way to go that it has not gone at once. */
  getCameraOrbit() {
    const { azimuth, polar, distance } = this.#stance;
    const [theta, phi] = [azimuth, polar].map((degrees) => (degrees * Math.PI) / 180);
    return { theta, phi, radius: distance, toString: () => `${theta}rad ${phi}rad ${distance}m` };
  }

  getCameraTarget() {
    return vector(this.#stance.target);
  }

  getFieldOfView() {
    return this.#stance.fieldOfView;
  }

  getDimensions() {
    return vector(this[VIEWER]?.dimensions ?? [0, 0, 0]);
  }

  /** @param {number} x @param {number} y of the viewport, as of a pointer event */
  positionAndNormalFromPoint(x, y) {
    const { left, top } = this.getBoundingClientRect();
    const found = this[VIEWER]?.pick(x - left, y - top);
    return found ? { position: vector(found.position), normal: vector(found.normal) } : null;
  }

  /** @param {string} [type] @param {number} [quality] */
  toDataURL(type, quality) {
    this[VIEWER]?.draw();
    return this.#canvas.toDataURL(type, quality);
  }

  /** @param {string} [type] @param {number} [quality] */
  toBlob(type, quality) {
    this[VIEWER]?.draw();
    return new Promise((/** @type {(blob: Blob | null) => void} */ resolve) => this.#canvas.toBlob(resolve, type, quality));
  }

  async toggleFullscreen() {
    if (document.fullscreenElement === this) await document.exitFullscreen();
    else await this.requestFullscreen();
  }

  /** The camera has moved. @param {keyof typeof MOVERS} by */
  tellMove(by) {
    this.dispatchEvent(new CustomEvent('camera-change', { detail: { source: MOVERS[by] } }));
  }

  /** Of a tileset, other tiles are shown or held. */
  tellStream() {
    this.dispatchEvent(new CustomEvent('stream', { detail: this[VIEWER]?.streamed }));
  }

  /** Brings the camera in line with the attributes. @param {string} [attribute] that has changed; default all */
  pose(attribute) {
    const viewer = this[VIEWER];
    if (!viewer) return;
    if (attribute === undefined || !/^(camera|field)/.test(attribute)) confine(viewer, this);
    if (attribute === undefined || /^(camera|field)/.test(attribute)) aim(viewer, this);
  }

  /** Brings the light in line with the attributes. Where its picture does not load, an `error` says so and the studio stays. */
  async light() {
    const viewer = this[VIEWER];
    if (!viewer) return;
    viewer.exposure = this.exposure;
    viewer.shadow = this.shadowIntensity;
    const address = ['neutral', 'legacy'].includes(this.environmentImage) ? '' : this.environmentImage;
    if (address === this.#surroundings) return;
    this.#surroundings = address;
    viewer.surroundings = 'neutral';
    if (!address) return;
    try {
      const { surroundingsAt } = await import('./surroundings.js');
      const surroundings = await surroundingsAt(address);
      if (address === this.#surroundings) viewer.surroundings = surroundings;
    } catch (error) {
      this.dispatchEvent(new CustomEvent('error', { detail: { src: this.src, error } }));
    }
  }

  get #canvas() {
    return /** @type {HTMLCanvasElement} */ (this.shadowRoot?.querySelector('canvas'));
  }

  get #stance() {
    return this[VIEWER]?.stance ?? { azimuth: 0, polar: 90, distance: 0, target: /** @type {[number, number, number]} */ ([0, 0, 0]), fieldOfView: 0 };
  }
}

/** @param {[number, number, number]} triple */
function vector([x, y, z]) {
  return { x, y, z, toString: () => `${x}m ${y}m ${z}m` };
}
