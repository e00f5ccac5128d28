import { setConsoleFunction } from 'three';
import { page } from '../page.js';

/** What three.js says of it; the page says it better. */
const SAID = /Context (Lost|Restored)/;

/**
 * Says so when the browser takes the graphics away, as it does when a device sleeps or has too much to do, until they are back. The
 * picture then comes back by itself; a reload, which keeps everything, helps where it does not.
 * @param {import('pointweave/viewer').Viewer} viewer
 */
export function tellWhenLost(viewer) {
  const note = page.graphicsLost;
  viewer.addEventListener('contextlost', () => (note.hidden = false));
  viewer.addEventListener('contextrestored', () => (note.hidden = true));
  page.graphicsReload.addEventListener('click', () => location.reload());
  setConsoleFunction((/** @type {'log' | 'warn' | 'error'} */ type, /** @type {unknown} */ message, /** @type {unknown[]} */ ...rest) => {
    if (!SAID.test(String(message))) console[type](message, ...rest);
  });
}
