/**
 * The element with this id, of the class that the caller relies on.
 * @template {HTMLElement} T
 * @param {string} id
 * @param {new () => T} kind
 * @returns {T}
 */
export function byId(id, kind) {
  const element = document.getElementById(id);
  if (!(element instanceof kind)) throw new Error(`the page has no ${kind.name} with id ${id}`);
  return element;
}

/** Tells a screen reader, without moving the focus. */
export function announce(/** @type {string} */ text) {
  byId('live', HTMLElement).textContent = text;
}
