// What must not wear out: jobs that are stopped wherever they are, one scan after the other.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { PATIENCE, start } from './browser.mjs';
import { spherePoints, toPly } from './scans.mjs';

const STAGES = {
  octree: 'Sorting the points', features: 'Measuring curvature and noise', cluster: 'Choosing the points to keep',
  place: 'Placing them on the surface', cells: 'Dividing the surface into patches', fit: 'Fitting the patches',
  orient: 'Finding out what is inside', extract: 'Weaving the triangles', report: 'Measuring the result',
};

test('a job is cancelled in each of its stages, and the next one works', { timeout: 2 * PATIENCE }, async (t) => {
  const server = await start(t);
  const site = await server.open({}, undefined, `?src=${server.serve('ball.ply', toPly(spherePoints(40_000)))}#count=8000`);
  const { page } = site;
  await site.opened('ball.ply');
  const stopped = [];
  for (const [stage, words] of Object.entries(STAGES)) {
    // Cancel is pressed in the moment in which the page says that the stage has begun.
    const pressed = page.evaluate((text) => new Promise((pressed) => {
      new MutationObserver((_, observer) => {
        if (document.querySelector('#progress-stage').textContent !== text) return;
        observer.disconnect();
        const since = performance.now();
        document.querySelector('#cancel').click();
        pressed([document.querySelector('#app').dataset.state, performance.now() - since]);
      }).observe(document.querySelector('#progress-stage'), { childList: true, characterData: true, subtree: true });
    }), words);
    // Every time another scan, of which nothing is known yet.
    await site.drop(`ball ${stage}.ply`, toPly(spherePoints(40_001 + stopped.length)));
    const [state, ms] = await pressed;
    assert.equal(state, 'ready', stage);
    stopped.push(stage);
    t.diagnostic(`${stage}: the page was free after ${ms.toFixed(1)} ms`);
    assert.ok(await page.isVisible('#run'), 'it can be started again');
    assert.equal(await page.isVisible('#progress'), false);
    assert.equal(await page.getAttribute('#numbers', 'data-fresh'), 'false', 'numbers of before are not taken for new ones');
  }
  await site.remade(() => page.click('#run'));
  assert.equal(await site.number('inputPoints'), 40_000 + stopped.length);
  assert.equal(await site.number('outputPoints'), 8000);
  assert.equal(await page.isVisible('#message'), false);
  assert.deepEqual(site.faults, []);
});

test('a change while a job runs, and a cancel, lose nothing of what was measured', { timeout: 2 * PATIENCE }, async (t) => {
  const server = await start(t);
  const site = await server.open({}, undefined, `?src=${server.serve('ball.ply', toPly(spherePoints(60_000)))}#count=9000`);
  const { page } = site;
  await site.opened('ball.ply');
  const stages = () => page.$$eval('#stages data', (rows) => rows.map((row) => row.dataset.stage));
  assert.ok((await stages()).includes('features'));
  await page.click('#more > summary');
  /** Chooses another count, and waits until the page says that its points are being chosen. */
  const begin = async (count) => {
    await page.fill('#keep-field', String(count));
    await page.waitForFunction((words) => document.querySelector('#progress-stage').textContent === words, STAGES.cluster, { timeout: PATIENCE });
  };
  await begin(15_000);
  await site.remade(() => page.selectOption('#option-boundary', 'open'));
  assert.equal(await site.number('outputPoints'), 15_000);
  const after = await stages();
  assert.ok(after.includes('fit') && !after.includes('features'), `measured once: ${after}`);

  await begin(20_000);
  await page.click('#cancel');
  await page.fill('#keep-field', '15000');
  await site.made();
  const back = await stages();
  assert.equal(await site.number('outputPoints'), 15_000);
  assert.ok(back.includes('fit') && !back.includes('features'), `measured once: ${back}`);
  assert.deepEqual(site.faults, []);
});

test('twenty scans in a row leave nothing behind', { timeout: 2 * PATIENCE }, async (t) => {
  const countObjects = (page) => page.addInitScript(() => {
    globalThis.alive = {};
    for (const kind of ['Buffer', 'Texture', 'Program', 'VertexArray']) {
      globalThis.alive[kind] = 0;
      const prototype = WebGL2RenderingContext.prototype;
      for (const [name, step] of [[`create${kind}`, 1], [`delete${kind}`, -1]]) {
        const original = prototype[name];
        prototype[name] = function (...args) {
          if (step === 1 || args[0]) globalThis.alive[kind] += step;
          return original.apply(this, args);
        };
      }
    }
  });
  const server = await start(t);
  const site = await server.open({}, countObjects, `?src=${server.serve('ball.ply', toPly(spherePoints(4000)))}#view=compare&colors=error`);
  const { page } = site;
  await site.opened('ball.ply');
  await page.keyboard.press('e');
  const debug = await page.context().newCDPSession(page);
  const measure = async () => {
    await debug.send('HeapProfiler.collectGarbage');
    const { metrics } = await debug.send('Performance.getMetrics');
    const value = (name) => metrics.find((metric) => metric.name === name).value;
    const { usedSize, backingStorageSize = 0 } = await debug.send('Runtime.getHeapUsage');
    return {
      heap: usedSize + backingStorageSize, nodes: value('Nodes'), listeners: value('JSEventListeners'),
      workers: page.workers().length, gpu: await page.evaluate(() => ({ ...globalThis.alive })),
    };
  };
  await debug.send('Performance.enable');
  const points = spherePoints(4000);
  const marks = [];
  for (let k = 0; k < 20; k++) {
    const name = `ball ${k}.ply`;
    await site.drop(name, toPly(points.map((p) => p.map((x) => x * (1 + k)))));
    await site.opened(name);
    await site.show('reduced'); // comparing shows the two others
    await site.show('compare');
    if (k === 4 || k === 19) marks.push(await measure());
  }
  const [early, late] = marks;
  t.diagnostic(`after 5 and after 20 scans: ${JSON.stringify(early)} ${JSON.stringify(late)}`);
  assert.ok(late.heap < 1.25 * early.heap + 2e6, 'the heap stays as it is');
  assert.deepEqual(late.gpu, early.gpu, 'buffers, textures and programs of old scans are freed');
  assert.equal(late.workers, early.workers);
  assert.ok(late.nodes < 1.1 * early.nodes + 50 && late.listeners < 1.1 * early.listeners + 20);
  assert.deepEqual(site.faults, []);
});
