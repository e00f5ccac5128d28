// Meshes with fewer triangles, and with pictures of what they lost.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { WebIO } from '@gltf-transform/core';
import { validateBytes } from 'gltf-validator';
import { createEngine, flip, poster, read, reconstruct, simplify, texture, write } from 'pointweave';
import { load } from 'pointweave/core';
import { engineBeside } from './installed.mjs';
import { sphere } from './support.mjs';

const run = promisify(execFile);
const CLI = fileURLToPath(new URL('../../pkg/cli.js', import.meta.url));

const scan = { ...sphere(3000), up: [0, 0, 1] };
const full = await reconstruct(scan, { reduce: false });
const light = await reconstruct(scan, { reduce: false, triangles: 500, distances: true });

/** Vertices of a sphere of radius 1 around the middle that are more than `most` away from it. */
const off = ({ positions }, most) => {
  const radii = Array.from({ length: positions.length / 3 }, (_, i) => Math.hypot(...positions.subarray(3 * i, 3 * i + 3)));
  const mean = radii.reduce((sum, r) => sum + r, 0) / radii.length;
  return radii.filter((r) => Math.abs(r / mean - 1) > most).length;
};

test('a reconstruction with a budget has at most so many triangles, and a report of what that cost', () => {
  const { indices, positions, normals, colors, attributes, distances, report, cloud } = light;
  const triangles = indices.length / 3;
  assert.ok(triangles <= 500 && triangles >= 490, `${triangles}`);
  const vertices = positions.length / 3;
  assert.deepEqual([normals.length, colors.length, distances.vertices.length, distances.points.length], [3 * vertices, 3 * vertices, vertices, 3000]);
  for (const values of Object.values(attributes ?? {})) assert.equal(values.length, vertices);
  assert.ok(!('' in (attributes ?? {})));
  const { simplified, ...told } = report;
  assert.deepEqual([told.triangles, told.components, told.boundaryEdges, told.genus, simplified.reason], [triangles, 1, 0, [0], '']);
  assert.ok(simplified.from === full.indices.length / 3 && simplified.error.max < 0.02 && simplified.error.rms <= simplified.error.max);
  assert.equal(cloud.positions.length, 9000);
  assert.equal(off(light, 0.03), 0);
});

test('simplify takes a mesh of a reconstruction, of a file, and bare triangles; the functions without an engine do the same', async () => {
  const again = await simplify(full, { triangles: 500 });
  assert.deepEqual(again.positions, light.positions);
  assert.deepEqual(again.indices, light.indices);
  assert.equal(again.report.inputPoints, 3000);
  assert.deepEqual(again.up, full.up);
  const core = await load();
  assert.deepEqual((await core.simplify(full, { triangles: 500 })).indices, light.indices);
  assert.throws(() => core.reconstruct(scan, { triangles: 500 }), { code: 'bad-option' });
  const near = await simplify({ positions: full.positions, indices: full.indices }, { error: 0.005 });
  assert.ok(near.report.simplified.error.max <= 0.005 && near.indices.length < full.indices.length / 2 && !near.normals);
  for (const format of ['ply', 'obj', 'stl', 'glb', '3mf']) {
    const file = await read(await write(full, { format }), { name: `mesh.${format}`, faces: 'mesh' });
    assert.equal(file.indices.length, full.indices.length, format);
    const fewer = await simplify(file, { triangles: 500 });
    assert.ok(fewer.indices.length <= 1500 && fewer.report.boundaryEdges === 0 && off(fewer, 0.03) === 0, format);
    assert.equal(Boolean(fewer.colors), Boolean(file.colors), format);
  }
});

test('what is wrong is said', async () => {
  for (const [mesh, options, code] of [
    [full, {}, 'bad-option'], [full, { triangles: 0 }, 'bad-option'], [full, { error: 0 }, 'bad-option'], [scan, { triangles: 100 }, 'bad-input'],
    [{ ...full, indices: Uint32Array.of(0, 1) }, { triangles: 100 }, 'bad-length'], [{ ...full, indices: Uint32Array.of(0, 1, 9e6) }, { triangles: 100 }, 'bad-index'],
  ]) await assert.rejects(simplify(mesh, options), { code });
  for (const texture of [{ size: 63 }, { maps: ['metal'] }, { scalar: 'weight' }, { scalar: '' }, { range: [0, 1] }, { scalar: 'height', range: [1, 1] }, 5]) await assert.rejects(reconstruct(scan, { texture }), { code: 'bad-option' });
});

test('a textured mesh is a GLB file that the validator has nothing to say about', async () => {
  const seen = new Set();
  const mesh = await reconstruct(scan, { reduce: false, triangles: 300, texture: { size: 256 }, onProgress: ({ stage }) => seen.add(stage) });
  const vertices = mesh.positions.length / 3;
  assert.ok(mesh.indices.length <= 900 && seen.has('texture') && seen.has('simplify'));
  assert.deepEqual([mesh.uvs.length, mesh.tangents.length], [2 * vertices, 4 * vertices]);
  assert.ok(mesh.uvs.every((x) => x >= 0 && x <= 1));
  for (const options of [{}, { quantize: true }]) {
    const glb = await write(mesh, { format: 'glb', ...options });
    const { issues } = await validateBytes(glb);
    assert.deepEqual(issues.messages.filter(({ severity }) => severity < 2), []);
    if (options.quantize) continue;
    const document = await new WebIO().readBinary(glb);
    const [material] = document.getRoot().listMaterials();
    const [primitive] = document.getRoot().listMeshes()[0].listPrimitives();
    assert.deepEqual(primitive.listSemantics().sort(), ['NORMAL', 'POSITION', 'TANGENT', 'TEXCOORD_0', '_HEIGHT']);
    for (const [texture, own] of [[material.getBaseColorTexture(), mesh.textures.color], [material.getNormalTexture(), mesh.textures.normal]]) {
      assert.deepEqual(texture.getSize(), [own.width, own.height]);
      assert.deepEqual(texture.getImage(), own.data);
    }
  }
  const usdz = Buffer.from(await write(mesh, { format: 'usdz' }));
  for (const { data } of Object.values(mesh.textures)) assert.equal(usdz.indexOf(data) % 64, 0, 'the pictures lie in USDZ as they are');
  const other = flip(mesh);
  assert.deepEqual(other.tangents.slice(0, 4), mesh.tangents.slice(0, 4).map((x) => -x));
  assert.ok(!('uvs' in (await simplify(mesh, { triangles: 100 }))));
});

test('a mesh that is there is textured as one of the same call, wherever its scan counts from', async () => {
  const whole = { reduce: false, triangles: 300, texture: { size: 128 } };
  const { uvs, textures } = await reconstruct(scan, whole);
  const mesh = await reconstruct(scan, { reduce: false });
  const apart = { ...scan, positions: Float64Array.from(scan.positions, (x, i) => x - [8, 0, -4][i % 3]), origin: [8, 0, -4] };
  for (const points of [scan, apart]) {
    const made = await texture(mesh, points, { triangles: 300, size: 128 });
    assert.deepEqual([made.uvs, made.textures], [uvs, textures]);
    assert.equal(made.report.simplified.from, mesh.report.triangles);
  }
  await assert.rejects(texture(mesh, scan, { size: 3 }), { code: 'bad-option' });
});

test('an engine with a worker makes the same bytes, and an abort ends it', async () => {
  const engine = await createEngine({ worker: true, threads: 1 });
  try {
    const options = { reduce: false, triangles: 300, texture: { size: 128, maps: ['color'] } };
    const [ours, theirs] = [await reconstruct(scan, options), await engine.reconstruct(scan, options)];
    assert.deepEqual(ours.textures, theirs.textures);
    assert.deepEqual(Object.keys(ours.textures), ['color']);
    const stop = new AbortController();
    await assert.rejects(engine.simplify(full, { triangles: 100, signal: stop.signal, onProgress: () => stop.abort(new Error('enough')) }), /enough/);
  } finally {
    await engine.dispose();
  }
});

test('the command line makes meshes light, and textures them', async (t) => {
  const folder = await mkdtemp(join(tmpdir(), 'pointweave-'));
  t.after(() => rm(folder, { recursive: true }));
  const pointweave = (...args) => run('node', [CLI, ...args], { cwd: folder });
  await writeFile(join(folder, 'mesh.ply'), await write(full));
  await writeFile(join(folder, 'scan.ply'), await write(scan));
  const { stderr } = await pointweave('simplify', 'mesh.ply', '-o', 'light.glb', '--triangles', '500');
  assert.match(stderr, /[\d,]+ → (500|49\d) triangles, [\d.]+ % of the diagonal off \(rms\), [\d.]+ % at most/);
  await pointweave('reconstruct', 'scan.ply', '-o', 'textured.glb', '--triangles', '300', '--texture', '128', '--maps', 'color');
  const document = await new WebIO().readBinary(await readFile(join(folder, 'textured.glb')));
  assert.equal(document.getRoot().listTextures().length, 1);
  for (const [args, words] of [
    [['simplify', 'mesh.ply', '-o', 'x.glb'], /how light/], [['simplify', 'scan.ply', '-o', 'x.glb', '--triangles', '500'], /no triangles/],
    [['reconstruct', 'scan.ply', '-o', 'x.ply', '--texture', '128'], /GLB and USDZ/], [['reconstruct', 'scan.ply', '-o', 'x.glb', '--maps', 'color'], /--texture/],
    [['simplify', 'mesh.ply', '-o', 'x.glb', '--triangles', '0'], /at least 1/],
    [['reconstruct', 'scan.ply', '-o', 'x.glb', '--scalar', 'height'], /--texture/], [['reconstruct', 'scan.ply', '-o', 'x.glb', '--texture', '128', '--range', '0,1'], /--scalar/],
    [['reconstruct', 'scan.ply', '-o', 'x.usdz', '--texture', '128', '--pictures', 'webp'], /GLB/], [['reconstruct', 'scan.ply', '-o', 'x.glb', '--texture', '64', '--scalar', 'weight'], /'height'/],
  ]) await assert.rejects(pointweave(...args), ({ stderr }) => words.test(stderr), args.join(' '));
});

test('a poster is a picture of a cloud or a mesh, the same by every way; a file has its pictures', async () => {
  const textured = await reconstruct(scan, { reduce: false, triangles: 300, texture: { size: 64 } });
  const options = { size: [160, 120], camera: '30deg 70deg 120%', background: '#203040' };
  const { width, height, type, data } = await poster(textured, options);
  assert.deepEqual([width, height, type, String.fromCharCode(...data.subarray(1, 4))], [160, 120, 'image/png', 'PNG']);
  const core = await load();
  assert.deepEqual((await core.poster(textured, options)).data, data);
  const engine = await createEngine({ threads: 2 });
  assert.deepEqual((await engine.poster(textured, options)).data, data);
  await engine.dispose();
  const other = await poster(textured, { ...options, camera: 'auto auto auto' });
  assert.notDeepEqual(other.data, data);
  assert.notDeepEqual((await poster({ ...textured, uvs: undefined, textures: undefined }, options)).data, data);
  assert.ok((await poster(scan, { size: [64, 48] })).data.length > 500);
  for (const wrong of [{ size: [8, 8] }, { size: '64x64' }, { camera: '30 70 120%' }, { camera: '30deg 70deg' }, { camera: '1deg 1deg 0%' }, { background: 'red' }]) {
    await assert.rejects(poster(scan, wrong), { code: 'bad-option' });
  }
  const folder = await mkdtemp(join(tmpdir(), 'poster-'));
  const [glb, png] = ['mesh.glb', 'poster.png'].map((name) => join(folder, name));
  await writeFile(glb, await write(textured, { format: 'glb', up: 'z' }));
  const { stdout } = await run(process.execPath, [CLI, 'poster', glb, '-o', png, '--up', 'z', '--size', '160x120', '--camera', '30deg,70deg,120%', '--background', '#203040', '--json']);
  assert.deepEqual(JSON.parse(stdout), { width: 160, height: 120, bytes: data.length });
  assert.deepEqual(await readFile(png), Buffer.from(data));
  await rm(folder, { recursive: true });
});

test('lods are several meshes of one reconstruction, and several files; a textured one is an archive, too', async () => {
  const near = await reconstruct(scan, { reduce: false, lods: [500, 200, 60], texture: { size: 64 } });
  const meshes = [near, ...near.lods];
  assert.ok(meshes.every(({ report, indices }) => report.triangles === indices.length / 3));
  assert.deepEqual(near.indices, (await reconstruct(scan, { reduce: false, triangles: 500, texture: { size: 64 } })).indices);
  const [most, middle, least] = meshes.map(({ indices }) => indices.length / 3);
  assert.ok(most <= 500 && middle <= 200 && middle >= 196 && least <= 60, `${most} ${middle} ${least}`);
  assert.ok(meshes.every(({ textures, uvs, positions }) => textures.color && uvs.length / 2 === positions.length / 3));
  for (const wrong of [{ lods: [] }, { lods: [100, 200] }, { lods: [100], triangles: 100 }]) await assert.rejects(reconstruct(scan, wrong), { code: 'bad-option' });

  const back = await read(await write(near, { format: 'zip' }), { name: 'model.zip', faces: 'mesh' });
  assert.deepEqual([back.indices.length, back.positions.length], [near.indices.length, near.positions.length]);
  const glb = await read(await write(near, { format: 'glb' }), { faces: 'mesh' });
  const off = Math.max(...back.colors.map((value, i) => Math.abs(value - glb.colors[i])));
  assert.ok(off <= 1, `its picture lies as in a GLB file: ${off}`);

  const folder = await mkdtemp(join(tmpdir(), 'lods-'));
  await writeFile(join(folder, 'scan.ply'), await write(scan, { format: 'ply' }));
  await run(process.execPath, [CLI, 'reconstruct', join(folder, 'scan.ply'), '-o', join(folder, 'a.glb'), '--no-reduce', '--lods', '300,100', '--texture', '64']);
  const counts = await Promise.all(['a.glb', 'a.lod1.glb'].map(async (name) => (await read(await readFile(join(folder, name)), { faces: 'mesh' })).indices.length / 3));
  assert.ok(counts[0] <= 300 && counts[0] >= 294 && counts[1] <= 100 && counts[1] >= 98, `${counts}`);
  await rm(folder, { recursive: true });
});

test('values are in the place of colours, and a range says which; occlusion is a picture, too', async () => {
  const maps = ['color', 'occlusion'];
  const made = await reconstruct(scan, { reduce: false, triangles: 300, texture: { size: 128, maps, scalar: 'height' } });
  assert.deepEqual(Object.keys(made.textures), maps);
  const { color, occlusion } = made.textures;
  assert.deepEqual([occlusion.width, occlusion.height], [color.width / 2, color.height / 2]);
  const mesh = await reconstruct(scan, { reduce: false });
  const others = { triangles: 300, size: 128, maps, scalar: 'height' };
  assert.deepEqual((await texture(mesh, scan, { ...others, range: color.range })).textures, made.textures);
  assert.notDeepEqual((await texture(mesh, scan, { ...others, range: [-9, 9] })).textures.color.data, color.data);
  // What an attribute says is shown as it would be of the height.
  const up = scan.up ?? [0, 1, 0];
  const height = Float32Array.from({ length: scan.positions.length / 3 }, (_, i) => up.reduce((sum, x, axis) => sum + x * scan.positions[3 * i + axis], 0));
  const named = await texture(mesh, { ...scan, up, attributes: { values: height } }, { ...others, scalar: 'values' });
  assert.deepEqual(named.textures.color, (await texture(mesh, { ...scan, up }, others)).textures.color);

  const glb = await write(made, { format: 'glb', up: 'z' });
  assert.deepEqual((await validateBytes(glb)).issues.messages.filter(({ severity }) => severity < 2), []);
  const document = await new WebIO().readBinary(glb);
  assert.deepEqual(document.getRoot().listMaterials()[0].getOcclusionTexture().getImage(), occlusion.data);
  const back = await read(glb, { faces: 'mesh' });
  assert.deepEqual(back.uvs, made.uvs);
  assert.deepEqual(Object.fromEntries(Object.entries(back.textures).map(([map, { width, data }]) => [map, [width, data]])), { color: [color.width, color.data], occlusion: [occlusion.width, occlusion.data] });
  const options = { size: [160, 120], background: '#203040' };
  const { data } = await poster(made, options);
  assert.deepEqual((await poster({ ...back, up: made.up }, options)).data, data);
  assert.notDeepEqual((await poster({ ...made, textures: { color, occlusion: color } }, options)).data, data);
});

test('pictures of a GLB are what is asked for, and the packages that are missing are named', async (t) => {
  const { engine } = await engineBeside(t, ['@gltf-transform', 'meshoptimizer', '@jsquash/webp', 'ktx2-encoder']);
  const mesh = await engine.reconstruct(scan, { reduce: false, triangles: 300, texture: { size: 256, maps: ['color', 'normal', 'occlusion'] } });
  const sizes = {};
  const { log } = console;
  // The validator knows no KTX2.
  const UNKNOWN = { png: [], webp: [], ktx2: ['VALUE_NOT_IN_LIST', 'IMAGE_UNRECOGNIZED_FORMAT'] };
  for (const pictures of ['png', 'webp', 'ktx2']) {
    for (const meshopt of [false, true]) {
      const glb = await engine.write(mesh, { format: 'glb', quantize: true, pictures, meshopt });
      sizes[pictures + meshopt] = glb.length;
      const { issues, info } = await validateBytes(glb, { ignoredIssues: ['UNSUPPORTED_EXTENSION', ...UNKNOWN[pictures]] });
      assert.deepEqual(issues.messages.filter(({ severity }) => severity < 2), [], pictures + meshopt);
      const needed = { png: [], webp: ['EXT_texture_webp'], ktx2: ['KHR_texture_basisu'] }[pictures];
      assert.deepEqual(needed.filter((name) => !info.extensionsRequired.includes(name)), []);
      if (meshopt || pictures === 'ktx2') continue;
      const back = await engine.read(glb, { faces: 'mesh' });
      assert.deepEqual(Object.values(back.textures).map(({ type }) => type), Array(3).fill(`image/${pictures}`));
      const [shown, bare] = [back, { ...back, textures: undefined, colors: undefined }].map((what) => engine.poster(what, { size: [64, 48] }));
      assert.notDeepEqual((await shown).data, (await bare).data, 'a poster has the pictures');
    }
  }
  assert.equal(console.log, log);
  t.diagnostic(JSON.stringify(sizes));
  assert.ok(sizes.webpfalse < 0.7 * sizes.pngfalse && sizes.ktx2false < sizes.pngfalse, JSON.stringify(sizes));
  const own = await engine.write(mesh, { format: 'glb', pictures: async ({ map, width, height, pixels }) => (pixels.length === 4 * width * height ? mesh.textures[map].data : undefined) });
  assert.deepEqual(own, await engine.write(mesh, { format: 'glb' }));
  for (const options of [{ format: 'usdz', pictures: 'webp' }, { format: 'glb', pictures: 'gif' }]) await assert.rejects(engine.write(mesh, options), { code: 'bad-option' });
  const { engine: alone } = await engineBeside(t, []);
  for (const [pictures, name] of [['webp', '@jsquash/webp'], ['ktx2', 'ktx2-encoder']]) {
    await assert.rejects(alone.write(mesh, { format: 'glb', pictures }), ({ code, message }) => code === 'missing-package' && message.includes(`npm install ${name}`));
  }
});
