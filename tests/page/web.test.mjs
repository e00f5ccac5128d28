// Save for the web: a model for a purpose, with its size and error, beside the scan.

import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { test } from 'node:test';
import { validateBytes } from 'gltf-validator';
import { PATIENCE, start } from './browser.mjs';
import { spherePoints, toXyz } from './scans.mjs';

test('a model is made when a purpose is chosen, shown beside the scan, and saved', { timeout: PATIENCE }, async (t) => {
  const server = await start(t);
  const site = await server.open({}, undefined, `?src=${server.serve('ball.xyz', toXyz(spherePoints(3000)))}`);
  const { page } = site;
  await site.opened('ball.xyz');
  assert.equal(await site.view(), 'mesh');
  await page.click('#web > summary');
  const choose = async (preset) => {
    await page.check(`input[name="preset"][value="${preset}"]`);
    await page.waitForSelector('#web-files .format', { timeout: PATIENCE });
    await page.waitForSelector('#web-bar', { state: 'hidden' });
    return page.textContent('#web-words');
  };
  const save = async (label) => {
    const [saved] = await Promise.all([page.waitForEvent('download'), page.locator('#web-files .format', { hasText: label }).click()]);
    return { name: saved.suggestedFilename(), bytes: await readFile(await saved.path()) };
  };

  assert.match(await choose('thumbnail'), /^(2,000|1,9[6-9]\d) triangles with pictures of 512 × \d+\. Off the full mesh by [\d.]+ % .*no colours/);
  assert.deepEqual([await site.view(), await page.inputValue('#split-left'), await page.inputValue('#split-right')], ['compare', 'points', 'light']);
  const { name, bytes } = await save('GLB');
  assert.equal(name, 'ball-thumbnail.glb');
  const { extensionsRequired, images, materials } = JSON.parse(bytes.toString('utf8', 20, 20 + bytes.readUInt32LE(12)));
  assert.deepEqual(extensionsRequired.sort(), ['EXT_meshopt_compression', 'EXT_texture_webp', 'KHR_mesh_quantization']);
  assert.deepEqual([images.length, images[0].mimeType, 'normalTexture' in materials[0]], [1, 'image/webp', true]);

  const { issues } = await validateBytes(new Uint8Array(bytes));
  assert.deepEqual(issues.messages.filter(({ severity }) => severity < 2), []);

  assert.match(await choose('print'), /^Watertight, ready for 3D printing/);
  assert.equal((await save('STL')).name, 'ball-print.stl');
  assert.equal(await page.inputValue('#split-right'), 'mesh', 'the light model is gone');

  await page.check('input[name="preset"][value="close-up"]');
  await page.click('#web-cancel');
  assert.equal(await page.locator('input[name="preset"]:checked').count(), 0);
  assert.equal(await page.textContent('#web-words'), '');
  assert.deepEqual(site.faults, []);
});
