// Pages with the element in them, on a static server of their own, in headless Chromium with WebGL by software.

import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { mkdir, readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { after, test as nodeTest } from 'node:test';
import { extname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

const PACKAGE = new URL('../../pkg/', import.meta.url);
const MODULES = new URL('../node_modules/', import.meta.url);
const CHROMIUM = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];
const FLAGS = [
  '--headless=new', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--disable-dev-shm-usage',
  '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--js-flags=--expose-gc',
];
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm', '.svg': 'image/svg+xml' };
const IMPORTS = {
  pointweave: '/pointweave/index.js', 'pointweave/viewer': '/pointweave/viewer.js',
  '3d-tiles-renderer': '/node_modules/3d-tiles-renderer/build/index.js',
  three: '/node_modules/three/build/three.module.js', 'three/addons/': '/node_modules/three/examples/jsm/',
};
const STRICT = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval' 'nonce-map'; style-src 'self'; worker-src 'self'; connect-src 'self'; img-src 'self' data:";

/** An isolated page takes workers only from those who say this, too. */
const WORKERS = { 'Cross-Origin-Embedder-Policy': 'require-corp' };

/** What lies over the picture, hidden for pixel tests; and no round corners. */
const PICTURE_ONLY = `point-weave { border-radius: 0 !important }
  point-weave::part(prompt), point-weave::part(toolbar), point-weave::part(progress), point-weave::part(error) { visibility: hidden !important }`;

/** Where pictures are kept for people to look at, when this is set. */
const PICTURES = process.env.POINTWEAVE_PICTURES;

/** Long enough for a slow machine: for one thing to wait for, and for one test. */
const PATIENCE = 60_000;

/** @param {string} name @param {(t: import('node:test').TestContext) => Promise<void>} run */
export const test = (name, run) => nodeTest(name, { timeout: 2 * PATIENCE }, run);

/** The fenced blocks of a language in a document. @param {string} document @param {string} language */
export const blocks = (document, language) =>
  [...document.matchAll(/^```(\w*)\n([\s\S]*?)^```$/gm)].filter(([, name]) => name === language).map(([, , text]) => text);

/** In a page: whether its canvas shows something. Stands alone. */
export function painted() {
  const { width, height } = document.querySelector('canvas');
  const copy = new OffscreenCanvas(width, height).getContext('2d');
  copy.drawImage(document.querySelector('canvas'), 0, 0);
  return copy.getImageData(0, 0, width, height).data.some((value, i) => i % 4 === 3 && value > 0);
}

/** A browser and a server, for a file of tests to have at its top; both end with it. */
export async function startSite() {
  const executablePath = CHROMIUM.find((path) => path && existsSync(path));
  assert.ok(executablePath, 'no Chromium found: install it, or set CHROMIUM to its path');
  const files = new Map();
  const server = createServer((request, response) => answer(request, response, files));
  await new Promise((ready) => server.listen(0, ready));
  const browser = await chromium.launch({ executablePath, args: FLAGS });
  after(async () => {
    await browser.close();
    server.closeAllConnections();
    server.close();
  });
  return new Site(browser, `http://localhost:${server.address().port}`, files);
}

async function answer(request, response, files) {
  const { pathname } = new URL(request.url, 'http://localhost');
  const { body, headers } = files.get(pathname) ?? { body: await fileBody(pathname) };
  const type = TYPES[extname(pathname)] ?? 'application/octet-stream';
  response.writeHead(body ? 200 : 404, { 'Content-Type': type, ...WORKERS, ...headers }).end(body ?? '');
}

/** @param {string} pathname */
function fileBody(pathname) {
  for (const [folder, at] of [['/pointweave/', PACKAGE], ['/node_modules/', MODULES]]) {
    if (pathname.startsWith(folder)) return readFile(fileURLToPath(new URL(pathname.slice(folder.length), at))).catch(() => null);
  }
  return null;
}

class Site {
  #browser;
  #files;
  #pages = 0;

  constructor(browser, address, files) {
    this.#browser = browser;
    this.address = address;
    this.#files = files;
  }

  /** Puts a file on the server. */
  put(path, body, headers = {}) {
    this.#files.set(path, { body, headers });
    return path;
  }

  /**
   * Opens a page that holds `body`. It has an import map and the element's module, as a person would write them.
   * @param {string} body
   * @param {object} [options] strict: a content security policy; prepare: before the page loads; define: false for no element
   */
  async open(body, { strict = false, prepare, define = true, imports = IMPORTS, style = '', headers = {}, ...context } = {}) {
    const path = `/${++this.#pages}.html`;
    const css = this.put(`/${this.#pages}.css`, `body { margin: 0; font: 16px sans-serif; background: #fff } point-weave { display: block } ${style}`, { 'Content-Type': 'text/css' });
    const html = `<!doctype html><html lang="en"><head><title>Objects</title><link rel="icon" href="data:,"><link rel="stylesheet" href="${css}">
      <meta name="viewport" content="width=device-width, initial-scale=1">
      <script type="importmap" nonce="map">${JSON.stringify({ imports })}</script>
      ${define ? '<script type="module" src="/pointweave/element.js"></script>' : ''}</head><body><main><h1>Objects</h1>${body}</main></body></html>`;
    this.put(path, html, { ...headers, ...(strict && { 'Content-Security-Policy': STRICT }) });
    return this.visit(path, { prepare, ...context });
  }

  /** Opens a page that is there already. */
  async visit(path, { prepare, ...context } = {}) {
    const page = await (await this.#browser.newContext({ viewport: { width: 800, height: 600 }, reducedMotion: 'reduce', ...context })).newPage();
    await page.addInitScript(watch);
    const opened = new Opened(page, this.address);
    await prepare?.(page);
    await page.goto(this.address + path);
    return opened;
  }
}

/** In the page, before all else: counts contexts and buffers, keeps the events of every element in order. */
function watch() {
  window.contexts = [];
  const { getContext } = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
    const context = getContext.call(this, kind, ...rest);
    if (kind.startsWith('webgl') && context && !window.contexts.includes(context)) window.contexts.push(context);
    return context;
  };
  window.held = { Buffer: 0, Texture: 0, VertexArray: 0 };
  for (const kind of Object.keys(window.held)) {
    for (const [verb, step] of [['create', 1], ['delete', -1]]) {
      const original = WebGL2RenderingContext.prototype[verb + kind];
      WebGL2RenderingContext.prototype[verb + kind] = function (...rest) {
        window.held[kind] += step;
        return original.apply(this, rest);
      };
    }
  }
  window.heard = [];
  for (const type of ['progress', 'load', 'error', 'abort', 'change']) {
    document.addEventListener(type, (event) => {
      if (!(event.target instanceof Element) || event.target.localName !== 'point-weave') return;
      const { error, report, ...detail } = event.detail ?? {};
      window.heard.push({
        type, ...detail, id: event.target.id, bubbles: event.bubbles,
        ...(report && { report: { inputPoints: report.inputPoints, outputPoints: report.outputPoints, build: report.build, threads: report.threads } }),
        ...(error && { name: error.constructor.name, code: error.code, message: error.message, found: error.found, index: error.index }),
      });
    }, true);
  }
}

/** A page as a person sees it. */
class Opened {
  constructor(page, address) {
    this.page = page;
    /** Uncaught errors, and what a policy forbade. */
    this.faults = [];
    /** Paths that were asked for. */
    this.asked = [];
    page.on('pageerror', (error) => this.faults.push(String(error)));
    page.on('console', (message) => message.type() === 'error' && !/Failed to load resource/.test(message.text()) && this.faults.push(message.text()));
    page.on('request', (request) => this.asked.push(request.url().replace(address, '')));
  }

  element(selector = 'point-weave') {
    return this.page.locator(selector);
  }

  /** Waits until every element (of the selector) shows the view that it asks for. */
  async loaded(selector = 'point-weave') {
    await this.page.waitForFunction((css) => [...document.querySelectorAll(css)].every(({ loaded }) => loaded), selector, { timeout: PATIENCE });
    await this.drawn();
  }

  /** Waits until what was asked for has been drawn. */
  drawn() {
    return this.page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  }

  /** @param {Record<string, unknown>} properties */
  async set(properties, selector = 'point-weave') {
    await this.element(selector).evaluate((element, values) => Object.assign(element, values), properties);
    await this.drawn();
  }

  /** Does something in the page the moment a stage is heard of, and waits until it is done. */
  at(stage, act) {
    return this.page.evaluate(([name, source]) => new Promise((resolve) => {
      const hear = (event) => {
        if (event.detail.stage !== name) return;
        document.removeEventListener('progress', hear, true);
        resolve((0, eval)(source)(event.target));
      };
      document.addEventListener('progress', hear, true);
    }), [stage, `(${act})`]);
  }

  /** Waits for an event, and gives all so far. */
  async heard(type, count = 1) {
    await this.page.waitForFunction(([name, least]) => window.heard.filter((event) => event.type === name).length >= least, [type, count], { timeout: PATIENCE });
    return this.events();
  }

  events() {
    return this.page.evaluate(() => window.heard);
  }

  /** The picture alone, as PNG bytes. */
  picture(selector = 'point-weave') {
    return this.element(selector).first().screenshot({ style: PICTURE_ONLY, animations: 'disabled' });
  }

  /** What a person sees, kept where the environment says so. */
  async keep(name) {
    if (!PICTURES) return;
    await mkdir(PICTURES, { recursive: true });
    await this.page.screenshot({ path: join(PICTURES, `element-${name}.png`), fullPage: true });
  }

  /** What a screen reader was last told. */
  spoken(selector = 'point-weave') {
    return this.element(selector).first().evaluate(({ shadowRoot }) => shadowRoot.querySelector('[role=status]').textContent);
  }
}
