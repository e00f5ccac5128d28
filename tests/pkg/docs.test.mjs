// Every snippet of the package's documentation runs, in a page or in Node, or is a part of something that does.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { cp, mkdir, mkdtemp, readFile, readdir, rm, symlink, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test, { after } from 'node:test';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { sample, write } from 'pointweave';
import { ISOLATED, OPEN, openBrowser, serve } from './browser.mjs';
import { CONSUMERS, PACKAGE } from './tarball.mjs';

const scan = Buffer.from(await write(await sample('duck', { count: 5000 }), { format: 'ply' }));

const browser = await openBrowser({ after });

const folder = await mkdtemp(join(tmpdir(), 'pointweave-docs-'));
after(() => rm(folder, { recursive: true }));
await mkdir(join(folder, 'node_modules'));
await cp(PACKAGE, join(folder, 'node_modules/pointweave'), { recursive: true });
for (const peer of ['@gltf-transform', '@jsquash', 'ktx2-encoder', 'meshoptimizer']) {
  await symlink(fileURLToPath(new URL(`../node_modules/${peer}`, import.meta.url)), join(folder, 'node_modules', peer));
}
await writeFile(join(folder, 'package.json'), '{ "type": "module" }');
for (const name of ['scan.ply', 'a.ply', 'b.ply']) await writeFile(join(folder, name), scan);
await mkdir(join(folder, 'scans'));
await writeFile(join(folder, 'scans/scan.ply'), scan);
await writeFile(join(folder, 'good.xyz'), '0 0 0\n1 0 0\n0 1 0\n0 0 1\n');

/** Runs a module in a folder that holds a scan. */
async function runInNode(code) {
  const file = join(folder, 'snippet.mjs');
  await writeFile(file, code);
  const { stderr } = await promisify(execFile)(process.execPath, [file], { cwd: folder });
  assert.equal(stderr, '');
}

/** What may be installed: the package, and what it works with. */
const INSTALLABLE = ['pointweave', ...Object.keys(JSON.parse(await readFile(new URL('package.json', PACKAGE), 'utf8')).peerDependencies)];

/** Runs what a reader would type, in the same folder. */
async function runInShell(code) {
  for (const line of code.trim().split('\n')) {
    const [program, command, ...words] = line.split(' ');
    if (program === 'cargo') continue; // what runs this very test
    if (line.startsWith('npm install ')) words.forEach((word) => assert.ok(INSTALLABLE.includes(word), line));
    else {
      assert.equal(`${program} ${command}`, 'npx pointweave');
      await promisify(execFile)(process.execPath, [join(folder, 'node_modules/pointweave/cli.js'), ...words], { cwd: folder });
    }
  }
}

const IMPORT_MAP = `<script type="importmap">{ "imports": { "pointweave": "/node_modules/pointweave/index.js", "pointweave/core": "/node_modules/pointweave/direct.js" } }</script>`;
/** A snippet of a module as a page, which says when its end is reached. */
const asPage = (code) => `<!doctype html><title>test</title>${IMPORT_MAP}<script type="module">${code}
document.body.append(document.createElement('output')); document.querySelector('output').textContent = 'done';</script>`;

/** A snippet in a page with a file input, which logs arrays at its end. */
const withInput = (code) => `<!doctype html><title>test</title>${IMPORT_MAP}<input type="file"><output></output><script type="module">
console.log = (what) => ArrayBuffer.isView(what) && (document.querySelector('output').textContent = 'done');
${code}</script>`;

/** Opens a page, gives it a file where it asks for one, and waits until it has something to say. */
async function runInPage(t, html, routes = {}, headers = ISOLATED) {
  const page = await browser.newPage();
  t.after(() => page.close());
  const faults = [];
  page.on('pageerror', (error) => faults.push(String(error)));
  page.on('console', (message) => message.type() === 'error' && faults.push(message.text()));
  await page.route('**/node_modules/pointweave/**', (route) => route.continue({ url: route.request().url().replace('/node_modules/', '/') }));
  const address = await serve(t, headers, { '/': () => html, '/scan.ply': () => scan, '/favicon.ico': () => 'none', ...routes });
  await page.goto(address);
  const input = page.locator('input[type=file]');
  if (await input.count()) await input.setInputFiles({ name: 'scan.ply', mimeType: 'application/octet-stream', buffer: scan });
  const done = page.waitForFunction(() => document.querySelector('output')?.textContent, undefined, { timeout: 60_000 });
  await Promise.race([done, new Promise((_, reject) => page.once('pageerror', reject))]);
  assert.deepEqual(faults, []);
  return page.locator('output').textContent();
}

/** Starts a snippet as the worker of a page, with another origin in the place of its CDN. */
async function runAsWorker(t, code) {
  const cdn = (await serve(t, { ...OPEN, ...ISOLATED }, {})).replace('localhost', '127.0.0.1');
  const script = code.replace('https://cdn.example/', cdn);
  assert.notEqual(script, code);
  const page = asPage(`import { createEngine } from 'pointweave';
    const engine = await createEngine({ workerUrl: '/pointweave-worker.js' });
    await engine.sample('duck', { count: 100 });`);
  await runInPage(t, page, { '/pointweave-worker.js': () => script });
}

/** Serves a page of no inline script with the headers: threads are there where it is isolated by them, and the engine works in any case. */
async function runUnder(t, code) {
  const headers = Object.fromEntries(code.trim().split('\n').map((line) => line.split(': ')));
  const script = `import { createEngine } from '/node_modules/pointweave/index.js';
    const engine = await createEngine({ threads: 2 });
    const { report } = await engine.reduce(await engine.sample('duck', { count: 300 }));
    document.querySelector('output').textContent = report.build;`;
  const html = '<!doctype html><title>test</title><output></output><script type="module" src="/script.js"></script>';
  const build = await runInPage(t, html, { '/script.js': () => script }, headers);
  assert.equal(build, 'Cross-Origin-Embedder-Policy' in headers ? 'threads' : 'single');
}

/** The fenced blocks of a page, each with the comment before it. */
const FENCED = /(?:<!-- (.*) -->\n)?```(\w*)\n([^]*?)```/g;
/** The pages of these have pictures in them: `tests/element` opens them. */
const PICTURES = ['docs/embed.md', 'docs/tiles.md', 'docs/viewer.md'];
const names = ['../README.md', 'README.md', ...(await readdir(new URL('docs/', PACKAGE))).map((name) => `docs/${name}`)];
const pages = await Promise.all(names.map(async (name) => ({ name, text: await readFile(new URL(name, PACKAGE), 'utf8') })));
for (const { name, text } of pages) {

  test(`${name}: links lead somewhere`, async () => {
    for (const [, target] of text.matchAll(/\]\((?!https?:)([^)#]+)/g)) await readFile(new URL(target, new URL(name, PACKAGE)));
  });

  if (name === 'docs/errors.md') {
    test('docs/errors.md: every code, and no other', async () => {
      const types = await readFile(new URL('types.d.ts', PACKAGE), 'utf8');
      const codes = /type ErrorCode =([^;]*);/.exec(types)[1].match(/(?<=')[a-z-]+/g);
      assert.deepEqual([...text.matchAll(/^\| `([a-z-]+)` \|/gm)].map(([, code]) => code).sort(), codes.sort());
    });
  }

  let number = 0;
  for (const [, where, language, code] of text.matchAll(FENCED)) {
    if (language === 'rust' || (PICTURES.includes(name) && language)) continue;
    test(`${name}, snippet ${++number}`, async (t) => {
      if (!language) return runInShell(code);
      if (language === 'http') return runUnder(t, code);
      if (where === 'in Node') return runInNode(code);
      if (where === 'in a page') return runInPage(t, language === 'html' ? code : asPage(code));
      if (where === 'in a page with a file input') return runInPage(t, withInput(code));
      if (where === 'as a worker') return runAsWorker(t, code);
      const other = /^from (.+)$/.exec(where ?? '')?.[1];
      if (other) return assert.ok((await readFile(new URL(other, PACKAGE), 'utf8')).includes(code));
      const file = /^as (.+)$/.exec(where ?? '')?.[1];
      assert.ok(file, `nothing says where it runs:\n${code}`);
      assert.equal(code, await readFile(new URL(file, CONSUMERS), 'utf8'));
    });
  }
}
