// A bare page that imports the package from a static server, in headless Chromium.

import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname } from 'node:path';
import { chromium } from 'playwright-core';

const PACKAGE = new URL('../../pkg/', import.meta.url);
const CHROMIUM = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];
const FLAGS = [
  '--headless=new', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--disable-dev-shm-usage',
];
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm' };

/** As a person would write it: an import map and no bundler. */
const HTML = `<!doctype html><title>test</title><link rel="icon" href="data:,">
<script type="importmap" nonce="map">{ "imports": { "pointweave": "/pointweave/index.js" } }</script>`;

const ISOLATED = { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' };
const STRICT = {
  'Content-Security-Policy': "default-src 'none'; script-src 'self' 'wasm-unsafe-eval' 'nonce-map'; worker-src 'self'; connect-src 'self'; img-src data:",
};

/**
 * A page with `pointweave` in reach of `import`. Browser and server end with the test.
 * @param {import('node:test').TestContext} t
 */
export async function openPage(t, { isolated = true, strict = false } = {}) {
  const executablePath = CHROMIUM.find((path) => path && existsSync(path));
  assert.ok(executablePath, 'no Chromium found: install it, or set CHROMIUM to its path');
  const headers = { ...(isolated && ISOLATED), ...(strict && STRICT) };
  const server = createServer((request, response) => answer(request.url, headers, response));
  await new Promise((ready) => server.listen(0, ready));
  const browser = await chromium.launch({ executablePath, args: FLAGS });
  t.after(async () => {
    await browser.close();
    server.close();
  });
  const page = await browser.newPage();
  page.on('pageerror', (error) => t.diagnostic(`page: ${error}`));
  await page.goto(`http://localhost:${server.address().port}/`);
  return page;
}

async function answer(url, headers, response) {
  const { pathname } = new URL(url, 'http://localhost');
  const file = pathname.startsWith('/pointweave/') ? new URL(`.${pathname.slice('/pointweave'.length)}`, PACKAGE) : null;
  const body = pathname === '/' ? HTML : file && (await readFile(file).catch(() => null));
  const type = pathname === '/' ? 'text/html' : TYPES[extname(pathname)] ?? 'application/octet-stream';
  response.writeHead(body ? 200 : 404, { ...headers, 'Content-Type': type }).end(body ?? '');
}
