// Files that come in together, jobs that were cancelled, and addresses of nothing.

import assert from 'node:assert/strict';
import { mkdir, mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { sortOut } from '../../www/src/session/dropped.js';
import { PATIENCE, start } from './browser.mjs';
import { spherePoints, toXyz } from './scans.mjs';

const named = (path) => ({ file: { name: path.split('/').at(-1) }, path });

test('of several files the first scan is opened, and what a mesh names goes with it', () => {
  const { first, all } = sortOut(['notes/readme.pdf', 'pot.png', 'pot.mtl', 'pot.OBJ', 'more/pot.ply'].map(named));
  assert.equal(first.path, 'pot.OBJ');
  assert.deepEqual(all.map(({ kind }) => kind), ['other', 'beside', 'beside', 'scan', 'scan']);
  assert.equal(sortOut(['picture.jpg', 'survey'].map(named)).first.path, 'survey', 'a file without an ending may be a scan');
  assert.equal(sortOut([named('holiday.jpg')]).first.path, 'holiday.jpg');
});

/** Drops what is at these paths of the file system on the page, as the browser does it. */
async function dropPaths(page, paths) {
  const debug = await page.context().newCDPSession(page);
  const data = { items: [], files: paths, dragOperationsMask: 1 };
  for (const type of ['dragEnter', 'dragOver', 'drop']) await debug.send('Input.dispatchDragEvent', { type, x: 300, y: 300, data });
}

test('dropped files and folders, and a job that was cancelled', { timeout: PATIENCE }, async (t) => {
  const folder = await mkdtemp(join(tmpdir(), 'pointweave-'));
  t.after(() => rm(folder, { recursive: true }));
  const put = async (path, text) => {
    await mkdir(join(folder, path, '..'), { recursive: true });
    await writeFile(join(folder, path), text);
  };
  await put('site/a first.xyz', toXyz(spherePoints(900)));
  await put('site/inner/second.xyz', toXyz(spherePoints(1100)));
  await put('site/broken.ply', 'ply\nformat ascii 1.0\n');
  await put('site/pot.mtl', 'newmtl pot\n');
  await put('site/.hidden', 'nothing');
  await mkdir(join(folder, 'empty'));

  const server = await start(t);
  const site = await server.open({}, undefined, `?src=${server.serve('small.xyz', toXyz(spherePoints(800)))}`);
  const { page } = site;
  await site.opened('small.xyz');
  const rows = () => page.$$eval('#dropped-rows li', (all) => all.map((row) => row.innerText.replace(/\s*\n\s*/g, ': ')));

  await t.test('a folder: its scans are parts of one, and what cannot be read is said to be so', async () => {
    await dropPaths(page, [join(folder, 'site')]);
    await site.opened('2 scans');
    const parts = await page.$$eval('#parts-rows li', (all) => all.map((row) => row.innerText.replace(/\s*\n\s*/g, ': ')));
    assert.deepEqual(parts.map((row) => row.replace(/: $/, '')), ['a first.xyz', 'broken.ply: cannot be read', 'second.xyz']);
    assert.equal(await site.number('inputPoints'), 2000);
    assert.equal(await page.isVisible('#dropped'), false);
    assert.equal(await page.isVisible('#message'), false);
  });

  await t.test('more files than parts of one scan: each has its line, and another is opened by its button', async () => {
    for (let i = 10; i < 26; i++) await put(`many/ball ${i}.xyz`, toXyz(spherePoints(700 + i)));
    await put('many/broken.ply', 'ply\nformat ascii 1.0\n');
    await put('many/pot.mtl', 'newmtl pot\n');
    await dropPaths(page, [join(folder, 'many')]);
    await site.opened('ball 10.xyz');
    assert.equal(await page.isVisible('#parts'), false);
    const all = await rows();
    assert.deepEqual([all[0], all[1], ...all.slice(16)], ['many/ball 10.xyz: open', 'many/ball 11.xyz: Open', 'many/broken.ply: Open', 'many/pot.mtl: used by a mesh that names it']);
    await page.click('#dropped-rows li:nth-child(17) button');
    await page.waitForSelector('#message:not([hidden])');
    assert.match((await rows())[16], /broken\.ply: cannot be read/);
    assert.equal(await page.innerText('#caption-title'), 'ball 10.xyz');
    await page.click('#dropped-rows li:nth-child(2) button');
    await site.opened('ball 11.xyz');
    assert.equal(await page.isVisible('#message'), false, 'the message was about another file');
    assert.match((await rows())[1], /ball 11\.xyz: open/);
    assert.equal(await site.number('inputPoints'), 711);
  });

  await t.test('one file alone has no list, and an empty folder is said to be empty', async () => {
    await dropPaths(page, [join(folder, 'site/a first.xyz')]);
    await site.opened('a first.xyz');
    assert.equal(await page.isVisible('#dropped'), false);
    await dropPaths(page, [join(folder, 'empty')]);
    await page.waitForSelector('#message:not([hidden])');
    assert.match(await site.message(), /no files in this folder/);
    await page.click('#message-close');
  });

  await t.test('a cancelled job does not begin again because another file cannot be read', async () => {
    await page.click('[data-sample="pig"]');
    await page.waitForSelector('#app[data-state="working"]', { timeout: PATIENCE });
    await page.keyboard.press('Escape');
    await page.waitForSelector('#app[data-state="ready"]');
    await page.evaluate(() => new MutationObserver((_, all) => (globalThis.states ??= []).push(document.querySelector('#app').dataset.state))
      .observe(document.querySelector('#app'), { attributeFilter: ['data-state'] }));
    await site.drop('holiday.jpg', Buffer.from([0xff, 0xd8, 0xff, 0xe0]));
    await page.waitForSelector('#message:not([hidden])');
    await page.waitForTimeout(300);
    assert.deepEqual(await page.evaluate(() => globalThis.states), ['reading', 'ready']);
    assert.ok(await page.isVisible('#run'), 'it is begun by hand');
    await page.click('#message-close');
  });

  await t.test('one that was only interrupted goes on', async () => {
    await page.click('[data-sample="part"]');
    await page.waitForSelector('#app[data-state="working"]', { timeout: PATIENCE });
    await site.drop('holiday.jpg', Buffer.from([0xff, 0xd8, 0xff, 0xe0]));
    await page.waitForSelector('#message:not([hidden])');
    await site.opened('Machined part');
    assert.ok((await site.number('triangles')) > 0);
  });

  assert.deepEqual(site.faults, []);
});

test('an address of nothing shows the duck and says so', { timeout: PATIENCE }, async (t) => {
  const site = await (await start(t)).open({}, undefined, '?src=missing.ply');
  await site.opened('Toy duck');
  assert.match(await site.message(), /could not be fetched[^]*A sample is shown instead/);
  assert.ok((await site.number('triangles')) > 0);
});
