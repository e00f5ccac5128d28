/** What assistive technology is told of the picture. */

/**
 * Without controls it is an image, with them something to handle.
 * @param {HTMLElement} canvas
 * @param {HTMLElement & { alt: string, controls: boolean }} element
 * @param {string} untitled
 */
export function describe(canvas, element, untitled) {
  const { alt, controls } = element;
  const decorative = element.hasAttribute('alt') && !alt && !controls;
  canvas.setAttribute('role', controls ? 'application' : 'img');
  canvas.setAttribute('aria-label', alt || untitled);
  setOrRemove(canvas, 'tabindex', controls && '0');
  setOrRemove(canvas, 'aria-describedby', controls && 'keys');
  setOrRemove(canvas, 'aria-hidden', decorative && 'true');
}

/** @param {HTMLElement} element @param {string} name @param {string | false} value */
export function setOrRemove(element, name, value) {
  if (value) element.setAttribute(name, value);
  else element.removeAttribute(name);
}
