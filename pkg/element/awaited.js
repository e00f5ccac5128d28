/** Events of an element as a promise. */

/** @import { ErrorDetail, LoadDetail, PointWeaveElement } from '../element.js' */

/** Why no load will come. */
const OVER = ['called', 'removed'];

/** What its next `load` tells, or its next `error`; an abort that nothing follows rejects. @param {HTMLElement} element @returns {Promise<LoadDetail>} */
export function nextLoad(element) {
  const heard = new AbortController();
  const { signal } = heard;
  const loaded = /** @type {PointWeaveElement} */ (element);
  return new Promise((resolve, reject) => {
    loaded.addEventListener('load', ({ detail }) => (heard.abort(), resolve(detail)), { signal });
    loaded.addEventListener('abort', ({ detail: { reason } }) => {
      if (!OVER.includes(reason)) return;
      heard.abort();
      reject(new DOMException(`stopped: ${reason}`, 'AbortError'));
    }, { signal });
    loaded.addEventListener('error', ({ detail }) => (heard.abort(), reject(detail.error)), { signal });
  });
}
