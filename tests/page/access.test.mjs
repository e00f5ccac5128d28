// For everybody: axe finds nothing, whatever is open; the keyboard is enough; old browsers are told why.

import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { test } from 'node:test';
import { PATIENCE, start } from './browser.mjs';
import { spherePoints, toXyz } from './scans.mjs';

const AXE = await readFile(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const small = toXyz(spherePoints(1500));

/** What axe holds against the page as it is now. */
async function violations({ page }) {
  // The page's own policy forbids scripts of others; the debugger may add one.
  if (!(await page.evaluate(() => 'axe' in globalThis))) await page.evaluate(AXE);
  const found = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ['violations'] }));
  return found.violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target.join(' ')).join(', ')}`);
}

for (const colorScheme of ['light', 'dark']) {
  test(`axe finds nothing, ${colorScheme}`, { timeout: PATIENCE }, async (t) => {
    const server = await start(t);
    const site = await server.open({ colorScheme }, undefined, `?src=${server.serve('ball.xyz', small)}`);
    const { page } = site;
    await site.opened('ball.xyz');
    assert.deepEqual(await violations(site), [], 'as it opens');
    for (const id of ['more', 'web', 'formats', 'share', 'comparison', 'made']) await page.click(`#${id} > summary`);
    await page.check('input[name="preset"][value="thumbnail"]');
    await page.waitForSelector('#web-files .format', { timeout: PATIENCE });
    await page.waitForFunction(() => /Each dot/.test(document.querySelector('#chart-note').textContent), null, { timeout: PATIENCE });
    await site.paint('error');
    await page.keyboard.press('4');
    assert.deepEqual(await violations(site), [], 'with everything unfolded, and a legend');
    await page.click('#camera-menu > summary');
    assert.deepEqual(await violations(site), [], 'with a menu');
    await page.keyboard.press('Escape');
    await site.drop('holiday.jpg', Buffer.from([0xff, 0xd8, 0xff, 0xe0]));
    await page.waitForSelector('#message:not([hidden])');
    assert.deepEqual(await violations(site), [], 'with a message');
    await page.keyboard.press('Escape');
    assert.equal(await page.isVisible('#message'), false);
    await page.click('#help-open');
    assert.deepEqual(await violations(site), [], 'with the list of keys');
    assert.deepEqual(site.faults, []);
  });
}

test('with the keyboard alone: choose a sample, settings, a view, save', { timeout: PATIENCE }, async (t) => {
  const server = await start(t);
  const site = await server.open({}, undefined, `?src=${server.serve('ball.xyz', small)}`);
  const { page } = site;
  await site.opened('ball.xyz');
  const focus = () => page.evaluate(() => document.activeElement?.id || document.activeElement?.getAttribute('data-sample') || document.activeElement?.parentElement?.id);
  const tabTo = async (id) => {
    for (let k = 0; k < 60; k++) {
      if ((await focus()) === id) return;
      await page.keyboard.press('Tab');
    }
    assert.fail(`${id} is not reached with Tab, the focus is on ${await focus()}`);
  };
  const restart = () => page.evaluate(() => /** @type {HTMLElement} */ (document.activeElement).blur());

  // The first stop leads past the picture.
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement?.className), 'skip');
  await restart();

  await page.keyboard.press('?');
  assert.ok(await page.isVisible('#help'));
  assert.match(await page.innerText('#help-keys'), /Fit the view/);
  await page.keyboard.press('1');
  assert.equal(await site.view(), 'mesh', 'keys are not heard behind the list');
  await page.keyboard.press('Escape');
  assert.equal(await page.isVisible('#help'), false);

  await tabTo('paint-menu');
  await page.keyboard.press('Enter');
  await page.keyboard.press('Tab');
  await page.keyboard.press('ArrowDown');
  assert.equal(await page.$eval('input[name="paint"]:checked', (input) => input.value), 'normals');
  await page.keyboard.press('Escape');
  assert.equal(await focus(), 'paint-menu', 'the focus goes back to the menu');

  await tabTo('part');
  await page.keyboard.press('Enter');
  await site.opened('Machined part');
  await tabTo('keep-field');
  await page.keyboard.press('Control+A');
  await site.remade(() => page.keyboard.type('5'));
  assert.equal(await site.number('outputPoints'), 3000);
  await restart();
  await page.keyboard.press('2');
  assert.equal(await site.view(), 'reduced');
  assert.equal(await page.textContent('#live'), 'Reduced points is shown');
  await tabTo('save');
  await page.waitForSelector('#save:enabled');
  const saved = page.waitForEvent('download');
  await page.keyboard.press('Space');
  assert.match((await saved).suggestedFilename(), /^part-mesh\./);
  assert.deepEqual(site.faults, []);
});

test('on a phone: fewer points of its own accord, and a message that hides no title', { timeout: PATIENCE }, async (t) => {
  const server = await start(t);
  const phone = { viewport: { width: 360, height: 740 }, deviceScaleFactor: 1, isMobile: true, hasTouch: true };
  const site = await server.open(phone, undefined, `?src=${server.serve('many.xyz', toXyz(spherePoints(70_000)))}`);
  const { page } = site;
  await site.opened('many.xyz');
  assert.equal(await site.number('outputPoints'), 20_000);
  await site.drop('holiday.jpg', Buffer.from([0xff, 0xd8, 0xff, 0xe0]));
  await page.waitForSelector('#message:not([hidden])');
  const [card, caption] = await Promise.all(['#message', '.caption'].map((part) => page.locator(part).boundingBox()));
  assert.ok(card.y >= caption.y + caption.height, 'the message lies under the caption');
  assert.ok(card.y + card.height <= 740 && card.x >= 0 && card.x + card.width <= 360);
  await page.tap('#message-close');
  await page.tap('#paint-menu > summary');
  const sheet = await page.locator('#paint-menu .sheet').boundingBox();
  assert.ok(sheet.x >= 0 && sheet.x + sheet.width <= 360 && sheet.y + sheet.height <= 740, 'menus fit on the screen');
  for (const input of await page.$$('#paint-menu .sheet input:enabled')) await input.click({ trial: true, timeout: 5000 });
});

test('a phone on its side: the page scrolls beside a picture that stays, and nothing is cut off', { timeout: PATIENCE }, async (t) => {
  const server = await start(t);
  const phone = { viewport: { width: 740, height: 360 }, deviceScaleFactor: 1, isMobile: true, hasTouch: true };
  const site = await server.open(phone, undefined, `?src=${server.serve('small.xyz', toXyz(spherePoints(800)))}`);
  const { page } = site;
  await site.opened('small.xyz');
  const inside = async (part) => {
    const box = await page.locator(part).boundingBox();
    assert.ok(box.x >= 0 && box.y >= 0 && box.x + box.width <= 740 && box.y + box.height <= 360, `${part}: ${JSON.stringify(box)}`);
  };
  for (const part of ['#stage', '#views', '.tools', '#choose']) await inside(part);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= 740);
  const finger = await page.context().newCDPSession(page);
  const touch = (type, touchPoints) => finger.send('Input.dispatchTouchEvent', { type, touchPoints });
  await touch('touchStart', [{ x: 560, y: 250 }]);
  for (let y = 230; y >= 50; y -= 20) await touch('touchMove', [{ x: 560, y }]);
  await touch('touchEnd', []);
  await page.waitForFunction(() => scrollY > 100);
  for (const part of ['#stage', '#views', '.tools']) await inside(part);
  await page.tap('#paint-menu > summary');
  await inside('#paint-menu .sheet');
});

test('a browser without SIMD is told why nothing happens', { timeout: PATIENCE }, async (t) => {
  const noSimd = (page) => page.addInitScript(() => (WebAssembly.validate = () => false));
  const site = await (await start(t)).open({}, noSimd);
  await site.page.waitForSelector('#no-engine:visible');
  assert.match(await site.page.innerText('#no-engine'), /WebAssembly SIMD/);
  assert.deepEqual(await violations(site), []);
  assert.deepEqual(site.faults, []);
});
