// In the room: where the button is, and what it would open.

import assert from 'node:assert/strict';
import { reconstruct, sample, write } from 'pointweave';
import { decodePng } from '../page/pictures.mjs';
import { ball, boxScan, glb } from './files.mjs';
import { startSite, test } from './site.mjs';

const site = await startSite();
const scan = await sample('duck', { count: 2000, seed: 1 });
const mesh = await reconstruct(scan, { triangles: 300, texture: { size: 128 } });
const textured = await write(mesh, { format: 'glb' });
site.put('/duck.glb', Buffer.from(textured));
site.put('/ball.glb', await glb([{ ...ball(8), color: [200, 10, 10] }]));
site.put('/box.xyz', boxScan());
site.put('/own.usdz', Buffer.from('PK'));

const ANDROID = 'Mozilla/5.0 (Linux; Android 14; Pixel 8) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/126.0 Mobile Safari/537.36';
const IPHONE = 'Mozilla/5.0 (iPhone; CPU iPhone OS 17_4 like Mac OS X) AppleWebKit/605.1.15 (KHTML, like Gecko) Version/17.4 Mobile/15E148 Safari/604.1';

/** Links are written down, not followed. */
const noted = (page) => page.addInitScript(() => {
  const supports = DOMTokenList.prototype.supports;
  DOMTokenList.prototype.supports = function (name) {
    return name === 'ar' || supports.call(this, name);
  };
  window.links = [];
  HTMLAnchorElement.prototype.click = function () {
    const { href, rel, download, firstElementChild } = this;
    window.links.push({ href, rel, download, picture: firstElementChild?.localName, inPage: this.isConnected });
  };
});

/** What a click on the button would open. */
async function opened(shown) {
  const { page } = shown;
  await page.locator('point-weave').getByRole('button', { name: 'View in your room' }).click();
  await page.waitForFunction(() => window.links.length > 0, null, { timeout: 60_000 });
  return page.evaluate(() => window.links.pop());
}

const button = ({ page }) => page.locator('point-weave').getByRole('button', { name: 'View in your room' });

test('Android opens Scene Viewer with the GLB, and says when there is none', async () => {
  const shown = await site.open('<point-weave src="/duck.glb?title=Duck#there" ar ar-scale="fixed" ar-placement="wall"></point-weave>', { userAgent: ANDROID, prepare: noted });
  await shown.loaded();
  const { data } = decodePng(await shown.picture());
  const yellow = Array.from({ length: data.length / 4 }, (_, i) => data.subarray(4 * i, 4 * i + 3)).filter(([r, g, b]) => r > 170 && g > 130 && b < 120);
  assert.ok(yellow.length > 5000, `the picture on it is shown: ${yellow.length} yellow pixels`);
  const { href, rel } = await opened(shown);
  const [, params, intent] = /^intent:\/\/arvr\.google\.com\/scene-viewer\/1\.2\?(.*)#Intent;(.*)end;$/.exec(href);
  const found = Object.fromEntries(new URLSearchParams(params));
  assert.deepEqual(found, {
    title: 'Duck', mode: 'ar_preferred', disable_occlusion: 'true', resizable: 'false', enable_vertical_placement: 'true', file: `${site.address}/duck.glb?title=Duck`,
  });
  assert.match(intent, /package=com\.google\.android\.googlequicksearchbox;action=android\.intent\.action\.VIEW/);
  assert.equal(rel, '');
  // Chrome goes to the fallback where the app is missing.
  await shown.page.evaluate(() => {
    window.failed = new Promise((heard) => document.querySelector('point-weave').addEventListener('ar-status', ({ detail }) => heard(detail.status)));
    location.hash = '#point-weave-no-ar';
  });
  assert.equal(await shown.page.evaluate(() => window.failed), 'failed');
  await shown.page.evaluate(() => document.querySelector('point-weave').setAttribute('ar-modes', 'quick-look'));
  assert.equal(await button(shown).isVisible(), false);
});

test('iPhones open Quick Look, with a file that is made of what is shown', async () => {
  const shown = await site.open('<point-weave src="/duck.glb" ar ar-scale="fixed"></point-weave>', { userAgent: IPHONE, prepare: noted });
  await shown.loaded();
  const { page } = shown;
  const made = async () => {
    const link = await opened(shown);
    assert.deepEqual([link.rel, link.download, link.picture, link.inPage], ['ar', 'model.usdz', 'img', true]);
    assert.match(link.href, /^blob:.*#allowsContentScaling=0$/);
    const bytes = Buffer.from(await page.evaluate(async (href) => [...new Uint8Array(await (await fetch(href)).arrayBuffer())], link.href.split('#')[0]));
    assert.equal(bytes.toString('latin1', 0, 2), 'PK');
    return bytes.toString('latin1').replace(/[^\n -~]+/g, '').replace(/(\[.{60})[^\]]*/g, '$1');
  };
  const pictured = await made();
  assert.match(pictured, /UsdUVTexture/);
  assert.match(pictured, /\.png/);
  for (const [src, holds] of [['/ball.glb', /displayColor = \[\(0\.78/], ['/box.xyz', /def Mesh "Surface"/]]) {
    await page.evaluate(async (to) => {
      const element = document.querySelector('point-weave');
      element.src = to;
      await element.whenLoaded();
    }, src);
    assert.match(await made(), holds, src);
  }
  await page.evaluate(() => document.querySelector('point-weave').setAttribute('ios-src', '/own.usdz'));
  const { href, download } = await opened(shown);
  assert.deepEqual([href, download], [`${site.address}/own.usdz#allowsContentScaling=0`, '']);
});

test('elsewhere there is no button, and on phones none without ar', async () => {
  for (const [attributes, userAgent] of [['ar'], ['', IPHONE], ['ar ar-modes="webxr"', ANDROID]]) {
    const shown = await site.open(`<point-weave src="/ball.glb" ${attributes}></point-weave>`, { ...(userAgent && { userAgent }), prepare: noted });
    await shown.loaded();
    assert.equal(await button(shown).isVisible(), false);
    assert.equal(await shown.page.evaluate(() => document.querySelector('point-weave').canActivateAR), false);
  }
});

test('a page has a button of its own', async () => {
  const shown = await site.open('<point-weave src="/ball.glb" ar><button slot="ar-button">At home</button></point-weave>', { userAgent: ANDROID, prepare: noted });
  await shown.loaded();
  await shown.page.getByRole('button', { name: 'At home' }).click();
  assert.match(await shown.page.evaluate(() => window.links.pop().href), /^intent:/);
});
