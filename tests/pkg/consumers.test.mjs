// Installed from the tarball, built with what people build with, and run in a browser: the same mesh everywhere, and elements that show it.

import assert from 'node:assert/strict';
import { execFile, spawn } from 'node:child_process';
import { mkdir, readFile, rm, writeFile } from 'node:fs/promises';
import test, { after } from 'node:test';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { read, sample, write } from 'pointweave';
import { blocks, painted } from '../element/site.mjs';
import { ball, glb } from '../element/files.mjs';
import { meanColor, silhouette } from '../page/pictures.mjs';
import { ISOLATED, newPage, serveFolders } from './browser.mjs';
import { CONSUMERS, install, pack } from './tarball.mjs';

const run = promisify(execFile);
const folder = (name) => new URL(`${name}/`, CONSUMERS);
const ENVIRONMENT = { ...process.env, NEXT_TELEMETRY_DISABLED: '1', NO_COLOR: '1' };

/** Runs a program of the consumers' own in a folder of theirs. */
const build = (name, ...program) =>
  run(process.execPath, program.map((word) => word.replace(/^bin:/, fileURLToPath(folder('node_modules')))), { cwd: fileURLToPath(folder(name)), env: ENVIRONMENT });

await install((await pack({ after })).file);

/** What Node says: all others have to say the same. */
const expected = JSON.parse((await build('node', 'main.js')).stdout);

/** Opens a page and waits for what it has to say. */
async function open(t, address) {
  const page = await newPage(t);
  const elsewhere = [];
  page.on('request', (request) => request.url().startsWith(new URL('/', address).href) || /^(data|blob):/.test(request.url()) || elsewhere.push(request.url()));
  await page.goto(address);
  await page.waitForFunction(() => document.documentElement.dataset.result, undefined, { timeout: 60_000 });
  const said = await page.evaluate(() => JSON.parse(document.documentElement.dataset.result));
  assert.equal(said.error, undefined);
  assert.deepEqual(elsewhere, [], 'nobody else is asked for anything');
  return { page, said };
}

/** There are elements of the name, and each shows something. */
async function checkPictures(page, name) {
  const elements = await page.locator(name).all();
  assert.ok(elements.length > 0);
  for (const element of elements) {
    const { area } = silhouette(await element.screenshot({ animations: 'disabled' }));
    assert.ok(area > 5000, `${area} pixels are shown`);
  }
}

/** Opens a page, and checks what it says and what it shows. */
async function check(t, address) {
  const { page, said } = await open(t, address);
  assert.deepEqual(said.hashes, expected.hashes);
  assert.deepEqual(said.reasons.filter((_, i) => i % 2 === 0), ['threads', 'single', 'single']);
  const [{ triangles }] = said.shown;
  assert.ok(triangles > 500);
  assert.deepEqual(said.shown, [{ kind: 'scan', triangles }, { kind: 'glb', triangles }]);
  assert.equal(said.viewed, triangles);
  await checkPictures(page, 'point-weave');
  await checkPictures(page, 'canvas#viewer');
  return page;
}

test('Node: every build and way gives one mesh', () => {
  assert.equal(expected.hashes.length, 4);
  assert.equal(new Set(expected.hashes).size, 1);
  assert.deepEqual(expected.reasons, ['threads', 'Node has threads', 'single', 'threads need a worker', 'single', 'threads need a worker']);
});

test('a module script with an import map', async (t) => {
  await check(t, await serveFolders(t, ISOLATED, [folder('importmap'), CONSUMERS]));
});

test('Vite, built', async (t) => {
  await build('vite', 'bin:vite/bin/vite.js', 'build');
  await check(t, await serveFolders(t, ISOLATED, [folder('vite/dist')]));
});

test('Vite, its development server', async (t) => {
  const vite = spawn(process.execPath, [fileURLToPath(folder('node_modules/vite/bin')) + 'vite.js', '--port', '0'], { cwd: fileURLToPath(folder('vite')), env: ENVIRONMENT });
  t.after(() => vite.kill());
  const address = await new Promise((resolve, reject) => {
    let said = '';
    vite.stdout.on('data', (text) => {
      said += text;
      const found = /http:\/\/localhost:\d+\//.exec(said);
      if (found) resolve(found[0]);
    });
    vite.once('exit', () => reject(new Error(said)));
  });
  await check(t, address);
});

test('webpack', async (t) => {
  const { default: webpack } = await import(new URL('node_modules/webpack/lib/index.js', CONSUMERS).href);
  const { default: config } = await import(new URL('webpack/webpack.config.js', CONSUMERS).href);
  const stats = await promisify(webpack)(config);
  assert.deepEqual([...stats.toJson().errors, ...stats.toJson().warnings].map(({ message }) => message), []);
  await check(t, await serveFolders(t, ISOLATED, [folder('webpack/dist'), folder('webpack')]));
});

test('esbuild', async (t) => {
  await build('esbuild', 'build.js');
  await check(t, await serveFolders(t, ISOLATED, [folder('esbuild/dist'), folder('esbuild')]));
});

test('Next.js, rendered on the server and exported', async (t) => {
  await rm(folder('next/dist'), { recursive: true, force: true });
  await build('next', 'bin:next/dist/bin/next', 'build');
  const page = await check(t, await serveFolders(t, ISOLATED, [folder('next/dist')]));
  await page.getByText(/^A duck of \d+ triangles\.$/).waitFor();
});

test('a mesh on a canvas in ten lines of a page, as the documentation has it', async (t) => {
  const document = await readFile(new URL('node_modules/pointweave/docs/viewer.md', CONSUMERS), 'utf8');
  const [html] = blocks(document, 'html');
  const script = /<script type="module">\n([^]*?)<\/script>/.exec(html)[1];
  assert.ok(script.includes('createViewer') && script.trim().split('\n').length <= 10, script);
  const files = folder('viewer/dist');
  await mkdir(files, { recursive: true });
  await writeFile(new URL('index.html', files), html);
  await writeFile(new URL('duck.ply', files), await write(await sample('duck', { count: 3000, seed: 1 })));
  const page = await newPage(t);
  const faults = [];
  page.on('pageerror', (error) => faults.push(String(error)));
  await page.goto(await serveFolders(t, {}, [files, CONSUMERS]));
  await page.waitForFunction(painted, undefined, { timeout: 60_000 });
  await checkPictures(page, 'canvas');
  assert.deepEqual(faults, []);
});

test("<model-viewer> shows the command line's GLB", async (t) => {
  const files = folder('model-viewer/dist');
  await mkdir(files, { recursive: true });
  await writeFile(new URL('scan.ply', files), await write(await sample('duck', { count: 3000, seed: 1 })));
  await run('npx', ['--no-install', 'pointweave', 'reconstruct', 'scan.ply', '-o', 'mesh.glb'], { cwd: fileURLToPath(files) });
  const { page, said } = await open(t, await serveFolders(t, {}, [folder('model-viewer'), files, CONSUMERS]));
  const { positions } = await read(await readFile(new URL('mesh.glb', files)), { faces: 'vertices' });
  for (const [axis, length] of [said.x, said.y, said.z].entries()) {
    const along = positions.filter((_, i) => i % 3 === axis);
    const expected = Math.max(...along) - Math.min(...along);
    assert.ok(Math.abs(length - expected) < 1e-4 * expected, `${length} and not ${expected} along axis ${axis}`);
  }
  await checkPictures(page, 'model-viewer');
});

for (const framework of ['tsx', 'vue', 'svelte']) {
  test(`the snippet of docs/embed.md in ${framework} shows a model and hears of it`, async (t) => {
    const { bundle } = await import(new URL('frameworks/build.js', CONSUMERS).href);
    const document = await readFile(new URL('node_modules/pointweave/docs/embed.md', CONSUMERS), 'utf8');
    const [component] = blocks(document, framework);
    await bundle(framework, component);
    const files = folder(`frameworks/dist/${framework}`);
    await writeFile(new URL('duck.glb', files), await glb([ball(20)]));
    const { page, said } = await open(t, await serveFolders(t, {}, [files, CONSUMERS]));
    assert.match(said.words, /^1600( triangles)?$/);
    assert.equal(await page.evaluate(() => document.querySelector('point-weave').controls), true);
    await checkPictures(page, 'point-weave');
  });
}

/** How many grey values a colour may differ by from what <model-viewer> shows: of mirrors, which show the studio itself, more. */
const BALLS = { white: [1, 0, 0.9, 6], grey: [0.2, 0, 0.9, 8], metal: [0.9, 1, 0.25, 20] };

test('the element in one file is as bright as <model-viewer> beside it', async (t) => {
  const files = folder('beside/dist');
  await mkdir(files, { recursive: true });
  for (const [name, [color, metallicFactor, roughnessFactor]] of Object.entries(BALLS)) {
    const material = { pbrMetallicRoughness: { baseColorFactor: [color, color, color, 1], metallicFactor, roughnessFactor } };
    await writeFile(new URL(`${name}.glb`, files), await glb([{ ...ball(32), material }]));
  }
  const address = await serveFolders(t, {}, [folder('beside'), files, CONSUMERS]);
  const { page } = await open(t, `${address}?names=${Object.keys(BALLS)}`);
  await page.waitForTimeout(1500); // model-viewer fades in
  for (const [name, [, , , most]] of Object.entries(BALLS)) {
    const greys = [];
    for (const tag of ['model-viewer', 'point-weave']) {
      const png = await page.locator(`${tag}[alt=${name}]`).screenshot({ animations: 'disabled' });
      greys.push(Math.round(meanColor(png, silhouette(png))[0]));
    }
    t.diagnostic(`${name}: ${greys.join(' and ')}`);
    assert.ok(Math.abs(greys[0] - greys[1]) <= most, `${name}: ${greys.join(' and ')}`);
  }
});
