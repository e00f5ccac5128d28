/** @import { LayerColors } from 'pointweave/viewer' */

/**
 * Calls back with the colours of the drawn layers now, and again whenever the device changes between light and dark. They come from
 * the style sheet, so that light and dark are decided in one place.
 */
export function followTheme(/** @type {(colors: LayerColors) => void} */ apply) {
  const read = () => {
    const style = getComputedStyle(document.documentElement);
    const color = (/** @type {string} */ name) => style.getPropertyValue(`--layer-${name}`).trim();
    apply({
      points: color('points'), reduced: color('reduced'), mesh: color('mesh'),
      edges: color('edges'), boxes: color('boxes'),
    });
  };
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', read);
  read();
}
