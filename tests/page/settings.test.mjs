// Settings, their address, what they cost, the numbers and the files: as a person who knows more uses the page.

import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { test } from 'node:test';
import { read } from '../../pkg/index.node.js';
import { CONTROLS } from '../../www/src/controls/settings.js';
import { PATIENCE, start } from './browser.mjs';
import { spherePoints, toPly } from './scans.mjs';

/** A shallow bowl, open above: one border. */
const RIM = -0.4;
const bowl = spherePoints(20_000).filter(([, , z]) => z < RIM);
const WIDTH = 2 * Math.sqrt(1 - RIM ** 2);
const DIAGONAL = Math.hypot(WIDTH, WIDTH, 1 + RIM);

test('an expert\'s visit', { timeout: 2 * PATIENCE }, async (t) => {
  const server = await start(t);
  const options = { permissions: ['clipboard-read', 'clipboard-write'] };
  const site = await server.open(options, undefined, `?src=${server.serve('bowl.ply', toPly(bowl))}#ratio=0.25`);
  const { page } = site;
  await site.opened('bowl.ply');
  const hash = () => page.evaluate(() => location.hash);
  const stages = () => page.$$eval('#stages data', (rows) => rows.map((row) => row.dataset.stage));
  const count = bowl.length;
  let mesh;

  await t.test('numbers: what came out of how much', async () => {
    assert.equal(await site.number('outputPoints'), Math.round(count / 4));
    assert.equal(await site.number('reduction'), Math.round(count / 4) / count);
    assert.equal(await site.number('holes'), 1);
    assert.ok((await site.number('boundaryEdges')) > 20);
    const [error, share] = [await site.number('errorRms'), await site.number('errorRmsShare')];
    assert.ok(Math.abs(error / share / DIAGONAL - 1) < 0.02, 'in file units and of the diagonal');

    await page.click('#made > summary');
    await page.click('#copy-json');
    await page.waitForFunction(() => document.querySelector('#copy-json').textContent === 'Copied');
    const { scan, settings, report } = JSON.parse(await page.evaluate(() => navigator.clipboard.readText()));
    assert.equal(scan.count, count);
    assert.deepEqual(settings, { reduce: { target: { ratio: 0.25 } }, surface: {} });
    assert.equal(report.outputPoints, Math.round(count / 4));
    assert.equal(report.distance.rms, share);
  });

  await t.test('every option has a control, and one that only shapes the surface does not reduce again', async () => {
    assert.ok(await page.isVisible('#option-boundary') && await page.isVisible('#option-outliers'), 'what most scans need is in sight');
    await page.click('#more > summary');
    assert.equal(await page.isVisible('#option-fuzzifier'), false, 'an expert looks further');
    assert.equal(await page.$('#target-kind [value="flatness"]'), null);
    await page.click('#expert > summary');
    for (const key of Object.keys(CONTROLS)) assert.ok(await page.isVisible(`#option-${key}`), key);
    assert.ok((await stages()).includes('cluster'));
    await site.remade(() => page.selectOption('#option-boundary', 'closed'));
    assert.equal(await site.number('holes'), 0, 'all holes are closed');
    const again = await stages();
    assert.ok(again.includes('fit') && !again.includes('cluster') && !again.includes('features'), `only the surface: ${again}`);
    assert.match(await hash(), /ratio=0\.25&boundary=closed/);

    const mean = await site.number('errorMean');
    await site.remade(() => page.fill('#option-smoothing', '50'));
    assert.ok((await site.number('errorMean')) > mean, 'smoothing moves the surface away from the points');
    await site.remade(() => page.fill('#option-smoothing', ''));
    assert.equal(await site.number('errorMean'), mean, 'and back to what follows the noise');

    await site.remade(() => page.selectOption('#option-method', 'paper'));
    const paper = await stages();
    assert.ok(paper.includes('cluster') && !paper.includes('features'), `what was measured stays: ${paper}`);
    assert.equal(await page.getAttribute('#option-fuzzifier', 'placeholder'), '2', 'the default follows the method');
  });

  await t.test('the four ways to say how much', async () => {
    await site.remade(() => page.click('#reset'));
    assert.ok(await page.isDisabled('#reset'));
    assert.equal(await hash(), '');
    assert.equal(await site.number('outputPoints'), 2000, 'what suits this scan');

    await page.selectOption('#target-kind', 'count');
    await site.remade(() => page.fill('#keep-field', '777'));
    assert.equal(await site.number('outputPoints'), 777);
    await site.remade(() => page.selectOption('#target-kind', 'ratio'));
    assert.equal(await hash(), `#ratio=${Number((777 / count).toPrecision(3))}`);
    await site.remade(() => page.fill('#keep-field', '33.3'));
    assert.equal(await hash(), '#ratio=0.333', 'as it is shown, without the digits of a binary fraction');
    await site.remade(() => page.selectOption('#target-kind', 'tolerance'));
    assert.match(await page.innerText('#keep-count'), new RegExp(`within ${(1e-3 * DIAGONAL).toPrecision(3)}`));
    const within = await site.number('outputPoints');
    await site.remade(() => page.fill('#keep-field', '1'));
    assert.ok((await site.number('outputPoints')) < within, 'ten times the tolerance, fewer points');
    await site.remade(() => page.selectOption('#target-kind', 'flatness'));
    assert.match(await hash(), /^#flatness=/);

    // What cannot be is said, and nothing starts.
    await page.selectOption('#target-kind', 'ratio');
    await site.made();
    await page.fill('#keep-field', '250');
    assert.equal(await page.$eval('#keep-field', (field) => field.validity.valid), false);
    assert.equal(await page.getAttribute('#keep-field', 'aria-invalid'), 'true');
    assert.equal(await page.innerText('#keep-error'), 'This takes a number above 0 %, up to 100 %.');
    await page.fill('#option-fuzzifier', '1');
    assert.equal(await page.innerText('#option-fuzzifier-error'), 'This takes a number above 1, up to 100.');
    await page.fill('#option-fuzzifier', '');
    assert.equal(await page.getAttribute('#option-fuzzifier', 'aria-invalid'), null);
    assert.equal(await page.isVisible('#option-fuzzifier-error'), false);
    assert.equal(await page.getAttribute('#app', 'data-state'), 'ready');
  });

  await t.test('the address brings all of it back, and a new one is followed', async () => {
    await page.evaluate(() => (location.hash = '#count=900&sharp=false&view=compare&colors=density'));
    await page.waitForFunction(() => document.querySelector('[data-number="outputPoints"]').value === '900', null, { timeout: PATIENCE });
    await site.made();
    const check = async () => {
      assert.equal(await site.view(), 'compare');
      assert.equal(await page.isChecked('input[name="paint"][value="density"]'), true);
      assert.equal(await page.isChecked('#option-sharp'), false);
      assert.equal(await site.number('outputPoints'), 900);
    };
    await check();
    const link = await page.inputValue('#share-link');
    await page.goto('about:blank');
    await page.goto(link);
    await site.opened('bowl.ply');
    await check();
    assert.match(await page.inputValue('#share-embed'), /<point-weave src="bowl-mesh.glb" alt="bowl.ply, a 3D model"/);
  });

  await t.test('error against count, and a dot that is chosen', async () => {
    await page.click('#comparison > summary');
    await page.waitForFunction(() => /Each dot/.test(document.querySelector('#chart-note').textContent), null, { timeout: PATIENCE });
    const dots = await page.$$eval('#chart .dot', (all) => all.map((dot) => dot.getAttribute('aria-label')));
    const counts = dots.map((words) => Number(words.split(' ')[0].replace(',', '')));
    const errors = dots.map((words) => Number(/([\d.]+) % of/.exec(words)[1]));
    assert.ok(counts.length >= 3 && counts.includes(900), `${counts}`);
    assert.deepEqual(counts, counts.toSorted((a, b) => a - b));
    assert.ok(errors[0] > 2 * errors.at(-1), `fewer points are further away: ${errors}`);
    await page.focus('#chart .dot');
    await site.remade(() => page.keyboard.press('Enter'));
    assert.equal(await site.number('outputPoints'), counts[0]);
    assert.equal(await page.$$eval('#chart .dot', (all) => all.length), counts.length, 'the others are still known');
    await page.click('#comparison > summary');
  });

  await t.test('every format: its size first, and what is in it', async () => {
    await page.click('#formats > summary');
    const [triangles, kept] = [await site.number('triangles'), await site.number('outputPoints')];
    const count = (pattern) => (bytes) => bytes.toString('latin1').match(pattern)?.length ?? 0;
    const glb = (bytes) => {
      assert.equal(bytes.toString('latin1', 0, 4), 'glTF');
      const { accessors, meshes } = JSON.parse(bytes.toString('utf8', 20, 20 + bytes.readUInt32LE(12)));
      const { indices, attributes } = meshes[0].primitives[0];
      return indices === undefined ? accessors[attributes.POSITION].count : accessors[indices].count / 3;
    };
    const header = (element) => (bytes) => Number(new RegExp(`element ${element} (\\d+)`).exec(bytes.toString('latin1', 0, 2000))[1]);
    const points = async (bytes) => (await read(bytes)).positions.length / 3;
    const holds = {
      'mesh-glb-small': [glb, triangles], 'mesh-glb': [glb, triangles], 'mesh-ply': [header('face'), triangles], 'mesh-obj': [count(/^f /gm), triangles],
      'mesh-stl': [(bytes) => bytes.readUInt32LE(80), triangles], 'mesh-3mf': [async (bytes) => (await read(bytes)).faces, triangles],
      'mesh-usdz': [(bytes) => count(/\d, (?=\d)/g)(/faceVertexCounts = \[(.*?)\]/.exec(bytes.toString('latin1'))?.[1] ?? '') + 1, triangles],
      'reduced-ply': [header('vertex'), kept], 'reduced-glb': [glb, kept], 'reduced-xyz': [count(/^[-\d]/gm), kept],
      'reduced-pcd': [points, kept], 'reduced-las': [points, kept],
    };
    for (const id of Object.keys(holds)) await page.waitForSelector(`#save-${id}`);
    assert.deepEqual((await page.$$eval('.format', (rows) => rows.map((row) => row.id.slice(5)))).sort(), Object.keys(holds).sort());
    for (const [id, [holding, expected]] of Object.entries(holds)) {
      const size = Number(await page.getAttribute(`#save-${id} data`, 'value'));
      // A click whose download does not begin is made once more, as a person would.
      const save = () => Promise.all([page.waitForEvent('download', { timeout: 10_000 }), page.click(`#save-${id}`)]);
      const [saved] = await save().catch(save);
      const bytes = await readFile(await saved.path());
      assert.equal(bytes.length, size, id);
      assert.equal(await holding(bytes), expected, id);
    }
    // The one button takes what most people need: small, with what it would be else said below.
    const [small, plain] = await Promise.all(['mesh-glb-small', 'mesh-glb'].map(async (id) => Number(await page.getAttribute(`#save-${id} data`, 'value'))));
    assert.ok(small < 0.5 * plain, `${small} of ${plain} bytes`);
    assert.match(await page.innerText('#save'), new RegExp(`GLB · ${Math.ceil(small / 1e3)} kB`));
    assert.match(await page.innerText('#save-note'), new RegExp(`has ${Math.ceil(plain / 1e3)} kB`));
    const saved = page.waitForEvent('download');
    await page.click('#save');
    assert.equal((await saved).suggestedFilename(), 'bowl-mesh.glb');
    mesh = await readFile(await (await saved).path());
  });

  await t.test('3D printing is offered where the mesh is watertight, with its size; else it is said what is missing', async () => {
    assert.equal(await page.innerText('#printing'), 'Not ready for 3D printing: it has an open border.');
    assert.doesNotMatch(await page.innerText('#format-list'), /3D printing/);
    await site.remade(() => page.click('#close-holes'));
    const words = await page.innerText('#printing');
    const [, across, deep, high, volume] = /^Watertight, ready for 3D printing: ([\d.]+) × ([\d.]+) × ([\d.]+) mm, ([\d.]+) mm³, if/.exec(words)?.map(Number) ?? [];
    for (const [found, truth] of [[across, WIDTH], [deep, WIDTH], [high, 1 + RIM], [volume, (Math.PI * (1 + RIM) ** 2 * (2 - RIM)) / 3]]) {
      assert.ok(Math.abs(found / truth - 1) < 0.25, `${words}: ${found} for ${truth}`);
    }
    assert.equal(await page.isVisible('#close-holes'), false);
    await page.waitForSelector('#save-mesh-stl');
    assert.match(await page.innerText('#save-mesh-stl'), /for 3D printing/);
    await page.click('#standing > summary');
    await page.selectOption('#stand-unit', 'in');
    await page.waitForFunction(() => /mm, [\d.]+ cm³\.$/.test(document.querySelector('#printing').textContent));
    assert.match(await page.innerText('#printing'), new RegExp(`: ${(25.4 * across).toFixed(1).slice(0, 3)}`));
  });

  await t.test('the snippet shows the saved mesh in another page', async () => {
    const body = await page.inputValue('#share-embed');
    const answer = async (route) => {
      const { pathname } = new URL(route.request().url());
      const html = `<!doctype html><title>own</title><link rel="icon" href="data:,">${body}`;
      if (pathname === '/own.html') return route.fulfill({ contentType: 'text/html', body: html });
      if (pathname === '/bowl-mesh.glb') return route.fulfill({ body: mesh });
      const [, path] = /^\/pointweave\/(.*)$/.exec(pathname);
      return route.fulfill({ contentType: 'text/javascript', body: await readFile(new URL(`../../pkg/${path}`, import.meta.url)) });
    };
    const own = await server.open({ serviceWorkers: 'block' }, (opened) => opened.route('**/*', answer), 'own.html');
    await own.page.waitForFunction(() => document.querySelector('point-weave').loaded, null, { timeout: PATIENCE });
    assert.equal(await own.page.getAttribute('point-weave', 'alt'), 'bowl.ply, a 3D model');
    assert.deepEqual(own.faults, []);
    await own.page.context().close();
  });

  await t.test('a small file that was saved can be opened again', async () => {
    await site.drop('bowl-mesh.glb', mesh);
    await site.opened('bowl-mesh.glb');
    assert.match(await page.innerText('#caption-detail'), /taken from [\d,]+ faces/);
  });

  assert.deepEqual(site.faults, []);
});
