// Where scans come from, and that the page needs nobody for it: addresses, the clipboard, no connection at all.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { PATIENCE, sharedFile, start } from './browser.mjs';
import { parseXyz, spherePoints, toXyz } from './scans.mjs';

const small = toXyz(spherePoints(1500));

test('addresses and the clipboard', { timeout: PATIENCE }, async (t) => {
  const server = await start(t);
  const kitten = (await sharedFile('scans/kitten.xyz')) ?? small;
  const site = await server.open({}, undefined, `?src=${server.serve('a kitten.xyz', kitten)}`);
  const { page } = site;
  await site.opened('a kitten.xyz');
  assert.equal(await site.number('inputPoints'), parseXyz(kitten.toString()).length);
  assert.match(page.url(), /src=dropped/);

  for (const [src, code] of [
    ['missing.ply', 'not-found'], ['https://example.org/scan.ply', 'other-server'], ['http://[', 'bad-address'],
  ]) {
    const other = await server.open({}, undefined, `?src=${encodeURIComponent(src)}`);
    await other.page.waitForSelector('#message:not([hidden])');
    assert.match(await other.message(), new RegExp(`\\[${code}\\]`), src);
    assert.ok(other.faults.every((fault) => /404/.test(fault)), `${other.faults}`);
    await other.page.context().close();
  }

  const paste = (kind, text) => page.evaluate(([kind, text]) => {
    const data = new DataTransfer();
    if (kind === 'file') data.items.add(new File([text], 'copied.xyz'));
    else data.setData('text/plain', text);
    document.body.dispatchEvent(new ClipboardEvent('paste', { clipboardData: data, bubbles: true }));
  }, [kind, text]);
  await paste('file', small.toString());
  await site.opened('copied.xyz');
  assert.doesNotMatch(page.url(), /src=/, 'the address does not claim to know this scan');
  await paste('text', toXyz(spherePoints(900)).toString());
  await site.opened('pasted points.xyz');
  assert.equal(await site.number('inputPoints'), 900);
  await paste('text', 'Dear Sir or Madam');
  assert.equal(await page.getAttribute('#app', 'data-state'), 'ready', 'a letter is no scan');

  const holes = `ply\nformat ascii 1.0\nelement vertex 902\nproperty float x\nproperty float y\nproperty float z\nend_header\n${
    toXyz(spherePoints(900)).toString()}\nnan nan nan\n0 inf 0\n`;
  await site.drop('holes.ply', Buffer.from(holes));
  await site.opened('holes.ply');
  assert.equal(await page.innerText('#caption-detail'), '900 points, 2 without a place left out');

  // A sample that the address names, and one that it is changed to.
  await page.evaluate(() => (location.hash = '#sample=part&count=500'));
  await site.opened('Machined part');
  assert.equal(await site.number('outputPoints'), 500);
  assert.equal(await page.getAttribute('[data-sample="part"]', 'aria-pressed'), 'true');
  assert.deepEqual(site.faults, []);
});

for (const isolated of [true, false]) {
  test(`without a server, ${isolated ? 'isolated' : 'not isolated'}`, { timeout: PATIENCE }, async (t) => {
    const server = await start(t, { isolated });
    const site = await server.open({}, undefined, '#count=2000');
    const { page } = site;
    await site.made();
    await page.waitForFunction(async () => (await navigator.serviceWorker.ready).active.state === 'activated');
    const [cache, ...others] = await page.evaluate(() => caches.keys());
    assert.deepEqual(others, [], 'one cache for one build');
    assert.match(cache, /^pointweave http.* [0-9a-f]{16}$/);

    await server.stop();
    await page.goto('about:blank');
    await page.goto(`${server.address}?from=home#sample=duck&count=1000`);
    await site.opened('Toy duck');
    assert.equal(await site.number('outputPoints'), 1000);
    assert.equal(await page.evaluate(() => crossOriginIsolated), isolated);
    assert.match(await page.textContent('#engine'), isolated ? /threads/ : /one thread/);
    await page.evaluate((text) => {
      const data = new DataTransfer();
      data.items.add(new File([text], 'own.xyz'));
      document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
    }, small.toString());
    await site.opened('own.xyz');
    assert.equal(await site.number('inputPoints'), 1500);
  });
}
