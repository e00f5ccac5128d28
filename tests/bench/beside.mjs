// `node tests/bench/beside.mjs FOLDER`: a catalogue of 30 GLBs, each in <point-weave> and in <model-viewer> beside it, as a picture in FOLDER to look
// at, and how far their colours are apart. It needs pkg/element.min.js, Chromium, and the packages of tests/consumers (MODEL_VIEWER names another
// folder with node_modules).

import { mkdir, readFile, writeFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname, join, normalize, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';
import { createEngine } from 'pointweave';
import { decodePng } from '../page/pictures.mjs';

const ROOT = fileURLToPath(new URL('../../', import.meta.url));
const PACKAGES = process.env.MODEL_VIEWER ?? join(ROOT, 'tests/consumers');
const OUT = resolve(process.argv[2] ?? '.');
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm', '.glb': 'model/gltf-binary' };
const SIZE = 200;

/** Ten each of three things: from coarse to fine, with and without colours, in colours of other kinds. */
async function models() {
  const engine = await createEngine();
  const all = [];
  for (const name of ['duck', 'pig', 'part']) {
    for (let k = 0; k < 10; k++) {
      const cloud = await engine.sample(name, { count: 3000 + 900 * k, seed: k });
      const tinted = cloud.colors?.map((x, i) => (k % 3 === 1 ? 255 - x : k % 3 === 2 ? (x + 120 * (i % 3)) % 256 : x));
      const mesh = await engine.reconstruct({ ...cloud, colors: k % 5 === 4 ? undefined : tinted }, { reduce: { target: { count: 1200 + 150 * k } } });
      all.push([`${name}-${k}.glb`, await engine.write(mesh, { format: 'glb' })]);
    }
  }
  await engine.dispose();
  return all;
}

const files = new Map(await models());
const cells = [...files.keys()].map((name) => `
  <figure><point-weave src="/${name}" alt="${name}" camera-orbit="30deg 75deg 105%"></point-weave><model-viewer src="/${name}" camera-orbit="30deg 75deg 105%"
    interaction-prompt="none" shadow-intensity="0"></model-viewer></figure>`);
const page = `<!doctype html><title>Beside</title>
<style>body { margin: 0; display: grid; grid-template-columns: repeat(5, ${2 * SIZE}px); background: #fff } figure { margin: 0; display: flex }
point-weave, model-viewer { display: block; width: ${SIZE}px; height: ${SIZE}px; background: #fff; --poster-color: #fff }</style>
<script type="module" src="/pkg/element.min.js"></script>
<script type="module" src="/packages/node_modules/@google/model-viewer/dist/model-viewer.min.js"></script>${cells.join('')}`;

const server = createServer(async ({ url = '/' }, response) => {
  const path = normalize(decodeURIComponent(new URL(url, 'http://localhost').pathname));
  const file = path.startsWith('/packages/') ? join(PACKAGES, path.slice('/packages/'.length)) : join(ROOT, path);
  const body = path === '/' ? page : files.get(path.slice(1)) ?? await readFile(file).catch(() => null);
  response.setHeader('Content-Type', path === '/' ? 'text/html' : TYPES[extname(path)] ?? 'application/octet-stream');
  response.writeHead(body ? 200 : 404).end(body ?? '');
});
await new Promise((ready) => server.listen(0, () => ready()));
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--headless=new', '--no-sandbox', '--disable-gpu', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-dev-shm-usage'],
});
const tab = await browser.newPage({ viewport: { width: 10 * SIZE, height: 6 * SIZE } });
await tab.goto(`http://localhost:${server.address().port}/`);
await tab.waitForFunction(() => [...document.querySelectorAll('model-viewer')].every((one) => one.loaded)
  && [...document.querySelectorAll('point-weave')].every((one) => one.shadowRoot?.querySelector('canvas')), null, { timeout: 300_000 });
await tab.evaluate(() => Promise.all([...document.querySelectorAll('point-weave')].map((one) => one.loaded)));
await tab.waitForTimeout(4000); // both fade in
const png = await tab.screenshot({ animations: 'disabled' });
await browser.close();
server.close();
await mkdir(OUT, { recursive: true });
await writeFile(join(OUT, 'beside.png'), png);

const { width, channels, data } = decodePng(png);
/** Mean colour of what is not white in a square of the picture, and how much of it that is. */
function seen(left, top) {
  const sum = [0, 0, 0];
  let count = 0;
  for (let y = top; y < top + SIZE; y++) {
    for (let x = left; x < left + SIZE; x++) {
      const at = channels * (y * width + x);
      if (Math.min(data[at], data[at + 1], data[at + 2]) > 250) continue;
      for (let k = 0; k < 3; k++) sum[k] += data[at + k];
      count++;
    }
  }
  return { color: sum.map((x) => x / count), share: count / SIZE ** 2 };
}
const rows = [...files.keys()].map((name, i) => {
  const [left, top] = [2 * SIZE * (i % 5), SIZE * Math.floor(i / 5)];
  const [ours, theirs] = [seen(left, top), seen(left + SIZE, top)];
  return { name, color: Math.max(...ours.color.map((x, k) => Math.abs(x - theirs.color[k]))), size: ours.share / theirs.share };
});
for (const { name, color, size } of rows) console.log(`${name.padEnd(12)} colours differ by ${color.toFixed(1)} of 255, area ${size.toFixed(3)} of theirs`);
const sorted = rows.map(({ color }) => color).sort((a, b) => a - b);
console.log(`colours: median ${sorted[15].toFixed(1)}, most ${sorted.at(-1).toFixed(1)}`);
