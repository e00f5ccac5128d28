// Every format that is written, read back by readers that the project had no part in.

import assert from 'node:assert/strict';
import test from 'node:test';
import { WebIO } from '@gltf-transform/core';
import { KHRMeshQuantization } from '@gltf-transform/extensions';
import { validateBytes } from 'gltf-validator';
import { reconstruct, reduce, write } from 'pointweave';
import { Color, LinearSRGBColorSpace, SRGBColorSpace, Vector3 } from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { OBJLoader } from 'three/examples/jsm/loaders/OBJLoader.js';
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';
import { STLLoader } from 'three/examples/jsm/loaders/STLLoader.js';
import { XYZLoader } from 'three/examples/jsm/loaders/XYZLoader.js';
import { rejection, sphere } from './support.mjs';

const ORIGIN = [4_512_345.625, -543_210.1, 0.1];
const FAR = { radius: 3, center: [4_512_345.678, -543_211.789, 100.123], type: Float64Array };

/** Points with every colour, and what is made of them. */
const cloud = { ...sphere(2000), origin: ORIGIN };
cloud.colors.forEach((_, i) => (cloud.colors[i] = (i * 7) % 256));
const mesh = await reconstruct(cloud);
const points = await reduce(cloud);
const [farMesh, farPoints] = [await reconstruct(sphere(2000, FAR)), await reduce(sphere(2000, FAR))];
const plain = ({ origin, ...result }) => result;

const buffer = (bytes) => bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
const text = (bytes) => new TextDecoder().decode(bytes);
/** World coordinates of a result. */
const world = ({ positions, origin = [0, 0, 0] }) => Float64Array.from(positions, (x, i) => x + origin[i % 3]);
/** Linear components from 0 to 1 as the bytes of sRGB. */
const srgb = (linear) => {
  const bytes = [];
  for (let i = 0; i < linear.length; i += 3) {
    const { r, g, b } = new Color().setRGB(...linear.slice(i, i + 3), LinearSRGBColorSpace).convertLinearToSRGB();
    bytes.push(...[r, g, b].map((x) => Math.round(255 * x)));
  }
  return Uint8Array.from(bytes);
};
const close = (found, expected, error, what) => {
  assert.equal(found.length, expected.length, `${what}: length`);
  const worst = expected.reduce((most, x, i) => Math.max(most, Math.abs(x - found[i])), 0);
  assert.ok(worst <= error, `${what}: ${worst} off`);
};

async function validated(bytes) {
  const { issues, info } = await validateBytes(bytes);
  assert.deepEqual(issues.messages, [], 'not an error, a warning or a hint');
  return info;
}

/** What glTF-Transform finds. */
async function byTransform(bytes) {
  const document = await new WebIO().registerExtensions([KHRMeshQuantization]).readBinary(bytes);
  const root = document.getRoot();
  const node = root.listNodes().find((candidate) => candidate.getMesh());
  const [primitive] = node.getMesh().listPrimitives();
  const values = (name) => {
    const accessor = primitive.getAttribute(name);
    return accessor && Array.from({ length: accessor.getCount() }, (_, i) => accessor.getElement(i, [])).flat();
  };
  const colors = values('COLOR_0');
  const [scale] = node.getScale();
  return {
    mode: primitive.getMode(),
    names: primitive.listSemantics(),
    translations: root.listNodes().map((one) => one.getTranslation()),
    scale,
    local: values('POSITION'),
    normals: values('NORMAL'),
    colors: colors && srgb(colors.filter((_, i) => i % 4 !== 3)),
    values,
    indices: primitive.getIndices()?.getArray(),
  };
}

/** What three shows. */
async function byThree(bytes) {
  const { scene } = await new GLTFLoader().parseAsync(buffer(bytes), '');
  scene.updateMatrixWorld();
  let found;
  scene.traverse((object) => (found = object.isMesh || object.isPoints ? object : found));
  const { position, normal, color } = found.geometry.attributes;
  const corner = new Vector3();
  const placed = Array.from({ length: position.count }, (_, i) => corner.fromBufferAttribute(position, i).applyMatrix4(found.matrixWorld).toArray());
  const linear = color && Array.from({ length: color.count }, (_, i) => [color.getX(i), color.getY(i), color.getZ(i)]).flat();
  return {
    kind: found.type,
    attributes: found.geometry.attributes,
    world: placed.flat(),
    normals: normal?.array,
    colors: linear && srgb(linear),
    indices: found.geometry.index?.array,
  };
}

test('GLB: a mesh and its points come back to the bit, with the origin in double precision', async () => {
  for (const [result, mode, kind] of [[mesh, 4, 'Mesh'], [points, 0, 'Points']]) {
    const bytes = await write(result, { format: 'glb' });
    const info = await validated(bytes);
    assert.equal(info.totalVertexCount, result.positions.length / 3);
    assert.equal(info.totalTriangleCount, (result.indices?.length ?? 0) / 3);

    const found = await byTransform(bytes);
    assert.equal(found.mode, mode);
    assert.deepEqual(found.names, ['POSITION', 'NORMAL', 'COLOR_0', '_HEIGHT']);
    assert.deepEqual(found.translations, [ORIGIN]);
    assert.deepEqual(Float32Array.from(found.local), result.positions);
    assert.deepEqual(found.colors, result.colors);
    assert.deepEqual(Float32Array.from(found.values('_HEIGHT')), result.attributes.height);
    assert.deepEqual(Float32Array.from(found.normals), result.normals);
    assert.deepEqual(found.indices && Uint32Array.from(found.indices), result.indices);

    const shown = await byThree(bytes);
    assert.equal(shown.kind, kind);
    assert.deepEqual(Float64Array.from(shown.world), world(result));
    assert.deepEqual(shown.colors, result.colors);
    assert.deepEqual(shown.attributes._height.array, result.attributes.height);
    assert.deepEqual(shown.normals, result.normals);
    assert.deepEqual(shown.indices && Uint32Array.from(shown.indices), result.indices);
  }
});

test('GLB: every colour comes back, and large meshes have long indices', async () => {
  const colors = Uint8Array.from({ length: 3 * 256 }, (_, i) => Math.floor(i / 3));
  const grey = await write({ positions: new Float32Array(3 * 256).map((_, i) => i), colors }, { format: 'glb' });
  await validated(grey);
  assert.deepEqual((await byTransform(grey)).colors, colors);

  for (const [count, Type] of [[65_535, Uint16Array], [65_536, Uint32Array]]) {
    const indices = Uint32Array.of(0, 1, count - 1);
    const bytes = await write({ positions: new Float32Array(3 * count).map((_, i) => i % 101), indices }, { format: 'glb' });
    assert.deepEqual((await byTransform(bytes)).indices, Type.from(indices));
  }
});

test('GLB: a cloud in double precision gets an origin near its middle', async () => {
  for (const result of [farMesh, farPoints]) {
    const found = await byTransform(await write(result, { format: 'glb' }));
    const [origin] = found.translations;
    assert.deepEqual(origin, [4_512_344, -543_212, 100]);
    close(found.local.map((x, i) => x + origin[i % 3]), result.positions, 2 ** -22, 'world'); // half a step of single precision under 8
  }
  const near = sphere(100, { type: Float64Array });
  const found = await byTransform(await write(near, { format: 'glb' }));
  assert.deepEqual(found.translations, [[0, 0, 0]]);
  assert.deepEqual(found.local, [...Float32Array.from(near.positions)]);
});

test('GLB: quantised to 1/65535 of the longest side, the origin exact', async () => {
  for (const [result, origin] of [[mesh, ORIGIN], [points, ORIGIN], [plain(mesh)], [farMesh, [4_512_344, -543_212, 100]]]) {
    const bytes = await write(result, { format: 'glb', quantize: true });
    await validated(bytes);
    const whole = await write(result, { format: 'glb' });
    assert.ok(bytes.length < 0.8 * whole.length, `${bytes.length} of ${whole.length} bytes`);
    const found = await byTransform(bytes);
    const [first, second] = found.translations;
    if (origin) assert.deepEqual(first, origin);
    const start = origin ? second : first;
    const local = found.local.map((x, i) => found.scale * x + start[i % 3]);
    const expected = world(result).map((x, i) => x - (origin?.[i % 3] ?? 0));
    const longest = Math.max(...[0, 1, 2].map((axis) => {
      const along = expected.filter((_, i) => i % 3 === axis);
      return Math.max(...along) - Math.min(...along);
    }));
    close(local, expected, 0.501 * longest / 65_535, 'positions');
    close(found.normals, result.normals, 0.5 / 127 + 1e-6, 'normals');
    assert.deepEqual(found.colors, result.colors);
    assert.deepEqual(Float32Array.from(found.values('_HEIGHT')), result.attributes.height);
    close((await byThree(bytes)).world, world(result), 0.502 * longest / 65_535 + 1e-9, 'as three shows it');
  }
});

test('GLB: names of attributes are what the format asks for, and normals are all or none', async () => {
  const positions = new Float32Array(9).map((_, i) => i);
  const value = Float32Array.of(1, 2, 3);
  const attributes = { 'Scan Angle': value, scan_angle: value, 'größe': value };
  const normals = Float32Array.of(0, 0, 2, 0, 0, 0, 1, 0, 0);
  const bytes = await write({ positions, normals, attributes }, { format: 'glb' });
  await validated(bytes);
  assert.deepEqual((await byTransform(bytes)).names, ['POSITION', '_SCAN_ANGLE', '_SCAN_ANGLE_', '_GR__E']);
  normals[4] = 3;
  const full = await write({ positions, normals }, { format: 'glb' });
  await validated(full);
  assert.deepEqual((await byTransform(full)).normals, [0, 0, 1, 0, 1, 0, 1, 0, 0]);
});

test('OBJ', async () => {
  const found = new OBJLoader().parse(text(await write(plain(mesh), { format: 'obj' }))).children[0];
  const corners = (array) => Float32Array.from([...mesh.indices].flatMap((i) => [...array.subarray(3 * i, 3 * i + 3)]));
  assert.ok(found.isMesh);
  assert.deepEqual(found.geometry.attributes.position.array, corners(mesh.positions));
  assert.deepEqual(found.geometry.attributes.normal.array, corners(mesh.normals));
  assert.deepEqual(srgb([...found.geometry.attributes.color.array]), Uint8Array.from(corners(mesh.colors)));

  const cloud = new OBJLoader().parse(text(await write(plain(points), { format: 'obj' }))).children[0];
  assert.ok(cloud.isPoints);
  assert.deepEqual(cloud.geometry.attributes.position.array, points.positions);
  assert.deepEqual(srgb([...cloud.geometry.attributes.color.array]), points.colors);

  for (const result of [mesh, points, farMesh]) {
    const lines = text(await write(result, { format: 'obj' })).split('\n').filter((line) => line.startsWith('v '));
    assert.deepEqual(Float64Array.from(lines.flatMap((line) => line.split(' ').slice(1, 4).map(Number))), world(result));
  }
});

test('STL', async () => {
  const bytes = await write(mesh, { format: 'stl' });
  const { position, normal } = new STLLoader().parse(buffer(bytes)).attributes;
  assert.deepEqual(position.array, Float32Array.from([...mesh.indices].flatMap((i) => [...mesh.positions.subarray(3 * i, 3 * i + 3)])));
  const [a, b, c] = [0, 1, 2].map((corner) => new Vector3().fromBufferAttribute(position, corner));
  const expected = b.sub(a).cross(c.sub(a)).normalize();
  close([...normal.array.slice(0, 3)], expected.toArray(), 1e-5, 'normal');
  assert.equal(text(bytes.subarray(0, 80)).trim(), `at ${ORIGIN.join(' ')}`);

  const found = new STLLoader().parse(buffer(await write(farMesh, { format: 'stl' }))).attributes.position.array;
  const origin = [4_512_344, -543_212, 100];
  const corners = [...farMesh.indices].flatMap((i) => [...farMesh.positions.subarray(3 * i, 3 * i + 3)]);
  close([...found].map((x, i) => x + origin[i % 3]), corners, 2 ** -22, 'world');

  const error = await rejection(write(points, { format: 'stl' }));
  assert.equal(error.code, 'needs-triangles');
  assert.match(error.message, /hold triangles, and there are none/);
});

test('PLY', async () => {
  for (const [result, encoding] of [[mesh, 'binary'], [mesh, 'ascii'], [points, 'binary']]) {
    const bytes = await write(plain(result), { format: 'ply', encoding });
    const loader = new PLYLoader();
    loader.setCustomPropertyNameMapping({ height: ['height'] });
    const { attributes, index } = loader.parse(buffer(bytes));
    assert.deepEqual(attributes.position.array, result.positions);
    assert.deepEqual(attributes.normal.array, result.normals);
    assert.deepEqual(attributes.height.array, result.attributes.height);
    assert.deepEqual(index && Uint32Array.from(index.array), result.indices ?? null);
    // The loader rounds linear colours to bytes.
    const linear = Array.from(result.colors, (c) => Math.round(255 * new Color().setRGB(c / 255, 0, 0, SRGBColorSpace).r));
    assert.deepEqual([...attributes.color.array], linear);
  }
  for (const result of [mesh, farPoints]) {
    const bytes = await write(result, { format: 'ply' });
    const start = text(bytes.subarray(0, 1000)).indexOf('end_header\n') + 11;
    const stride = 3 * 8 + 3 * 4 + 3 + 4; // doubles, normals, colours, height
    const view = new DataView(bytes.buffer, bytes.byteOffset + start);
    const found = Float64Array.from(result.positions, (_, i) => view.getFloat64(stride * Math.floor(i / 3) + 8 * (i % 3), true));
    assert.deepEqual(found, world(result));
  }
});

test('XYZ', async () => {
  const { positions, colors } = points;
  const { attributes } = new XYZLoader().parse(text(await write({ positions, colors }, { format: 'xyz' })));
  assert.deepEqual(attributes.position.array, positions);
  assert.deepEqual(srgb([...attributes.color.array]), colors);
  // Readers such as trimesh's take every word for a number; where there are attributes, a comment has their names.
  const words = text(await write({ positions, colors }, { format: 'xyz' })).trim().split(/\s+/).map(Number);
  assert.ok(words.length === 2 * positions.length && words.every(Number.isFinite));
  for (const result of [mesh, farPoints]) {
    const rows = text(await write(result, { format: 'xyz' })).trimEnd().split('\n').slice(1).map((row) => row.split(' ').map(Number));
    assert.deepEqual(Float64Array.from(rows.flatMap((row) => row.slice(0, 3))), world(result));
    assert.deepEqual(Float32Array.from(rows.flatMap((row) => row.slice(3, 6))), result.normals);
    assert.deepEqual(Uint8Array.from(rows.flatMap((row) => row.slice(6, 9))), result.colors);
  }
});

test('what only a GLB file can be is refused for others', async () => {
  for (const option of ['quantize', 'meshopt']) {
    for (const format of [undefined, 'ply', 'obj']) {
      const error = await rejection(write(points, { format, [option]: true }));
      assert.equal(error.code, 'bad-option');
      assert.match(error.message, new RegExp(`option ${option} is true.*'glb'`));
    }
    await write(points, { format: 'obj', [option]: false });
  }
});
