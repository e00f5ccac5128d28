/** A scan and a model that was made of it, each in an element of the page, and its mesh on a canvas. */
import { createEngine } from 'pointweave';
import { PointWeaveElement } from 'pointweave/element';
import { createViewer } from 'pointweave/viewer';

/** What the elements and the viewer say that they show. */
export async function elements({ workerUrl, wasmUrl } = {}) {
  Object.assign(PointWeaveElement, { workerUrl, wasmUrl });
  const engine = await createEngine({ threads: 1, workerUrl, wasmUrl });
  const scan = await engine.sample('duck', { count: 3000, seed: 1 });
  const mesh = await engine.reconstruct(scan, { reduce: { target: 'auto' } }); // as the element does by itself
  const files = [await engine.write(scan), await engine.write(mesh, { format: 'glb' })];
  await engine.dispose();
  return { shown: await Promise.all(files.map(shown)), viewed: viewed(mesh) };
}

/** Puts a canvas with a mesh into the page. @param {import('pointweave').SurfaceMesh} mesh */
function viewed(mesh) {
  const canvas = Object.assign(document.createElement('canvas'), { id: 'viewer', width: 400, height: 300 });
  document.body.append(canvas);
  const viewer = createViewer(canvas);
  viewer.show(mesh);
  return viewer.size('mesh').triangles;
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
