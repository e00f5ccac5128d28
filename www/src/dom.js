import { page } from './page.js';

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
  page.live.textContent = text;
}
