/**
 * `<point-weave>`: a raw scan or a finished model in a page, by one tag. Importing this defines it; on a server nothing happens.
 * What is heavy (three.js, the engine) is loaded when the first element nears the viewport.
 */
import { PointWeaveElement } from './element/element.js';

if (globalThis.customElements && !customElements.get('point-weave')) customElements.define('point-weave', PointWeaveElement);

export { PointWeaveElement };
