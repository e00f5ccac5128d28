// The package in a real browser: its worker, its threads, and a page that stays alive meanwhile.

import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import test from 'node:test';
import { openPage, runInFirefox } from './browser.mjs';
import { engineFor } from './support.mjs';

const JOB = { model: 'duck', count: 8000, seed: 4 };

/** In a page: the reconstruction of a job, as hashes of its arrays. Stands alone, as pages know nothing of this file. */
async function reconstructJob([engineOptions, { model, ...sampling }]) {
  const { createEngine } = await import('pointweave');
  const engine = await createEngine(engineOptions);
  const mesh = await engine.reconstruct(await engine.sample(model, sampling));
  const hash = async (array) => [...new Uint8Array(await crypto.subtle.digest('SHA-256', array))].map((x) => x.toString(16).padStart(2, '0')).join('');
  const { build, threads, reason } = engine;
  const { report } = mesh;
  const hashes = [await hash(mesh.positions), await hash(mesh.indices), await hash(mesh.cloud.normals)];
  await engine.dispose();
  return { build, threads, reason, hashes, reported: [report.build, report.threads, report.reason] };
}

const reconstructIn = (page, options) => page.evaluate(reconstructJob, [options, JOB]);

/** What Node makes of {@link JOB}. */
async function expectedHashes(t) {
  const engine = await engineFor(t, { threads: 1 });
  const { model, ...sampling } = JOB;
  const mesh = await engine.reconstruct(await engine.sample(model, sampling));
  return [mesh.positions, mesh.indices, mesh.cloud.normals].map((array) => createHash('sha256').update(array).digest('hex'));
}

test('an isolated page has threads, and the bytes of Node', async (t) => {
  const page = await openPage(t);
  const expected = await expectedHashes(t);
  const found = await reconstructIn(page, { threads: 2 });
  assert.deepEqual([found.build, found.threads, found.reason], ['threads', 2, 'the page is cross-origin isolated']);
  assert.deepEqual(found.hashes, expected);
  assert.deepEqual(found.reported.slice(0, 2), ['threads', 2]);
  assert.deepEqual((await reconstructIn(page, { threads: 1 })).hashes, expected);
  assert.deepEqual((await reconstructIn(page, { worker: false })).hashes, expected);
});

test('any other page has the single-threaded build', async (t) => {
  const page = await openPage(t, { isolated: false });
  const { build, threads, reason, reported } = await reconstructIn(page, {});
  assert.deepEqual([build, threads, reason], ['single', 1, 'the page is not cross-origin isolated']);
  assert.deepEqual(reported.slice(0, 2), ['single', 1]);
});

test('wasm files elsewhere are found from the page', async (t) => {
  const page = await openPage(t);
  for (const wasmUrl of ['pointweave/wasm', '/pointweave/wasm/', { threads: 'pointweave/wasm/threads/pointweave_bg.wasm' }]) {
    assert.equal((await reconstructIn(page, { threads: 2, wasmUrl })).build, 'threads');
  }
  const lost = await reconstructIn(page, { threads: 1, wasmUrl: 'nowhere' }).catch(String);
  assert.match(lost, /nowhere\/single\/pointweave_bg\.wasm did not load: 404/);
});

test('threads that do not start leave the single-threaded build', async (t) => {
  const page = await openPage(t);
  const { build, reason, hashes } = await reconstructIn(page, { threads: 2, wasmUrl: { threads: 'nowhere.wasm' } });
  assert.equal(build, 'single');
  assert.match(reason, /^the threads build did not start: .*nowhere\.wasm did not load: 404/);
  assert.deepEqual(hashes, await expectedHashes(t));
});

test('a strict content security policy is enough', async (t) => {
  const page = await openPage(t, { strict: true });
  for (const threads of [1, 2]) assert.equal((await reconstructIn(page, { threads })).threads, threads);
});

/** In a page: what happens while a long job runs, and after it was aborted. Stands alone. */
async function abortJob(threads) {
  const { createEngine } = await import('pointweave');
  const engine = await createEngine({ threads });
  const pig = await engine.sample('pig');
  const start = performance.now();
  let ticks = 0;
  const ticking = setInterval(() => ticks++, 10);
  const controller = new AbortController();
  const stages = new Set();
  let aborted = 0;
  const error = await engine.reconstruct(pig, {
    signal: controller.signal,
    onProgress({ stage }) {
      stages.add(stage);
      if (stage !== 'cluster' || aborted) return;
      aborted = 1;
      setTimeout(() => {
        aborted = performance.now();
        controller.abort('enough');
      }, 100);
    },
  }).catch((reason) => reason);
  const took = performance.now() - aborted;
  clearInterval(ticking);
  const tick = (performance.now() - start) / ticks;
  const next = await engine.reduce(pig, { target: { count: 1234 } });
  await engine.dispose();
  return { error, took, tick, stages: [...stages], points: next.positions.length / 3 };
}

function checkAbort(seen) {
  assert.equal(seen.error, 'enough');
  assert.ok(seen.took < 100, `the abort took ${seen.took} ms`);
  assert.ok(seen.tick < 100, `a timer of 10 ms fired every ${seen.tick} ms`);
  assert.deepEqual(seen.stages.slice(0, 3), ['octree', 'features', 'cluster']);
  assert.equal(seen.points, 1234);
}

test('the page stays responsive, an abort takes effect within 100 ms and the next call works', async (t) => {
  const page = await openPage(t);
  for (const threads of [1, 2]) checkAbort(await page.evaluate(abortJob, threads));
});

test('Firefox: threads, the bytes of Node, aborts', async (t) => {
  const expected = await expectedHashes(t);
  for (const threads of [1, 2]) {
    const found = await runInFirefox(t, reconstructJob, [{ threads }, JOB]);
    assert.equal(found.threads, threads);
    assert.deepEqual(found.hashes, expected);
  }
  checkAbort(await runInFirefox(t, abortJob, 2));
});

test('engines that are disposed of leave no worker behind', async (t) => {
  const page = await openPage(t);
  await page.evaluate(async () => {
    const { createEngine } = await import('pointweave');
    for (let round = 0; round < 10; round++) {
      const engine = await createEngine({ threads: 1 + (round % 2) });
      await engine.inspect({ positions: new Float32Array(300).map((_, i) => Math.sin(i)) });
      await engine.dispose();
    }
  });
  for (let tries = 0; page.workers().length > 0 && tries < 50; tries++) await page.waitForTimeout(100);
  assert.equal(page.workers().length, 0);
});

test('errors cross the worker with all they say', async (t) => {
  const page = await openPage(t);
  const error = await page.evaluate(async () => {
    const { PointweaveError, reduce } = await import('pointweave');
    const positions = new Float32Array(3000);
    positions[1000] = NaN;
    const thrown = await reduce({ positions }).catch((reason) => reason);
    return { ours: thrown instanceof PointweaveError, code: thrown.code, index: thrown.index, found: thrown.found };
  });
  assert.deepEqual(error, { ours: true, code: 'non-finite', index: 333, found: 'NaN' });
});
