/** Events of an element as a promise. */

/** @import { ErrorDetail, LoadDetail, PointWeaveElement } from '../element.js' */

/** What its next `load` tells, or its next `error`. @param {HTMLElement} element @returns {Promise<LoadDetail>} */
export function nextLoad(element) {
  const heard = new AbortController();
  const { signal } = heard;
  const loaded = /** @type {PointWeaveElement} */ (element);
  return new Promise((resolve, reject) => {
    loaded.addEventListener('load', ({ detail }) => (heard.abort(), resolve(detail)), { signal });
    loaded.addEventListener('error', ({ detail }) => (heard.abort(), reject(detail.error)), { signal });
  });
}
