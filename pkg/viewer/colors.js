/** The layers' colours, as the style sheet says them, whatever way they are written: names, oklch(), light-dark() … */

/** Red, green and blue of sRGB, 0 to 1. @typedef {[number, number, number]} Rgb */
/** @typedef {{ mesh: Rgb, points: Rgb, reduced: Rgb }} Colors */

/** @type {CanvasRenderingContext2D | undefined} */
let pixel;

/** Of the canvas, which carries them as colours that it has no use for itself (sheet.js). @param {HTMLCanvasElement} canvas @returns {Colors} */
export function layerColors(canvas) {
  const { color, caretColor, columnRuleColor } = getComputedStyle(canvas);
  return { mesh: rgb(color), points: rgb(caretColor), reduced: rgb(columnRuleColor) };
}

/** Paints one pixel and looks at it. @param {string} color @returns {Rgb} */
function rgb(color) {
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
