/**
 * The colours of the drawn layers come from the style sheet, so that light and dark are decided in one place.
 * @typedef {{ points: string, reduced: string, mesh: string, edges: string, boxes: string, background: string }} Theme
 */

/** Calls back with the colours now, and again whenever the device changes between light and dark. */
export function followTheme(/** @type {(theme: Theme) => void} */ apply) {
  const read = () => {
    const style = getComputedStyle(document.documentElement);
    const color = (/** @type {string} */ name) => style.getPropertyValue(`--layer-${name}`).trim();
    apply({
      points: color('points'), reduced: color('reduced'), mesh: color('mesh'),
      edges: color('edges'), boxes: color('boxes'), background: color('background'),
    });
  };
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', read);
  read();
}
