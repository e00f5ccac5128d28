// Files that are damaged, odd, or of a kind that few programs read.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { PATIENCE, sharedFolder, start } from './browser.mjs';

test('hostile files: each one is shown or explained', { timeout: 4 * PATIENCE }, async (t) => {
  const browser = await start(t);
  // Few points are enough to tell, and are made in no time.
  const site = await browser.open({}, undefined, '#ratio=0.02');
  await site.made();
  const outcomes = { shown: 0, explained: 0 };
  for (const [name, bytes] of await sharedFolder('hostile')) {
    await site.drop(name, bytes);
    await site.settled();
    const shown = (await site.page.innerText('#caption-title')) === name;
    const explained = await site.page.isVisible('#message');
    assert.ok(shown || explained, `${name}: nothing happened`);
    if (explained) assert.match(await site.message(), /\[[a-z-]+\]/);
    assert.doesNotMatch(explained ? await site.message() : '', /\[internal\]/, name);
    outcomes[explained ? 'explained' : 'shown'] += 1;
  }
  t.diagnostic(`hostile files: ${outcomes.shown} shown, ${outcomes.explained} explained`);
  assert.deepEqual(site.faults, []);
});
