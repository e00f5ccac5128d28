/** @import { Scan } from '../session/session.js' */
/** @import { From } from './shown.js' */

/** Where a scan comes from, as it is kept. @returns {From} */
export function fromOf(/** @type {Scan} */ { model, src, key, columns, parts }) {
  return model ? { model } : src ? { src } : { key: key ?? '', ...(columns && { columns }), ...(parts && { parts }) };
}

/** Whether two parts of a value are the same. */
export function same(/** @type {unknown} */ one, /** @type {unknown} */ other) {
  return JSON.stringify(one) === JSON.stringify(other);
}
