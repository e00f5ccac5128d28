/** A pointer that moves farther than this, in CSS pixels, turns the picture and means nothing. */
const STILL = 4;

/** Clicks on the picture that are no drags, and Enter, which means its middle. */
export class Still {
  #on = false;
  #canvas;

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {(x: number, y: number) => void} clicked  CSS pixels from the canvas' top left
   * @param {() => { left: number, right: number }} [insets] beside the middle of the picture
   */
  constructor(canvas, clicked, insets = () => ({ left: 0, right: 0 })) {
    this.#canvas = canvas;
    let down = { x: 0, y: 0 };
    canvas.addEventListener('pointerdown', ({ clientX, clientY }) => (down = { x: clientX, y: clientY }));
    canvas.addEventListener('click', ({ clientX, clientY }) => {
      if (!this.#on || Math.hypot(clientX - down.x, clientY - down.y) > STILL) return;
      const { left, top } = canvas.getBoundingClientRect();
      clicked(clientX - left, clientY - top);
    });
    canvas.addEventListener('keydown', (event) => {
      if (!this.#on || event.key !== 'Enter') return;
      event.preventDefault();
      const { left, right } = insets();
      clicked((canvas.clientWidth + left - right) / 2, canvas.clientHeight / 2);
    });
  }

  /** Listens, or no longer. */
  listen(/** @type {boolean} */ on) {
    this.#on = on;
    this.#canvas.classList.toggle('choosing', on);
  }
}
