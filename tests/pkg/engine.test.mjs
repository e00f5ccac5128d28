// The life of an engine: which build, the queue, progress, aborts, workers.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { availableParallelism } from 'node:os';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import test from 'node:test';
import { setImmediate } from 'node:timers/promises';
import { promisify } from 'node:util';
import { setFlagsFromString } from 'node:v8';
import { runInNewContext } from 'node:vm';
import { createEngine } from 'pointweave';
import { makeApi } from '../../pkg/engine/api.js';
import { workerHost } from '../../pkg/engine/worker-host.js';
import { sharedMemory } from '../../pkg/engine/memory.js';
import { platform } from '../../pkg/engine/platform.node.js';
import { engineFor, rejection, sphere } from './support.mjs';

const STAGES = ['octree', 'features', 'cluster', 'place', 'cells', 'fit', 'orient', 'extract', 'report'];

/** Takes seconds. */
const large = sphere(100_000);

/** Node's platform, which counts what is made. */
function counting(changes = {}) {
  const made = { compiled: 0, workers: 0 };
  const counted = {
    ...platform,
    compile: (...args) => (made.compiled++, platform.compile(...args)),
    startWorker: (...args) => (made.workers++, platform.startWorker(...args)),
    ...changes,
  };
  return { made, api: makeApi(counted) };
}

test('the build that was asked for, and why', async (t) => {
  const one = await engineFor(t, { threads: 1 });
  assert.deepEqual([one.build, one.threads, one.reason], ['single', 1, 'one thread was asked for']);
  const two = await engineFor(t, { threads: 2 });
  assert.deepEqual([two.build, two.threads, two.reason], ['threads', 2, 'Node has threads']);
  const auto = await engineFor(t);
  assert.equal(auto.threads, Math.min(availableParallelism(), 16));
  const bound = await engineFor(t, { threads: 2, worker: false });
  assert.deepEqual([bound.build, bound.reason], ['single', 'threads need a worker']);
  const { api } = counting({ cores: () => 1 });
  const small = await api.createEngine();
  assert.deepEqual([small.build, small.reason], ['single', 'there is one processor core']);
  for (const engine of [one, two]) {
    const { report } = await engine.reconstruct(sphere());
    assert.deepEqual([report.build, report.threads], [engine.build, engine.threads]);
    assert.ok(report.reason.startsWith(engine.reason), report.reason);
    assert.ok(report.peakMemoryBytes > 1e6 && report.peakMemoryBytes % 65_536 === 0);
  }
});

test('a reduction takes no more than 160 bytes a point', async (t) => {
  const engine = await engineFor(t, { threads: 1 });
  const points = 300_000;
  const { positions } = sphere(points);
  const { report } = await engine.reduce({ positions });
  assert.ok(report.peakMemoryBytes <= 160 * points, `${report.peakMemoryBytes / points} bytes a point`);
});

test('threads that do not start leave the single-threaded build', async (t) => {
  const engine = await engineFor(t, { threads: 2, wasmUrl: { threads: 'file:///nowhere.wasm' } });
  assert.deepEqual([engine.build, engine.threads], ['single', 1]);
  assert.match(engine.reason, /threads build did not start: .*nowhere\.wasm/);
  assert.match((await engine.reduce(sphere())).report.reason, /did not start/);

  let workers = 0;
  const { api } = counting({ startWorker: () => platform.startWorker(++workers === 3 ? 'data:text/javascript,throw new Error("no room")' : undefined) });
  const broken = await api.createEngine({ threads: 2 });
  t.after(() => broken.dispose());
  assert.match(broken.reason, /^the threads build did not start: the worker did not start: no room$/);
  assert.deepEqual([broken.build, (await broken.reduce(sphere(500))).report.build], ['single', 'single']);
});

test('memory that cannot be shared, or not so much of it, is no end either', async (t) => {
  const { Memory } = WebAssembly;
  t.after(() => void (WebAssembly.Memory = Memory));
  const refuse = (above) => {
    WebAssembly.Memory = class extends Memory {
      constructor(limits) {
        if (limits.maximum > above / 65_536) throw new RangeError('could not allocate memory');
        super(limits);
      }
    };
  };
  refuse(2 ** 30);
  const limited = await engineFor(t, { threads: 2 });
  assert.deepEqual([limited.build, limited.reason], ['threads', 'Node has threads; memory is limited to 1024 MiB here']);
  assert.equal((await limited.reduce(sphere())).report.reason, limited.reason);
  refuse(0);
  const single = await engineFor(t, { threads: 2 });
  assert.deepEqual([single.build, single.reason], ['single', 'the threads build did not start: could not allocate memory']);
});

test('a pool that does not come is not waited for for ever', async () => {
  const stuck = () => {
    const worker = platform.startWorker();
    return { ...worker, post: (message, transfer) => message.request?.call !== 'lendThread' && worker.post(message, transfer) };
  };
  const module = await platform.compile('threads');
  const { memory } = sharedMemory();
  const error = await rejection(workerHost(stuck, { build: 'threads', threads: 2, module, memory, poolLimitMs: 500 }));
  assert.match(error.message, /no pool within 0.5 s/);
});

test('workers without a call end, and the next call has fresh ones', async (t) => {
  const ended = [];
  const { api } = counting({
    startWorker() {
      const worker = platform.startWorker();
      return { ...worker, terminate: () => (ended.push(worker), worker.terminate()) };
    },
  });
  const engine = await api.createEngine({ threads: 2, idleMs: 50 });
  t.after(() => engine.dispose());
  const idle = async (count) => {
    while (ended.length < count) await new Promise((resolve) => setTimeout(resolve, 10));
  };
  await idle(3);
  assert.equal((await engine.reduce(large)).positions.length / 3, 33_333, 'not idle while it works, however long');
  await idle(6);
  const patient = await api.createEngine({ threads: 1, worker: true, idleMs: Infinity });
  await new Promise((resolve) => setTimeout(resolve, 200));
  assert.equal(ended.length, 6);
  await patient.dispose();
  assert.equal(ended.length, 7);
});

test("the worker's script can lie elsewhere", async (t) => {
  const mine = `data:text/javascript,import ${JSON.stringify(import.meta.resolve('pointweave/worker'))}`;
  const engine = await engineFor(t, { threads: 2, workerUrl: mine });
  assert.equal(engine.build, 'threads');
  assert.equal((await engine.reduce(sphere(500))).positions.length / 3, 167);
  const error = await rejection(createEngine({ threads: 1, worker: true, workerUrl: 'nowhere.js' }));
  assert.equal(error.code, 'load-failed');
  assert.match(error.message, /the worker did not start: .*nowhere\.js/);
});

test('the wasm files can lie elsewhere', async (t) => {
  const folder = new URL('../../pkg/wasm/', import.meta.url);
  const single = new URL('single/pointweave_bg.wasm', folder);
  for (const wasmUrl of [folder, folder.href, folder.href.slice(0, -1), { single }, { single: single.href }]) {
    const asked = [];
    const { api } = counting({ compile: (build, url) => (asked.push(url), platform.compile(build, url)) });
    const engine = await api.createEngine({ threads: 1, wasmUrl });
    t.after(() => engine.dispose());
    assert.deepEqual(asked, [wasmUrl]);
    assert.equal((await engine.inspect(sphere(500))).count, 500);
  }
  assert.equal((await engineFor(t, { threads: 2, wasmUrl: folder })).build, 'threads');
});

test('the wasm files can lie on a server, in Node too', async (t) => {
  const wasm = await readFile(new URL('../../pkg/wasm/single/pointweave_bg.wasm', import.meta.url));
  const server = createServer(({ url }, answer) => (url === '/wasm/single/pointweave_bg.wasm' ? answer.end(wasm) : answer.writeHead(404).end()));
  await new Promise((resolve) => server.listen(0, 'localhost', resolve));
  t.after(() => server.close());
  const place = `http://localhost:${server.address().port}`;
  const engine = await engineFor(t, { threads: 1, wasmUrl: `${place}/wasm` });
  assert.equal((await engine.inspect(sphere(500))).count, 500);
  const error = await rejection(createEngine({ threads: 1, wasmUrl: `${place}/nowhere` }));
  assert.equal(error.code, 'load-failed');
  assert.match(error.message, /nowhere\/single\/pointweave_bg\.wasm did not load: 404/);
});

test('concurrent first calls start one host', async () => {
  const { made, api } = counting();
  const engine = await api.createEngine({ threads: 1, worker: true });
  await engine.dispose();
  assert.deepEqual(made, { compiled: 1, workers: 1 });
  await Promise.all([api.inspect(sphere(500)), api.inspect(sphere(500)), api.reduce(sphere(500))]);
  assert.equal(made.compiled, 2);
});

test('calls run one after the other, in order', async (t) => {
  for (const worker of [false, true]) {
    const engine = await engineFor(t, { threads: 1, worker });
    const log = [];
    const call = (name, count) => engine.reduce(sphere(count), { onProgress: () => log.push(name) }).then(() => log.push(`${name} done`));
    await Promise.all([call('a', 20_000), call('b', 500), call('c', 2000)]);
    const order = log.filter((entry, i) => entry !== log[i - 1]);
    assert.deepEqual(order.filter((entry) => !entry.endsWith('done')), ['a', 'b', 'c']);
    assert.deepEqual(order.filter((entry) => entry.endsWith('done')), ['a done', 'b done', 'c done']);
  }
});

test('a call that fails does not hold up the next', async (t) => {
  const engine = await engineFor(t, { threads: 1 });
  const bad = rejection(engine.reduce({ positions: new Float32Array(0) }));
  const good = engine.reduce(sphere(500));
  assert.equal((await bad).code, 'empty-cloud');
  assert.equal((await good).positions.length / 3, 167);
});

test('what a call gave is not kept', async (t) => {
  setFlagsFromString('--expose-gc');
  const collect = runInNewContext('gc');
  for (const threads of [1, 2]) {
    const engine = await engineFor(t, { threads });
    const results = [];
    for (let k = 0; k < 3; k++) results.push(new WeakRef(await engine.sample('duck', { count: 1000 })));
    await engine.sample('duck', { count: 10 }); // the last answer may still be held
    for (let k = 0; k < 20 && results.some((result) => result.deref()); k++) {
      await setImmediate();
      collect();
    }
    assert.deepEqual(results.map((result) => result.deref()), [undefined, undefined, undefined], `${threads} threads`);
  }
});

test('with keep, what would come out the same is not done again', async (t) => {
  const engine = await engineFor(t, { threads: 1 });
  const cloud = sphere(3000);
  const first = await engine.reconstruct(cloud, { keep: true });
  const second = await engine.reconstruct(cloud, { keep: true, sharp: false });
  const fresh = await engine.reconstruct(cloud, { sharp: false });
  const forgotten = await engine.reconstruct(cloud, { keep: true });
  assert.deepEqual(second.positions, fresh.positions);
  assert.deepEqual(second.indices, fresh.indices);
  assert.deepEqual(['features', 'cluster', 'fit'].map((stage) => stage in second.report.ms), [false, false, true]);
  for (const { report } of [first, fresh, forgotten]) assert.ok('features' in report.ms && 'cluster' in report.ms);
});

test('with keep, an abort leaves the worker and what it knew, where memory is shared', async (t) => {
  const cloud = sphere(30_000);
  for (const threads of [1, 2]) {
    const { made, api } = counting();
    const engine = await api.createEngine({ threads, worker: true });
    t.after(() => engine.dispose());
    const first = await engine.reconstruct(cloud, { keep: true });
    const workers = made.workers;
    for (const wanted of ['cluster', 'fit', 'extract']) {
      const controller = new AbortController();
      const reason = new Error(wanted);
      let asked = 0;
      const error = await rejection(engine.reconstruct(cloud, {
        keep: true,
        reduce: { target: { count: 8000 } },
        signal: controller.signal,
        onProgress({ stage }) {
          if (asked || stage !== wanted) return;
          asked = performance.now();
          controller.abort(reason);
        },
      }));
      assert.ok(performance.now() - asked < 100, `took ${performance.now() - asked} ms`);
      assert.equal(error, reason);
    }
    const again = await engine.reconstruct(cloud, { keep: true, boundary: 'open' });
    assert.equal(made.workers, workers, 'no worker was made anew');
    assert.ok(!('features' in again.report.ms), 'what was measured is not measured again');
    assert.deepEqual(again.cloud.positions, first.cloud.positions);
  }
});

test('with keep, a worker that does not stop by itself holds nobody up, and is ended', async (t) => {
  let workers = 0;
  const { api } = counting({
    startWorker() {
      const worker = platform.startWorker();
      workers++;
      // It never hears of the flag.
      return { ...worker, post: (message, transfer) => worker.post('start' in message ? { start: { ...message.start, stop: undefined } } : message, transfer) };
    },
  });
  const engine = await api.createEngine({ threads: 1, worker: true });
  t.after(() => engine.dispose());
  const controller = new AbortController();
  let asked = 0;
  const aborted = rejection(engine.reconstruct(large, {
    keep: true,
    signal: controller.signal,
    onProgress({ stage }) {
      if (asked || stage !== 'cluster') return;
      asked = performance.now();
      controller.abort('enough');
    },
  }));
  const next = aborted.then(() => engine.reduce(sphere(500)));
  assert.equal(await aborted, 'enough');
  assert.ok(performance.now() - asked < 100);
  assert.equal((await next).positions.length / 3, 167);
  assert.equal(workers, 2, 'it has a fresh one');
});

test('progress goes through the stages, never back, and ends at 1', async (t) => {
  for (const worker of [false, true]) {
    const engine = await engineFor(t, { threads: 1, worker });
    for (const [call, stages] of [['reduce', ['octree', 'features', 'cluster', 'place', 'report']], ['reconstruct', STAGES], ['inspect', ['octree', 'features']]]) {
      const seen = [];
      await engine[call](sphere(10_000), { onProgress: (progress) => seen.push(progress) });
      assert.ok(seen.length > 3, `${call} said ${seen.length} things`);
      let before = 0;
      for (const { stage, fraction, overall } of seen) {
        assert.ok(STAGES.includes(stage), stage);
        assert.ok(fraction >= 0 && fraction <= 1 && overall >= before && overall <= 1, `${call}: ${stage} ${fraction} ${overall}`);
        before = overall;
      }
      assert.equal(seen.at(-1).overall, 1);
      assert.equal(seen.filter(({ overall }) => overall === 1).length, 1, 'one end');
      const order = [...new Set(seen.map(({ stage }) => stage))];
      assert.deepEqual(order, stages, call);
    }
  }
});

test('wasm is compiled once, however many engines have it', async () => {
  const [first, second, other] = await Promise.all(['single', 'single', 'threads'].map((build) => platform.compile(build)));
  assert.equal(first, second);
  assert.notEqual(first, other);
});

test('an abort ends a worker within 100 ms; the next call has a fresh one', async (t) => {
  for (const threads of [1, 2]) {
    const { made, api } = counting();
    const engine = await api.createEngine({ threads, worker: true });
    t.after(() => engine.dispose());
    const controller = new AbortController();
    const reason = new Error('enough');
    let asked = 0;
    const error = await rejection(engine.reconstruct(large, {
      signal: controller.signal,
      onProgress({ stage }) {
        if (asked || stage !== 'features') return;
        asked = performance.now();
        setTimeout(() => {
          asked = performance.now();
          controller.abort(reason);
        }, 20);
      },
    }));
    assert.ok(performance.now() - asked < 100, `took ${performance.now() - asked} ms`);
    assert.equal(error, reason);
    assert.equal((await engine.reduce(sphere(500))).positions.length / 3, 167);
    const perHost = threads === 1 ? 1 : 1 + threads;
    assert.equal(made.workers, 2 * perHost);
  }
});

test('in process, an abort from onProgress stops the work', async (t) => {
  const engine = await engineFor(t, { threads: 1 });
  for (const reason of [new Error('enough'), 'a string', undefined]) {
    const controller = new AbortController();
    let after = 0;
    const error = await rejection(engine.reduce(large, {
      signal: controller.signal,
      onProgress({ stage }) {
        if (controller.signal.aborted) after++;
        if (stage === 'features') controller.abort(reason);
      },
    }));
    assert.equal(error, controller.signal.reason);
    assert.equal(after, 0, 'it went on');
  }
  assert.equal((await engine.reduce(sphere(500))).positions.length / 3, 167);
});

test('an abort before or while waiting rejects at once', async (t) => {
  for (const worker of [false, true]) {
    const engine = await engineFor(t, { threads: 1, worker });
    const error = await rejection(engine.reduce(sphere(), { signal: AbortSignal.abort('early') }));
    assert.equal(error, 'early');
    const running = engine.reduce(sphere(20_000));
    const controller = new AbortController();
    const waiting = rejection(engine.reduce(large, { signal: controller.signal }));
    controller.abort('changed my mind');
    assert.equal(await waiting, 'changed my mind');
    assert.equal((await running).positions.length / 3, 6667);
  }
});

test('what onProgress throws is what the call rejects with', async (t) => {
  for (const worker of [false, true]) {
    const engine = await engineFor(t, { threads: 1, worker });
    const mine = new RangeError('mine');
    const error = await rejection(engine.reduce(sphere(20_000), { onProgress() { throw mine; } }));
    assert.equal(error, mine);
    assert.equal((await engine.reduce(sphere(500))).positions.length / 3, 167);
  }
});

test('a worker that dies in the middle rejects its call, whichever it was, and the next call works', async (t) => {
  for (const victim of [0, 2]) {
    const workers = [];
    const { api } = counting({ startWorker: () => (workers.push(platform.startWorker()), workers.at(-1)) });
    const engine = await api.createEngine({ threads: 2 });
    t.after(() => engine.dispose());
    const error = await rejection(engine.reconstruct(large, {
      onProgress: ({ stage }) => stage === 'features' && workers[victim].terminate(),
    }));
    assert.equal(error.code, 'internal');
    assert.match(error.message, /the worker died/);
    assert.equal((await engine.reduce(sphere(500))).positions.length / 3, 167);
    assert.equal(workers.length, 6);
  }
});

test('dispose ends the workers, and the call under way', async () => {
  const ended = new Set();
  const { api } = counting({
    startWorker() {
      const worker = platform.startWorker();
      return { ...worker, terminate: () => (ended.add(worker), worker.terminate()) };
    },
  });
  const idle = await api.createEngine({ threads: 1, worker: true });
  await idle.dispose();
  assert.equal(ended.size, 1);
  ended.clear();
  const engine = await api.createEngine({ threads: 2 });
  const running = rejection(engine.reconstruct(large));
  await new Promise((resolve) => setTimeout(resolve, 200));
  await engine.dispose();
  assert.equal((await running).code, 'disposed');
  assert.equal(ended.size, 3, 'one that computes and two that lend their threads');
});

test('a process ends by itself, and does not end before its results are there', async () => {
  const script = `
    import { createEngine } from 'pointweave';
    for (const options of [{ threads: 1 }, { threads: 1, worker: true }, { threads: 2 }]) {
      const engine = await createEngine(options);
      engine.reduce({ positions: Float32Array.from({ length: 3000 }, (_, i) => Math.sin(i * i)) })
        .then(({ positions }) => console.log(engine.build, positions.length));
    }`;
  const { stdout } = await promisify(execFile)(process.execPath, ['--input-type=module', '--eval', script], {
    cwd: new URL('..', import.meta.url), timeout: 60_000,
  });
  assert.deepEqual(stdout.trim().split('\n').sort(), ['single 999', 'single 999', 'threads 999']);
});

test('the browser entry can be imported on a server', async () => {
  const web = await import('../../pkg/index.js');
  const node = await import('pointweave');
  assert.deepEqual(Object.keys(web).sort(), Object.keys(node).sort());
});

test('the shared engine is made on the first call', async () => {
  const { made, api } = counting();
  assert.equal(made.compiled, 0);
  await api.reduce(sphere(500));
  await api.reduce(sphere(500));
  assert.equal(made.compiled, 1);
});
