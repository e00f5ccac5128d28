// The page as a person uses it, in both builds of the engine.

import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { test } from 'node:test';
import { PATIENCE, start } from './browser.mjs';
import { difference, meanColor, overlap, silhouette } from './pictures.mjs';

const DUCK = 35_647;

/** Opens the page and waits for the sample. */
async function withSample(t, server = {}, options = {}, prepare = undefined) {
  const site = await (await start(t, server)).open(options, prepare);
  await site.made();
  return site;
}

/** Remembers the graphics contexts of the page: its canvases share one that is in no document. */
const noteContexts = (page) => page.addInitScript(() => {
  globalThis.contexts = [];
  const original = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
    const context = original.call(this, kind, ...rest);
    if (kind === 'webgl2' && context) globalThis.contexts.push(context);
    return context;
  };
});

for (const isolated of [true, false]) {
  test(`opens with a meshed sample, ${isolated ? 'isolated: threads' : 'not isolated: one thread'}`, { timeout: PATIENCE }, async (t) => {
    const requests = [];
    const watch = async (page) => page.on('request', (request) => requests.push(request));
    const site = await withSample(t, { isolated }, {}, watch);

    assert.equal(await site.view(), 'mesh');
    assert.equal(await site.number('inputPoints'), DUCK);
    assert.equal(await site.number('outputPoints'), Math.round(DUCK / 3));
    assert.equal(await site.number('components'), 1);
    assert.match(await site.page.textContent('#engine'), isolated ? /^\d+ threads$/ : /^one thread$/);
    if (!isolated) assert.match(await site.page.textContent('#engine-reason'), /not cross-origin isolated/);
    assert.equal(await site.page.isVisible('#message'), false);

    const mesh = silhouette(await site.pictureOf('mesh')).closed(6);
    const scan = silhouette(await site.pictureOf('points')).closed(6);
    assert.ok(overlap(mesh, scan) > 0.8, 'the mesh covers what the scan covers');
    const [red, green, blue] = meanColor(await site.pictureOf('mesh'), mesh);
    assert.ok(red > green && green > 2 * blue, `a yellow duck with an orange beak: ${[red, green, blue].map(Math.round)}`);

    assert.deepEqual(site.faults, []);
    const origin = new URL(site.page.url()).origin;
    for (const request of requests) {
      assert.equal(request.method(), 'GET', `nothing is sent: ${request.url()}`);
      assert.ok(request.url().startsWith(origin) || /^(blob|data):/.test(request.url()), `only this server is asked: ${request.url()}`);
    }
  });
}

test('one visit', { timeout: 2 * PATIENCE }, async (t) => {
  const site = await withSample(t, {}, {}, noteContexts);
  const { page } = site;

  await t.test('keyboard alone', async () => {
    for (const [key, view] of [['1', 'points'], ['2', 'reduced'], ['3', 'mesh']]) {
      await page.keyboard.press(key);
      assert.equal(await site.view(), view);
    }
    await page.focus('#canvas');
    const front = await site.picture();
    for (let k = 0; k < 6; k++) await page.keyboard.press('ArrowRight');
    const side = await site.picture();
    assert.ok(difference(front, side) > 0.05, 'the arrows turn the model');
    await page.keyboard.press('-');
    await page.keyboard.press('-');
    assert.ok(silhouette(await site.picture()).area < 0.9 * silhouette(side).area, 'minus goes away');
    await page.keyboard.press('f');
    await site.settled();
    const fitted = silhouette(await site.picture());
    assert.ok(Math.max(fitted.box.width / fitted.width, fitted.box.height / fitted.height) > 0.7, 'F fits the view');

    // Keys belong to the field while one types in it.
    await page.focus('#keep-field');
    await page.keyboard.press('1');
    assert.equal(await site.view(), 'mesh');

    // Every control is reached with Tab.
    const reached = new Set();
    await page.evaluate(() => /** @type {HTMLElement} */ (document.activeElement).blur());
    for (let k = 0; k < 40; k++) {
      await page.keyboard.press('Tab');
      reached.add(await page.evaluate(() => document.activeElement?.id || document.activeElement?.getAttribute('data-sample') || document.activeElement?.getAttribute('name')));
    }
    for (const id of ['choose', 'canvas', 'fit', 'up', 'view', 'duck', 'pig', 'part', 'keep-slider', 'keep-field', 'save']) {
      assert.ok(reached.has(id), `${id} is reached with Tab`);
    }
  });

  await t.test('mouse: drag turns, wheel zooms, buttons fit and stand up', async () => {
    const before = await site.picture();
    await page.mouse.move(400, 400);
    await page.mouse.down();
    await page.mouse.move(520, 420, { steps: 4 });
    await page.mouse.up();
    await site.settled();
    const turned = await site.picture();
    assert.ok(difference(before, turned) > 0.05, 'dragging turns the model');
    await page.mouse.wheel(0, 600);
    await site.settled();
    assert.ok(silhouette(await site.picture()).area < 0.9 * silhouette(turned).area, 'the wheel goes away');
    await page.click('#up');
    await page.click('#fit');
    await site.settled();
    assert.ok(difference(turned, await site.picture()) > 0.05, 'another side is up');
  });

  await t.test('downloads hold what the numbers say', async () => {
    await page.click('#formats > summary');
    for (const [button, pattern, number] of [
      ['#save-reduced-ply', /element vertex (\d+)/, 'outputPoints'],
      ['#save-mesh-ply', /element face (\d+)/, 'triangles'],
    ]) {
      const size = Number(await page.getAttribute(`${button} data`, 'value'));
      const saved = page.waitForEvent('download');
      await page.click(button);
      const download = await saved;
      assert.match(download.suggestedFilename(), /^duck-.*\.ply$/);
      const bytes = await readFile(await download.path());
      assert.equal(bytes.length, size, 'the size was shown first');
      assert.equal(Number(pattern.exec(bytes.toString('latin1', 0, 2000))?.[1]), await site.number(number));
    }
  });

  await t.test('a dragged file is shown where to go', async () => {
    const drag = (type) => page.evaluate((kind) => {
      const data = new DataTransfer();
      data.items.add(new File(['0 0 0'], 'scan.xyz'));
      document.body.dispatchEvent(new DragEvent(kind, { dataTransfer: data, bubbles: true, cancelable: true }));
    }, type);
    await drag('dragenter');
    assert.ok(await page.isVisible('#veil'));
    await drag('dragleave');
    assert.equal(await page.isVisible('#veil'), false);
  });

  await t.test('the picture comes back when the graphics context was lost', async () => {
    const before = await site.picture();
    const said = [];
    const hear = (message) => said.push(message.text());
    page.on('console', hear);
    const told = await page.evaluate(async () => {
      const note = document.querySelector('#graphics-lost');
      const [shared] = globalThis.contexts;
      const { canvas } = shared;
      const context = shared.getExtension('WEBGL_lose_context');
      const event = (type) => new Promise((heard) => canvas.addEventListener(type, heard, { once: true }));
      const lost = event('webglcontextlost');
      context.loseContext();
      await lost;
      const shown = note.checkVisibility();
      const restored = event('webglcontextrestored');
      setTimeout(() => context.restoreContext());
      await restored;
      return [shown, note.checkVisibility()];
    });
    await site.settled();
    page.off('console', hear);
    assert.deepEqual(told, [true, false], 'it is said as long as it is so');
    assert.deepEqual(said.filter((text) => /THREE/.test(text)), []);
    assert.ok(difference(before, await site.picture()) < 0.001);
  });

  await t.test('another share of the points gives exactly that many', async () => {
    const before = await site.number('triangles');
    await site.remade(() => page.fill('#keep-field', '12.5'));
    assert.equal(await site.number('outputPoints'), Math.round(DUCK * 0.125));
    assert.notEqual(await site.number('triangles'), before);

    // Several steps of the slider in a row: only the last one counts.
    await page.focus('#keep-slider');
    await site.remade(async () => {
      for (let step = 0; step < 5; step++) await page.keyboard.press('PageUp');
    });
    const share = Number(await page.inputValue('#keep-field')) / 100;
    assert.ok(share > 0.125, 'the slider moved the field');
    assert.equal(await site.number('outputPoints'), Math.round(DUCK * share));
  });

  await t.test('a job can be cancelled and started again', async () => {
    await page.click('[data-sample="pig"]');
    await page.waitForSelector('#app[data-state="working"]', { timeout: PATIENCE });
    await page.click('#cancel');
    await page.waitForSelector('#app[data-state="ready"]', { timeout: 1000 });
    assert.equal(await page.isVisible('#progress'), false);
    assert.ok(Number.isNaN(await site.number('triangles')), 'no number is left from the scan before');
    assert.ok(silhouette(await site.picture()).area > 0, 'the scan itself is shown');

    await page.fill('#keep-field', '5');
    await site.made();
    assert.equal(await site.number('outputPoints'), Math.round((await site.number('inputPoints')) * 0.05));
    assert.equal(await page.isVisible('#message'), false);
  });

  await t.test('bad files are explained, and the page goes on', async () => {
    const triangles = await site.number('triangles');
    const title = await page.innerText('#caption-title');
    const cut = Buffer.from('ply\nformat binary_little_endian 1.0\nelement vertex 1000\n'
      + 'property float x\nproperty float y\nproperty float z\nend_header\n\0\0\0\0');
    const cases = [
      ['empty.ply', Buffer.alloc(0), 'bad-file|unknown-format|empty-cloud'],
      ['cut.ply', cut, 'bad-file'],
      ['holiday.jpg', Buffer.from([0xff, 0xd8, 0xff, 0xe0, 0, 16, 0x4a, 0x46, 0x49, 0x46]), 'unknown-format'],
      ['broken.xyz', Buffer.from('0 0 0\n1 0 0\n0 1 zero\n'), 'bad-file'],
    ];
    for (const [name, bytes, codes] of cases) {
      await site.drop(name, bytes);
      await page.waitForSelector('#message:not([hidden])');
      const text = await site.message();
      assert.match(text, new RegExp(`\\[(${codes})\\]`), `${name}: ${text}`);
      assert.ok(text.includes(name), 'the file is named');
      if (text.includes('[bad-file]')) assert.match(text, /(line|byte) \d+/, 'the place is named');
      assert.equal(await page.getAttribute('#app', 'data-state'), 'ready');
      assert.equal(await site.number('triangles'), triangles, 'what was there is still there');
      if (name === 'broken.xyz') {
        await page.waitForSelector('#columns[open]', { timeout: 30_000 });
        await page.keyboard.press('Escape');
      }
      await page.click('#message-close');
    }
    assert.equal(await page.innerText('#caption-title'), title);

    // Three points on a line: they are shown, and it is said why there is no mesh.
    await site.drop('line.xyz', Buffer.from(Array.from({ length: 50 }, (_, i) => `${i} 0 0`).join('\n')));
    await page.waitForSelector('#message:not([hidden])');
    assert.match(await site.message(), /\[(degenerate|too-few-points)\]/);
    await site.settled();
    assert.ok(await page.isDisabled('input[name="view"][value="mesh"]'));

    await page.click('[data-sample="duck"]');
    await site.made();
    assert.equal(await site.number('inputPoints'), DUCK, 'a good scan after all');
    assert.ok((await site.number('triangles')) > 0);
    assert.equal(await page.isVisible('#message'), false);
  });

  assert.deepEqual(site.faults, []);
});

for (const colorScheme of ['light', 'dark']) {
  test(`a phone, 360 px wide, ${colorScheme}`, { timeout: PATIENCE }, async (t) => {
    const phone = { viewport: { width: 360, height: 740 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true, colorScheme };
    const site = await withSample(t, {}, phone);
    const width = await site.page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(width <= 360, `nothing sticks out: ${width} px`);

    const small = await site.page.$$eval('button, input[type="range"], input[type="number"], .views label', (controls) =>
      controls.filter((control) => control.checkVisibility())
        .map((control) => [control.id || control.textContent.trim(), control.getBoundingClientRect()])
        .filter(([, box]) => box.width < 44 || box.height < 44)
        .map(([name, box]) => `${name}: ${box.width} × ${box.height}`));
    assert.deepEqual(small, [], 'every target is at least 44 px');

    const paper = await site.page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const brightness = paper.match(/\d+/g).slice(0, 3).reduce((sum, value) => sum + Number(value), 0) / 3;
    assert.ok(colorScheme === 'dark' ? brightness < 60 : brightness > 200, `paper is ${paper}`);
    assert.ok(silhouette(await site.picture()).area > 0, 'the model is drawn');
  });
}

test('without WebGL it says so, and still computes', { timeout: PATIENCE }, async (t) => {
  const noWebgl = (page) => page.addInitScript(() => {
    const original = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return /webgl/.test(kind) ? null : original.call(this, kind, ...rest);
    };
  });
  const site = await (await start(t)).open({}, noWebgl);
  await site.made();
  assert.match(await site.page.locator('#no-webgl:visible').innerText(), /cannot be drawn/);
  assert.equal(await site.number('inputPoints'), DUCK);
  await site.page.waitForSelector('#save:enabled');
});
