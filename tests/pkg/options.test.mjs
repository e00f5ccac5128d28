// Options: checked at the border with a helpful error, and the same in JavaScript and in Rust.

import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import test from 'node:test';
import { DEFAULTS, PointweaveError, createEngine, inspect, read, reconstruct, reduce, sample, write } from 'pointweave';
import { loadBindings } from '../../pkg/engine/wasm-bindings.js';
import { rejection, sphere } from './support.mjs';

const cloud = sphere(500);

/** Asserts that a call rejects with `bad-option`, and gives the error. */
async function badOption(promise) {
  const error = await rejection(promise);
  assert.ok(error instanceof PointweaveError, String(error));
  assert.equal(error.code, 'bad-option');
  return error;
}

test('an unknown option is named, with the nearest name', async () => {
  const error = await badOption(reduce(cloud, { fuzzifer: 2 }));
  assert.match(error.message, /fuzzifer.*did you mean fuzzifier\?/);
  assert.equal(error.expected, 'fuzzifier');
  assert.equal(error.found, 'fuzzifer');

  const nested = await badOption(reconstruct(cloud, { reduce: { sed: 1 } }));
  assert.match(nested.message, /reduce\.sed.*did you mean seed\?/);

  const moved = await badOption(reduce(cloud, { ratio: 0.5 }));
  assert.match(moved.message, /did you mean target: \{ ratio \}\?/);

  const [target, ratio] = [await badOption(reconstruct(cloud, { target: { ratio: 0.5 } })), await badOption(reconstruct(cloud, { ratio: 0.5 }))];
  assert.match(target.message, /did you mean reduce: \{ target \}\?/);
  assert.match(ratio.message, /did you mean reduce: \{ target: \{ ratio \} \}\?/);

  const strange = await badOption(reduce(cloud, { purple: 1 }));
  assert.doesNotMatch(strange.message, /did you mean/);
  assert.ok(strange.expected.includes('target'));
});

test('every wrong value is named, with what was expected', async () => {
  const wrong = [
    { target: { ratio: 0 } }, { target: { ratio: 1.01 } }, { target: { ratio: NaN } }, { target: { ratio: '0.5' } },
    { target: { count: 0 } }, { target: { count: 1.5 } }, { target: { tolerance: 1 } }, { target: { flatness: Infinity } },
    { target: { ratio: 0.5, count: 7 } }, { target: {} }, { target: 0.5 }, { target: null },
    { method: 'best' }, { fuzzifier: 1 }, { fuzzifier: NaN }, { epsilon: 0 }, { maxIterations: 0 }, { maxIterations: 2.5 },
    { norm: 'manhattan' }, { clusters: 3 }, { curvatureWeight: -0.1 }, { placement: 'on' }, { seed: -1 }, { seed: 0.5 },
    { cellPoints: 7 }, { maxDepth: 22 },
    { attributes: 'majority' }, { attributes: null }, { attributes: ['height'] }, { attributes: { height: 'median' } },
    { attributes: { height: undefined } }, { attributes: { depth: 'mean' } }, { assignment: 1 }, { assignment: null },
    { outliers: 'remove' }, { outliers: true },
    { signal: 'stop' }, { onProgress: true }, { transfer: 1 },
  ];
  for (const options of wrong) {
    const [key] = Object.keys(options);
    const error = await badOption(reduce(cloud, options));
    assert.match(error.message, new RegExp(`option ${key}`), error.message);
    assert.equal(typeof error.expected, 'string');
  }
  const surface = [
    { reduce: true }, { accuracy: 0 }, { kernel: 'gauss' }, { smoothing: -1 }, { smoothing: 'none' }, { orient: 1 },
    { propagation: 'local' }, { resolution: 0.5 }, { sharp: 'yes' }, { boundary: 'shut' }, { scatter: 'none' },
  ];
  for (const options of surface) await badOption(reconstruct(cloud, options));
  await badOption(reduce(cloud, 3));
  await badOption(inspect(cloud, { target: { ratio: 1 } }));
  await badOption(read(new Uint8Array(3), { format: 'doc' }));
  await badOption(write(cloud, { format: 'doc' }));
  await badOption(sample('goat'));
  await badOption(sample('duck', 500));
  await badOption(sample('duck', { model: 'pig' }));
  await badOption(sample('duck', { count: 0 }));
  await badOption(sample('duck', { count: 1e7 + 1 }));
  await badOption(sample('duck', { noise: 0.02 }));
  for (const options of [{ threads: 0 }, { threads: 'many' }, { worker: 1 }, { wasmUrl: 5 }, { wasmUrl: { double: 'x' } },
    { wasmUrl: '/wasm/single/pointweave_bg.wasm' }, { wasmUrl: new URL('https://cdn.example/a.wasm?v=2') }, { workers: true }]) {
    await badOption(createEngine(options));
  }
});

test('an attribute that the cloud does not have is named, with those that it has', async () => {
  for (const call of [
    reduce(cloud, { attributes: { heigth: 'majority' } }),
    reconstruct(cloud, { reduce: { attributes: { heigth: 'majority' } } }),
  ]) {
    const error = await badOption(call);
    assert.match(error.message, /option attributes is an object with heigth: expected .*height, colors$/);
    assert.equal(error.found, 'an object with heigth');
  }
  const bare = await badOption(reduce({ positions: cloud.positions }, { attributes: { colors: 'nearest' } }));
  assert.match(bare.message, /colors: expected an empty object/);
  const nested = await badOption(reconstruct(cloud, { reduce: { attributes: { height: 'sum' } } }));
  assert.match(nested.message, /option reduce\.attributes\.height is 'sum': expected one of 'mean', 'majority', 'nearest'/);
});

test('undefined means not given', async () => {
  const given = await reduce(cloud, { target: undefined, seed: undefined, signal: undefined });
  const bare = await reduce(cloud);
  assert.deepEqual(given.positions, bare.positions);
  const nested = await reconstruct(cloud, { reduce: { target: { ratio: 0.5, count: undefined }, norm: undefined } });
  assert.deepEqual(nested.positions, (await reconstruct(cloud, { reduce: { target: { ratio: 0.5 } } })).positions);
});

/** A wasm instance without the checks of the package in front. */
async function bareWasm() {
  const bindings = await loadBindings('single');
  await bindings.instantiate({ module_or_path: await readFile(new URL('../../pkg/wasm/single/pointweave_bg.wasm', import.meta.url)) });
  return bindings;
}

test('the defaults cannot be changed', () => {
  assert.ok(Object.isFrozen(DEFAULTS) && Object.isFrozen(DEFAULTS.reduce) && Object.isFrozen(DEFAULTS.reconstruct.reduce.target));
});

test('giving the defaults changes nothing', async () => {
  const given = await reduce(cloud, DEFAULTS.reduce);
  const bare = await reduce(cloud);
  assert.deepEqual(given.positions, bare.positions);
});

test('Rust has the same ranges', async () => {
  const wasm = await bareWasm();
  /** Whether the package accepts these options, and whether Rust alone does. */
  const verdicts = async (call, options) => {
    const controller = new AbortController();
    const stop = () => controller.abort('accepted');
    const js = await rejection(call === 'reduce'
      ? reduce(cloud, { ...options, signal: controller.signal, onProgress: stop })
      : reconstruct(cloud, { ...options, signal: controller.signal, onProgress: stop }));
    let rust;
    try {
      wasm[call]({ ...cloud }, options, () => true);
    } catch (error) {
      rust = error;
    }
    return [js === 'accepted', rust?.code === 'cancelled'];
  };
  const edges = {
    reduce: [
      ['target', [[{ ratio: 1 }, true], [{ ratio: 1e-9 }, true], [{ ratio: 0 }, false], [{ ratio: 1.0001 }, false],
        [{ count: 1 }, true], [{ count: 0 }, false], [{ tolerance: 0.999 }, true], [{ tolerance: 1 }, false],
        [{ flatness: 1 }, true], [{ flatness: 0 }, false], [{}, false]]],
      ['fuzzifier', [[1, false], [1.001, true], [100, true], [100.1, false]]],
      ['epsilon', [[0, false], [1, true], [1.1, false]]],
      ['maxIterations', [[0, false], [1, true], [100_000, true], [100_001, false]]],
      ['curvatureWeight', [[0, true], [1, true], [1.1, false], [-0.1, false]]],
      ['cellPoints', [[7, false], [8, true], [65_536, true], [65_537, false]]],
      ['maxDepth', [[0, false], [1, true], [21, true], [22, false]]],
      ['seed', [[0, true], [2 ** 53 - 1, true], [-1, false]]],
      ['attributes', [[{}, true], [{ height: 'mean', colors: 'majority' }, true], [{ height: 'nearest' }, true],
        [{ height: 'other' }, false], [{ depth: 'mean' }, false], ['mean', false]]],
      ['assignment', [[true, true], [false, true], [1, false]]],
      ['cells', [[true, true], [1, false]]],
      ...[['method', ['adaptive', 'paper']], ['norm', ['euclidean', 'diagonal', 'mahalanobis']],
        ['clusters', ['proportional', 'validity']], ['placement', ['implicit', 'mesh', 'center', 'sample']],
        ['outliers', ['keep', 'drop']]]
        .map(([key, names]) => [key, [...names.map((name) => [name, true]), ['other', false]]]),
    ],
    reconstruct: [
      ['accuracy', [[0, false], [0.999, true], [1, false]]],
      ['triangles', [[1, true], [0, false], [1.5, false], [1e6, true]]],
      ['smoothing', [['auto', true], [0, true], [1e6, true], [1.1e6, false], [-1, false], ['other', false]]],
      ['resolution', [['auto', true], [1e-4, true], [0.25, true], [0.26, false], [9e-5, false]]],
      ['reduce', [[false, true], [true, false], [{}, true], [{ maxDepth: 22 }, false]]],
      ...[['kernel', ['biharmonic', 'triharmonic', 'thin-plate']], ['propagation', ['global', 'paper']], ['orientation', ['auto', 'up', 'outward', 'inward']],
        ['boundary', ['auto', 'closed', 'base', 'open']]]
        .map(([key, names]) => [key, [...names.map((name) => [name, true]), ['other', false]]]),
      ['orient', [[true, true], [1, false]]],
      ['flip', [[true, true], ['no', false]]],
      ['sharp', [[false, true], ['no', false]]],
      ['distances', [[true, true], [1, false]]],
      ['keep', [[true, true], ['yes', false]]],
    ],
  };
  for (const [call, options] of Object.entries(edges)) {
    for (const [key, values] of options) {
      for (const [value, good] of values) {
        assert.deepEqual(await verdicts(call, { [key]: value }), [good, good], `${call} ${key}: ${JSON.stringify(value)}`);
      }
    }
  }
});
