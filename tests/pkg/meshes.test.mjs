/** Meshes as scans, units and sides, and the writers that are a module of their own, through the package. */
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { promisify } from 'node:util';
import { deflateSync } from 'node:zlib';
import { createEngine, read, reconstruct, reduce, write } from '../../pkg/index.node.js';

const run = promisify(execFile);
const CLI = new URL('../../pkg/cli.js', import.meta.url).pathname;
const data = (path) => readFile(new URL(`../../../shared/${path}`, import.meta.url));
const text = (string) => new TextEncoder().encode(string);

const CUBE = `OFF\n8 6 0\n${[0, 1, 2, 3, 4, 5, 6, 7].map((i) => `${i & 1} ${(i >> 1) & 1} ${i >> 2}`).join('\n')}\n4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n`;

test('a mesh becomes points of its faces, and says so everywhere', async () => {
  const cloud = await read(text(CUBE));
  assert.equal(cloud.positions.length, 300_000);
  assert.equal(cloud.faces, 6);
  assert.equal(cloud.file.sampled, 100_000);
  const reduced = await reduce(cloud, { target: { count: 2000 } });
  assert.equal(reduced.faces, 6);
  assert.deepEqual(reduced.report.doubts.map(({ code }) => code), ['sampled-from-faces']);
  const vertices = await read(text(CUBE), { faces: 'vertices' });
  assert.deepEqual([vertices.positions.length, vertices.faces, vertices.file.faces, vertices.file.sampled], [24, undefined, 6, undefined]);
  await assert.rejects(read(text(CUBE), { faces: 'corners' }), { code: 'bad-option' });
});

test('the cube of twelve triangles comes back as one', async () => {
  const mesh = await reconstruct(await read(await data('field/cases/stl_cad_cube.stl')));
  const { components, boundaryEdges, genus } = mesh.report;
  assert.deepEqual([components, boundaryEdges, genus], [1, 0, [0]]);
});

test('the textured duck is yellow', async () => {
  const duck = await read(await data('data/meshes/Duck.glb'));
  assert.deepEqual([duck.up, duck.unit], [[0, 1, 0], 'm']);
  const mean = [0, 1, 2].map((k) => duck.colors.filter((_, i) => i % 3 === k).reduce((sum, c) => sum + c, 0) / (duck.colors.length / 3));
  assert.ok(mean[0] > 200 && mean[1] > 150 && mean[2] < 60, mean.join(' '));
});

/** A PNG file of one colour. */
function png([r, g, b]) {
  const crcs = Array.from({ length: 256 }, (_, n) => [...Array(8)].reduce((c) => (c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1), n));
  const crc = (bytes) => ~bytes.reduce((c, byte) => crcs[(c ^ byte) & 255] ^ (c >>> 8), ~0) >>> 0;
  const chunk = (kind, content) => {
    const named = Buffer.concat([Buffer.from(kind), content]);
    const out = Buffer.alloc(8 + named.length);
    out.writeUInt32BE(content.length);
    named.copy(out, 4);
    out.writeUInt32BE(crc(named), 4 + named.length);
    return out;
  };
  const header = Buffer.from([0, 0, 0, 1, 0, 0, 0, 1, 8, 2, 0, 0, 0]);
  return Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk('IHDR', header), chunk('IDAT', deflateSync(Buffer.from([0, r, g, b]))), chunk('IEND', Buffer.alloc(0))]);
}

const OBJ = 'mtllib scan.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl skin\nf 1/1 2/2 3/3\n';
const MTL = 'newmtl skin\nmap_Kd photo.png\n';

test('an OBJ file has the colours of pictures beside it', async () => {
  const files = { 'scan.mtl': text(MTL), 'photo.png': png([10, 200, 30]) };
  const beside = Object.entries(files).map(([name, bytes]) => new File([bytes], name.toUpperCase()));
  for (const given of [beside, (name) => files[name], async (name) => new Blob([files[name]])]) {
    const cloud = await read(text(OBJ), { beside: given });
    assert.deepEqual([...cloud.colors.subarray(0, 3)], [10, 200, 30]);
    assert.equal(cloud.file.missing, undefined);
  }
  // A library that was renamed with its mesh is the only one there.
  const renamed = [new File([MTL], 'my chair.mtl'), new File([files['photo.png']], 'photo.png')];
  assert.deepEqual([...(await read(text(OBJ), { beside: renamed })).colors.subarray(0, 3)], [10, 200, 30]);
  const two = [...renamed, new File([MTL], 'other.mtl')];
  assert.deepEqual((await read(text(OBJ), { beside: two })).file.missing, ['scan.mtl']);
  const without = await read(text(OBJ));
  assert.deepEqual([without.colors, without.file.missing], [undefined, ['scan.mtl']]);
  const broken = await read(text(OBJ), { beside: (name) => (name === 'scan.mtl' ? text(MTL) : text('no picture')) });
  assert.equal(broken.file.missing.length, 1);
});

test('the command line finds them in the folder', async (t) => {
  const folder = await mkdtemp(join(tmpdir(), 'pointweave-'));
  t.after(() => rm(folder, { recursive: true }));
  await writeFile(join(folder, 'scan.obj'), OBJ);
  await writeFile(join(folder, 'scan.mtl'), MTL);
  await writeFile(join(folder, 'photo.png'), png([10, 200, 30]));
  const { stdout } = await run('node', [CLI, 'inspect', join(folder, 'scan.obj')]);
  assert.match(stdout, /also has +colours, normals/);
  assert.match(stdout, /faces +1, 100,000 points taken from them/);
  await writeFile(join(folder, 'my chair.obj'), OBJ.replace('scan.mtl', 'gone.mtl'));
  await writeFile(join(folder, 'my chair.mtl'), MTL);
  assert.match((await run('node', [CLI, 'inspect', join(folder, 'my chair.obj')])).stdout, /also has +colours, normals/);
  const out = join(folder, 'few.stl.ply');
  const { stderr } = await run('node', [CLI, 'reduce', join(folder, 'scan.obj'), '-o', out, '--unit', 'in', '--up', 'y', '--to-unit', 'mm', '--to-up', 'z', '--count', '500']);
  assert.match(stderr, /taken from 1 faces/);
  const few = await read(await readFile(out));
  let [widest, highest] = [0, 0];
  few.positions.forEach((x, i) => (i % 3 === 0 ? (widest = Math.max(widest, x)) : i % 3 === 2 && (highest = Math.max(highest, x))));
  assert.ok(widest > 24 && widest < 26 && highest > 24 && highest < 26, `${widest} ${highest}`);
});

const SCAN = {
  positions: new Float32Array([0, 0, 0, 300, 0, 0, 0, 200, 100]),
  normals: new Float32Array([0, 0, 1, 0, 0, 1, 0, 0, 1]),
  colors: new Uint8Array([1, 2, 3, 4, 5, 6, 7, 8, 9]),
  attributes: { intensity: new Float32Array([1, 2, 300]), quality: new Float32Array([0.5, 0.25, 0]) },
  indices: new Uint32Array([0, 1, 2]),
  up: [0, 0, 1],
  unit: 'mm',
};

test('a scan of 300 mm is 0.3 m in glTF, with y up', async () => {
  const back = await read(await write(SCAN, { format: 'glb' }), { faces: 'vertices' });
  assert.deepEqual([...back.positions], [0, 0, 0, 0.3, 0, 0, 0, 0.1, -0.2].map(Math.fround));
  const told = await read(await write(SCAN, { format: 'ply', up: '-y', unit: 'cm' }), { faces: 'vertices' });
  assert.deepEqual([...told.positions.subarray(3)], [30, 0, 0, 0, -10, 20]);
  const { up, unit, ...silent } = SCAN;
  await assert.rejects(write(silent, { up: 'y' }), { code: 'bad-option' });
  await assert.rejects(write(SCAN, { unit: 'furlong' }), { code: 'bad-option' });
  await assert.rejects(write({ ...SCAN, unit: 'furlong' }, {}), { code: 'bad-input' });
});

test('PCD, LAS, LAZ and 3MF come back', async () => {
  for (const format of /** @type {const} */ (['pcd', 'las', 'laz'])) {
    const back = await read(await write(SCAN, { format }));
    assert.equal(back.file.format, format === 'laz' ? 'las' : format);
    back.positions.forEach((x, i) => assert.ok(Math.abs(x - SCAN.positions[i]) < 1e-4, format));
    assert.deepEqual(back.colors, SCAN.colors, format);
    assert.deepEqual([back.attributes.intensity, back.attributes.quality], Object.values(SCAN.attributes), format);
    assert.deepEqual(back.up, [0, 0, 1]);
  }
  const back = await read(await write(SCAN, { format: '3mf' }), { faces: 'vertices' });
  assert.deepEqual([back.positions, back.colors, back.up, back.unit], [SCAN.positions, SCAN.colors, [0, 0, 1], 'mm']);
  await assert.rejects(write({ positions: SCAN.positions }, { format: '3mf' }), { code: 'needs-triangles' });
});

test('a reduced LAS goes back to where it came from', async () => {
  const cloud = await read(await data('data/lidar/autzen_trim.laz'));
  assert.ok(cloud.crs);
  const reduced = await reduce(cloud, { target: { count: 1000 } });
  assert.deepEqual([reduced.crs, reduced.unit, reduced.up], [cloud.crs, cloud.unit, [0, 0, 1]]);
  const back = await read(await write(reduced, { format: 'laz' }));
  assert.deepEqual([back.crs, back.unit, back.positions.length], [cloud.crs, cloud.unit, 3000]);
});

test('every build and host gives the same bytes', async () => {
  const [one, other] = await Promise.all([createEngine({ threads: 1 }), createEngine({ threads: 1, worker: true })]);
  const clouds = await Promise.all([one, other].map((engine) => engine.read(text(CUBE))));
  assert.deepEqual(clouds[0], clouds[1]);
  await Promise.all([one.dispose(), other.dispose()]);
});
