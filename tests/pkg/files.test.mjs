// read, write and inspect.

import assert from 'node:assert/strict';
import test from 'node:test';
import { inspect, read, reconstruct, reduce, write } from 'pointweave';
import { sphere } from './support.mjs';

const text = (bytes) => new TextDecoder().decode(bytes);

test('a PLY that was written is read back the same', async () => {
  const reduced = await reduce(sphere(1000));
  for (const encoding of ['binary', 'ascii']) {
    const bytes = await write(reduced, { format: 'ply', encoding });
    assert.ok(text(bytes.slice(0, 40)).includes(encoding === 'ascii' ? 'format ascii' : 'format binary_little_endian'));
    const back = await read(bytes);
    assert.deepEqual(back.positions, reduced.positions);
    assert.deepEqual(back.normals, reduced.normals);
    assert.deepEqual(back.colors, reduced.colors);
    assert.deepEqual(back.attributes.height, reduced.attributes.height);
  }
});

test('a mesh is written with its triangles', async () => {
  const mesh = await reconstruct(sphere(1000));
  const file = text(await write(mesh, { encoding: 'ascii' }));
  assert.match(file, new RegExp(`element vertex ${mesh.positions.length / 3}\\n`));
  assert.match(file, new RegExp(`element face ${mesh.indices.length / 3}\\n`));
  assert.ok(file.trimEnd().endsWith(`3 ${[...mesh.indices.slice(-3)].join(' ')}`));
});

test('XYZ keeps the points', async () => {
  const cloud = sphere(100);
  const back = await read(await write(cloud, { format: 'xyz' }), { name: 'points.xyz' });
  assert.deepEqual(back.positions, cloud.positions);
});

test('an origin is added in double precision when a file is written', async () => {
  const cloud = { positions: Float32Array.of(0.5, 0.25, 1, 2, 3, 4), origin: [4_512_345.5, -543_210.25, 100] };
  const back = await read(await write(cloud));
  const world = Array.from(back.positions, (x, i) => x + (back.origin?.[i % 3] ?? 0));
  assert.deepEqual(world, [4_512_346, -543_210, 101, 4_512_347.5, -543_207.25, 104]);
});

test('every kind of data that holds a file', async () => {
  const bytes = new TextEncoder().encode('0 0 0\n1 0 0.5\n0 1 0.25\n');
  const expected = Float32Array.of(0, 0, 0, 1, 0, 0.5, 0, 1, 0.25);
  const kinds = [bytes, bytes.buffer, Buffer.from(bytes), new Blob([bytes]), new File([bytes], 'points.txt')];
  for (const data of kinds) assert.deepEqual((await read(data)).positions, expected, data.constructor.name);
  assert.equal(bytes.length, 23, 'nothing was detached');
  const part = new Uint8Array(40);
  part.set(bytes, 9);
  assert.deepEqual((await read(part.subarray(9, 9 + bytes.length))).positions, expected);
  assert.deepEqual((await read(bytes, { format: 'xyz' })).positions, expected);
});

test('inspect tells what a cloud is like', async () => {
  const cloud = sphere(4000, { radius: 10, center: [100, 0, 0], type: Float64Array });
  const info = await inspect(cloud);
  assert.equal(info.count, 4000);
  info.bounds.min.forEach((x, axis) => assert.ok(Math.abs(x - [90, -10, -10][axis]) < 0.05, `min ${x}`));
  info.bounds.max.forEach((x, axis) => assert.ok(Math.abs(x - [110, 10, 10][axis]) < 0.05, `max ${x}`));
  const diagonal = Math.hypot(...info.bounds.max.map((x, axis) => x - info.bounds.min[axis]));
  assert.ok(Math.abs(info.diagonal - diagonal) < 1e-9 * diagonal);
  const spacing = Math.sqrt((4 * Math.PI * 100) / 4000);
  assert.ok(info.spacing > 0.6 * spacing && info.spacing < 1.4 * spacing, `${info.spacing} by ${spacing}`);
  assert.deepEqual([info.duplicates, info.nonFinite], [0, 0]);
  assert.ok(info.noise < 0.005, `noise ${info.noise}`);

  const dirty = new Float32Array(3 * 4003);
  dirty.set(cloud.positions);
  dirty.set([NaN, 0, 0, ...cloud.positions.subarray(0, 6)], 3 * 4000);
  const found = await inspect({ positions: dirty });
  assert.deepEqual([found.count, found.duplicates, found.nonFinite], [4003, 2, 1]);

  let seed = 1;
  const random = () => (seed = (seed * 16_807) % 2_147_483_647) / 2_147_483_647 - 0.5;
  const factors = Array.from({ length: 4000 }, () => 1 + 0.02 * random());
  const center = [100, 0, 0];
  const noisy = cloud.positions.map((x, i) => center[i % 3] + (x - center[i % 3]) * factors[Math.floor(i / 3)]);
  const { noise } = await inspect({ positions: noisy });
  const deviation = (10 * 0.02) / Math.sqrt(12);
  assert.ok(noise > deviation / 2 && noise < 2 * deviation, `noise ${noise} where ${deviation} was added`);
});
