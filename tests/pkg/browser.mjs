// Bare pages that import the package from a static server, in headless Chromium and Firefox.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join } from 'node:path';
import { text } from 'node:stream/consumers';
import { chromium } from 'playwright-core';

const PACKAGE = new URL('../../pkg/', import.meta.url);
const CHROMIUM = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];
const FIREFOX = [process.env.FIREFOX, '/usr/bin/firefox-esr', '/usr/bin/firefox'];
const FLAGS = [
  '--headless=new', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--disable-dev-shm-usage',
  '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
];
/** A Firefox that starts without questions and calls nobody. */
const PREFERENCES = {
  'browser.aboutwelcome.enabled': false, 'browser.shell.checkDefaultBrowser': false, 'app.update.enabled': false,
  'datareporting.policy.dataSubmissionEnabled': false, 'toolkit.telemetry.enabled': false, 'network.captive-portal-service.enabled': false,
  'network.connectivity-service.enabled': false, 'app.normandy.enabled': false, 'browser.safebrowsing.malware.enabled': false,
};
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm' };

/** As a person would write it: an import map and no bundler. */
const HTML = `<!doctype html><title>test</title><link rel="icon" href="data:,">
<script type="importmap" nonce="map">{ "imports": { "pointweave": "/pointweave/index.js" } }</script>`;

/** Of a server whose files other origins may have. */
export const OPEN = { 'Access-Control-Allow-Origin': '*', 'Cross-Origin-Resource-Policy': 'cross-origin' };

export const ISOLATED = { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' };
const STRICT = {
  'Content-Security-Policy': "default-src 'none'; script-src 'self' 'wasm-unsafe-eval' 'nonce-map'; worker-src 'self'; connect-src 'self'; img-src data:",
};

/**
 * A page in Chromium with `pointweave` in reach of `import`. Browser and server end with the test.
 * @param {import('node:test').TestContext} t
 */
export async function openPage(t, { isolated = true, strict = false, prepare = async (_page) => {}, flags = [] } = {}) {
  const address = await serve(t, { ...(isolated && ISOLATED), ...(strict && STRICT) }, {});
  const page = await newPage(t, flags);
  await prepare(page);
  await page.goto(address);
  return page;
}

/** A Chromium that ends with the test, or the file of tests. */
export async function openBrowser({ after }, flags = []) {
  const executablePath = found(CHROMIUM, 'Chromium', 'CHROMIUM');
  const browser = await chromium.launch({ executablePath, args: [...FLAGS, ...flags] });
  after(() => browser.close());
  return browser;
}

/** An empty page in a Chromium of its own, which ends with the test. */
export async function newPage(t, flags = []) {
  const browser = await openBrowser({ after: (end) => t.after(end) }, flags);
  const page = await browser.newPage();
  page.on('pageerror', (error) => t.diagnostic(`page: ${error}`));
  return page;
}

/**
 * What an async function gives in an isolated page in Firefox, which reports to the server: no driver is needed.
 * @param {import('node:test').TestContext} t
 * @param {(argument: any) => Promise<any>} job stands alone: only `import('pointweave')` is in its reach
 * @param {any} argument
 */
export async function runInFirefox(t, job, argument) {
  const executable = found(FIREFOX, 'Firefox', 'FIREFOX');
  let report;
  const reported = new Promise((resolve) => (report = resolve));
  const script = `const job = ${job};
    const answer = await job(${JSON.stringify(argument)}).then((value) => ({ value }), (error) => ({ error: String(error) }));
    await fetch('/report', { method: 'POST', body: JSON.stringify(answer) });`;
  const address = await serve(t, ISOLATED, {
    '/job.html': () => `${HTML}<script type="module" src="/job.js"></script>`,
    '/job.js': () => script,
    '/report': async (request) => (report(JSON.parse(await text(request))), 'thanks'),
  });
  const profile = mkdtempSync(join(tmpdir(), 'pointweave-firefox-'));
  const preferences = Object.entries(PREFERENCES).map(([name, value]) => `user_pref("${name}", ${value});`);
  writeFileSync(join(profile, 'user.js'), preferences.join('\n'));
  const firefox = spawn(executable, ['--headless', '--no-remote', '--profile', profile, `${address}job.html`], { stdio: 'ignore' });
  const ended = new Promise((resolve) => firefox.once('exit', resolve));
  t.after(async () => {
    firefox.kill();
    await ended;
    rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
  });
  const { value, error } = await Promise.race([
    reported,
    ended.then((code) => ({ error: `Firefox exited with ${code} before the page reported` })),
  ]);
  assert.equal(error, undefined);
  return value;
}

/** @param {(string | undefined)[]} candidates */
function found(candidates, name, variable) {
  const path = candidates.find((candidate) => candidate && existsSync(candidate));
  assert.ok(path, `no ${name} found: install it, or set ${variable} to its path`);
  return path;
}

/**
 * Serves the package as `/pointweave/`, a bare page and what `routes` gives. Ends with the test.
 * @param {import('node:test').TestContext} t
 * @param {Record<string, string>} headers of every response
 * @param {Record<string, (request: import('node:http').IncomingMessage) => string | Promise<string>>} routes
 * @returns {Promise<string>} the address
 */
export function serve(t, headers, routes) {
  return listen(t, headers, (pathname, request) => {
    if (pathname in routes) return routes[pathname](request);
    if (pathname === '/') return HTML;
    return pathname.startsWith('/pointweave/') && fileIn(PACKAGE, pathname.slice('/pointweave'.length));
  });
}

/**
 * Serves folders, the first that has a file. Ends with the test.
 * @param {import('node:test').TestContext} t
 * @param {Record<string, string>} headers of every response
 * @param {URL[]} folders
 * @returns {Promise<string>} the address
 */
export function serveFolders(t, headers, folders) {
  return listen(t, headers, async (pathname) => {
    for (const folder of folders) {
      const body = await fileIn(folder, pathname.replace(/\/$/, '/index.html'));
      if (body) return body;
    }
  });
}

/** @param {URL} folder @param {string} pathname of a request, from its '/' on */
function fileIn(folder, pathname) {
  return readFile(new URL(`.${pathname}`, folder)).catch(() => null);
}

async function listen(t, headers, answer) {
  const server = createServer(async (request, response) => {
    const { pathname } = new URL(request.url, 'http://localhost');
    const body = await answer(pathname, request);
    const type = pathname.endsWith('/') ? 'text/html' : TYPES[extname(pathname)] ?? 'application/octet-stream';
    response.writeHead(body ? 200 : 404, { ...headers, 'Content-Type': type }).end(body || '');
  });
  await new Promise((ready) => server.listen(0, ready));
  t.after(() => server.closeAllConnections());
  t.after(() => server.close());
  return `http://localhost:${server.address().port}/`;
}
