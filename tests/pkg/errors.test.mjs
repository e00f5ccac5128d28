// Every error code of the package, reached through its functions.

import assert from 'node:assert/strict';
import test from 'node:test';
import { PointweaveError, createEngine, inspect, read, reconstruct, reduce, write } from 'pointweave';
import { makeApi } from '../../pkg/engine/api.js';
import { platform } from '../../pkg/engine/platform.node.js';
import { engineFor, rejection, sphere } from './support.mjs';

/** Asserts what a promise rejects with, and gives the error. */
async function rejects(promise, code, fields = {}) {
  const error = await rejection(promise);
  assert.ok(error instanceof PointweaveError, String(error));
  assert.equal(error.code, code, error.message);
  assert.equal(error.name, 'PointweaveError');
  assert.notEqual(error.message, '');
  for (const [name, value] of Object.entries(fields)) assert.deepEqual(error[name], value, `${name} of: ${error.message}`);
  return error;
}

const text = (content) => new TextEncoder().encode(content);

for (const worker of [false, true]) {
  test(`errors of the cloud, ${worker ? 'with a worker' : 'in process'}`, async (t) => {
    const engine = await engineFor(t, { threads: 1, worker });
    const { positions } = sphere(500);
    for (const call of ['reduce', 'reconstruct']) {
      await rejects(engine[call]({ positions: new Float32Array(0) }), 'empty-cloud', { found: '0 points' });
      await rejects(engine[call]({ positions: positions.slice(0, 7) }), 'bad-length', { found: '7' });
      await rejects(engine[call]({ positions, colors: new Uint8Array(3) }), 'bad-length', { found: '3' });
      await rejects(engine[call]({ positions, normals: new Float32Array(9) }), 'bad-length', { found: '9' });
      await rejects(engine[call]({ positions, attributes: { age: new Float32Array(1) } }), 'bad-length', { found: '1' });
      for (const [bad, found] of [[NaN, 'NaN'], [Infinity, 'inf'], [-Infinity, '-inf']]) {
        const broken = positions.slice();
        broken[3 * 41 + 1] = bad;
        await rejects(engine[call]({ positions: broken }), 'non-finite', { index: 41, found });
      }
    }
    await rejects(engine.reconstruct({ positions: positions.slice(0, 6) }), 'too-few-points');
    await rejects(engine.reconstruct({ positions: new Float32Array(3000).fill(2) }), 'degenerate');
    const line = Float32Array.from({ length: 3000 }, (_, i) => Math.floor(i / 3) * [1, 2, -1][i % 3]);
    await rejects(engine.reconstruct({ positions: line }), 'degenerate');
  });

  test(`errors of files, ${worker ? 'with a worker' : 'in process'}`, async (t) => {
    const engine = await engineFor(t, { threads: 1, worker });
    await rejects(engine.read(text('<html>and so on')), 'unknown-format', { found: 'an XML or HTML document' });
    await rejects(engine.read(text('LASF and so on')), 'bad-file', { index: 0 });
    const header = 'ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n';
    const short = await rejects(engine.read(text(`${header}1 2 3\n`)), 'bad-file');
    assert.ok(short.index >= 8, `at line ${short.index}`);
    const word = await rejects(engine.read(text(`${header}1 2 3\n1 two 3\n`)), 'bad-file', { index: 9 });
    assert.match(word.message, /two/);
    await rejects(engine.read(Uint8Array.of(0xff, 0xfe, 0x31, 0), { format: 'xyz' }), 'unsupported-file', { found: 'UTF-16 text' });
  });
}

test('arguments of the wrong kind are bad input', async () => {
  const { positions } = sphere(10);
  const origin = [1, 2, NaN];
  for (const cloud of [undefined, null, 5, 'cloud', {}, { positions: [...positions] }, { positions: new Int16Array(3) },
    { positions, colors: new Float32Array(30) }, { positions, normals: new Float64Array(30) },
    { positions, attributes: { age: [1] } }, { positions, origin }, { positions, origin: [1, 2] }]) {
    for (const call of [reduce, reconstruct, inspect, write]) await rejects(call(cloud), 'bad-input');
  }
  await rejects(write({ positions, indices: [0, 1, 2] }), 'bad-input', { expected: 'a Uint32Array', found: 'Array' });
  for (const data of [undefined, null, 'ply', [1, 2, 3]]) await rejects(read(data), 'bad-input');
});

test('arrays that were handed over are told from empty ones', async () => {
  const { positions, colors } = { ...sphere(10), colors: new Uint8Array(30) };
  await reduce({ positions, colors }, { transfer: true });
  for (const call of [reduce, reconstruct, inspect, write]) await rejects(call({ positions }), 'detached');
  const error = await rejects(reduce({ positions: sphere(10).positions, colors }), 'detached');
  assert.match(error.message, /^the memory of colors was handed over/);
  const bytes = text('1 2 3\n4 5 6\n7 8 9\n');
  await read(bytes, { transfer: true, format: 'xyz' });
  await rejects(read(bytes, { format: 'xyz' }), 'detached');
  await rejects(read(bytes.buffer, { format: 'xyz' }), 'detached');
  await rejects(reduce({ positions: new Float32Array(0) }), 'empty-cloud');
});

test('points beyond what wasm can address run out of memory, and the next call works', async (t) => {
  const engine = await engineFor(t, { threads: 1 });
  const positions = new Float32Array(2 ** 29 + 1);
  await rejects(engine.inspect({ positions }, { transfer: true }), 'out-of-memory');
  assert.equal((await engine.reduce(sphere(500))).positions.length / 3, 167);
});

/** A platform whose first instance dies in its first call of `reduce`, the way wasm does. */
function dying(trap, panic) {
  let instances = 0;
  return {
    ...platform,
    async loadBindings(build) {
      const bindings = await platform.loadBindings(build);
      if (instances++ > 0) return bindings;
      return { ...bindings, panicMessage: () => panic, reduce() { throw trap; } };
    },
  };
}

test('a panic is internal, tells its text, and the next call has a fresh instance', async (t) => {
  const panic = 'panicked at src/fit.rs:1:2:\nindex out of bounds';
  for (const [trap, text, code, message] of [
    [new WebAssembly.RuntimeError('unreachable'), panic, 'internal', /index out of bounds/],
    [new WebAssembly.RuntimeError('memory access out of bounds'), '', 'internal', /memory access/],
    [new RangeError('Maximum call stack size exceeded'), '', 'internal', /call stack/],
    [new WebAssembly.RuntimeError('unreachable'), '', 'out-of-memory', /memory/],
    [new WebAssembly.RuntimeError('unreachable'), 'panicked at library/alloc: capacity overflow', 'out-of-memory', /memory/],
  ]) {
    const engine = await makeApi(dying(trap, text)).createEngine({ threads: 1 });
    t.after(() => engine.dispose());
    const error = await rejects(engine.reduce(sphere(500)), code);
    assert.match(error.message, message);
    assert.equal((await engine.reduce(sphere(500))).positions.length / 3, 167);
  }
});

test('wasm that does not load says which, and the next try is a new one', async () => {
  const error = await rejects(createEngine({ threads: 1, wasmUrl: 'file:///nowhere/' }), 'load-failed');
  assert.match(error.message, /nowhere\/single/);
  let failures = 1;
  const api = makeApi({
    ...platform,
    cores: () => 1,
    compile: (build, url) => (failures-- > 0 ? Promise.reject(new TypeError('offline')) : platform.compile(build, url)),
  });
  assert.match(String(await rejection(api.reduce(sphere(500)))), /offline/);
  assert.equal((await api.inspect(sphere(500))).count, 500);
});

test('a disposed engine says so', async () => {
  const engine = await createEngine({ threads: 1 });
  const waiting = rejects(engine.reduce(sphere()), 'disposed');
  await engine.dispose();
  await engine.dispose();
  await waiting;
  await rejects(engine.reduce(sphere()), 'disposed');
  await rejects(engine.inspect(sphere()), 'disposed');
});
