/** Colours as style sheets write them: names, `#rgb`, `oklch()`, `light-dark()` and all else that the browser knows. */

/** @import { LayerColors } from '../viewer.js' */

/** Red, green and blue of sRGB, 0 to 1. @typedef {[number, number, number]} Rgb */

/** For layers without colours of their own, on light and on dark backgrounds. @type {LayerColors} */
export const COLORS = { points: '#5d7f93', reduced: '#0f8c84', mesh: '#f1e7d8', edges: '#14303a', boxes: '#b07d1e' };

/** @type {CanvasRenderingContext2D | undefined} */
let pixel;

/** Paints one pixel and looks at it. @param {string} color @returns {Rgb} */
export function rgb(color) {
  if (!pixel) {
    const canvas = document.createElement('canvas');
    canvas.width = canvas.height = 1;
    pixel = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d', { willReadFrequently: true }));
  }
  pixel.fillStyle = color;
  pixel.fillRect(0, 0, 1, 1);
  const [red, green, blue] = pixel.getImageData(0, 0, 1, 1).data;
  return [red / 255, green / 255, blue / 255];
}
