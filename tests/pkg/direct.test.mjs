// `pointweave/core`: the same functions, at once and in this thread.

import assert from 'node:assert/strict';
import test from 'node:test';
import * as api from 'pointweave';
import { DEFAULTS, PointweaveError, load } from 'pointweave/core';
import { makeLoad } from '../../pkg/engine/direct-api.js';
import { platform } from '../../pkg/engine/platform.node.js';
import { engineFor, rejection, sphere } from './support.mjs';

/** What a function throws. */
function thrown(f) {
  try {
    f();
  } catch (error) {
    return error;
  }
  throw new Error('expected an error');
}

test('direct calls give what an engine gives', async (t) => {
  const core = await load();
  const engine = await engineFor(t, { threads: 1 });
  const scan = await core.sample('duck', { count: 4000, seed: 2 });
  assert.deepEqual(scan, await engine.sample('duck', { count: 4000, seed: 2 }));
  const { report, ...mesh } = core.reconstruct(scan, { reduce: { target: { ratio: 0.5 } } });
  const { report: _, ...same } = await engine.reconstruct(scan, { reduce: { target: { ratio: 0.5 } } });
  assert.deepEqual([mesh.positions, mesh.indices], [same.positions, same.indices]);
  assert.deepEqual([report.build, report.threads, report.reason], ['single', 1, 'called directly']);
  assert.equal(core.reduce(scan, { target: { count: 77 } }).nearest.length, 77);
  assert.equal(core.inspect(scan).count, 4000);
  const back = await core.read(await core.write(scan, { format: 'ply' }), { name: 'scan.ply' });
  assert.deepEqual(back.positions, scan.positions);
  assert.equal(DEFAULTS, api.DEFAULTS);
  assert.equal(PointweaveError, api.PointweaveError);
});

test('inputs are left alone unless they are to be taken', async () => {
  const core = await load();
  const cloud = sphere();
  core.reduce(cloud);
  assert.deepEqual(cloud, sphere());
  core.reduce(cloud, { transfer: true });
  assert.equal(cloud.positions.length, 0);
});

test('errors are thrown, with all they say', async () => {
  const core = await load();
  assert.equal(thrown(() => core.reduce({ positions: new Float32Array(0) })).code, 'empty-cloud');
  assert.equal(thrown(() => core.reduce(sphere(), { raito: 1 })).code, 'bad-option');
  assert.equal((await rejection(core.read(5))).code, 'bad-input');
  assert.equal((await rejection(core.read(new Blob(['0 0 0\n1 x 2\n'])))).index, 2);
  assert.match((await rejection(core.write(sphere(), { format: 'glb', meshopt: true }))).message, /compress of 'pointweave\/meshopt'/);
  assert.match((await load({ wasmUrl: 'file:///nowhere/' }).catch(String)), /nowhere\/single/);
  assert.match((await load({ threads: 2 }).catch(String)), /there is no option threads/);
  assert.equal(core.reduce(sphere()).nearest.length, 667);
});

test('onProgress can stop a call, and the instance goes on', async () => {
  const core = await load();
  const controller = new AbortController();
  const stop = ({ stage }) => stage === 'features' && controller.abort('enough');
  assert.equal(thrown(() => core.reduce(sphere(20_000), { signal: controller.signal, onProgress: stop })), 'enough');
  assert.equal(thrown(() => core.reduce(sphere(), { signal: AbortSignal.abort('early') })), 'early');
  assert.equal(core.reduce(sphere()).nearest.length, 667);
});

test('an instance that broke says so ever after, and another works', async () => {
  const breaking = makeLoad({
    ...platform,
    loadBindings: async (build) => ({ ...(await platform.loadBindings(build)), panicMessage: () => 'panicked', reduce() { throw new WebAssembly.RuntimeError('unreachable'); } }),
  });
  const core = await breaking();
  assert.match(thrown(() => core.reduce(sphere())).message, /panicked/);
  const after = thrown(() => core.inspect(sphere()));
  assert.equal(after.code, 'internal');
  assert.match(after.message, /load another/);
  assert.equal((await load()).inspect(sphere()).count, 2000);
});

test('instances are independent', async () => {
  const [one, two] = await Promise.all([load(), load()]);
  assert.deepEqual(one.reduce(sphere()).positions, two.reduce(sphere()).positions);
});
