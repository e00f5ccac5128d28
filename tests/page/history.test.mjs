// What the page shows is one value with a history: undo, redo, Back, and a reload that finds all of it again.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { PATIENCE, start } from './browser.mjs';
import { difference } from './pictures.mjs';
import { spherePoints, toXyz } from './scans.mjs';

const ball = toXyz(spherePoints(1200));
/** Two balls: two pieces. */
const pair = toXyz([...spherePoints(700), ...spherePoints(700).map(([x, y, z]) => [x + 4, y, z])]);

test('steps back and forth, and a reload', { timeout: PATIENCE }, async (t) => {
  const server = await start(t);
  const requests = [];
  const site = await server.open({}, (opened) => opened.on('request', (request) => requests.push(request)), `?src=${server.serve('ball.xyz', ball)}#count=600`);
  const { page } = site;
  await site.opened('ball.xyz');
  const kept = (count) => page.waitForFunction((wanted) => document.querySelector('#app').dataset.state === 'ready'
    && document.querySelector('#numbers').dataset.fresh === 'true'
    && document.querySelector('[data-number="outputPoints"]').value === String(wanted), count, { timeout: PATIENCE });

  await t.test('settings: undo and redo by buttons, keys and the browser', async () => {
    assert.ok(await page.isDisabled('#undo') && await page.isDisabled('#redo'));
    await site.remade(() => page.fill('#keep-field', '500'));
    await site.remade(() => page.selectOption('#option-boundary', 'closed'));
    await page.click('#undo');
    await kept(500);
    assert.equal(await page.inputValue('#option-boundary'), 'auto');
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press('Control+z');
    await kept(600);
    assert.match(page.url(), /#count=600$/);
    assert.ok(await page.isDisabled('#undo'), 'the first step');
    await page.keyboard.press('Control+Shift+z');
    await kept(500);
    await page.goBack();
    await kept(600);
    await page.goForward();
    await kept(500);
    await page.click('#redo');
    await page.waitForFunction(() => document.querySelector('#option-boundary').value === 'closed');
    assert.ok(await page.isDisabled('#redo'));
    await page.click('#undo');
    await kept(500);
  });

  await t.test('a look is no step, and a new step forgets those that were undone', async () => {
    await page.keyboard.press('1');
    await page.click('#undo');
    await kept(600);
    await site.remade(() => page.fill('#keep-field', '550'));
    assert.ok(await page.isDisabled('#redo'));
  });

  await t.test('a file of the person’s: Back goes to the scan before, Forward to the file', async () => {
    await site.drop('pair.xyz', pair);
    await site.opened('pair.xyz');
    assert.doesNotMatch(page.url(), /pair/);
    await page.goBack();
    await site.opened('ball.xyz');
    await kept(550);
    await page.goForward();
    await site.opened('pair.xyz');
    await kept(550);
  });

  await t.test('unit, side up and a piece that was flipped are steps, too', async () => {
    await page.click('#standing > summary');
    await page.selectOption('#stand-unit', 'cm');
    await page.selectOption('#stand-up', 'x');
    await page.click('#flip-piece');
    await page.focus('#canvas');
    await page.keyboard.press('3');
    const { x, y, width, height } = await page.locator('#canvas').boundingBox();
    for (let k = 0; k < 40 && await page.getAttribute('#flip-piece', 'aria-pressed') === 'true'; k++) {
      await page.mouse.click(x + width / 2, y + height * (0.2 + 0.015 * k));
    }
    assert.match(await page.innerText('#side-words'), /a piece was turned by hand/);
    await page.click('#undo');
    await page.waitForFunction(() => !/by hand/.test(document.querySelector('#side-words').textContent));
    await page.click('#undo');
    await page.waitForFunction(() => document.querySelector('#stand-up').value !== 'x');
    assert.equal(await page.inputValue('#stand-unit'), 'cm');
    for (let k = 0; k < 2; k++) {
      await page.click('#redo');
      await page.waitForFunction((wanted) => (wanted ? /by hand/.test(document.querySelector('#side-words').textContent) : document.querySelector('#stand-up').value === 'x'), k);
    }
  });

  await t.test('a reload finds the file, its settings and what was said of it', async () => {
    await page.reload();
    await site.opened('pair.xyz');
    await kept(550);
    assert.equal(await page.inputValue('#stand-unit'), 'cm');
    assert.equal(await page.inputValue('#stand-up'), 'x');
    assert.match(await page.innerText('#side-words'), /a piece was turned by hand/);
    await page.click('#undo');
    await page.waitForFunction(() => !/by hand/.test(document.querySelector('#side-words').textContent));
    assert.equal(await page.isDisabled('#redo'), false);
    const origin = new URL(page.url()).origin;
    for (const request of requests) {
      assert.ok(request.method() === 'GET' && (request.url().startsWith(origin) || /^(blob|data):/.test(request.url())), `nothing is sent: ${request.url()}`);
    }
  });

  await t.test('what is kept can be forgotten', async () => {
    await page.click('#forget');
    await page.waitForSelector('#kept', { state: 'hidden' });
    await page.reload();
    await site.opened('Toy duck');
    assert.match(await site.message(), /not kept any more[^]*A sample is shown instead/);
  });

  assert.deepEqual(site.faults, []);
});

test('a mesh that was kept stands beside one of other settings, with sizes and errors', { timeout: PATIENCE }, async (t) => {
  const server = await start(t);
  const site = await server.open({}, undefined, `?src=${server.serve('ball.xyz', ball)}#count=900`);
  const { page } = site;
  await site.opened('ball.xyz');
  assert.equal(await page.isEnabled('#split-left option[value="kept"]'), false);
  const many = await site.pictureOf('mesh');
  const error = await page.innerText('[data-number="errorRmsShare"]');
  await page.click('#keep-mesh');
  await site.remade(() => page.fill('#keep-field', '300'));
  assert.equal(await site.view(), 'compare');
  const [left, right] = [await page.innerText('#split-left-words'), await page.innerText('#split-right-words')];
  assert.match(left, /^900 points, [\d.]+K triangles, RMS /);
  assert.ok(left.endsWith(error), `${left} has ${error}`);
  assert.match(right, /^300 points, \d+ triangles, RMS /);
  const both = await site.picture();
  assert.ok(difference(both, many, 0, 0.49) < 0.001, 'the kept mesh is at the left');
  const highest = async () => Number(await page.$$eval('#legend .legend-ends data', (ends) => ends.at(-1).value));
  await site.paint('error');
  const scale = await highest();
  await page.selectOption('#split-left', 'points');
  await page.selectOption('#split-right', 'kept');
  assert.equal(await highest(), scale, 'errors of both have one scale');
  await page.selectOption('#split-left', 'kept');
  await page.selectOption('#split-right', 'mesh');
  await site.paint('natural');
  assert.ok(difference(both, await site.pictureOf('mesh'), 0.51, 1) < 0.001, 'the one of now at the right');
  await site.remade(() => page.fill('#keep-field', '400'));
  assert.equal(await site.view(), 'mesh', 'who looks at something else stays there');
  await site.drop('pair.xyz', pair);
  await site.opened('pair.xyz');
  assert.equal(await page.inputValue('#split-left'), 'points', 'another scan has nothing to compare with');
  assert.deepEqual(site.faults, []);
});
