// The built page on a static server of its own, in headless Chromium, and what the tests do with it.

import assert from 'node:assert/strict';
import { readFile, readdir } from 'node:fs/promises';
import { existsSync } from 'node:fs';
import { createServer } from 'node:http';
import { dirname, extname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

const ROOT = resolve(dirname(fileURLToPath(import.meta.url)), '../..');
export const DIST = join(ROOT, 'www/dist');
const SHARED = process.env.POINTWEAVE_SHARED ?? resolve(ROOT, '../shared');

const CHROMIUM = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];
const FLAGS = [
  '--headless=new', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--disable-dev-shm-usage',
  '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
];

export const TYPES = {
  '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.wasm': 'application/wasm', '.json': 'application/json',
};

/** What lies over the picture, hidden for pixel tests. */
const PICTURE_ONLY = '.caption, .legend, .tools, .views, .split, .section, .progress, .message { visibility: hidden !important }';

/** Where pictures are kept for people to look at, when this is set. */
const PICTURES = process.env.POINTWEAVE_PICTURES;

/** Long enough for the largest scan on a slow machine. */
export const PATIENCE = 300_000;

/** A file of the shared data, or null after a printed line when it is not there. */
export async function sharedFile(path) {
  const file = join(SHARED, 'data', path);
  if (existsSync(file)) return readFile(file);
  console.log(`not tested: ${file} is missing (set POINTWEAVE_SHARED to the folder that holds data/)`);
  return null;
}

/** Names and contents of the files in a folder of the shared data; none, after a printed line, where it is missing. */
export async function sharedFolder(path) {
  const names = await readdir(join(SHARED, 'data', path)).catch(() => []);
  if (!names.length) console.log(`not tested: ${join(SHARED, 'data', path)} is missing (set POINTWEAVE_SHARED to the folder that holds data/)`);
  return Promise.all(names.map(async (name) => [name, await readFile(join(SHARED, 'data', path, name))]));
}

/**
 * A browser and a static server for the built page, or for another in `dist`; both end with the test.
 * @param {import('node:test').TestContext} t
 */
export async function start(t, { isolated = true, dist = DIST } = {}) {
  assert.ok(existsSync(join(dist, 'index.html')), 'the page is not built: run `cargo xtask build` first');
  const executablePath = CHROMIUM.find((path) => path && existsSync(path));
  assert.ok(executablePath, 'no Chromium found: install it, or set CHROMIUM to its path');

  const files = new Map();
  const server = createServer((request, response) => answer(request, response, { files, isolated, dist }));
  await new Promise((ready) => server.listen(0, ready));
  const browser = await chromium.launch({ executablePath, args: FLAGS });
  t.after(async () => {
    await browser.close();
    server.close();
  });
  return new Site(browser, server, files);
}

async function answer(request, response, { files, isolated, dist }) {
  const path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
  const file = join(dist, path.endsWith('/') ? `${path}index.html` : path);
  const body = files.get(path) ?? (file.startsWith(dist) ? await readFile(file).catch(() => null) : null);
  if (isolated) {
    response.setHeader('Cross-Origin-Opener-Policy', 'same-origin');
    response.setHeader('Cross-Origin-Embedder-Policy', 'require-corp');
  }
  response.setHeader('Content-Type', TYPES[extname(file)] ?? 'application/octet-stream');
  response.writeHead(body ? 200 : 404).end(body ?? '');
}

/** The page's address, and the files that a test puts beside it to be dropped. */
class Site {
  #browser;
  #server;
  #files;

  constructor(browser, server, files) {
    this.#browser = browser;
    this.#server = server;
    this.address = `http://localhost:${server.address().port}/`;
    this.#files = files;
  }

  /** Puts a file beside the page and says what its address ends with. */
  serve(name, bytes) {
    this.#files.set(`/dropped/${name}`, bytes);
    return `dropped/${encodeURIComponent(name)}`;
  }

  /** From now on there is no server any more. */
  async stop() {
    this.#server.closeAllConnections();
    await new Promise((closed) => this.#server.close(closed));
  }

  /** Opens the page, or what follows its address, and waits for nothing. */
  async open(options = {}, prepare = async (_page) => {}, path = '') {
    const context = await this.#browser.newContext({ viewport: { width: 1280, height: 820 }, reducedMotion: 'reduce', ...options });
    const page = await context.newPage();
    const faults = [];
    page.on('pageerror', (error) => faults.push(String(error)));
    page.on('console', (message) => message.type() === 'error' && faults.push(message.text()));
    await prepare(page);
    await page.goto(this.address + path);
    return new PageUnderTest(page, faults, this.#files);
  }
}

/** The page as a person sees and uses it. */
class PageUnderTest {
  #files;

  constructor(page, faults, files) {
    this.page = page;
    /** Uncaught errors and console errors so far. */
    this.faults = faults;
    this.#files = files;
  }

  /** Waits until no job runs any more. */
  async settled() {
    await this.page.waitForSelector('#app[data-state="ready"]:not([data-painting])', { timeout: PATIENCE });
    await this.page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
  }

  /** Waits until the result of the present settings is shown. */
  async made() {
    await this.page.waitForSelector('#app[data-state="ready"] #numbers[data-fresh="true"]', { timeout: PATIENCE });
    await this.settled();
  }

  /** Does what makes the page work again, and waits until that result is shown, however short the work was. */
  async remade(action) {
    const begun = await this.page.evaluateHandle(() => {
      const app = document.querySelector('#app');
      const begun = new Promise((heard) => new MutationObserver((_, observer) => {
        if (app.dataset.state !== 'working') return;
        observer.disconnect();
        heard();
      }).observe(app, { attributeFilter: ['data-state'] }));
      return { begun };
    });
    await action();
    await begun.evaluate(({ begun }) => begun);
    await this.made();
  }

  /** Waits until this file is open and its mesh is made. */
  async opened(name) {
    await this.page.waitForFunction((title) => document.querySelector('#caption-title').textContent === title, name, { timeout: PATIENCE });
    await this.made();
  }

  /** Drops a file on the middle of the page, with its real events, and waits until the page has taken it. */
  async drop(name, bytes) {
    const path = `/dropped/${encodeURIComponent(name)}`;
    this.#files.set(`/dropped/${name}`, bytes);
    await this.page.evaluate(async ([address, fileName]) => {
      const data = new DataTransfer();
      data.items.add(new File([await (await fetch(address)).blob()], fileName));
      for (const type of ['dragenter', 'dragover', 'drop']) {
        document.body.dispatchEvent(new DragEvent(type, { dataTransfer: data, bubbles: true, cancelable: true }));
      }
    }, [path, name]);
  }

  /** Chooses a file through the button. */
  async choose(name, bytes) {
    const chooser = this.page.waitForEvent('filechooser');
    await this.page.click('#choose');
    await (await chooser).setFiles({ name, mimeType: 'application/octet-stream', buffer: Buffer.from(bytes) });
  }

  async show(view) {
    await this.page.locator(`input[name="view"][value="${view}"]`).check({ force: true });
    await this.settled();
  }

  /** Chooses what the colours show, as a person does. */
  async paint(name) {
    await this.page.click('#paint-menu > summary');
    await this.page.check(`input[name="paint"][value="${name}"]`);
    await this.page.keyboard.press('Escape');
    await this.settled();
  }

  view() {
    return this.page.getAttribute('#app', 'data-view');
  }

  /** A number of the panel, as the machine-readable value; NaN while there is none. */
  async number(name) {
    const value = await this.page.getAttribute(`data[data-number="${name}"]`, 'value');
    return value === null ? NaN : Number(value);
  }

  /** The picture alone, as PNG bytes. */
  picture() {
    return this.page.locator('#canvas').screenshot({ style: PICTURE_ONLY, animations: 'disabled' });
  }

  /** The picture of one view. Under a name it is kept, where the environment says so. */
  async pictureOf(view, name = '') {
    await this.show(view);
    if (PICTURES && name) await this.page.screenshot({ path: join(PICTURES, `${name}-${view}.png`), animations: 'disabled' });
    return this.picture();
  }

  message() {
    return this.page.locator('#message:visible').innerText();
  }
}
