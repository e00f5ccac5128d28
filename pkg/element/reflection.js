/** How a property reads and writes its attribute: what is not valid counts as not given; null and undefined take it away. */

/** @param {HTMLElement} element @param {string} name @param {unknown} value */
export function write(element, name, value) {
  if (value === null || value === undefined) element.removeAttribute(name);
  else element.setAttribute(name, String(value));
}

/** @param {HTMLElement} element @param {string} name @param {(value: number) => boolean} valid */
export function readNumber(element, name, valid) {
  const text = element.getAttribute(name)?.trim();
  const value = text ? Number(text) : NaN;
  return valid(value) ? value : null;
}

/**
 * In any case of letters, as HTML's own.
 * @template {string} Choice
 * @param {HTMLElement} element
 * @param {string} name
 * @param {readonly Choice[]} choices the first is what is meant by none, and by a wrong one
 */
export function readChoice(element, name, choices) {
  const text = element.getAttribute(name)?.trim().toLowerCase();
  return choices.find((choice) => choice === text) ?? choices[0];
}
