/**
 * The page's texts are in English where they stand, in `index.html` and in the code. A table says them in another language, by the
 * English text. Which one is the browser's choice.
 */

/** @type {Record<string, () => Promise<{ default: Record<string, string> }>>} */
const TABLES = { de: () => import('./de.js'), fr: () => import('./fr.js') };

/** The first of the person's languages that there is; numbers are written as there. */
const language = (globalThis.navigator?.languages ?? []).map((tag) => tag.split('-')[0]).find((tag) => tag === 'en' || tag in TABLES) ?? 'en';

/** @type {Record<string, string>} */
const table = language in TABLES ? (await TABLES[language]()).default : {};

export const words = { language, table };

/**
 * A text of the page in the person's language, with values in the places of `{name}`.
 * @param {string} text
 * @param {Record<string, string | number>} [values]
 */
export function say(text, values = {}) {
  return (table[text] ?? text).replace(/\{(\w+)\}/g, (place, name) => String(values[name] ?? place));
}
