// GLB files as a viewer shows them: three.js in Chromium.

import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join, relative } from 'node:path';
import test from 'node:test';
import { fileURLToPath } from 'node:url';
import { openPage } from './browser.mjs';
import { PEERS, engineBeside } from './installed.mjs';

const MODULES = fileURLToPath(new URL('../node_modules', import.meta.url));
/** Where pictures are kept for people to look at, when this is set. */
const PICTURES = process.env.POINTWEAVE_PICTURES;
const SIZE = 256;
/** Where the page finds these packages. */
const IMPORTS = Object.fromEntries(
  ['three', 'property-graph', 'ktx-parse', ...PEERS].map((name) => [name, `/modules/${relative(MODULES, fileURLToPath(import.meta.resolve(name)))}`]),
);
const HTML = `<!doctype html><script type="importmap">${JSON.stringify({ imports: { ...IMPORTS, 'addons/': '/modules/three/examples/jsm/' } })}</script>
  <style>body { margin: 0 }</style><canvas width="${SIZE}" height="${SIZE}"></canvas>`;

/** In the page: the pixels of a file, seen from a corner of its bounding box. */
async function draw(url) {
  const THREE = await import('three');
  const { GLTFLoader } = await import('addons/loaders/GLTFLoader.js');
  const { MeshoptDecoder } = await import('addons/libs/meshopt_decoder.module.js');
  const { scene: model } = await new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).loadAsync(url);
  const canvas = document.querySelector('canvas');
  const renderer = new THREE.WebGLRenderer({ canvas, preserveDrawingBuffer: true });
  const scene = new THREE.Scene().add(model, new THREE.HemisphereLight(0xffffff, 0x888888, 3));
  model.traverse((object) => object.isPoints && (object.material.size = 4, object.material.sizeAttenuation = false));
  const box = new THREE.Box3().setFromObject(model);
  const [middle, size] = [box.getCenter(new THREE.Vector3()), box.getSize(new THREE.Vector3()).length()];
  const camera = new THREE.PerspectiveCamera(40, 1, size / 10, 10 * size);
  camera.position.copy(middle).add(new THREE.Vector3(0.8, 0.5, 1).multiplyScalar(size));
  camera.lookAt(middle);
  renderer.render(scene, camera);
  const pixels = new Uint8Array(4 * canvas.width * canvas.height);
  renderer.getContext().readPixels(0, 0, canvas.width, canvas.height, renderer.getContext().RGBA, renderer.getContext().UNSIGNED_BYTE, pixels);
  renderer.dispose();
  return [...pixels];
}

test('a mesh, plain, quantised and compressed, and its points look the same', async (t) => {
  const { engine } = await engineBeside(t, PEERS);
  const cloud = await engine.sample('duck', { count: 20_000, seed: 3 });
  const mesh = await engine.reconstruct(cloud);
  const light = await engine.reduce({ positions: mesh.cloud.positions, colors: mesh.cloud.colors }, { target: { ratio: 1 } });
  const files = {
    mesh: await engine.write({ ...mesh, origin: [1000, -20, 0.5] }, { format: 'glb' }),
    quantized: await engine.write(mesh, { format: 'glb', quantize: true }),
    compressed: await engine.write(mesh, { format: 'glb', quantize: true, meshopt: true }),
    points: await engine.write(light, { format: 'glb' }),
  };

  const page = await openPage(t);
  const address = page.url();
  await page.route('**/modules/**', (route) => route.fulfill({ path: join(MODULES, new URL(route.request().url()).pathname.slice('/modules'.length)) }));
  await page.route('**/view.html', (route) => route.fulfill({ contentType: 'text/html', body: HTML }));
  await page.route('**/*.glb', (route) => {
    const [, name] = route.request().url().match(/(\w+)\.glb$/);
    return route.fulfill({ contentType: 'model/gltf-binary', body: Buffer.from(files[name]) });
  });
  await page.goto(`${address}view.html`);
  const pictures = {};
  for (const name of Object.keys(files)) {
    pictures[name] = await page.evaluate(draw, `/${name}.glb`);
    if (PICTURES) writeFileSync(join(PICTURES, `${name}.png`), await page.locator('canvas').screenshot());
  }

  const covered = (pixels) => Array.from({ length: SIZE * SIZE }, (_, i) => pixels[4 * i] + pixels[4 * i + 1] + pixels[4 * i + 2] > 0);
  const silhouette = covered(pictures.mesh);
  const share = silhouette.filter(Boolean).length / silhouette.length;
  assert.ok(share > 0.15 && share < 0.6, `the duck covers ${share} of the picture`);
  const yellow = silhouette.filter((on, i) => on && pictures.mesh[4 * i] > 150 && pictures.mesh[4 * i + 1] > 100 && pictures.mesh[4 * i + 2] < 110);
  assert.ok(yellow.length > 0.5 * share * SIZE * SIZE, `${yellow.length} yellow pixels`);
  for (const [name, most] of [['quantized', 0.01], ['compressed', 0.01], ['points', 0.15]]) {
    const other = covered(pictures[name]).filter((on, i) => on !== silhouette[i]).length;
    assert.ok(other <= most * share * SIZE * SIZE, `${name}: ${other} pixels of the silhouette differ`);
  }

  const length = await page.evaluate(async (bytes) => {
    const { read, write } = await import('/pointweave/index.js');
    return (await write(await read(Uint8Array.from(bytes)), { format: 'glb', quantize: true, meshopt: true })).length;
  }, [...await engine.write(light)]);
  const here = await engine.write(await engine.read(await engine.write(light)), { format: 'glb', quantize: true, meshopt: true });
  assert.equal(length, here.length, 'compressed in the page, with the packages of its import map');
});
