// A person knows better: which side is up, picked in the picture, and what the columns of a refused table are.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { PATIENCE, start } from './browser.mjs';
import { silhouette } from './pictures.mjs';

/** Turns about z, by which the slab leans to the left. */
const LEAN = Math.PI / 6;

/** Points of a slab of 2 by 0.6 by 2 that leans. */
function slab() {
  const points = [];
  const steps = 32;
  const half = [1, 0.3, 1];
  for (const axis of [0, 1, 2]) {
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    const counts = [u, v].map((side) => Math.round(steps * half[side]));
    for (const side of [-1, 1]) {
      for (let i = 0; i <= counts[0]; i++) {
        for (let j = 0; j <= counts[1]; j++) {
          const p = [0, 0, 0];
          p[axis] = side * half[axis];
          p[u] = half[u] * ((2 * i) / counts[0] - 1);
          p[v] = half[v] * ((2 * j) / counts[1] - 1);
          points.push([Math.cos(LEAN) * p[0] - Math.sin(LEAN) * p[1], Math.sin(LEAN) * p[0] + Math.cos(LEAN) * p[1], p[2]]);
        }
      }
    }
  }
  return points;
}

test('what a person knows of a scan', { timeout: 2 * PATIENCE }, async (t) => {
  const browser = await start(t);
  const site = await browser.open();
  const { page } = site;
  await site.made();

  /** Height of the picture's object from the front, as a share of its width. */
  const flatness = async () => {
    await page.click('#camera-menu > summary');
    await page.click('[data-side="front"]');
    await page.keyboard.press('Escape');
    await site.settled();
    const { box } = silhouette(await site.pictureOf('mesh', `slab-${await page.inputValue('#stand-up')}`));
    return box.height / box.width;
  };

  await t.test('a table that was refused is read with columns of the person’s', async () => {
    const text = slab().map(([x, y, z]) => [z, x, y].map((value) => value.toFixed(5)).join(';')).join('\n');
    await site.drop('slab.csv', Buffer.from(`deep;right;tall\n${text}\n`));
    await page.waitForSelector('#columns[open]');
    assert.match(await site.message(), /slab\.csv/);
    assert.ok(await page.isDisabled('#columns-read'));
    assert.match(await page.innerText('#columns-table'), /deep\s+right\s+tall/);
    for (const [i, name] of ['z', 'x', 'y'].entries()) await page.selectOption(`[aria-label="Column ${i + 1} holds"]`, name);
    await page.click('#columns-read');
    await site.opened('slab.csv');
    assert.equal(await site.number('inputPoints'), slab().length);
    assert.ok(await page.isHidden('#message'));
  });

  await t.test('the side that is picked is up', async () => {
    assert.equal(await page.inputValue('#stand-up'), 'y');
    assert.ok((await flatness()) > 0.6, 'it leans');
    await page.click('#camera-menu > summary');
    await page.click('[data-side="top"]');
    await page.keyboard.press('Escape');
    await site.settled();
    await page.click('#standing > summary');
    assert.ok(await page.isHidden('#stand-stale'));
    await page.click('#stand-pick');
    assert.equal(await page.getAttribute('#stand-pick', 'aria-pressed'), 'true');
    await page.keyboard.press('Enter');
    assert.equal(await page.getAttribute('#stand-pick', 'aria-pressed'), 'false');
    assert.match(await page.innerText('#stand-words'), /^The picked side is up/);
    assert.equal(await page.inputValue('#stand-up'), 'picked');
    const flat = await flatness();
    assert.ok(Math.abs(flat - 0.3) < 0.04, `it lies flat: ${flat}`);
    // The result was made before that, and says so until it is made again.
    assert.ok(await page.isVisible('#stand-stale'));
    await site.remade(() => page.click('#run'));
    assert.ok(await page.isHidden('#stand-stale'));
    assert.equal(await page.inputValue('#stand-up'), 'picked');
    await page.selectOption('#stand-up', 'z');
    assert.equal(await page.locator('#stand-up option').count(), 6);
    assert.match(await page.innerText('#stand-words'), /^Z is up/);
  });

  await t.test('lengths are said in the unit that it has', async () => {
    await page.selectOption('#stand-unit', 'mm');
    await site.paint('error');
    assert.match(await page.innerText('#legend'), /in mm and of the diagonal/);
    assert.doesNotMatch(await page.innerText('main, body'), /file units/);
    await page.selectOption('#stand-unit', 'cm');
    await page.locator('#legend', { hasText: 'in cm and of the diagonal' }).waitFor();
  });
  assert.deepEqual(site.faults, []);
});
