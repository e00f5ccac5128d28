// `node ours.mjs write FOLDER`: the cloud and the mesh of the comparison, by Pointweave's writers, and what they are, in truth.json.
// `node ours.mjs read FOLDER`: what Pointweave reads of the peers' files in FOLDER/theirs, beside what they meant.

import { mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { crc32, deflateSync } from 'node:zlib';
import { createEngine } from 'pointweave';
import validator from 'gltf-validator';

const [job, folder] = process.argv.slice(2);
const POINTS = 2000;
/** Of the surveyed cloud: metres, as a projected reference system has them. */
const ORIGIN = [455_000, 5_412_000, 320];
/** Positions are multiples of it, which every format holds. */
const STEP = 1 / 1024;

/** Numbers in [0, 1), the same every time. */
function random(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

function cloudOf() {
  const next = random(7);
  const positions = Float32Array.from({ length: 3 * POINTS }, (_, i) => Math.round(next() * [4096, 3072, 1024][i % 3]) * STEP);
  const normals = new Float32Array(3 * POINTS);
  for (let i = 0; i < POINTS; i++) {
    const [x, y, z] = [next() - 0.5, next() - 0.5, next() + 0.1];
    const length = Math.hypot(x, y, z);
    normals.set([x / length, y / length, z / length], 3 * i);
  }
  const column = (make) => Float32Array.from({ length: POINTS }, make);
  return {
    positions, normals,
    colors: Uint8Array.from({ length: 3 * POINTS }, () => Math.floor(next() * 256)),
    attributes: {
      intensity: column(() => Math.floor(next() * 65536)),
      classification: column(() => Math.floor(next() * 12)),
      scan_angle: column(() => (Math.floor(next() * 10_000) - 5000) * 0.006),
      gps_time: column((_, i) => i / 4),
      quality: column(() => next() - 0.5),
    },
    up: [0, 0, 1], unit: 'm',
  };
}

/** A closed body of 24 by 12 faces, with colours. */
function meshOf() {
  const [columns, rows] = [24, 11];
  const positions = [[0, 0, 2]];
  for (let row = 1; row <= rows; row++) {
    for (let column = 0; column < columns; column++) {
      const [a, b] = [(row / (rows + 1)) * Math.PI, (column / columns) * 2 * Math.PI];
      positions.push([2 * Math.sin(a) * Math.cos(b), Math.sin(a) * Math.sin(b), 2 * Math.cos(a)]);
    }
  }
  positions.push([0, 0, -2]);
  const at = (row, column) => (row === 0 ? 0 : row > rows ? positions.length - 1 : 1 + (row - 1) * columns + (column % columns));
  const indices = [];
  for (let row = 0; row <= rows; row++) {
    for (let column = 0; column < columns; column++) {
      const [a, b, c, d] = [at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)];
      if (row < rows) indices.push(a, b, c);
      if (row > 0) indices.push(a, c, d);
    }
  }
  const flat = Float32Array.from(positions.flat().map((x) => Math.round(x / STEP) * STEP));
  const normals = new Float32Array(flat.length);
  positions.forEach((p, i) => normals.set(p.map((x) => x / Math.hypot(...p)), 3 * i));
  const next = random(11);
  return {
    positions: flat, normals, indices: Uint32Array.from(indices),
    colors: Uint8Array.from({ length: flat.length }, () => Math.floor(next() * 256)),
    up: [0, 0, 1], unit: 'm',
  };
}

/** A picture of 2 x 2 pixels of one colour. */
function png(color) {
  const chunk = (name, data) => {
    const body = Buffer.concat([Buffer.from(name), data]);
    const [length, sum] = [Buffer.alloc(4), Buffer.alloc(4)];
    length.writeUInt32BE(data.length);
    sum.writeUInt32BE(crc32(body));
    return Buffer.concat([length, body, sum]);
  };
  const row = [0, ...color, ...color];
  const head = chunk('IHDR', Buffer.from([0, 0, 0, 2, 0, 0, 0, 2, 8, 2, 0, 0, 0]));
  return new Uint8Array(Buffer.concat([Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'), head, chunk('IDAT', deflateSync(Buffer.from([...row, ...row]))), chunk('IEND', Buffer.alloc(0))]));
}

/** The mesh with pictures. */
function textured(mesh) {
  const next = random(5);
  const picture = (color) => ({ width: 2, height: 2, type: 'image/png', data: png(color) });
  const uvs = Float32Array.from({ length: (2 * mesh.positions.length) / 3 }, () => Math.round(next() * 1024) / 1024);
  return { ...mesh, uvs, textures: { color: picture([200, 100, 50]), normal: picture([128, 128, 255]) } };
}

const engine = await createEngine({ threads: 1, worker: false });
if (job === 'write') await write();
else await read();
await engine.dispose();

async function write() {
  mkdirSync(join(folder, 'ours'), { recursive: true });
  mkdirSync(join(folder, 'theirs'), { recursive: true });
  const local = cloudOf();
  const surveyed = { ...local, origin: ORIGIN };
  const mesh = meshOf();
  const pictured = textured(mesh);
  const plain = (thing) => Object.fromEntries(Object.entries(thing).map(([key, value]) => [key, ArrayBuffer.isView(value) ? [...value] : value]));
  const attributes = Object.fromEntries(Object.entries(local.attributes).map(([key, values]) => [key, [...values]]));
  writeFileSync(join(folder, 'truth.json'), JSON.stringify({ cloud: { ...plain(local), attributes }, mesh: { ...plain(mesh), uvs: [...pictured.uvs] }, origin: ORIGIN }));
  const options = {
    ply: [{ encoding: 'binary' }, { encoding: 'ascii' }], glb: [{}, { quantize: true }],
  };
  const reports = [];
  for (const [name, thing] of [['cloud', local], ['surveyed', surveyed], ['mesh', mesh]]) {
    const formats = name === 'mesh' ? ['ply', 'obj', 'glb', 'stl', '3mf', 'usdz'] : ['ply', 'xyz', 'obj', 'pcd', 'glb', 'las', 'laz', 'usdz'];
    for (const format of formats) {
      for (const [i, more] of (options[format] ?? [{}]).entries()) {
        const bytes = await engine.write(thing, { format, ...more });
        const file = `${name}${i === 0 ? '' : `-${Object.values(more)[0] === true ? Object.keys(more)[0] : Object.values(more)[0]}`}.${format}`;
        writeFileSync(join(folder, 'ours', file), bytes);
        if (format !== 'glb') continue;
        const { issues } = await validator.validateBytes(new Uint8Array(bytes));
        reports.push([file, 'gltf-validator', issues.numErrors + issues.numWarnings === 0 ? 'equal' : `${issues.numErrors} errors, ${issues.numWarnings} warnings: ${issues.messages[0].message}`]);
      }
    }
  }
  writeFileSync(join(folder, 'ours', 'mesh-pictures.usdz'), await engine.write(pictured, { format: 'usdz' }));
  writeFileSync(join(folder, 'validated.json'), JSON.stringify(reports));
}

/** Reads what the peers wrote; `theirs/NAME.json` says what each file holds. */
async function read() {
  const rows = [];
  for (const file of readdirSync(join(folder, 'theirs')).filter((name) => name.endsWith('.json')).sort()) {
    const meant = JSON.parse(readFileSync(join(folder, 'theirs', file), 'utf8'));
    const data = new Uint8Array(readFileSync(join(folder, 'theirs', meant.file)));
    let wrong;
    try {
      wrong = compare(await engine.read(data, { name: meant.file, faces: 'vertices' }), meant);
    } catch (error) {
      wrong = [error.message];
    }
    rows.push([meant.file, meant.by, wrong.length === 0 ? 'equal' : wrong.join('; ')]);
  }
  writeFileSync(join(folder, 'read.json'), JSON.stringify(rows));
}

function compare(cloud, meant) {
  const wrong = [];
  const expect = (what, found, wanted) => {
    if (JSON.stringify(found ?? null) !== JSON.stringify(wanted ?? null)) wrong.push(`${what} ${JSON.stringify(found)}, not ${JSON.stringify(wanted)}`);
  };
  const near = (what, found, wanted, tolerance) => {
    if (found?.length !== wanted.length) return wrong.push(`${what}: ${found?.length ?? 'no'} values, not ${wanted.length}`);
    const at = wanted.findIndex((value, i) => !(Math.abs(found[i] - value) <= tolerance));
    if (at >= 0) wrong.push(`${what}[${at}] ${found[at]}, not ${wanted[at]}`);
  };
  const origin = cloud.origin ?? [0, 0, 0];
  if (meant.sorted) sort(cloud, meant);
  near('positions', [...cloud.positions].map((x, i) => x + origin[i % 3]), meant.positions, meant.tolerance ?? 1e-9);
  for (const name of ['colors', 'normals']) {
    if (meant[name]) near(name, cloud[name], meant[name], name === 'colors' ? 0 : 1e-5);
    else expect(name, cloud[name]?.length, undefined);
  }
  for (const [name, values] of Object.entries(meant.attributes ?? {})) near(name, cloud.attributes?.[name], values, 1e-6 * Math.max(...values.map(Math.abs)));
  const more = Object.keys(cloud.attributes ?? {}).filter((name) => !(name in (meant.attributes ?? {})) && !(meant.also ?? []).includes(name));
  expect('other attributes', more, []);
  expect('up', cloud.up, meant.up);
  expect('unit', cloud.unit, meant.unit);
  expect('skipped', cloud.skipped, meant.skipped ?? {});
  if (meant.faces) expect('faces', cloud.file.faces, meant.faces);
  return wrong;
}

/** Points of both in the order of their coordinates: peers weld or reorder vertices. */
function sort(cloud, meant) {
  for (const side of [cloud, meant]) {
    const count = side.positions.length / 3;
    const order = Array.from({ length: count }, (_, i) => i);
    const key = (i) => [0, 1, 2].map((axis) => Math.round(side.positions[3 * i + axis] * 1e4));
    order.sort((i, j) => key(i).map((x, axis) => x - key(j)[axis]).find((x) => x !== 0) ?? 0);
    for (const name of ['positions', 'colors', 'normals']) {
      if (side[name]) side[name] = order.flatMap((i) => [...side[name].slice(3 * i, 3 * i + 3)]);
    }
  }
}
