// From a scan with a table to the object alone, as a person does it: suggested, shown, done, undone, and found again.

import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { test } from 'node:test';
import { PATIENCE, start } from './browser.mjs';
import { spherePoints, toPly, toXyz } from './scans.mjs';

const AXE = await readFile(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

/** A golden-ratio sequence: as good as random, and the same every time. */
const spread = (i, step) => (i * step) % 1;
const BALL = 6000;
const SMALL = 900;
const FLOOR = 14_000;
const STRAYS = 12;
/** A ball of radius 1 that stands on a floor of 8 by 8, a small ball beside it, and strays far from everything. */
const SCENE = [
  ...spherePoints(BALL).map(([x, y, z]) => [x, y, z + 1]),
  ...spherePoints(SMALL).map(([x, y, z]) => [2.4 + 0.4 * x, 0.4 * y, 0.9 + 0.4 * z]),
  ...Array.from({ length: FLOOR }, (_, i) => [8 * spread(i, 0.7548776662) - 4, 8 * spread(i, 0.5698402911) - 4, 0.004 * (spread(i, 0.6180339887) - 0.5)]),
  ...Array.from({ length: STRAYS }, (_, i) => [3.5 * Math.cos(i), 3.5 * Math.sin(i), 3 + 0.4 * i]),
];

async function openScene(t, options, path = '', bytes = toPly(SCENE)) {
  const server = await start(t);
  const site = await server.open({ viewport: { width: 1280, height: 820 }, ...options }, undefined, `?src=${server.serve('scene.ply', bytes)}#count=1500${path}`);
  await site.opened('scene.ply');
  return site;
}

/** Waits until a tool says what it would do. */
const told = async ({ page }, words) => {
  await page.waitForFunction((text) => new RegExp(text).test(document.querySelector('#tidy-words').textContent), words.source, { timeout: 60_000 });
  return page.innerText('#tidy-words');
};
const take = async (site, tool, words) => {
  await site.page.click(`[data-tool="${tool}"]`);
  return told(site, words);
};
const left = ({ page }) => page.evaluate(() => Number(/\d[\d,]*/.exec(document.querySelector('#caption-detail').textContent)[0].replace(/,/g, '')));
const recipe = ({ page }) => JSON.parse(new URLSearchParams(new URL(page.url()).hash.slice(1)).get('prepare') ?? '[]');
const steps = ({ page }) => page.$$eval('#tidy-steps .check > span:first-of-type', (rows) => rows.map((row) => row.textContent));

test('floor, pieces, strays: each is shown, done, switched off and on, undone, and found again', { timeout: PATIENCE }, async (t) => {
  const site = await openScene(t);
  const { page } = site;

  await page.waitForSelector('#suggestion:not([hidden])');
  assert.match(await page.innerText('#suggestion-words'), /^6\d % of these points are one flat plane\. Remove the floor\?$/);
  assert.equal(await left(site), SCENE.length, 'nothing is done by itself');
  await page.click('#suggestion-yes');
  assert.match(await told(site, /would go/), /^6\d %/);
  assert.equal(await site.view(), 'points');
  await page.evaluate(AXE);
  const found = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ['violations'] }));
  assert.deepEqual(found.violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target)}`), []);
  await page.locator('#tidy-height').fill('60');
  await told(site, /7\d %|6\d %/);
  await page.locator('#tidy-height').fill('0');
  await told(site, /6\d %/);
  await site.remade(() => page.click('#tidy-apply'));
  assert.ok(await page.isHidden('#tidy-bar'));
  const objects = BALL + SMALL + STRAYS;
  assert.ok(Math.abs(await left(site) - objects) < 0.02 * objects, `${await left(site)} of ${objects}`);
  assert.deepEqual(recipe(site), [{ step: 'plane', drop: 'floor' }]);
  assert.equal(await site.number('inputPoints'), await left(site));

  // Pieces: the small ball is chosen by a click on it, and by its row in the list.
  await take(site, 'pieces', /stay/);
  await page.click('#tidy-cancel');
  assert.equal(await page.evaluate(() => document.activeElement?.getAttribute('data-tool')), 'pieces', 'the focus goes back');
  await take(site, 'pieces', /stay/);
  const before = await page.innerText('#tidy-words');
  await page.focus('#tidy-pieces-list input[value="1"]');
  await page.keyboard.press('Space');
  assert.notEqual(await told(site, /9\d %|100 %/), before);
  await page.keyboard.press('Space');
  await told(site, /8\d %/);
  await site.remade(() => page.click('#tidy-apply'));
  assert.ok(Math.abs(await left(site) - BALL) < 0.02 * BALL, `${await left(site)} of ${BALL}`);
  assert.deepEqual(await steps(site), ['Floor removed', 'Main piece kept']);
  const alone = await left(site);

  // Off and on again, undo by key, redo by button.
  await site.remade(() => page.uncheck('#tidy-step-1'));
  assert.ok(await left(site) > alone);
  assert.deepEqual(recipe(site)[1], { step: 'pieces', keep: 'largest', off: true });
  await page.evaluate(() => document.activeElement.blur());
  await site.remade(() => page.keyboard.press('Control+z'));
  assert.equal(await left(site), alone);
  assert.ok(await page.isChecked('#tidy-step-1'));
  await site.remade(() => page.click('#redo'));
  await page.click('#tidy-remove-1'); // which is off: the same is left
  await page.waitForFunction(() => document.querySelectorAll('#tidy-steps li').length === 1);
  await page.click('#undo');
  await page.waitForFunction(() => document.querySelectorAll('#tidy-steps li').length === 2);
  await site.remade(() => page.click('#undo'));
  assert.equal(await left(site), alone);

  await page.reload();
  await site.opened('scene.ply');
  assert.equal(await left(site), alone);
  assert.deepEqual(await steps(site), ['Floor removed', 'Main piece kept']);
  assert.ok(await page.isHidden('#suggestion'), 'nothing is suggested where something was done');

  await site.remade(() => page.click('#tidy-remove-1'));
  assert.match(await take(site, 'strays', /would go/), /^(1[2-9]|[2-9]\d) points would go/);
  await page.keyboard.press('Escape');
  assert.ok(await page.isHidden('#tidy-bar'));
  assert.deepEqual(site.faults, []);
});

test('box, rectangle and lasso, and a recipe that an address brings', { timeout: PATIENCE }, async (t) => {
  // The small ball is left of 3.2 along x; and a step that leaves nothing.
  const path = `&prepare=${encodeURIComponent(JSON.stringify([{ step: 'box', min: [-4.1, -4.1, 0.05], max: [3.2, 4.1, 2.1] }, { step: 'sphere', center: [0, 0, 90], radius: 1 }]))}`;
  const site = await openScene(t, {}, path);
  const { page } = site;
  assert.match(await site.message(), /A step of the tidying cannot be done/);
  await page.keyboard.press('Escape');
  assert.deepEqual(recipe(site).map(({ off }) => Boolean(off)), [false, true]);
  const whole = await left(site);
  assert.ok(Math.abs(whole - 0.975 * BALL - SMALL) < 0.01 * BALL, `${whole}`);
  await page.click('#tidy-remove-1');
  await page.waitForFunction(() => document.querySelectorAll('#tidy-steps li').length === 1);

  // A face is moved by keys and by the pointer, the box is turned by a number.
  await take(site, 'crop', /100 %/);
  assert.ok(await page.isDisabled('#tidy-apply'));
  await page.fill('[data-crop="x-max"]', '1.5');
  assert.match(await told(site, /8\d %/), /inside of the box/);
  const handle = page.getByRole('button', { name: 'Upper face along x' });
  await handle.focus();
  await page.keyboard.press('Shift+ArrowLeft');
  await page.waitForFunction(() => Number(document.querySelector('[data-crop="x-max"]').value) < 1.5);
  await page.keyboard.press('Shift+ArrowRight');
  const { x, y } = await handle.boundingBox();
  await page.mouse.move(x + 22, y + 22);
  await page.mouse.down();
  await page.mouse.move(x + 62, y + 22, { steps: 3 });
  await page.mouse.up();
  assert.ok(Math.abs(Number(await page.inputValue('[data-crop="x-max"]')) - 1.5) > 0.05);
  await page.fill('[data-crop="x-max"]', '1.5');
  await page.fill('[aria-label="Turned about z, in degrees"]', '90');
  await told(site, /9\d %|8\d %|7\d %/);
  await page.fill('[aria-label="Turned about z, in degrees"]', '0');
  await told(site, /8\d %/);
  await site.remade(() => page.click('#tidy-apply'));
  assert.ok(Math.abs(await left(site) - 0.975 * BALL) < 0.01 * BALL, `${await left(site)}`);

  // Half of the picture by numbers, straight from the front.
  await page.click('#camera-menu > summary');
  await page.click('[data-side="front"]');
  await page.keyboard.press('Escape');
  await take(site, 'rectangle', /Drag over points/);
  await page.fill('[data-select] >> nth=0', '0');
  await page.fill('[data-select] >> nth=1', '0');
  await page.fill('[data-select] >> nth=3', '100');
  await page.fill('[data-select] >> nth=2', '50');
  await told(site, /selected/);
  const before = await left(site);
  await site.remade(() => page.click('#tidy-cut'));
  assert.ok(Math.abs(await left(site) - before / 2) < 0.1 * before, `${await left(site)} of ${before}`);
  await site.remade(() => page.click('#undo'));
  assert.equal(await left(site), before);

  // A lasso, to which another is added, and of which a third is taken away.
  await take(site, 'lasso', /Draw around points/);
  const canvas = await page.locator('#canvas').boundingBox();
  const draw = async (at, size, key) => {
    if (key) await page.keyboard.down(key);
    for (let k = 0; k <= 16; k++) {
      const angle = (2 * Math.PI * k) / 16;
      await page.mouse.move(canvas.x + canvas.width * at + size * Math.cos(angle), canvas.y + canvas.height / 2 + size * Math.sin(angle));
      if (k === 0) await page.mouse.down();
    }
    await page.mouse.up();
    if (key) await page.keyboard.up(key);
    return Number((await told(site, /selected/)).match(/^[\d,]+/)[0].replace(/,/g, ''));
  };
  const chosen = async (former, act) => {
    await act();
    await page.waitForFunction((text) => document.querySelector('#tidy-words').textContent !== text, former);
    return Number((await page.innerText('#tidy-words')).match(/^[\d,]+/)[0].replace(/,/g, ''));
  };
  const words = () => page.innerText('#tidy-words');
  const one = await draw(0.46, 50);
  const two = await chosen(await words(), () => draw(0.54, 50, 'Shift'));
  const less = await chosen(await words(), () => draw(0.5, 30, 'Alt'));
  assert.ok(two > 1.4 * one && less < two && less > 0.5 * one, `${one}, ${two}, ${less}`);
  await site.remade(() => page.click('#tidy-apply'));
  assert.ok(Math.abs(await left(site) - less) <= 0.02 * less + 3, `${await left(site)} of ${less}`);
  assert.equal(recipe(site).at(-1).step, 'polygon');
  assert.deepEqual(site.faults, []);
});

test('on a phone: fingers draw and cut; a length that is known makes all of it as large', { timeout: PATIENCE }, async (t) => {
  const site = await openScene(t, { viewport: { width: 360, height: 740 }, isMobile: true, hasTouch: true }, '', toXyz(spherePoints(3000)));
  const { page } = site;
  await page.locator('[data-tool="rectangle"]').tap();
  await told(site, /Drag over points in the picture\.$/);
  const canvas = await page.locator('#canvas').boundingBox();
  assert.ok(canvas.y >= -1 && canvas.y + canvas.height <= 741, 'the picture is in sight');
  const finger = await page.context().newCDPSession(page);
  const touch = (type, ...at) => finger.send('Input.dispatchTouchEvent', { type, touchPoints: at });
  await touch('touchStart', { x: canvas.x + 5, y: canvas.y + 70 });
  for (const share of [0.2, 0.35, 0.5]) await touch('touchMove', { x: canvas.x + share * canvas.width, y: canvas.y + 0.65 * canvas.height });
  await touch('touchEnd');
  await told(site, /selected/);
  await site.remade(() => page.locator('#tidy-cut').tap());
  assert.ok(await left(site) < 2500, `${await left(site)}`);
  await site.remade(() => page.click('#undo'));

  // Two places on the ball: what is between them is said to be 50 mm, a length of the file twice as long.
  await page.click('#standing > summary');
  await page.click('#measure');
  const stage = await page.locator('#canvas').boundingBox();
  for (const share of [0.3, 0.5]) await page.touchscreen.tap(stage.x + share * stage.width, stage.y + 0.4 * stage.height);
  const raw = Number((await page.innerText('#measure-words')).replace(/^Length: /, ''));
  assert.ok(raw > 0.1 && raw < 2, `${raw}`);
  await page.fill('#measure-length', String(25 * raw));
  await page.click('#measure-set');
  assert.match(await page.innerText('#measure-words'), /^Length: [\d.]+ mm$/);
  await page.touchscreen.tap(stage.x + 0.45 * stage.width, stage.y + 0.5 * stage.height);
  assert.match(await page.innerText('#measure-words'), /^Angle at the second place: \d+(\.\d+)?°$/);
  await page.click('#measure-close');
  assert.match(await page.innerText('#scale-words'), /shown and saved 25× as large/);
  await page.click('#formats > summary');
  const saved = page.waitForEvent('download');
  await page.click('#save-reduced-xyz');
  const rows = (await readFile(await (await saved).path(), 'utf8')).trim().split('\n').map((row) => row.split(/\s+/).map(Number)).filter((row) => row.length > 2 && row.every(Number.isFinite));
  const radius = Math.max(...rows.map(([x, y, z]) => Math.hypot(x, y, z)));
  assert.ok(Math.abs(radius - 25) < 0.7, `${radius}`);
  await page.click('#scale-reset');
  assert.ok(await page.isHidden('#scale-note'));
  assert.deepEqual(site.faults, []);
});

test('a sample as one gets it: floor, strays and the main piece leave the duck alone', { timeout: PATIENCE }, async (t) => {
  const site = await (await start(t)).open({}, undefined, '#sample=desk&count=3000');
  const { page } = site;
  await site.made();
  await page.waitForSelector('#suggestion:not([hidden])');
  await page.click('#suggestion-yes');
  await told(site, /would go/);
  await site.remade(() => page.click('#tidy-apply'));
  for (const [tool, words] of [['strays', /would go/], ['pieces', /stay/]]) {
    await take(site, tool, words);
    await site.remade(() => page.click('#tidy-apply'));
  }
  const duck = 0.482 * 60_000;
  const all = await left(site);
  assert.ok(all > 0.98 * duck && all < 1.05 * duck, `${all} of ${duck}`);
  assert.match(page.url(), /sample=desk/);
  await site.pictureOf('mesh', 'desk');
  assert.deepEqual(site.faults, []);
});
