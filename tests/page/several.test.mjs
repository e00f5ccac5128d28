// Several scans as one: listed, hidden, taken away, registered, undone, found again; and a plane through what is shown.

import assert from 'node:assert/strict';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { sample } from 'pointweave';
import { areParts } from '../../www/src/session/parts.js';
import { PATIENCE, start } from './browser.mjs';
import { silhouette } from './pictures.mjs';
import { spherePoints, toPly, toXyz } from './scans.mjs';

const COUNT = 5000;

/** More than half of a pig, from one side and another, in frames of their own; and another thing. */
async function scans() {
  const pigs = await Promise.all([1, 2].map((seed) => sample('pig', { count: COUNT, seed })));
  const views = pigs.map(({ positions }, k) => {
    const toward = k === 0 ? [1, 0] : [0.6, 0.8];
    const points = Array.from({ length: COUNT }, (_, i) => [...positions.subarray(3 * i, 3 * i + 3)]);
    return points.filter(([x, , z]) => x * toward[0] + z * toward[1] > -2).map(([x, y, z]) => (k === 0 ? [x, y, z] : [30 - y, x - 5, z + 7]));
  });
  const { positions } = await sample('part', { count: 2000 });
  return [...views, Array.from({ length: 2000 }, (_, i) => [...positions.subarray(3 * i, 3 * i + 3)])];
}

/** Drops these files of the file system together. */
async function dropPaths(page, files) {
  const debug = await page.context().newCDPSession(page);
  const data = { items: [], files, dragOperationsMask: 1 };
  for (const type of ['dragEnter', 'dragOver', 'drop']) await debug.send('Input.dispatchDragEvent', { type, x: 300, y: 300, data });
}

test('a few scans are parts of one, a folder of many files is not', () => {
  const all = (...kinds) => kinds.map((kind) => ({ kind }));
  assert.equal(areParts(all('scan', 'beside', 'other')), false);
  assert.equal(areParts(all('scan', 'beside', 'scan')), true);
  assert.equal(areParts(all(...Array(17).fill('scan'))), false);
});

test('several scans: an eye and a bin each, registered as a step, undone, and there after a reload', { timeout: PATIENCE }, async (t) => {
  const folder = await mkdtemp(join(tmpdir(), 'pointweave-'));
  t.after(() => rm(folder, { recursive: true }));
  const points = await scans();
  const names = ['left.ply', 'other.ply', 'right.ply'];
  const [left, right, other] = points.map(({ length }) => length);
  await Promise.all([0, 2, 1].map((k, i) => writeFile(join(folder, names[i]), toPly(points[k]))));
  await writeFile(join(folder, 'worse.ply'), 'ply\nformat ascii 1.0\n');
  const server = await start(t);
  const site = await server.open({}, undefined, `?src=${server.serve('small.xyz', toXyz(spherePoints(800)))}#count=800`);
  const { page } = site;
  await site.opened('small.xyz');
  assert.equal(await page.isVisible('#parts'), false);
  const rows = () => page.$$eval('#parts-rows li', (all) => all.map((row) => row.innerText.replace(/\s*\n\s*/g, ': ')));
  const inputPoints = () => site.number('inputPoints');
  const recipe = () => JSON.parse(new URLSearchParams(new URL(page.url()).hash.slice(1)).get('prepare') ?? '[]');

  await dropPaths(page, [...names, 'worse.ply'].map((name) => join(folder, name)));
  await site.opened('3 scans');
  assert.deepEqual((await rows()).map((row) => row.replace(/:.*:|: $/, ':')), ['left.ply', 'other.ply', 'right.ply', 'worse.ply: cannot be read']);
  assert.equal(await inputPoints(), left + right + other);
  await site.remade(() => page.click('#part-bin-3'));
  await site.opened('3 scans');

  await site.remade(() => page.click('#part-eye-1'));
  await site.opened('2 scans');
  assert.deepEqual(await rows(), ['left.ply', 'other.ply: hidden', 'right.ply']);
  assert.equal(await inputPoints(), left + right);
  assert.equal(await page.getAttribute('#part-eye-1', 'aria-pressed'), 'false');
  await page.click('#undo');
  await site.opened('3 scans');

  assert.match(await page.innerText('#parts-words'), /as they lie in their files/);
  await site.remade(() => page.click('#parts-register'));
  assert.equal(await page.innerText('#parts-words'), '2 of 3 scans are registered; the others are left out.');
  const said = await rows();
  assert.match(said[0], /^left\.ply: fits, \d+ % overlap$/);
  assert.match(said[1], /^other\.ply: left out: (nothing of it looks like|too little of it lies on)/);
  assert.match(said[2], /^right\.ply: fits/);
  assert.deepEqual(recipe(), [{ step: 'register' }]);
  assert.equal(await inputPoints(), left + right);
  const size = (await page.innerText('#caption-size')).split('×').map(Number);
  assert.ok(Math.max(...size) < 25, `one pig: ${size}`);
  assert.equal(await page.isVisible('#parts-register'), false);

  // A step behind it is told of the points of all files, and what is registered stays.
  await page.click('[data-tool="strays"]');
  await page.waitForFunction(() => /would go|There are no/.test(document.querySelector('#tidy-words').textContent), null, { timeout: PATIENCE });
  await page.click('#tidy-cancel');

  await page.reload();
  await site.opened('3 scans');
  assert.match((await rows())[2], /^right\.ply: fits/);
  assert.equal(await inputPoints(), left + right);
  await site.remade(() => page.click('#undo'));
  assert.equal(await inputPoints(), left + right + other);
  assert.deepEqual(site.faults, []);
});

test('a plane through the mesh: by key, slider and buttons', { timeout: PATIENCE }, async (t) => {
  const server = await start(t);
  const site = await server.open({}, undefined, `?src=${server.serve('ball.xyz', toXyz(spherePoints(3000)))}#count=1000`);
  const { page } = site;
  await site.opened('ball.xyz');
  await page.click('#camera-menu > summary');
  await page.click('[data-side="front"]');
  await page.keyboard.press('Escape');
  const shape = async () => silhouette(await site.picture()).box;
  const whole = await shape();
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press('x');
  await page.check('#section-along [value="x"]', { force: true });
  await site.settled();
  assert.match(await page.innerText('#section-words'), /^x = [-−]?0(\.0\d*)?$/);
  const half = await shape();
  assert.ok(Math.abs(half.width / half.height - 0.5) < 0.06, JSON.stringify([whole, half]));
  await page.focus('#section-place');
  for (let i = 0; i < 50; i++) await page.keyboard.press('ArrowRight');
  await site.settled();
  const more = await shape();
  assert.ok(Math.abs(more.width / more.height - 0.75) < 0.06, JSON.stringify(more));
  await page.click('#section-flip');
  await site.settled();
  const less = await shape();
  assert.ok(less.width / less.height < 0.35, JSON.stringify(less));
  await page.keyboard.press('m');
  assert.ok(await page.isHidden('#section-bar') && await page.isVisible('#measure-bar'), 'it is measured in the section');
  await page.keyboard.press('Escape');
  assert.ok(await page.isVisible('#section-bar'));
  await page.keyboard.press('Escape');
  assert.ok(await page.isHidden('#section-bar'));
  await page.evaluate(() => document.activeElement.blur());
  await site.settled();
  const again = await shape();
  assert.ok(Math.abs(again.width / again.height - whole.width / whole.height) < 0.02, JSON.stringify([again, whole]));
  assert.deepEqual(site.faults, []);
});
