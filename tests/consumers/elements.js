/** A scan and a model that was made of it, each in an element of the page. */
import { createEngine } from 'pointweave';
import { PointWeaveElement } from 'pointweave/element';

/** What the elements say that they show. */
export async function elements({ workerUrl, wasmUrl } = {}) {
  Object.assign(PointWeaveElement, { workerUrl, wasmUrl });
  const engine = await createEngine({ threads: 1, workerUrl, wasmUrl });
  const scan = await engine.sample('duck', { count: 3000, seed: 1 });
  const files = [await engine.write(scan), await engine.write(await engine.reconstruct(scan), { format: 'glb' })];
  await engine.dispose();
  return Promise.all(files.map(shown));
}

/** Puts an element for a file into the page. @param {Uint8Array} file */
function shown(file) {
  const element = document.createElement('point-weave');
  element.alt = 'A toy duck';
  element.src = URL.createObjectURL(new Blob([file]));
  document.body.append(element);
  return new Promise((resolve, reject) => {
    element.addEventListener('load', ({ detail: { kind, triangles } }) => resolve({ kind, triangles }));
    element.addEventListener('error', ({ detail: { error } }) => reject(error));
  });
}
