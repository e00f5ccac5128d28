// What engines leave behind in a browser, and what they survive there.

import assert from 'node:assert/strict';
import test from 'node:test';
import { openPage } from './browser.mjs';

/** Memory is measured at once when a page asks, and not after half a minute. */
const MEASURE_NOW = ['--enable-blink-features=ForceEagerMeasureMemory'];

/** In a page: makes, uses and disposes of engines of all kinds. Stands alone. */
async function rounds(count) {
  const { createEngine } = await import('pointweave');
  const positions = Float32Array.from({ length: 30_000 }, (_, i) => Math.sin(i * i));
  for (let round = 0; round < count; round++) {
    const engine = await createEngine([{ threads: 2 }, { threads: 1 }, { worker: false }][round % 3]);
    const { report } = await engine.reduce({ positions });
    if (report.outputPoints !== 3333) throw new Error(`${report.outputPoints} points`);
    await engine.dispose();
  }
}

/** In a page: bytes of its JavaScript and its workers', without WebAssembly's memory. Stands alone. */
async function bytes() {
  return (await performance.measureUserAgentSpecificMemory()).bytes;
}

test('a hundred engines that are disposed of leave no worker and no memory behind', async (t) => {
  const page = await openPage(t, { flags: MEASURE_NOW });
  const devtools = await page.context().newCDPSession(page);
  /** WebAssembly memories of the page that a garbage collection leaves: shared ones, and those of engines without a worker. */
  const memories = async () => {
    const { result } = await devtools.send('Runtime.evaluate', { expression: 'WebAssembly.Memory.prototype', objectGroup: 'count' });
    const { objects } = await devtools.send('Runtime.queryObjects', { prototypeObjectId: result.objectId, objectGroup: 'count' });
    const { result: count } = await devtools.send('Runtime.callFunctionOn', {
      objectId: objects.objectId, functionDeclaration: 'function () { return this.length; }', returnByValue: true,
    });
    await devtools.send('Runtime.releaseObjectGroup', { objectGroup: 'count' });
    return count.value;
  };
  const settled = async () => {
    for (let tries = 0; page.workers().length > 0 && tries < 50; tries++) await page.waitForTimeout(100);
    for (let i = 0; i < 3; i++) await devtools.send('HeapProfiler.collectGarbage');
    return page.evaluate(bytes);
  };
  await page.evaluate(async () => {
    const { createEngine } = await import('pointweave');
    globalThis.kept = [await createEngine({ worker: false }), await createEngine({ threads: 2 })];
  });
  assert.equal(await memories(), 2, 'engines that live are seen');
  await page.evaluate(() => Promise.all(globalThis.kept.splice(0).map((engine) => engine.dispose())));
  await page.evaluate(rounds, 6);
  const before = await settled();
  await page.evaluate(rounds, 100);
  const after = await settled();
  assert.equal(page.workers().length, 0);
  assert.equal(await memories(), 0);
  assert.ok(after - before < 1e6, `${before} bytes before, ${after} after`);
});

/** In a page: uses an engine that was used before, if there is one. Stands alone. */
async function useAgain(threads) {
  const { createEngine } = await import('pointweave');
  globalThis.engine ??= await createEngine({ threads, idleMs: 200 });
  const { report } = await globalThis.engine.reduce({ positions: Float32Array.from({ length: 3000 }, (_, i) => Math.sin(i * i)) });
  return [report.build, report.outputPoints];
}

test('workers without a call end, and the next call has fresh ones', async (t) => {
  const page = await openPage(t);
  let made = 0;
  page.on('worker', () => made++);
  assert.deepEqual(await page.evaluate(useAgain, 2), ['threads', 333]);
  for (let tries = 0; page.workers().length > 0 && tries < 100; tries++) await page.waitForTimeout(50);
  assert.deepEqual([made, page.workers().length], [3, 0], 'one that computes and two that lend their threads have ended');
  assert.deepEqual(await page.evaluate(useAgain, 2), ['threads', 333]);
  assert.equal(made, 6);
});

/** In a page: what becomes of a cloud that is too large, and of the next. Stands alone. */
async function exhaust(threads) {
  const { createEngine } = await import('pointweave');
  const engine = await createEngine({ threads });
  const large = { positions: Float32Array.from({ length: 9_000_000 }, (_, i) => Math.sin(i * i)) };
  const code = await engine.reduce(large).then(() => 'none', (error) => error.code);
  const { report } = await engine.reduce({ positions: large.positions.slice(0, 3000) });
  await engine.dispose();
  return [code, report.build, report.outputPoints, report.reason];
}

test('where little memory is to be had, threads take that, and what is too large for it is refused', async (t) => {
  const page = await openPage(t, {
    prepare: (page) => page.addInitScript(() => {
      const { Memory } = WebAssembly;
      WebAssembly.Memory = class extends Memory {
        constructor(limits) {
          if (limits.maximum > 2 ** 28 / 65_536) throw new RangeError('could not allocate memory');
          super(limits);
        }
      };
    }),
  });
  assert.deepEqual(await page.evaluate(exhaust, 2), ['out-of-memory', 'threads', 333, 'the page is cross-origin isolated; memory is limited to 256 MiB here']);
});
