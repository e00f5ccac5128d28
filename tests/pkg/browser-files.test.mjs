// Files in a browser: the modules of the readers come when a file of theirs does, and from nowhere else.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { openPage } from './browser.mjs';

const FIXTURES = new URL('../fixtures/', import.meta.url);

/** Points of the fixtures, and the module that reads each. */
const FILES = [['small.laz', 30, 'las'], ['small.e57', 9, 'e57'], ['small.ply', 3, 'files']];

/** In a page: reads a file with an engine of its own. Stands alone. */
async function readIn([engineOptions, name, bytes]) {
  const { createEngine } = await import('pointweave');
  const engine = await createEngine(engineOptions);
  const shares = [];
  const file = new File([Uint8Array.from(bytes)], name);
  const cloud = await engine.read(file, { onProgress: ({ overall }) => shares.push(overall) });
  await engine.dispose();
  return { points: cloud.positions.length / 3, file: cloud.file, first: [...cloud.positions.slice(0, 3)], shares };
}

const bytesOf = (name) => [...readFileSync(new URL(name, FIXTURES))];

test('a reader is loaded when a file of its format comes', async (t) => {
  const page = await openPage(t);
  const loaded = [];
  page.on('request', (request) => {
    const [, module] = /wasm\/(\w+)\/\w+\.wasm$/.exec(request.url()) ?? [];
    if (module) loaded.push(module);
  });
  let workers = 0;
  page.on('worker', () => workers++);
  for (const options of [{ threads: 1 }, { threads: 1, worker: false }, { threads: 2 }]) {
    for (const [name, points, module] of FILES) {
      loaded.length = 0;
      workers = 0;
      const read = await page.evaluate(readIn, [options, name, bytesOf(name)]);
      assert.equal(read.points, points, `${name} ${JSON.stringify(options)}`);
      assert.equal(read.shares.at(-1), 1);
      // The engine's own, with its pool, and one for the reader.
      assert.equal(workers, options.worker === false ? 0 : options.threads === 2 ? 4 : 2);
      const others = loaded.filter((other) => ['files', 'las', 'e57', 'packed'].includes(other) && other !== module);
      assert.deepEqual(others, [], `${name} needs ${module} alone`);
      assert.ok(options.threads === 2 || options.worker === false || loaded.includes(module), `${name}: ${loaded}`);
    }
  }
  for (let tries = 0; page.workers().length > 0 && tries < 50; tries++) await page.waitForTimeout(100);
  assert.equal(page.workers().length, 0, 'readers leave no worker behind');
});

test('wasmUrl says where the readers are, and errors cross the worker', async (t) => {
  const page = await openPage(t);
  const las = await page.evaluate(readIn, [{ threads: 1, wasmUrl: '/pointweave/wasm' }, 'small.laz', bytesOf('small.laz')]);
  assert.equal(las.file.format, 'las');
  const lost = await page.evaluate(readIn, [{ threads: 1, wasmUrl: { las: 'nowhere.wasm' } }, 'small.laz', bytesOf('small.laz')]).catch(String);
  assert.match(lost, /nowhere\.wasm did not load: 404/);
  const cut = await page.evaluate(readIn, [{ threads: 1 }, 'small.laz', bytesOf('small.laz').slice(0, -100)]).catch(String);
  assert.match(cut, /bad LAS file at byte \d+: expected/);
});

test('a strict content security policy is enough for the readers', async (t) => {
  const page = await openPage(t, { strict: true });
  for (const [name, points] of FILES) {
    assert.equal((await page.evaluate(readIn, [{ threads: 1 }, name, bytesOf(name)])).points, points);
  }
});
