// How many points suit a scan and a device.

import assert from 'node:assert/strict';
import test from 'node:test';
import { autoCount, reconstruct, reduce } from 'pointweave';
import { load } from 'pointweave/core';
import { parse } from '../../pkg/cli/arguments.js';
import { sphere } from './support.mjs';

const cloud = sphere(3000);

test('a third, within bounds that are those of the device', (t) => {
  assert.deepEqual([0, 900, 3000, 30_000, 1_000_000, 3_000_600].map(autoCount), [0, 900, 2000, 10_000, 60_000, 60_000]);
  const asked = [];
  globalThis.matchMedia = (query) => (asked.push(query), { matches: true });
  t.after(() => delete globalThis.matchMedia);
  assert.deepEqual([900, 30_000, 1_000_000].map(autoCount), [900, 10_000, 20_000]);
  assert.match(asked[0], /pointer: coarse/);
});

test("target: 'auto' keeps as many, in every host", async () => {
  const core = await load();
  const [count, auto] = [{ target: { count: 2000 } }, { target: 'auto' }];
  const { positions } = await reduce(cloud, count);
  assert.equal(positions.length, 6000);
  assert.deepEqual((await reduce(cloud, auto)).positions, positions);
  assert.deepEqual((await reduce({ positions: cloud.positions.slice() }, { ...auto, transfer: true })).positions, positions);
  assert.deepEqual(core.reduce(cloud, auto).positions, positions);
  const { indices } = await reconstruct(cloud, { reduce: count });
  assert.deepEqual((await reconstruct(cloud, { reduce: auto })).indices, indices);
  assert.deepEqual(core.reconstruct(cloud, { reduce: auto }).indices, indices);
  assert.deepEqual(parse(['reduce', 'a.ply', '-o', 'b.ply', '--count', 'auto']).own, auto);
});
