// Recipes: what prepare gives, before a reduction, and on the command line.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { PointweaveError, createEngine, prepare, read, reconstruct, reduce, sample, write } from 'pointweave';
import { load } from 'pointweave/core';
import { rejection } from './support.mjs';

const CLI = fileURLToPath(new URL('../../pkg/cli.js', import.meta.url));
const run = promisify(execFile);

/** A duck on a floor of a grid, a ball beside it, in single precision with all that a cloud may have. */
const duck = await sample('duck', { count: 4000 });
const low = duck.positions.reduce((least, y, i) => (i % 3 === 1 ? Math.min(least, y) : least), Infinity);
const floor = Array.from({ length: 80 * 80 }, (_, i) => [(i % 80) * 0.3 - 12, low, Math.floor(i / 80) * 0.3 - 12]).filter(([x, , z]) => Math.hypot(x, z) > 3);
const ball = Array.from({ length: 500 }, (_, i) => {
  const [up, turn] = [1 - (2 * i + 1) / 500, i * 2.39996];
  return [9 + Math.sqrt(1 - up * up) * Math.cos(turn), low + 1.2 + up, 9 + Math.sqrt(1 - up * up) * Math.sin(turn)];
});
const count = 4000 + floor.length + 500;
const scan = {
  positions: Float32Array.from([...duck.positions, ...floor.flat(), ...ball.flat()]),
  colors: Uint8Array.from({ length: 3 * count }, (_, i) => i % 251),
  attributes: { number: Float32Array.from({ length: count }, (_, i) => i) },
  origin: [500000, 20, 4e6],
  unit: 'cm',
  viewpoints: { positions: Float64Array.of(0, 40, 0, 40, 40, 0), of: Uint32Array.from({ length: count }, (_, i) => i % 2) },
};
const STEPS = [{ step: 'plane', drop: 'floor' }, { step: 'pieces', keep: 'largest' }];

test('a recipe leaves the object with all that is its own, and says what it dropped', async () => {
  const { cloud, kept, labels, steps } = await prepare(scan, STEPS);
  assert.ok(labels instanceof Uint8Array && labels.length === count);
  const right = labels.reduce((sum, label, i) => sum + (label === (i < 4000 ? 0 : i < count - 500 ? 1 : 2)), 0);
  assert.ok(right >= 0.99 * count, `${right} of ${count}`);
  assert.deepEqual([...kept], [...labels.keys()].filter((i) => labels[i] === 0));
  assert.ok(cloud.positions instanceof Float32Array);
  kept.forEach((i, k) => {
    assert.deepEqual([...cloud.positions.subarray(3 * k, 3 * k + 3)], [...scan.positions.subarray(3 * i, 3 * i + 3)]);
    assert.deepEqual([...cloud.colors.subarray(3 * k, 3 * k + 3)], [...scan.colors.subarray(3 * i, 3 * i + 3)]);
    assert.equal(cloud.attributes.number[k], i);
    assert.equal(cloud.viewpoints.of[k], i % 2);
  });
  assert.deepEqual([cloud.origin, cloud.unit, cloud.normals], [scan.origin, 'cm', undefined]);
  assert.deepEqual(steps.map(({ step, kept, dropped }) => [step, kept + dropped]), [['plane', count], ['pieces', steps[0].kept]]);
  const [plane] = steps[0].planes;
  assert.ok(plane.floor && plane.dropped && plane.normal[1] > 0.999 && Math.abs(plane.point[1] - low) < 0.05);
  assert.equal(steps[0].labels.length, count);
  const [piece, other] = steps[1].pieces;
  assert.ok(piece.kept && !other.kept && Math.abs(other.points - 500) < 20 && Math.abs(other.max[0] - 10) < 0.1);
  assert.equal(scan.positions.length, 3 * count, 'the scan is the caller\'s still');
});

test('a reduction and a mesh after a recipe are those of what it leaves, told of the points that were given', async () => {
  const options = { target: { ratio: 0.2 }, assignment: true };
  const { cloud, kept, labels } = await prepare(scan, STEPS);
  const alone = await reduce(cloud, options);
  const seen = [];
  const whole = await reduce(scan, { ...options, prepare: STEPS, onProgress: ({ stage, overall }) => seen.push([stage, overall]) });
  assert.deepEqual(whole.positions, alone.positions);
  assert.deepEqual(whole.prepared.labels, labels);
  assert.deepEqual([...whole.nearest], [...alone.nearest].map((i) => kept[i]));
  assert.equal(whole.assignment.length, count);
  kept.forEach((i, k) => assert.equal(whole.assignment[i], alone.assignment[k]));
  assert.equal(whole.assignment[count - 1], 0xffffffff);
  assert.ok(seen.every(([, overall], i) => i === 0 || overall >= seen[i - 1][1]) && seen.at(-1)[1] === 1);
  assert.ok(seen.some(([stage]) => stage === 'prepare') && seen.some(([stage]) => stage === 'cluster'));
  const mesh = await reconstruct(scan, { reduce: options, prepare: STEPS, distances: true });
  assert.equal(mesh.report.components, 1);
  assert.equal(mesh.distances.points.length, count);
  assert.ok(Number.isNaN(mesh.distances.points[count - 1]) && mesh.distances.points[kept[0]] < 0.02);
});

test('the floor that was dropped stays with the cloud, and a mesh has its base there', async () => {
  const { cloud } = await prepare(scan, STEPS);
  const { point, normal } = cloud.floor;
  assert.ok(normal[1] > 0.999 && Math.abs(point[1] - low) < 0.05, JSON.stringify(cloud.floor));
  assert.equal((await prepare(scan, [{ step: 'outliers' }])).cloud.floor, undefined);
  assert.deepEqual((await reduce(cloud)).floor.point, point);
  const mesh = await reconstruct(scan, { prepare: STEPS, boundary: 'base' });
  assert.equal(mesh.report.boundaryEdges, 0);
  const over = Array.from({ length: mesh.positions.length / 3 }, (_, i) => normal.reduce((sum, x, k) => sum + x * (mesh.positions[3 * i + k] - point[k]), 0));
  assert.ok(Math.abs(Math.min(...over)) < 1e-3, `${Math.min(...over)}`);
  assert.ok(over.filter((height) => Math.abs(height) < 1e-3).length > 50);
  for (const floor of [1, { point }, { point, normal: [0, 1] }]) assert.equal((await rejection(reduce({ ...cloud, floor }))).code, 'bad-input');
  assert.equal((await rejection(reduce({ ...cloud, floor: { point, normal: [0, 0, 0] } }))).code, 'bad-option');
});

test('regions cut as they say, each with what those before left', async () => {
  const camera = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 20]; // a twentieth of x and y
  const steps = [
    { step: 'box', min: [-20, low + 0.1, -20], max: [20, 20, 20] },
    { step: 'sphere', center: [9, low + 1.2, 9], radius: 2, keep: false },
    { step: 'half-space', point: [0, 0, 0], normal: [1, 0, 0] },
    { step: 'polygon', points: [0, -1, 1, -1, 1, 0.1, 0, 0.1], camera },
  ];
  const { labels } = await prepare(scan, steps);
  labels.forEach((label, i) => {
    const [x, y, z] = scan.positions.subarray(3 * i, 3 * i + 3);
    const drops = [y < low + 0.1, Math.hypot(x - 9, y - low - 1.2, z - 9) <= 2, x < 0, y > 2];
    assert.equal(label, drops.indexOf(true) + 1, `${i}: ${x} ${y} ${z}`);
  });
});

test('several clouds become one, in one frame', async () => {
  const half = (from, to, origin) => ({ positions: Float64Array.from(scan.positions.subarray(3 * from, 3 * to), (x, i) => x - (origin?.[i % 3] ?? 0)), ...(origin && { origin }) });
  const { cloud, labels } = await prepare([half(0, 3000, [1, 2, 3]), half(3000, count, [-50, 0, 0])], []);
  assert.equal(labels.length, count);
  assert.deepEqual(cloud.origin, [1, 2, 3]);
  for (const i of [0, 1, 9000, 9001, 3 * count - 3, 3 * count - 1]) {
    assert.ok(Math.abs(cloud.positions[i] + cloud.origin[i % 3] - scan.positions[i]) < 1e-9);
  }
  const short = { positions: new Float32Array(30), colors: new Uint8Array(29) };
  assert.equal((await rejection(prepare([half(0, 9), short], []))).code, 'bad-length');
  assert.equal((await rejection(prepare([], []))).code, 'bad-input');
});

/** More than half of a pig from one side and another, scanned twice, in frames of their own, the second in less light. */
const pigs = [await sample('pig', { count: 6000, seed: 1 }), await sample('pig', { count: 6000, seed: 2 })];
const views = pigs.map(({ positions, colors }, k) => {
  const toward = k === 0 ? [1, 0] : [0.6, 0.8];
  const at = (values, i) => [...values.subarray(3 * i, 3 * i + 3)];
  const seen = [...Array(6000).keys()].filter((i) => positions[3 * i] * toward[0] + positions[3 * i + 2] * toward[1] > -2);
  const place = ([x, y, z]) => (k === 0 ? [x, y, z] : [30 - y, x - 5, z + 7]);
  return {
    positions: Float32Array.from(seen.flatMap((i) => place(at(positions, i)))),
    colors: Uint8Array.from(seen.flatMap((i) => at(colors, i).map((x) => x * [1, 0.9][k]))),
    attributes: { number: Float32Array.from(seen) },
    up: k === 0 ? [0, 1, 0] : [-1, 0, 0],
  };
});

test('scans in frames of their own are put together, and what fits none is left out', async () => {
  const other = { positions: (await sample('part', { count: 3000 })).positions };
  const { cloud, kept, labels, steps } = await prepare([...views, other], [{ step: 'register' }, { step: 'outliers' }]);
  const [{ scans, pairs, dropped, reason }] = steps;
  assert.deepEqual(scans.map(({ placed }) => placed), [true, true, false]);
  assert.match(reason, /1 scan/);
  assert.match(scans[2].reason, /another scan/);
  assert.ok(scans[2].pose === undefined && dropped === 3000);
  assert.deepEqual(pairs.map(({ scans, trusted }) => [scans, trusted]), [[[0, 1], true]]);
  assert.ok(pairs[0].overlap > 0.25 && pairs[0].rms < 0.05, JSON.stringify(pairs));
  assert.ok(labels.subarray(-3000).every((label) => label === 1) && kept.at(-1) < labels.length - 3000);
  assert.deepEqual(cloud.up, [0, 1, 0]);
  const first = views[0].positions.length / 3;
  let most = 0;
  const [before, after] = [[0, 0], [0, 0]];
  kept.forEach((point, k) => {
    const which = point < first ? 0 : 1;
    const i = cloud.attributes.number[k];
    for (let a = 0; a < 3; a++) {
      most = Math.max(most, Math.abs(cloud.positions[3 * k + a] - pigs[which].positions[3 * i + a]));
      before[which] += pigs[which].colors[3 * i + a];
      after[which] += cloud.colors[3 * k + a];
    }
  });
  assert.ok(most < 0.1, `${most} of a pig of 24`);
  for (const k of [0, 1]) assert.ok(Math.abs(after[k] / before[k] - 0.95) < 0.01, 'both are in the light between');
  const alone = await prepare(views[0], [{ step: 'register' }]);
  assert.match(alone.steps[0].reason, /one scan/);
  const error = await rejection(prepare(views, [{ step: 'outliers' }, { step: 'register' }]));
  assert.match(error.message, /prepare\[1\]\.step/);
});

test('what is no recipe is an error that names the step', async () => {
  for (const [steps, option] of [
    ['floor', /prepare/], [[1], /prepare/], [[{}], /prepare\[0\]\.step/], [[{ step: 'melt' }], /prepare\[0\]\.step.*'plane'/s],
    [[{ step: 'outliers' }, { step: 'pieces', gap: 0 }], /prepare\[1\]\.gap/], [[{ step: 'plane', drop: 'roof' }], /prepare\[0\]\.drop/],
    [[{ step: 'box', min: [0, 0, 0] }], /prepare\[0\]\.max/], [[{ step: 'box', min: [1, 0, 0], max: [0, 1, 1] }], /prepare\[0\]\.min/],
    [[{ step: 'sphere', center: [0, 0, 0], radius: 1, size: 2 }], /prepare\[0\]\.size/],
    [[{ step: 'sphere', center: [500, 0, 0], radius: 1 }], /prepare\[0\].*all/s],
  ]) {
    for (const call of [prepare(scan, steps), reduce(scan, { prepare: steps })]) {
      const error = await rejection(call);
      assert.ok(error instanceof PointweaveError, String(error));
      assert.equal(error.code, 'bad-option', error.message);
      assert.match(error.message, option);
    }
  }
});

test('pointweave/core and an engine with a worker give the same; a transferred cloud is gone', async () => {
  const core = await load();
  const engine = await createEngine({ worker: true, threads: 1 });
  try {
    const ours = await core.prepare(scan, STEPS);
    const copy = structuredClone(scan);
    const theirs = await engine.prepare(copy, STEPS, { transfer: true });
    assert.equal(copy.positions.length, 0);
    assert.deepEqual(ours.labels, theirs.labels);
    assert.deepEqual(ours.cloud, theirs.cloud);
    assert.throws(() => core.reduce(scan, { prepare: STEPS }), { code: 'bad-option' });
    const stop = new AbortController();
    await assert.rejects(engine.prepare(scan, STEPS, { signal: stop.signal, onProgress: () => stop.abort(new Error('enough')) }), /enough/);
  } finally {
    await engine.dispose();
  }
});

test('the command line prepares, merges, and takes a recipe before a reduction', async (t) => {
  const folder = await mkdtemp(join(tmpdir(), 'pointweave-'));
  t.after(() => rm(folder, { recursive: true }));
  const at = (name) => join(folder, name);
  await writeFile(at('scan.ply'), await write(scan));
  await writeFile(at('recipe.json'), JSON.stringify(STEPS));
  const pointweave = (...args) => run('node', [CLI, ...args], { cwd: folder });
  const { stderr } = await pointweave('prepare', 'scan.ply', '-o', 'object.ply', '--drop-floor', '--keep-largest');
  assert.match(stderr, /10,\d{3} → [34],\d{3} points, plane −\d,\d{3}, pieces −\d+/);
  const object = await read(await readFile(at('object.ply')));
  // The underside, which lies in the plane of the floor, goes with it.
  assert.ok(Math.abs(object.positions.length / 3 - 4000) < 80 && object.colors && object.attributes.number);
  const json = JSON.parse((await pointweave('reduce', 'scan.ply', '--json', '--prepare', 'recipe.json', '--ratio', '0.1')).stdout);
  assert.equal(json.inputPoints, object.positions.length / 3);
  assert.deepEqual(json.steps.map(({ step }) => step), ['plane', 'pieces']);
  await pointweave('merge', 'object.ply', 'scan.ply', '-o', 'all.ply');
  assert.equal((await read(await readFile(at('all.ply')))).positions.length, object.positions.length + 3 * count);
  for (const [k, view] of views.entries()) await writeFile(at(`view${k}.ply`), await write(view));
  const merged = await pointweave('merge', 'view0.ply', 'view1.ply', 'object.ply', '-o', 'pig.ply', '--register');
  assert.match(merged.stderr, /2 of 3 scans placed/);
  assert.match(merged.stderr, /object\.ply is left out: /);
  const points = views[0].positions.length + views[1].positions.length;
  assert.equal((await read(await readFile(at('pig.ply')))).positions.length, points);
  for (const [args, words] of [
    [['prepare', 'scan.ply', '-o', 'x.ply'], /what should be cut/], [['prepare', 'scan.ply', '-o', 'x.stl', '--drop-floor'], /triangles/],
    [['prepare', 'scan.ply', '-o', 'x.ply', '--crop', '1,2'], /six numbers/], [['prepare', 'scan.ply', '-o', 'x.ply', '--prepare', 'scan.ply'], /no recipe/],
    [['merge', 'scan.ply'], /where should the result go/], [['merge', 'scan.ply', '-o', 'scan.ply'], /scan itself/],
  ]) {
    const failed = await rejection(pointweave(...args));
    assert.equal(failed.code, 2, args.join(' '));
    assert.match(failed.stderr, words);
  }
});
