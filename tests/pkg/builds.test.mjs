// One code, two builds: the same bytes from each, with any number of threads.

import assert from 'node:assert/strict';
import test from 'node:test';
import { platform } from '../../pkg/engine/platform.node.js';
import { workerHost } from '../../pkg/engine/worker-host.js';
import { sharedMemory } from '../../pkg/engine/memory.js';
import { arraysOf, engineFor, sphere } from './support.mjs';

/** The threads build with a pool of one, which an engine would not take. */
async function poolOfOne(t) {
  const module = await platform.compile('threads', undefined);
  const { memory } = sharedMemory();
  const host = await workerHost(platform.startWorker, { build: 'threads', threads: 1, module, memory });
  t.after(() => host.end());
  const call = (name) => (cloud, options = {}) => host.run({ call: name, args: [structuredClone(cloud), options] }, {});
  return { reduce: call('reduce'), reconstruct: call('reconstruct') };
}

/** A report without what may differ. */
function figures({ ms, totalMs, peakMemoryBytes, build, threads, reason, ...rest }) {
  assert.ok(ms && totalMs >= 0 && peakMemoryBytes > 0 && build && threads > 0 && typeof reason === 'string');
  return rest;
}

test('the builds agree byte for byte', async (t) => {
  const single = await engineFor(t, { threads: 1 });
  const duck = await single.sample('duck', { count: 12_000, seed: 3 });
  const jobs = [
    ['reduce', duck, {}],
    ['reduce', duck, { target: { ratio: 0.1 }, placement: 'mesh', curvatureWeight: 1 }],
    ['reduce', duck, { method: 'paper', target: { flatness: 0.0003 }, seed: 5, maxIterations: 20 }],
    ['reduce', sphere(3000, { type: Float64Array, center: [1e6, -2e6, 3e3] }), { target: { count: 777 } }],
    ['reconstruct', duck, {}],
    ['reconstruct', sphere(1500), { reduce: false, kernel: 'thin-plate', propagation: 'paper' }],
  ];
  const others = [
    ['a worker', await engineFor(t, { threads: 1, worker: true })],
    ['1 thread', await poolOfOne(t)],
    ['2 threads', await engineFor(t, { threads: 2 })],
    ['4 threads', await engineFor(t, { threads: 4 })],
  ];
  for (const [call, cloud, options] of jobs) {
    const expected = await single[call](cloud, options);
    const arrays = Object.entries(arraysOf(expected));
    assert.ok(arrays.length >= 4 && expected.positions.length > 300);
    for (const [name, engine] of others) {
      const found = await engine[call](cloud, options);
      const foundArrays = arraysOf(found);
      assert.deepEqual(Object.keys(foundArrays).sort(), arrays.map(([path]) => path).sort());
      for (const [path, array] of arrays) {
        assert.equal(Buffer.compare(bytes(array), bytes(foundArrays[path])), 0, `${call} ${JSON.stringify(options)}: ${path} differs with ${name}`);
      }
      assert.deepEqual(figures(found.report), figures(expected.report), `${call}: the report differs with ${name}`);
    }
  }
});

test('samples are the same in both builds, and have the points that were asked for', async (t) => {
  const single = await engineFor(t, { threads: 1 });
  const pool = await engineFor(t, { threads: 2 });
  for (const model of ['duck', 'pig', 'part', 'desk']) {
    const scan = await single.sample(model, { count: 5000, seed: 9 });
    assert.equal(scan.positions.length, 15_000);
    assert.equal(scan.colors.length, 15_000);
    assert.deepEqual(await pool.sample(model, { count: 5000, seed: 9 }), scan);
    assert.notDeepEqual((await single.sample(model, { count: 5000, seed: 10 })).positions, scan.positions);
  }
  assert.equal((await single.sample('duck')).positions.length, 3 * 35_647);
  const noises = [undefined, 5e-4, 0];
  const [usual, same, none] = await Promise.all(noises.map((noise) => single.sample('duck', { count: 5000, noise })));
  assert.deepEqual(usual, same);
  assert.notDeepEqual(usual.positions, none.positions);
});

/** @param {ArrayBufferView} array */
function bytes(array) {
  return Buffer.from(array.buffer, array.byteOffset, array.byteLength);
}
