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

/**
 * A new element with these properties.
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {Partial<HTMLElementTagNameMap[Tag]>} [properties]
 * @returns {HTMLElementTagNameMap[Tag]}
 */
export function element(tag, properties = {}) {
  return Object.assign(document.createElement(tag), properties);
}

/** A radio button, by its group and value. @param {string} name @param {string} value */
export function radio(name, value) {
  return /** @type {HTMLInputElement} */ (document.querySelector(`input[name="${name}"][value="${value}"]`));
}

/** Tells a screen reader, without moving the focus. */
export function announce(/** @type {string} */ text) {
  byId('live', HTMLElement).textContent = text;
}
