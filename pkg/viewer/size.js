/** How large a canvas is, in device pixels: it has as many as its place in the page. */

/** @typedef {{ width: number, height: number, ratio: number }} Pixels ratio: device pixels in a CSS pixel */

/** More device pixels than this in a CSS pixel cost much and show nothing. */
const FINEST = 2;

export class Size {
  #canvas;
  #changed;
  #observer = new ResizeObserver(([{ contentRect }]) => this.#tell(contentRect));

  /** @param {HTMLCanvasElement} canvas @param {(size: Pixels) => void} changed */
  constructor(canvas, changed) {
    this.#canvas = canvas;
    this.#changed = changed;
  }

  /** Tells the size now, and when it changes: also when the window goes to a screen of other pixels. */
  follow() {
    const { isConnected, width, height, clientWidth, clientHeight } = this.#canvas;
    if (isConnected) {
      this.#tell({ width: clientWidth, height: clientHeight });
      this.#hold(clientWidth, clientHeight);
    } else this.#changed({ width, height, ratio: 1 });
    try {
      this.#observer.observe(this.#canvas, { box: 'device-pixel-content-box' });
    } catch {
      this.#observer.observe(this.#canvas); // a browser that does not know device pixels
    }
  }

  stop() {
    this.#observer.disconnect();
  }

  /** What is not displayed keeps the size that it had. @param {{ width: number, height: number }} size in CSS pixels */
  #tell({ width, height }) {
    if (!width || !height) return;
    const ratio = Math.min(devicePixelRatio, FINEST);
    const pixels = { width: Math.round(width * ratio), height: Math.round(height * ratio), ratio };
    if (pixels.width !== this.#canvas.width) this.#canvas.width = pixels.width;
    if (pixels.height !== this.#canvas.height) this.#canvas.height = pixels.height;
    this.#changed(pixels);
  }

  /** A canvas without a size in CSS would grow with its pixels. @param {number} width @param {number} height */
  #hold(width, height) {
    if (!width || !height) return;
    const { clientWidth, clientHeight, style } = this.#canvas;
    if (clientWidth !== width) style.width = `${width}px`;
    if (clientHeight !== height) style.height = `${height}px`;
  }
}
