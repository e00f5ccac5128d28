/** @type {Worker | undefined} */
let worker;
let last = 0;

/** What a compressed GLB asks of who reads it. */
export const COMPRESSED = 'EXT_meshopt_compression';

/** Compresses a GLB by `EXT_meshopt_compression`. @param {Uint8Array} glb */
export function compressAside(glb) {
  return inWorker(glb, 'small');
}

/** The same, with pictures as WebP, or JPEG where the browser writes no WebP. @param {Uint8Array} glb */
export function webAside(glb) {
  return inWorker(glb, 'web');
}

/** A GLB without that compression. @param {Uint8Array} glb */
export function expandAside(glb) {
  return inWorker(glb, 'plain');
}

/**
 * Keeps the page free. The program is fetched at the first call.
 * @param {Uint8Array} glb
 * @param {'small' | 'web' | 'plain'} to
 * @returns {Promise<Uint8Array>}
 */
function inWorker(glb, to) {
  worker ??= new Worker(new URL('./compress-worker.js', import.meta.url), { type: 'module' });
  const asked = worker;
  const id = ++last;
  return new Promise((resolve, reject) => {
    const done = new AbortController();
    asked.addEventListener('message', ({ data }) => {
      if (data.id !== id) return;
      done.abort();
      if (data.made) resolve(data.made);
      else reject(new Error(data.message));
    }, { signal: done.signal });
    asked.addEventListener('error', (event) => {
      done.abort();
      worker = undefined;
      reject(new Error(event.message || 'the compressor could not be loaded'));
    }, { signal: done.signal });
    asked.postMessage({ id, glb, to });
  });
}
