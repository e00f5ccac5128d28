// The main flow in Firefox. The page drives itself: a script beside it acts as a person and reports to the server.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join } from 'node:path';
import { text } from 'node:stream/consumers';
import { test } from 'node:test';
import { DIST, PATIENCE, TYPES } from './browser.mjs';

const FIREFOX = [process.env.FIREFOX, '/usr/bin/firefox-esr', '/usr/bin/firefox'];
/** A Firefox that starts without questions and calls nobody, and draws without a graphics card. */
const PREFERENCES = {
  'browser.aboutwelcome.enabled': false, 'browser.shell.checkDefaultBrowser': false, 'app.update.enabled': false,
  'datareporting.policy.dataSubmissionEnabled': false, 'toolkit.telemetry.enabled': false, 'network.captive-portal-service.enabled': false,
  'network.connectivity-service.enabled': false, 'app.normandy.enabled': false, 'browser.safebrowsing.malware.enabled': false,
  'webgl.force-enabled': true,
};

/** What a person does; runs in the page. */
async function visit() {
  const one = (selector) => document.querySelector(selector);
  const until = async (what) => {
    for (;;) {
      const value = what();
      if (value) return value;
      await new Promise((later) => setTimeout(later, 50));
    }
  };
  const number = (name) => Number(one(`data[data-number="${name}"]`).value);
  const made = () => until(() => one('#app[data-state="ready"] #numbers[data-fresh="true"]'));
  const drop = (name, content) => {
    const data = new DataTransfer();
    data.items.add(new File([content], name));
    document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
  };
  const colors = () => until(() => {
    // Read in the frame in which it was drawn.
    const canvas = one('canvas');
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d');
    copy.drawImage(canvas, 0, 0);
    const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
    let drawn = 0;
    for (let i = 3; i < data.length; i += 4) drawn += data[i] ? 1 : 0;
    return drawn / (data.length / 4);
  });
  const drawn = async (key) => {
    document.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true }));
    return new Promise((resolve) => requestAnimationFrame(() => resolve(colors())));
  };
  await made();
  const duck = { points: number('inputPoints'), kept: number('outputPoints'), triangles: number('triangles') };
  // Without a driver Firefox has no WebGL; then the page says so, and does all else.
  const webgl = Boolean(document.createElement('canvas').getContext('webgl2'));
  const views = webgl ? { scan: await drawn('1'), reduced: await drawn('2'), mesh: await drawn('3'), compare: await drawn('4') } : {};
  const saved = await until(() => one('#save:enabled') && one('#save-detail').textContent);
  drop('bad.ply', 'ply\nformat ascii 1.0\nelement vertex 1\nend_header\n');
  const message = await until(() => !one('#message').hidden && one('#message-detail').textContent);
  drop('own.xyz', Array.from({ length: 1200 }, (_, i) => {
    const z = 1 - (2 * i + 1) / 1200;
    return [Math.sqrt(1 - z * z) * Math.cos(2.4 * i), Math.sqrt(1 - z * z) * Math.sin(2.4 * i), z].join(' ');
  }).join('\n'));
  await until(() => one('#caption-title').textContent === 'own.xyz');
  await made();
  return {
    duck, views, saved, message, webgl, excused: !one('#no-webgl').hidden, engine: one('#engine').textContent,
    own: { points: number('inputPoints'), holes: number('holes') },
  };
}

test('the main flow in Firefox', { timeout: PATIENCE }, async (t) => {
  const executable = FIREFOX.find((path) => path && existsSync(path));
  assert.ok(executable, 'no Firefox found: install it, or set FIREFOX to its path');
  let report;
  const reported = new Promise((resolve) => (report = resolve));
  const drive = `(${visit})().then((value) => ({ value }), (error) => ({ error: String(error) }))
    .then((answer) => fetch('./report', { method: 'POST', body: JSON.stringify(answer) }));`;
  const server = createServer(async (request, response) => {
    const { pathname } = new URL(request.url, 'http://localhost');
    const headers = { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' };
    if (pathname === '/report') report(JSON.parse(await text(request)));
    const file = join(DIST, pathname === '/' ? 'index.html' : pathname);
    let body = pathname === '/drive.js' ? drive : await readFile(file).catch(() => '');
    if (pathname === '/') body = body.toString().replace('</body>', '<script type="module" src="./drive.js"></script></body>');
    response.writeHead(body ? 200 : 404, { ...headers, 'Content-Type': TYPES[extname(file)] ?? 'application/octet-stream' }).end(body);
  });
  await new Promise((ready) => server.listen(0, ready));
  const profile = mkdtempSync(join(tmpdir(), 'pointweave-firefox-'));
  writeFileSync(join(profile, 'user.js'), Object.entries(PREFERENCES).map(([name, value]) => `user_pref("${name}", ${value});`).join('\n'));
  const address = `http://localhost:${server.address().port}/`;
  const firefox = spawn(executable, ['--headless', '--no-remote', '--profile', profile, address], { stdio: 'ignore' });
  const ended = new Promise((resolve) => firefox.once('exit', resolve));
  t.after(async () => {
    firefox.kill();
    await ended;
    server.closeAllConnections();
    server.close();
    rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
  });
  const { value, error } = await Promise.race([reported, ended.then((code) => ({ error: `Firefox exited with ${code}` }))]);
  assert.equal(error, undefined);
  t.diagnostic(JSON.stringify(value));
  const { duck, views, saved, message, webgl, excused, engine, own } = value;
  assert.deepEqual([duck.points, duck.kept], [35_647, 11_882]);
  assert.ok(duck.triangles > 10_000);
  assert.equal(excused, !webgl, 'it draws, or says why not');
  assert.equal(Object.keys(views).length, webgl ? 4 : 0);
  for (const [view, share] of Object.entries(views)) assert.ok(share > 0.1 && share < 0.7, `${view}: ${share} of the picture is drawn`);
  assert.match(saved, /^[A-Z]+ · [\d.]+ [kM]B$/);
  assert.match(message, /bad\.ply.*\[[a-z-]+\]/);
  assert.match(engine, /^(\d+ threads|one thread)$/);
  assert.deepEqual(own, { points: 1200, holes: 0 });
});
