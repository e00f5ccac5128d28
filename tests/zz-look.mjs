import { chromium } from 'playwright-core';
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { extname, join } from 'node:path';
const DIST = new URL('../www/dist/', import.meta.url).pathname;
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.wasm': 'application/wasm', '.json': 'application/json' };
export const server = createServer(async (q, r) => {
  const path = decodeURIComponent(new URL(q.url, 'http://x').pathname);
  const body = await readFile(join(DIST, path.endsWith('/') ? path + 'index.html' : path)).catch(() => null);
  r.setHeader('Cross-Origin-Opener-Policy', 'same-origin'); r.setHeader('Cross-Origin-Embedder-Policy', 'require-corp');
  r.setHeader('Content-Type', TYPES[extname(path) || '.html'] ?? 'application/octet-stream');
  r.writeHead(body ? 200 : 404).end(body ?? '');
});
await new Promise((ok) => server.listen(0, ok));
export const address = `http://localhost:${server.address().port}/`;
export const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--headless=new', '--no-sandbox', '--disable-gpu', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-dev-shm-usage'] });
export async function open(options = {}, path = '') {
  const context = await browser.newContext({ viewport: { width: 1360, height: 850 }, reducedMotion: 'reduce', ...options });
  const page = await context.newPage();
  page.on('pageerror', (e) => console.log('pageerror', String(e)));
  page.on('console', (m) => m.type() === 'error' && console.log('console', m.text()));
  await page.goto(address + path);
  return page;
}
export const ready = (page) => page.waitForSelector('#app[data-state="ready"] #numbers[data-fresh="true"]', { timeout: 200_000 });
export const drawn = (page) => page.evaluate(() => new Promise((d) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(d, 150)))));
