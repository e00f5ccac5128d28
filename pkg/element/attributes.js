/** The element's own attributes as properties, as HTML does it: a property reads what its attribute says and writes it there. */

import { SWITCHED, Switching, propertyOf } from './switching.js';

export class Reflecting extends Switching {
  static observedAttributes = [...SWITCHED, 'controls', 'camera-controls'];

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
