// The page where its address names a tileset.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';
import { tileset } from '../element/tilesets.mjs';
import { start } from './browser.mjs';
import { silhouette } from './pictures.mjs';

const PATIENCE = 60_000;

test('a tileset streams: how much is shown is said, what makes no sense is away, and a scan brings the page back', async (t) => {
  const site = await start(t);
  for (const [path, body] of await tileset({ origin: [400_000.125, 5_700_000.5, 100.375] })) site.serve(`hills/${path}`, body);
  const opened = await site.open({}, undefined, '?src=dropped/hills/tileset.json');
  const { page, faults } = opened;
  await page.locator('#app[data-state=ready]').waitFor({ timeout: PATIENCE });
  const number = (name) => page.locator(`data[data-stream=${name}]`).evaluate(({ value }) => Number(value));
  await page.waitForFunction(() => document.querySelector('data[data-stream=tiles]').value > 1 && document.querySelector('data[data-stream=loading]').value === '0');
  assert.equal(await number('total'), 128 ** 2);
  const shown = await number('points');
  assert.ok(shown > 32 ** 2 && shown <= 128 ** 2);
  assert.equal(await page.locator('#caption-detail').textContent(), `${shown.toLocaleString('en')} of 16,384 points shown`);
  assert.match(await page.locator('data[data-stream=bytes]').textContent(), /^\d+ kB of 268 MB$/);
  assert.equal(await page.locator('#caption-size').textContent(), '100 × 100 × 20');
  for (const away of ['#views', '#save', '#keep-slider', '#tidy', '#numbers', '#samples']) assert.equal(await page.locator(away).isVisible(), false, away);
  for (const there of ['#fit', '#up', '#picture', '#stream-measure', '.note']) assert.equal(await page.locator(there).isVisible(), true, there);
  assert.ok(silhouette(await page.locator('#canvas').screenshot(), 30).area > 20_000);
  if (process.env.POINTWEAVE_PICTURES) await page.screenshot({ path: join(process.env.POINTWEAVE_PICTURES, 'streamed.png') });

  await page.keyboard.press('m');
  const { x, y, width, height } = await page.locator('#canvas').boundingBox();
  for (const dx of [-60, 60]) await page.mouse.click(x + width / 2 + dx, y + height / 2);
  const length = /Length: ([\d.]+)/.exec(await page.locator('#measure-words').textContent());
  assert.ok(Number(length?.[1]) > 5 && Number(length[1]) < 60, await page.locator('#measure-words').textContent());
  assert.equal(await page.locator('#measure-real').isVisible(), false);
  await page.keyboard.press('Escape');
  assert.deepEqual(faults, []);

  const points = Array.from({ length: 300 }, (_, i) => `${Math.cos(i)} ${Math.sin(i)} ${i / 300}`).join('\n');
  await page.locator('#file').setInputFiles({ name: 'ring.xyz', mimeType: 'text/plain', buffer: Buffer.from(points) });
  await page.waitForFunction(() => document.querySelector('#caption-title').textContent === 'ring.xyz' && document.querySelector('#app').dataset.state === 'ready', undefined, { timeout: PATIENCE });
  assert.equal(new URL(page.url()).search, '');
  assert.equal(await page.locator('#save').isVisible(), true);
});

test('a tileset that is none, is elsewhere or does not come says so', async (t) => {
  const site = await start(t);
  site.serve('none.json', Buffer.from('{"asset":{"version":"1.0"}}'));
  for (const [src, title] of [
    ['dropped/none.json', /breaks the rules/], ['dropped/nowhere.json', /could not be fetched/], ['https://example.org/tileset.json', /another server/],
  ]) {
    const { page } = await site.open({}, undefined, `?src=${encodeURIComponent(src)}`);
    await page.locator('#message').waitFor();
    assert.match(await page.locator('#message-title').textContent(), title);
    await page.close();
  }
});
