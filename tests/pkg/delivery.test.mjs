// Where the files lie and what a page forbids: other origins, security policies, servers.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import test from 'node:test';
import { promisify } from 'node:util';
import { ISOLATED, OPEN, newPage, serve } from './browser.mjs';
import { engineBeside } from './installed.mjs';

/** A page whose import map takes the package from another origin, and that origin. */
async function pageFromCdn(t, { headers = {}, routes = (_cdn) => ({}) } = {}) {
  const cdn = (await serve(t, { ...OPEN, ...ISOLATED }, {})).replace('localhost', '127.0.0.1');
  const html = `<!doctype html><title>test</title><link rel="icon" href="data:,">
    <script type="importmap" nonce="map">{ "imports": { "pointweave": "${cdn}pointweave/index.js" } }</script>`;
  const given = typeof headers === 'function' ? headers(cdn) : headers;
  const page = await newPage(t);
  await page.goto(await serve(t, given, { '/': () => html, ...routes(cdn) }));
  return { page, cdn };
}

/** In a page: what reduces a small cloud, or the error. Stands alone. */
async function reduceIn(options) {
  const { createEngine } = await import('pointweave');
  try {
    const engine = await createEngine(options);
    const { report } = await engine.reduce({ positions: Float32Array.from({ length: 3000 }, (_, i) => Math.sin(i * i)) });
    await engine.dispose();
    return [report.build, report.outputPoints];
  } catch ({ code, message }) {
    return [code, message];
  }
}

test('everything can come from a CDN', async (t) => {
  const { page } = await pageFromCdn(t, { headers: ISOLATED });
  assert.deepEqual(await page.evaluate(reduceIn, { threads: 2 }), ['threads', 333]);
  assert.deepEqual(await page.evaluate(reduceIn, { threads: 1 }), ['single', 333]);
});

test('under a strict policy, a line of the page’s own starts the worker of a CDN', async (t) => {
  const { page } = await pageFromCdn(t, {
    headers: (cdn) => ({
      ...ISOLATED,
      'Content-Security-Policy': `default-src 'none'; script-src 'self' ${cdn} 'wasm-unsafe-eval' 'nonce-map'; worker-src 'self' ${cdn}; connect-src ${cdn}; img-src data:`,
    }),
    routes: (cdn) => ({ '/my-worker.js': () => `import '${cdn}pointweave/worker.js';` }),
  });
  for (const threads of [1, 2]) assert.deepEqual(await page.evaluate(reduceIn, { threads, workerUrl: 'my-worker.js' }), [threads === 1 ? 'single' : 'threads', 333]);
  const [code, message] = await page.evaluate(reduceIn, { threads: 1 });
  assert.equal(code, 'load-failed');
  assert.match(message, /the worker did not start/);
});

test('a worker that is not there is an error of its own', async (t) => {
  const { page } = await pageFromCdn(t);
  for (const workerUrl of ['nowhere.js', 'http://127.0.0.1:1/nowhere.js']) {
    assert.equal((await page.evaluate(reduceIn, { threads: 1, workerUrl }))[0], 'load-failed');
  }
});

/** In a fresh process: imports all entries where every global of a browser, and Node's own, throws when it is touched. */
const IMPORT_ON_SERVER = `
  const touched = [];
  for (const name of ['window', 'self', 'document', 'navigator', 'location', 'Worker', 'fetch', 'Blob', 'crossOriginIsolated', 'customElements', 'HTMLElement']) {
    Object.defineProperty(globalThis, name, { configurable: true, get() { touched.push(name); return undefined; } });
  }
  for (const entry of process.argv.slice(1)) await import(entry);
  console.log(JSON.stringify(touched));`;

test('importing touches no global of a browser', async () => {
  const entries = ['index.js', 'direct.js', 'index.node.js', 'direct.node.js'].map((name) => new URL(`../../pkg/${name}`, import.meta.url).href);
  const { stdout } = await promisify(execFile)(process.execPath, ['--input-type=module', '--eval', IMPORT_ON_SERVER, ...entries]);
  assert.deepEqual(JSON.parse(stdout), []);
});

test('the viewer is imported on a server, where three.js is beside it', async (t) => {
  const { home } = await engineBeside(t, ['three']);
  const before = Object.keys(globalThis);
  const viewer = await import(`${home}viewer.js`);
  assert.deepEqual(Object.keys(globalThis), before);
  assert.deepEqual(Object.keys(viewer).sort(), ['PAINTS', 'PAINT_WORDS', 'canPaint', 'colorAt', 'createViewer', 'cssGradient', 'frameOf', 'paintOf', 'readGlb']);
  assert.ok(viewer.canPaint('density', { cloud: { positions: new Float32Array(3) } }));
});
