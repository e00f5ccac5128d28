// Whose memory is whose: inputs are left alone, results belong to the caller.

import assert from 'node:assert/strict';
import test from 'node:test';
import { reconstruct, reduce } from 'pointweave';
import { arraysOf, engineFor, rejection, sphere } from './support.mjs';

for (const worker of [false, true]) {
  const where = worker ? 'with a worker' : 'in process';

  test(`inputs are neither changed nor detached, ${where}`, async (t) => {
    const engine = await engineFor(t, { threads: 1, worker });
    const cloud = sphere();
    const before = structuredClone(cloud);
    await engine.reduce(cloud);
    await engine.reconstruct(cloud);
    await engine.inspect(cloud);
    assert.deepEqual(cloud, before);
  });

  test(`transfer takes the buffers over, ${where}`, async (t) => {
    const engine = await engineFor(t, { threads: 1, worker });
    const copied = await engine.reduce(sphere());
    const cloud = sphere();
    const taken = await engine.reduce(cloud, { transfer: true });
    for (const [name, array] of Object.entries(arraysOf(cloud))) assert.equal(array.length, 0, name);
    assert.deepEqual(taken.positions, copied.positions);
    assert.deepEqual(taken.colors, copied.colors);
  });

  test(`a rejected call takes nothing over, ${where}`, async (t) => {
    const engine = await engineFor(t, { threads: 1, worker });
    const cloud = sphere();
    await rejection(engine.reduce(cloud, { transfer: true, method: 'none' }));
    await rejection(engine.reduce(cloud, { transfer: true, signal: AbortSignal.abort() }));
    assert.equal(cloud.positions.length, 6000);
  });

  test(`changes after the call do not reach it, ${where}`, async (t) => {
    const engine = await engineFor(t, { threads: 1, worker });
    const expected = await engine.reduce(sphere());
    const cloud = sphere();
    const promise = engine.reduce(cloud);
    cloud.positions.fill(NaN);
    assert.deepEqual((await promise).positions, expected.positions);
  });

  test(`results own their memory, ${where}`, async (t) => {
    const engine = await engineFor(t, { threads: 1, worker });
    const cloud = sphere();
    const first = await engine.reconstruct(cloud);
    const kept = structuredClone(arraysOf(first));
    await engine.reconstruct(sphere(3000));
    assert.deepEqual(arraysOf(first), kept);
    for (const [name, array] of Object.entries(arraysOf(first))) {
      assert.ok(array.buffer instanceof ArrayBuffer, name);
      assert.equal(array.byteLength, array.buffer.byteLength, `${name} is a view of something larger`);
      structuredClone(array, { transfer: [array.buffer] }); // throws for wasm's own memory
    }
  });
}

test('views and shared memory come in like any array', async () => {
  const cloud = sphere();
  const expected = await reduce(cloud);
  const wide = new Float32Array(cloud.positions.length + 14);
  const view = wide.subarray(7, 7 + cloud.positions.length);
  view.set(cloud.positions);
  const shared = new Float32Array(new SharedArrayBuffer(cloud.positions.byteLength));
  shared.set(cloud.positions);
  for (const positions of [view, shared]) assert.deepEqual((await reduce({ positions })).positions, expected.positions);
  assert.deepEqual((await reduce({ positions: shared }, { transfer: true })).positions, expected.positions);
});

test('results have the type of the input, and everything that an input carries', async () => {
  for (const type of [Float32Array, Float64Array]) {
    const cloud = { ...sphere(2000, { type }), origin: [4e6, 5e5, 120] };
    const reduced = await reduce(cloud, { target: { count: 600 } });
    const mesh = await reconstruct(cloud);
    for (const part of [reduced, mesh, mesh.cloud]) {
      assert.ok(part.positions instanceof type);
      assert.deepEqual(part.origin, cloud.origin);
      const points = part.positions.length / 3;
      assert.equal(part.normals.length, 3 * points);
      assert.equal(part.colors.length, 3 * points);
      assert.equal(part.attributes.height.length, points);
      for (let i = 0; i < points; i++) {
        const z = part.positions[3 * i + 2];
        assert.ok(Math.abs(part.attributes.height[i] - z) < 0.1, `height ${part.attributes.height[i]} at ${z}`);
        assert.ok(Math.abs(part.colors[3 * i + 1] - 127.5 * (z + 1)) < 13);
      }
    }
    assert.equal(reduced.positions.length, 1800);
    assert.equal(reduced.weights.reduce((sum, w) => sum + w, 0), 2000);
    assert.ok(reduced.nearest.every((i) => i < 2000) && reduced.variation.length === 600);
  }
});

test('labels and colours are carried as they are told to', async () => {
  const cloud = sphere(3000);
  const label = cloud.attributes.height.map((z) => (z > 0 ? 2 : 9));
  cloud.attributes = { mixed: label, label, picked: label };
  const reduced = await reduce(cloud, { attributes: { label: 'majority', picked: 'nearest', colors: 'nearest' } });
  const { mixed, label: voted, picked } = reduced.attributes;
  assert.ok(mixed.some((value) => value !== 2 && value !== 9), 'means lie between the labels');
  assert.ok(voted.every((value) => value === 2 || value === 9));
  reduced.nearest.forEach((input, i) => {
    assert.equal(picked[i], label[input]);
    assert.deepEqual(reduced.colors.slice(3 * i, 3 * i + 3), cloud.colors.slice(3 * input, 3 * input + 3));
  });
});

test('every input point is assigned to a reduced point', async () => {
  const cloud = sphere(3000);
  assert.equal((await reduce(cloud)).assignment, undefined);
  const reduced = await reduce(cloud, { assignment: true });
  const mesh = await reconstruct(cloud, { reduce: { assignment: true } });
  for (const { assignment, weights, positions } of [reduced, mesh.cloud]) {
    assert.ok(assignment instanceof Uint32Array && assignment.length === 3000);
    const members = new Float32Array(weights.length);
    assignment.forEach((reducedPoint, i) => {
      members[reducedPoint]++;
      const apart = [0, 1, 2].map((axis) => positions[3 * reducedPoint + axis] - cloud.positions[3 * i + axis]);
      assert.ok(Math.hypot(...apart) < 0.2, `input point ${i}`);
    });
    assert.deepEqual(members, weights);
  }
});

test('the sub-domains are boxes that hold every point', async () => {
  const cloud = sphere(3000, { center: [100, 0, 0] });
  assert.equal((await reduce(cloud)).cells, undefined);
  for (const method of ['adaptive', 'paper']) {
    const { cells, report } = await reduce(cloud, { method, cells: true });
    assert.ok(cells instanceof Float32Array && cells.length === 6 * report.cells && report.cells > 4);
    const holds = (k, i) => [0, 1, 2].every((axis) => {
      const value = cloud.positions[3 * i + axis];
      return cells[6 * k + axis] - 1e-4 <= value && value <= cells[6 * k + 3 + axis] + 1e-4;
    });
    for (let i = 0; i < 3000; i += 7) {
      assert.ok(Array.from({ length: report.cells }, (_, k) => k).some((k) => holds(k, i)), `${method}: point ${i}`);
    }
  }
});

test('a map of the distances adds up to the report, point by point and on the vertices', async () => {
  const clean = sphere(3000);
  const cloud = { positions: Float32Array.of(9, 0, 0, ...clean.positions) };
  assert.equal((await reconstruct(cloud)).distances, undefined);
  const mesh = await reconstruct(cloud, { distances: true, reduce: { outliers: 'drop', target: { count: 500 } } });
  const { points, vertices } = mesh.distances;
  assert.equal(points.length, 3001);
  assert.equal(vertices.length, mesh.positions.length / 3);
  assert.ok(Number.isNaN(points[0]), 'the stray was dropped');
  const kept = points.subarray(1);
  const { mean, rms, max } = mesh.report.distance;
  const near = (found, expected) => assert.ok(Math.abs(found - expected) < 1e-5 * expected, `${found}, not ${expected}`);
  near(kept.reduce((sum, d) => sum + d, 0) / 3000, mean);
  near(Math.sqrt(kept.reduce((sum, d) => sum + d * d, 0) / 3000), rms);
  near(Math.max(...kept), max);
  // A vertex has the mean of points around it: no more than the largest, and something nearly everywhere.
  const known = vertices.filter((d) => !Number.isNaN(d));
  assert.ok(known.length > 0.9 * vertices.length && known.every((d) => d >= 0 && d <= Math.fround(max)));
});

test('outliers are dropped when they are to be, and indices stay those of the input', async () => {
  const clean = sphere(3000);
  const strays = [9, 0, 0, -7, 7, 0, 0, 0, 0.02, 0, -8, 6, 0, -8.01, 6];
  // The strays come first, so that every index of the others is shifted.
  const cloud = {
    positions: Float32Array.of(...strays, ...clean.positions),
    attributes: { index: Float32Array.from({ length: 3005 }, (_, i) => i) },
  };
  const options = { outliers: 'drop', assignment: true, attributes: { index: 'nearest' } };
  const reduced = await reduce(cloud, options);
  const mesh = await reconstruct(cloud, { reduce: options });
  for (const { report, assignment, nearest, weights, positions, attributes } of [reduced, mesh.cloud]) {
    assert.deepEqual([report.inputPoints, report.outliers, report.outputPoints], [3005, 5, 1000]);
    assert.deepEqual([...assignment.slice(0, 5)], Array(5).fill(0xffffffff));
    assert.ok(assignment.length === 3005 && assignment.slice(5).every((i) => i < 1000));
    assert.equal(weights.reduce((sum, w) => sum + w, 0), 3000);
    assert.ok(nearest.every((i) => i >= 5));
    assert.deepEqual([...attributes.index], [...nearest]);
    assert.ok(positions.every((x) => Math.abs(x) < 1.05), 'in the frame of the caller');
  }
  assert.equal(mesh.report.outliers, 5);
  assert.deepEqual(mesh.report.genus, [0]);
  const kept = await reduce(cloud);
  assert.equal(kept.report.outliers, 0);
  assert.equal(kept.weights.reduce((sum, w) => sum + w, 0), 3005);
  assert.equal((await reconstruct(cloud, { reduce: false })).cloud.report.outliers, 0);
});

test('what is mostly isolated is not dropped, and the report says so', async () => {
  const positions = Float32Array.from({ length: 15 }, (_, i) => i * i);
  const { report } = await reduce({ positions }, { outliers: 'drop' });
  assert.equal(report.outliers, 0);
  assert.match(report.reason, /; 5 points, more than half, are isolated: none was dropped$/);
});

test('georeferenced clouds keep their precision', async () => {
  const center = [4_512_345.678, 543_210.123, 87.5];
  const here = await reduce(sphere(2000, { type: Float64Array }));
  const there = await reduce(sphere(2000, { type: Float64Array, center }));
  for (let i = 0; i < here.positions.length; i++) {
    assert.ok(Math.abs(there.positions[i] - center[i % 3] - here.positions[i]) < 1e-5);
  }
});
