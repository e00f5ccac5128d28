/** What went wrong before the engine had anything to do; the codes are in error-messages.js with the engine's. */
class FetchError extends Error {
  constructor(/** @type {string} */ code, /** @type {string} */ message) {
    super(message);
    this.code = code;
  }
}

/** The address of a scan beside this page. Others are refused: the page talks to no other server. */
export function ownAddress(/** @type {string} */ src) {
  const url = parse(src);
  if (!url) throw new FetchError('bad-address', `'${src}' is not an address`);
  if (url.origin !== location.origin) throw new FetchError('other-server', `${url.origin} is not ${location.origin}`);
  return url;
}

function parse(/** @type {string} */ src) {
  try {
    return new URL(src, document.baseURI);
  } catch {
    return null;
  }
}

/**
 * The bytes at an address.
 * @param {URL} url
 * @param {AbortSignal} signal
 * @param {(share: number) => void} progress  where the server says how many there are
 */
export async function fetchBytes(url, signal, progress) {
  const response = await fetch(url, { signal }).catch((error) => {
    signal.throwIfAborted();
    throw new FetchError('not-found', `${url.pathname}: ${error.message}`);
  });
  if (!response.ok || !response.body) throw new FetchError('not-found', `${url.pathname}: the server says ${response.status}`);
  const size = Number(response.headers.get('Content-Length'));
  const chunks = [];
  let loaded = 0;
  for (const reader = response.body.getReader(); ;) {
    const { done, value } = await reader.read();
    if (done) return new Blob(chunks);
    chunks.push(value);
    loaded += value.length;
    if (size) progress(Math.min(1, loaded / size));
  }
}
