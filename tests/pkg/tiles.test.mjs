// Tiles by the command line: the same bytes however they are made, a valid tileset, and clear words for what goes wrong.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { buffer } from 'node:stream/consumers';
import test from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import { WebIO } from '@gltf-transform/core';
import { KHRMeshQuantization } from '@gltf-transform/extensions';
import { read, write } from 'pointweave';
import { decode, encode, joined } from '../../pkg/tiles/columns.js';
import { tasksOf } from '../../pkg/tiles/plan.js';
import { validateTileset } from './validate-tileset.mjs';

const CLI = fileURLToPath(new URL('../../pkg/cli.js', import.meta.url));
const ORIGIN = [400000, 5700000, 100];

/** Half of a hilly square, 100 m wide; the file's coordinates are large, and its points have colours, intensities and classes. */
function half(side) {
  const count = 24_000;
  const positions = new Float64Array(3 * count);
  const colors = new Uint8Array(3 * count);
  const [intensity, classification] = [new Float32Array(count), new Float32Array(count)];
  let seed = 1 + side;
  const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
  for (let i = 0; i < count; i++) {
    const [x, y] = [50 * (side + random()), 100 * random()];
    positions.set([ORIGIN[0] + x, ORIGIN[1] + y, ORIGIN[2] + 4 * Math.sin(x / 9) * Math.cos(y / 11)], 3 * i);
    colors.set([2 * x, 2 * y, 60], 3 * i);
    intensity[i] = Math.round(10 * x);
    classification[i] = x > 50 ? 6 : 2;
  }
  return write({ positions, colors, attributes: { intensity, classification } }, { format: 'laz' });
}

const halves = await Promise.all([half(0), half(1)]);

/** A folder with the scan in it. */
function folder(t) {
  const path = mkdtempSync(join(tmpdir(), 'pointweave-tiles-'));
  t.after(() => rmSync(path, { recursive: true }));
  mkdirSync(join(path, 'scan'));
  halves.forEach((bytes, i) => writeFileSync(join(path, 'scan', `${i}.laz`), bytes));
  return path;
}

function start(cwd, ...args) {
  const child = spawn(process.execPath, [CLI, 'tiles', ...args], { cwd });
  const exit = new Promise((resolve) => child.once('close', (code, signal) => resolve(code ?? signal)));
  const ended = Promise.all([exit, buffer(child.stdout), buffer(child.stderr)]).then(([code, stdout, stderr]) => ({ code, stdout: String(stdout), stderr: String(stderr) }));
  return { child, ended };
}

async function good(cwd, ...args) {
  const { code, stdout, stderr } = await start(cwd, ...args).ended;
  assert.equal(code, 0, stderr);
  return { stdout, stderr };
}

async function bad(cwd, ...args) {
  const { code, stderr } = await start(cwd, ...args).ended;
  return { code, stderr };
}

/** The hashes of all files of a tileset. */
function hashes(path) {
  const files = readdirSync(path, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile() && !entry.parentPath.includes('work'));
  const names = files.map(({ parentPath, name }) => join(parentPath, name)).sort();
  return names.map((name) => `${name.slice(path.length)} ${createHash('sha256').update(readFileSync(name)).digest('hex')}`);
}

const OPTIONS = ['--tile-points', '12000', '--ratio', '0.2'];

test('a tileset is valid, in its place, and has about the points that were asked for', async (t) => {
  const path = folder(t);
  const { stdout } = await good(path, 'scan', '-o', 'out', ...OPTIONS, '--json', '--jobs', '2');
  const manifest = JSON.parse(stdout);
  assert.deepEqual([manifest.points, manifest.strays, manifest.inputs.map(({ name }) => name)], [48_000, 0, ['0.laz', '1.laz']]);
  const found = await validateTileset(join(path, 'out'));
  assert.ok(found.depth >= 1, `depth ${found.depth}`);
  assert.equal(found.leafPoints, manifest.reduced);
  assert.ok(Math.abs(found.leafPoints / 9600 - 1) < 0.1, `${found.leafPoints} points`);
  const [low, high] = found.box;
  for (const [axis, size] of [[0, 100], [1, 100]]) {
    assert.ok(Math.abs(low[axis] - ORIGIN[axis]) < 1 && Math.abs(high[axis] - ORIGIN[axis] - size) < 1, `${low} ${high}`);
  }
  assert.ok(!existsSync(join(path, 'out/work')));

  // A finest tile: its scalars and colours are those of the place.
  const { root } = JSON.parse(readFileSync(join(path, 'out/tileset.json'), 'utf8'));
  let leaf = root;
  while (leaf.children) leaf = leaf.children.at(-1);
  const io = new WebIO().registerExtensions([KHRMeshQuantization]);
  const document = await io.readBinary(new Uint8Array(readFileSync(join(path, 'out', leaf.content.uri))));
  const node = document.getRoot().listNodes().find((other) => other.getMesh());
  const [primitive] = node.getMesh().listPrimitives();
  const [position, color, intensity, classification] = ['POSITION', 'COLOR_0', '_INTENSITY', '_CLASSIFICATION'].map((name) => primitive.getAttribute(name));
  assert.ok(position.getCount() > 50);
  const [scale, , , , , , , , , , , , x0] = node.getWorldMatrix();
  const colors = await read(readFileSync(join(path, 'out', leaf.content.uri)), { name: 'tile.glb' });
  for (let i = 0; i < position.getCount(); i++) {
    const x = x0 + scale * position.getElement(i, [])[0] + root.transform[12] - ORIGIN[0];
    assert.ok(Math.abs(intensity.getScalar(i) / 10 - x) < 4, `${intensity.getScalar(i)} at ${x}`);
    assert.ok(Math.abs(colors.colors[3 * i] / 2 - x) < 4);
    assert.ok([2, 6].includes(classification.getScalar(i)));
  }
  assert.equal(color.getCount(), position.getCount());

  // The same again, whatever does it.
  const whole = hashes(join(path, 'out'));
  await good(path, 'scan', '-o', 'one', ...OPTIONS, '--jobs', '1');
  assert.deepEqual(hashes(join(path, 'one')), whole);
  assert.match((await good(path, 'scan', '-o', 'out', ...OPTIONS, '--resume')).stderr, /nothing to do/);
  assert.match((await bad(path, 'scan', '-o', 'out', ...OPTIONS)).stderr, /has a tileset: remove it/);
  assert.match((await bad(path, 'scan', '-o', 'out', '--resume')).stderr, /has a tileset of other scans or options/);

  // What is killed at any moment goes on, and ends in the same bytes.
  for (const after of [400, 1200]) {
    const { child, ended } = start(path, 'scan', '-o', 'killed', ...OPTIONS, '--jobs', '2', '--resume');
    await sleep(after);
    child.kill('SIGKILL');
    await ended;
  }
  const again = await bad(path, 'scan', '-o', 'killed', ...OPTIONS);
  if (again.code === 2) assert.match(again.stderr, /--resume goes on with it|has a tileset/);
  await good(path, 'scan', '-o', 'killed', ...OPTIONS, '--resume');
  assert.deepEqual(hashes(join(path, 'killed')), whole);
});

test('tiles of a mesh meet in every bit', async (t) => {
  const path = folder(t);
  const { stdout } = await good(path, 'scan', '-o', 'mesh', '--tile-points', '9000', '--ratio', '0.1', '--mesh', '--mesh-points', '6000', '--json');
  const { triangles } = JSON.parse(stdout);
  const found = await validateTileset(join(path, 'mesh'));
  assert.equal(found.leafTriangles, triangles);
  assert.ok(found.depth > 0 && triangles > 3000, `${found.depth}, ${triangles}`);
  const { root } = JSON.parse(readFileSync(join(path, 'mesh/tileset.json'), 'utf8'));
  const leaves = [];
  const walk = (node) => (node.children ? node.children.forEach(walk) : leaves.push(node));
  walk(root);
  /** How often each edge is passed, by the exact places of its ends. */
  const edges = new Map();
  const io = new WebIO();
  for (const { content: { uri } } of leaves) {
    const document = await io.readBinary(new Uint8Array(readFileSync(join(path, 'mesh', uri))));
    for (const node of document.getRoot().listNodes()) {
      const [primitive] = node.getMesh()?.listPrimitives() ?? [];
      if (!primitive) continue;
      const corner = node.getWorldTranslation();
      const place = (vertex) => primitive.getAttribute('POSITION').getElement(vertex, []).map((x, axis) => x + corner[axis]).join(' ');
      const corners = Array.from(primitive.getIndices().getArray(), place);
      for (let i = 0; i < corners.length; i++) {
        const edge = [corners[i], corners[i % 3 === 2 ? i - 2 : i + 1]].sort().join(', ');
        edges.set(edge, (edges.get(edge) ?? 0) + 1);
      }
    }
  }
  assert.ok([...edges.values()].every((count) => count <= 2));
  // What one triangle alone has is the rim of the square, and a hole or two: a cut through the middle would be as long as that again.
  const open = [...edges].filter(([, count]) => count === 1).map(([edge]) => edge.split(', ').map((end) => end.split(' ').map(Number)));
  const inside = ([x, , z]) => Math.min(x + root.transform[12] - ORIGIN[0], -z + root.transform[13] - ORIGIN[1]) > 5 && Math.max(x + root.transform[12] - ORIGIN[0], -z + root.transform[13] - ORIGIN[1]) < 95;
  assert.ok(open.length > 50, `${open.length}`);
  assert.ok(open.filter((ends) => ends.some(inside)).length < 8, `${open.filter((ends) => ends.some(inside)).length}`);
});

test('a tolerance asks for fewer points where it is larger, and strays go where that is asked', async (t) => {
  const path = folder(t);
  const made = async (name, ...args) => JSON.parse((await good(path, 'scan', '-o', name, '--tile-points', '12000', '--json', ...args)).stdout);
  const [fine, coarse] = [await made('fine', '--tolerance', '0.02'), await made('coarse', '--tolerance', '0.2')];
  assert.deepEqual([fine.tolerance, coarse.tolerance], [0.02, 0.2]);
  assert.ok(fine.reduced > 1.5 * coarse.reduced && coarse.reduced > 20 && fine.reduced < 24_000, `${fine.reduced} and ${coarse.reduced}`);
  const strays = Array.from({ length: 60 }, (_, i) => `${ORIGIN[0] + (i * 37) % 100} ${ORIGIN[1] + (i * 61) % 100} ${ORIGIN[2] + 12 + (i % 7)}`);
  writeFileSync(join(path, 'scan/strays.xyz'), `${strays.join('\n')}\n`);
  const top = async (name, ...args) => {
    await made(name, ...args);
    return (await validateTileset(join(path, name))).box[1][2];
  };
  assert.ok((await top('kept')) > ORIGIN[2] + 10);
  assert.ok((await top('dropped', '--outliers', 'drop')) < ORIGIN[2] + 6);
});

test('what goes wrong is said in a line, and what was done stays', async (t) => {
  const path = folder(t);
  writeFileSync(join(path, 'scan/2.laz'), halves[0].subarray(0, 3000));
  const broken = await bad(path, 'scan', '-o', 'out', ...OPTIONS);
  assert.equal(broken.code, 1);
  assert.match(broken.stderr, /pointweave: 2\.laz: .+\n/);
  assert.match(broken.stderr, /1 of 3 files cannot be read/);
  assert.equal(broken.stderr.split('\n').filter((line) => line.includes('2.laz')).length, 1);
  assert.ok(existsSync(join(path, 'out/work/counts/0.json')));

  writeFileSync(join(path, 'packed.xyz.gz'), gzipSync('0 0 0\n1 1 1\n'));
  for (const [args, words, code] of [
    [['packed.xyz.gz', '-o', 'x'], /packed\.xyz\.gz is an archive/, 1],
    [['scan'], /where should the tiles go\? -o FOLDER/, 2],
    [['nothing.laz', '-o', 'x'], /'nothing\.laz': there is no such file or folder/, 2],
    [['scan', '-o', 'x', '--ratio', '0.1', '--count', '3'], /--ratio and --count exclude each other/, 2],
    [['scan', '-o', 'x', '--spacing', '0'], /--spacing is '0': expected a number in/, 2],
    [['scan', '-o', 'x', '--mesh', '--spacing', '1'], /--mesh needs --ratio or --count/, 2],
    [['scan', '-o', 'x', '--mesh', '--tolerance', '1'], /--mesh needs --ratio or --count/, 2],
    [['scan', '-o', 'x', '--outliers', 'all'], /--outliers is 'all': expected keep or drop/, 2],
    [['scan', '-o', 'x', '--memory', '300MB'], /--tile-points \d+ fits/, 2],
    [['scan', '-o', 'x', '--mesh', '--mesh-points', '3000000'], /a mesh through 3000000 points takes \d+ MB: --mesh-points \d+ fits/, 2],
    [['scan', '-o', 'x', '--memory', 'much'], /expected a size as 2GB or 900MB/, 2],
    [['make', '-o', 'out', '--tile', '0-0-0-0'], /the step that makes it has not run/, 1],
    [['list', '-o', 'out'], /the step that makes it has not run/, 1],
    [['scan', '-o', 'out', '--tile-points', '9000', '--resume'], /the work of other scans or options/, 2],
  ]) {
    const { code: found, stderr } = await bad(path, ...args);
    assert.match(stderr, words);
    assert.equal(found, code, stderr);
  }
});

test('points of tiles come back from their files', () => {
  const block = { places: Uint32Array.of(1, 2, 3, 4, 5, 2 ** 32 - 1), colors: Uint8Array.of(1, 2, 3, 4, 5, 6), names: ['a'], values: [Float32Array.of(0.5, -1)], more: { x: 1 } };
  const plain = { places: Uint32Array.of(7, 8, 9), names: [], values: [], more: undefined };
  const bytes = new Uint8Array(Buffer.concat([encode(block), encode(plain)]));
  const copy = bytes.slice();
  assert.deepEqual(decode(copy), [block, plain]);
  assert.deepEqual(joined(decode(copy), ['b', 'a']), {
    places: Uint32Array.of(1, 2, 3, 4, 5, 2 ** 32 - 1, 7, 8, 9),
    colors: Uint8Array.of(1, 2, 3, 4, 5, 6, 255, 255, 255),
    names: ['b', 'a'],
    values: [new Float32Array(3), Float32Array.of(0.5, -1, 0)],
  });
  assert.throws(() => decode(copy.slice(0, copy.length - 4)), { code: 'bad-file' });
});

test('a plan says of every task what it needs and makes', () => {
  const leaf = (tile, files, around) => ({ tile, level: 0, files, around });
  const [a, b] = ['1-0-0-0', '1-1-0-0'];
  const tasks = tasksOf({
    corner: [0, 0, 0], size: 1, strays: 0,
    leaves: [leaf(a, [[0, 10]], [a, b]), leaf(b, [[0, 4], [1, 5]], [a, b])],
    inner: [{ tile: '0-0-0-0', level: 1, files: [], around: [a, b] }],
  }, { ratio: 0.5 });
  const made = new Set(['work/plan.json', 'work/counts/0.json', 'work/counts/1.json']);
  for (const { needs, makes } of tasks) {
    assert.ok(needs.every((name) => made.has(name)), `${needs}`);
    makes.forEach((name) => made.add(name));
  }
  assert.ok(made.has('tileset.json') && made.has('points/0-0-0-0.glb'));
  assert.equal(tasks.find(({ id }) => id === `make-${b}`).needs.length, 5);
});
