/** The element's part in AR: what that needs is loaded where a page asks for it. */
import { Posed } from './posed.js';

/** What `src` holds, once it is there. */
export const SOURCE = Symbol('source');

export class InRoom extends Posed {
  /** @type {import('./source.js').Glb | import('./source.js').Tileset | import('./source.js').Scan | undefined} */
  [SOURCE];
  /** @type {import('./ar.js').Ar | undefined} */
  #room;

  /** Whether this device can show it in the room. */
  get canActivateAR() {
    return Boolean(this.#room?.mode);
  }

  /** Shows it in the room, where a visitor has just clicked. */
  async activateAR() {
    await this.#room?.open();
  }

  /** Shows the button, or hides it. */
  async offerAr() {
    if (this.ar && !this.#room) {
      const { Ar } = await import('./ar.js');
      this.#room ??= new Ar(this);
    }
    this.#room?.offer();
  }
}
