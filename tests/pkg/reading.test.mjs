// Files of every format, by the wasm modules that are loaded when such a file comes.

import assert from 'node:assert/strict';
import { existsSync, readFileSync, readdirSync, openAsBlob } from 'node:fs';
import test from 'node:test';
import { arraysOf, engineFor, rejection } from './support.mjs';

const DATA = new URL('../../../shared/data/', import.meta.url);
const skip = existsSync(DATA) ? false : 'no shared data';

/** File, points, its format, the arrays that it has, the sum of the red bytes. As `tests/files.rs` has them natively. */
const FILES = [
  ['lidar/autzen_trim.las', 110_000, 'las', ['positions', 'colors', 'attributes']],
  ['lidar/autzen_trim.laz', 110_000, 'las', ['positions', 'colors', 'attributes']],
  ['scans/forest_plot/TLS_Clip.laz', 400_754, 'las', ['positions', 'attributes']],
  ['hostile/pdal_simple-laszip-compressor-version-1.2r0.laz', 1065, 'las', ['positions', 'colors', 'attributes']],
  ['scans/pcl/milk_color.pcd', 13_704, 'pcd', ['positions', 'colors']],
  ['scans/pcl/bun0.pcd', 397, 'pcd', ['positions', 'normals', 'attributes']],
  ['meshes/Duck.glb', 2399, 'glb', ['positions', 'normals']],
  ['meshes/block.off', 2132, 'off', ['positions']],
  ['meshes/featuretype.stl', 2010, 'stl', ['positions']],
  ['hostile/assimp_point_cloud.obj', 3, 'obj', ['positions', 'normals']],
  ['scans/redwood_fragment_002.ply', 112_698, 'ply', ['positions', 'colors']],
  ['scans/bunnyData.pts', 30_571, 'xyz', ['positions']],
];

const ARRAYS = ['positions', 'normals', 'colors', 'attributes'];

/** An engine for each way of computing: here, in a worker, with threads. */
const ENGINES = [{ threads: 1 }, { threads: 1, worker: true }, { threads: 2 }];

test('each format is read by its module, the same in every engine', { skip }, async (t) => {
  const engines = await Promise.all(ENGINES.map((options) => engineFor(t, options)));
  for (const [name, points, format, arrays] of FILES) {
    const blob = await openAsBlob(new URL(name, DATA));
    const options = { name, faces: 'vertices' };
    const cloud = await engines[0].read(blob, options);
    assert.equal(cloud.positions.length, 3 * points, name);
    assert.equal(cloud.file.format, format, name);
    assert.deepEqual(Object.keys(cloud).filter((key) => ARRAYS.includes(key)).sort(), [...arrays].sort(), name);
    if (points > 50_000) continue; // to start a worker for each is what takes the time
    for (const engine of engines.slice(1)) assertSame(await engine.read(blob, options), cloud, name);
    assertSame(await engines[0].read(readFileSync(new URL(name, DATA)), { faces: 'vertices' }), cloud, `${name} by its content`);
  }
});

/** Byte for byte, which for large arrays is much faster than `deepEqual`. */
function assertSame(cloud, expected, what) {
  assert.deepEqual(cloud.file, expected.file, what);
  const [found, wanted] = [arraysOf(cloud), arraysOf(expected)];
  assert.deepEqual(Object.keys(found), Object.keys(wanted), what);
  const bytes = (array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength);
  for (const [path, array] of Object.entries(found)) assert.ok(bytes(array).equals(bytes(wanted[path])), `${what}: ${path}`);
}

test('LAS and LAZ hold the same points, georeferenced and exact', { skip }, async (t) => {
  const engine = await engineFor(t, { threads: 1 });
  const [las, laz] = await Promise.all(['las', 'laz'].map((end) => engine.read(readFileSync(new URL(`lidar/autzen_trim.${end}`, DATA)))));
  assertSame(laz, las, 'LAZ');
  assert.ok(las.positions instanceof Float64Array);
  const column = (axis) => las.positions.filter((_, i) => i % 3 === axis);
  assert.deepEqual([0, 1, 2].map((axis) => column(axis).reduce((a, b) => Math.min(a, b))), [636001.76, 848935.2000000001, 406.26]);
  assert.equal(las.attributes.intensity.reduce((sum, x) => sum + x, 0), 11_220_547);
  assert.equal(las.attributes.classification.reduce((sum, x) => sum + x, 0), 136_107);
  assert.equal(las.colors.reduce((sum, x, i) => sum + (i % 3 ? 0 : x), 0), 12_255_922);
});

test('every hostile file ends in points or in one sentence', { skip }, async (t) => {
  const engine = await engineFor(t, { threads: 1 });
  const ends = { points: 0, errors: 0 };
  for (const name of readdirSync(new URL('hostile/', DATA))) {
    const result = await engine.read(readFileSync(new URL(`hostile/${name}`, DATA)), { name }).catch((error) => error);
    if (result instanceof Error) {
      ends.errors++;
      assert.match(result.code, /^(bad-file|unsupported-file|unknown-format)$/, `${name}: ${result.message}`);
      assert.doesNotMatch(result.message, /\n/, name);
      assert.equal(result.index !== undefined, result.code === 'bad-file', name);
    } else {
      ends.points++;
      assert.ok(result.positions.every(Number.isFinite), name);
    }
  }
  // As many as the table of tests/files.rs.
  assert.deepEqual(ends, { points: 52, errors: 18 });
});

test('what a file lacked is said', async (t) => {
  const engine = await engineFor(t, { threads: 1 });
  const ply = 'ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float t\n'
    + 'element face 1\nproperty list uchar int vertex_indices\nend_header\nnan 0 0 1\n1 2 3 inf\n3 0 1 0\n';
  const cloud = await engine.read(new TextEncoder().encode(ply), { faces: 'vertices' });
  assert.deepEqual(cloud.file, { format: 'ply', dropped: 1, replaced: 1, faces: 1, notes: [] });
  assert.deepEqual([...cloud.positions, ...cloud.attributes.t], [1, 2, 3, 0]);
});

/** A binary PLY of `points` points of 15 bytes, as a Blob; point i is at (i, 2i, 3i) and of the colour (i, 0, 255). */
function largePly(points) {
  const header = `ply\nformat binary_little_endian 1.0\nelement vertex ${points}\nproperty float x\nproperty float y\nproperty float z\n`
    + 'property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n';
  const parts = [new TextEncoder().encode(header)];
  for (let start = 0; start < points; start += 100_000) {
    const count = Math.min(100_000, points - start);
    const rows = new DataView(new ArrayBuffer(15 * count));
    for (let i = 0; i < count; i++) {
      [1, 2, 3].forEach((factor, axis) => rows.setFloat32(15 * i + 4 * axis, factor * (start + i), true));
      rows.setUint8(15 * i + 12, start + i);
      rows.setUint8(15 * i + 14, 255);
    }
    parts.push(new Uint8Array(rows.buffer));
  }
  return new Blob(parts);
}

test('a large file comes in slices, with progress, and can be cancelled', async (t) => {
  const points = 1_500_000;
  const blob = largePly(points);
  for (const options of ENGINES.slice(0, 2)) {
    const engine = await engineFor(t, options);
    const shares = [];
    const cloud = await engine.read(blob, { onProgress: ({ stage, overall }) => shares.push([stage, overall]) });
    assert.equal(cloud.positions.length, 3 * points);
    assert.equal(cloud.positions.buffer.byteLength, 12 * points, 'no room is left over');
    for (const i of [0, 1, 279_620, points - 1]) {
      assert.deepEqual([...cloud.positions.slice(3 * i, 3 * i + 3)], [i, 2 * i, 3 * i]);
      assert.deepEqual([...cloud.colors.slice(3 * i, 3 * i + 3)], [i % 256, 0, 255]);
    }
    assert.ok(shares.length > 5 && shares.every(([stage, share], i) => stage === 'read' && share >= (shares[i - 1]?.[1] ?? 0)));
    assert.equal(shares.at(-1)[1], 1);

    const controller = new AbortController();
    const reading = engine.read(blob, {
      signal: controller.signal,
      onProgress: ({ overall }) => overall > 0.3 && controller.abort('enough'),
    });
    assert.equal(await rejection(reading), 'enough');
    assert.equal((await engine.read(blob)).positions.length, 3 * points, 'the next call works');
  }
});

test('what onProgress throws ends the reading', async (t) => {
  const engine = await engineFor(t, { threads: 1, worker: true });
  const thrown = new Error('no more');
  const reading = engine.read(largePly(10), { onProgress: () => { throw thrown; } });
  assert.equal(await rejection(reading), thrown);
  assert.equal((await engine.read(largePly(10))).positions.length, 30);
});

test('a count that the file cannot hold reserves nothing', async (t) => {
  const engine = await engineFor(t, { threads: 1 });
  const header = new Uint8Array(375 + 8);
  header.set(new TextEncoder().encode('LASF'));
  const view = new DataView(header.buffer);
  header.set([1, 4], 24);
  view.setUint16(94, 375, true);
  view.setUint32(96, 375, true);
  view.setUint16(105, 30, true);
  view.setBigUint64(247, 2n ** 60n, true);
  [131, 139, 147].forEach((at) => view.setFloat64(at, 0.01, true));
  for (const format of [6, 6 + 128]) {
    header[104] = format;
    const error = await rejection(engine.read(header));
    assert.equal(error.code, 'bad-file', error.message);
  }
});

test('a format that is named is believed', async (t) => {
  const engine = await engineFor(t, { threads: 1 });
  const bytes = new TextEncoder().encode('0 0 0\n1 2 3\n');
  assert.equal((await engine.read(bytes, { format: 'xyz' })).positions.length, 6);
  for (const [format, place] of [['las', 0], ['e57', 0], ['glb', 0], ['ply', 1], ['pcd', 1], ['off', 1], ['obj', 3]]) {
    const error = await rejection(engine.read(bytes, { format }));
    assert.deepEqual([error.code, error.index], ['bad-file', place], `${format}: ${error.message}`);
  }
  assert.equal((await rejection(engine.read(bytes, { format: 'dae' }))).code, 'bad-option');
});

test('the modules come from where wasmUrl says', { skip }, async (t) => {
  const file = readFileSync(new URL('lidar/100-points.las', DATA));
  const las = new URL('../../pkg/wasm/las/pointweave_bg.wasm', import.meta.url);
  for (const wasmUrl of [{ las }, new URL('../../pkg/wasm/', import.meta.url)]) {
    const engine = await engineFor(t, { threads: 1, wasmUrl });
    assert.equal((await engine.read(file)).positions.length, 300);
  }
  const lost = await engineFor(t, { threads: 1, wasmUrl: { las: 'nowhere.wasm' } });
  assert.equal((await rejection(lost.read(file))).code, 'load-failed');
  assert.equal((await lost.read(new TextEncoder().encode('0 0 0\n'))).positions.length, 3, 'other formats need it not');
});
