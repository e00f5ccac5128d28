// Which side is out: what is known of it on its way in, through every call and out again, and what is said of it.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { fileURLToPath } from 'node:url';
import { PointweaveError, flip, inspect, read, reconstruct, reduce, sample, sideInWords, write } from 'pointweave';
import { load } from 'pointweave/core';
import { parse } from '../../pkg/cli/arguments.js';
import { withSaid } from '../../pkg/cli/cloud-flags.js';
import { UsageError } from '../../pkg/cli/usage.js';
import { sharedFile } from '../page/browser.mjs';
import { engineFor, rejection, sphere } from './support.mjs';

/** A bowl of hills, open above: `up` says how much of a mesh of it looks up. */
function hills(count = 40, type = Float32Array) {
  const positions = type.from({ length: 3 * count * count }, (_, i) => {
    const [x, y] = [Math.floor(i / 3) % count, Math.floor(i / (3 * count))].map((k) => (4 * k) / count - 2);
    return [x, y, 0.3 * Math.sin(2 * x) * Math.cos(1.7 * y)][i % 3];
  });
  return { positions };
}

/** Share of a mesh's area that faces the way that `toward` gives for the middle of a triangle. */
function facing({ positions, indices }, toward) {
  let [area, right] = [0, 0];
  for (let t = 0; t < indices.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => positions.slice(3 * indices[t + k], 3 * indices[t + k] + 3));
    const [u, v] = [b, c].map((p) => [0, 1, 2].map((k) => p[k] - a[k]));
    const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const size = Math.hypot(...normal);
    const way = toward([0, 1, 2].map((k) => (a[k] + b[k] + c[k]) / 3));
    area += size;
    if (normal.reduce((sum, x, k) => sum + x * way[k], 0) > 0) right += size;
  }
  return right / area;
}
const up = () => [0, 0, 1];
const outward = (p) => p;

const share = (report, name) => report.orientation.sources.find(({ source }) => source === name)?.share ?? 0;

for (const worker of [false, true]) {
  test(`viewpoints, up and seenFromAbove go through, ${worker ? 'with a worker' : 'in process'}`, async (t) => {
    const engine = await engineFor(t, { threads: 1, worker });
    const cloud = sphere(900);
    const of = Uint32Array.from({ length: 900 }, (_, i) => (cloud.positions[3 * i + 2] > 0.5 ? 1 : cloud.positions[3 * i + 2] < -0.5 ? 0xffffffff : 0));
    const viewpoints = { positions: Float64Array.of(5, 0, 0, 0.1, 0.2, 1e7), of };
    const known = { ...cloud, viewpoints, up: [0, 3, 4], seenFromAbove: true };
    const [light, mesh] = [await engine.reduce(known), await engine.reconstruct(known)];
    for (const result of [light, mesh.cloud]) {
      assert.deepEqual(result.viewpoints.positions, viewpoints.positions);
      assert.deepEqual(result.viewpoints.of, Uint32Array.from(result.nearest, (i) => of[i]));
      assert.equal(result.seenFromAbove, true);
    }
    for (const result of [light, mesh, mesh.cloud]) {
      assert.equal(result.up[0], 0);
      assert.ok(Math.hypot(result.up[1] - 0.6, result.up[2] - 0.8) < 1e-7);
    }
    // A result is a cloud again.
    const again = await engine.reduce(light, { target: { count: 100 } });
    assert.deepEqual(again.viewpoints.of, Uint32Array.from(again.nearest, (i) => light.viewpoints.of[i]));
    const dropped = await engine.reduce({ ...known, viewpoints: { positions: Float64Array.of(5, 0, 0) } }, { outliers: 'drop' });
    assert.deepEqual(dropped.viewpoints, { positions: Float64Array.of(5, 0, 0) });
    const bare = await engine.reduce(cloud);
    for (const name of ['viewpoints', 'up', 'seenFromAbove']) assert.ok(!(name in bare), name);
    assert.equal((await engine.inspect(known)).count, 900);
    assert.ok((await engine.write(light)).length > 0);
  });
}

test('viewpoints are copied, unless they are handed over', async () => {
  const cloud = sphere(500);
  const viewpoints = { positions: Float64Array.of(1, 2, 30), of: new Uint32Array(500) };
  await reduce({ ...cloud, viewpoints });
  assert.deepEqual([viewpoints.positions, viewpoints.of.length], [Float64Array.of(1, 2, 30), 500]);
  const { viewpoints: carried } = await reduce({ ...cloud, viewpoints }, { transfer: true });
  assert.deepEqual([viewpoints.positions.length, viewpoints.of.length], [0, 0]);
  assert.deepEqual(carried.positions, Float64Array.of(1, 2, 30));
});

test('what is wrong with them is told', async () => {
  const cloud = sphere(300);
  const view = (positions, of) => ({ viewpoints: { positions: Float64Array.from(positions), of } });
  const cases = [
    [{ viewpoints: 5 }, 'bad-input', /viewpoints is of type number: expected an object with positions/],
    [{ viewpoints: null }, 'bad-input', /viewpoints is of type null/],
    [{ viewpoints: {} }, 'bad-input', /viewpoints\.positions is of type undefined: expected a Float64Array/],
    [{ viewpoints: { positions: new Float32Array(3) } }, 'bad-input', /viewpoints\.positions is of type Float32Array/],
    [{ viewpoints: { positions: new Float64Array(3), of: [0] } }, 'bad-input', /viewpoints\.of is of type Array: expected a Uint32Array/],
    [{ up: [0, 0] }, 'bad-input', /up is of type Array: expected three finite numbers/],
    [{ up: 'z' }, 'bad-input', /up is of type string/],
    [{ up: [0, NaN, 1] }, 'bad-input', /up/],
    [{ seenFromAbove: 1 }, 'bad-input', /seenFromAbove is of type number: expected true or false/],
    [view([]), 'bad-length', /viewpoints\.positions/],
    [view([1, 2, 3, 4]), 'bad-length', /viewpoints\.positions/, { found: '4' }],
    [view([1, 2, 3, 4, NaN, 6]), 'non-finite', /viewpoints\.positions/, { index: 1 }],
    [view([1, 2, 3], new Uint32Array(299)), 'bad-length', /viewpoints\.of/, { found: '299' }],
    [view([1, 2, 3], new Uint32Array(300).fill(1, 7, 8)), 'bad-option', /viewpoints\.of\[7\] is 1/],
    [{ up: [0, 0, 0] }, 'bad-option', /up/],
  ];
  for (const [wrong, code, message, more = {}] of cases) {
    for (const call of [reduce, reconstruct]) {
      const error = await rejection(call({ ...cloud, ...wrong }));
      assert.ok(error instanceof PointweaveError, String(error));
      assert.equal(error.code, code, error.message);
      assert.match(error.message, message);
      for (const [name, value] of Object.entries(more)) assert.equal(error[name], value, error.message);
    }
    if (code === 'bad-input') for (const call of [inspect, write]) assert.equal((await rejection(call({ ...cloud, ...wrong }))).code, code);
  }
});

test('evidence that is asked for has to be there', async () => {
  const cloud = hills();
  for (const orientation of ['normals', 'viewpoints']) {
    const error = await rejection(reconstruct(cloud, { orientation }));
    assert.deepEqual([error.code, error.expected], ['bad-option', `a cloud with ${orientation}`]);
  }
  for (const wrong of [{ orientation: 'down' }, { orientation: null }, { flip: 1 }, { flip: 'yes' }]) {
    assert.equal((await rejection(reconstruct(cloud, wrong))).code, 'bad-option');
  }
});

test('a viewpoint decides, and flip turns what it decided', async () => {
  for (const type of [Float32Array, Float64Array]) {
    const cloud = hills(40, type);
    for (const [z, side] of [[9, 1], [-9, 0]]) {
      const viewpoints = { positions: Float64Array.of(0.3, 0.2, z) };
      for (const orientation of ['auto', 'viewpoints']) {
        const mesh = await reconstruct({ ...cloud, viewpoints }, { orientation });
        assert.ok(Math.abs(facing(mesh, up) - side) < 0.001, `${orientation}, from ${z}: ${facing(mesh, up)} up`);
        assert.ok(share(mesh.report, 'viewpoints') > 0.99, JSON.stringify(mesh.report.orientation));
        assert.deepEqual(mesh.report.doubts, []);
      }
      const turned = await reconstruct({ ...cloud, viewpoints }, { flip: true });
      assert.ok(Math.abs(facing(turned, up) - (1 - side)) < 0.001);
      const normals = turned.cloud.normals.filter((_, i) => i % 3 === 2);
      assert.ok(normals.every((n) => (side ? n < 0 : n > 0)), 'the cloud turns with it');
    }
  }
});

test('normals of the cloud decide; those that are zero or NaN are none', async () => {
  const cloud = hills();
  const down = Float32Array.from(cloud.positions, (_, i) => (i % 3 === 2 ? -1 : 0));
  const mesh = await reconstruct({ ...cloud, normals: down });
  assert.ok(facing(mesh, up) < 0.001);
  assert.ok(share(mesh.report, 'normals') > 0.99, JSON.stringify(mesh.report.orientation));
  const half = down.map((x, i) => (i % 6 < 3 ? x : NaN));
  assert.ok(facing(await reconstruct({ ...cloud, normals: half }), up) < 0.001, 'the others tell');
  for (const none of [down.fill(0), down.slice().fill(NaN)]) {
    const alone = await reconstruct({ ...cloud, normals: none });
    assert.equal(share(alone.report, 'normals'), 0);
    assert.deepEqual(alone.positions, (await reconstruct(cloud)).positions);
    for (const wants of [{ orient: false }, { orientation: 'normals' }]) {
      assert.equal((await rejection(reconstruct({ ...cloud, normals: none }, wants))).code, 'bad-option');
    }
  }
});

test('up, outward and inward', async () => {
  const cloud = hills();
  assert.ok(facing(await reconstruct({ ...cloud, up: [0, 0, -1] }, { orientation: 'up' }), up) < 0.001);
  assert.ok(facing(await reconstruct(cloud, { orientation: 'up' }), up) > 0.999);
  assert.ok(facing(await reconstruct({ ...cloud, seenFromAbove: true }), up) > 0.999);
  const ball = sphere(1500);
  assert.ok(facing(await reconstruct(ball), outward) > 0.999);
  const room = await reconstruct(ball, { orientation: 'inward' });
  assert.ok(facing(room, outward) < 0.001);
  assert.equal(room.report.boundaryEdges, 0);
  const inside = await reconstruct({ ...ball, viewpoints: { positions: Float64Array.of(0.1, 0, 0.2) } });
  assert.ok(facing(inside, outward) < 0.001);
});

test('the types have every code of a doubt, and no other', () => {
  const text = (path) => readFileSync(new URL(`../../${path}`, import.meta.url), 'utf8');
  const [made] = text('src/report/knowledge.rs').split('#[cfg(test)]');
  const codes = [...made.matchAll(/(?:code: |doubt\(\s*)"([a-z-]+)"/g)].map(([, code]) => code);
  const typed = /type DoubtCode =([^;]*);/.exec(text('pkg/types.reports.d.ts'))[1].match(/(?<=')[a-z-]+/g);
  assert.deepEqual(typed.toSorted(), codes.toSorted());
});

test('the report says what told the side, and doubts only what is doubtful', async () => {
  const { report } = await reconstruct(sphere(1500));
  assert.deepEqual(report.doubts, []);
  assert.equal(report.orientation.guessed, 0);
  assert.ok(Math.abs(report.orientation.sources.reduce((sum, { share }) => sum + share, 0) - 1) < 1e-6);
  assert.equal(sideInWords(report), 'what tells the outer side: its shape, which encloses the inside');
  const two = { orientation: { sources: [{ source: 'guess', share: 0.2 }, { source: 'viewpoints', share: 0.796 }, { source: 'up', share: 0.004 }], guessed: 0.2 } };
  assert.equal(sideInWords(two), 'what tells the outer side: where it was scanned from (80 %), nothing, so this is a guess (20 %)');
  assert.deepEqual((await reduce(sphere(500))).report.doubts, []);
  const duck = await reconstruct(await sample('duck', { count: 3000 }), { reduce: { target: { ratio: 0.2 } } });
  assert.deepEqual(duck.report.doubts, [], 'nor is a scan of few points, whose smallest parts hang on little');
  const core = await load();
  const direct = core.reconstruct({ ...hills(), viewpoints: { positions: Float64Array.of(0, 0, -9) } });
  assert.ok(share(direct.report, 'viewpoints') > 0.99);
});

test('flip turns a mesh, or one piece of it with the points near it', async () => {
  const count = 700;
  const ball = sphere(count).positions;
  const two = new Float32Array(6 * count);
  two.set(ball);
  two.set(ball.map((x, i) => 0.5 * x + (i % 3 === 0 ? 1.7 : 0)), 3 * count);
  const mesh = await reconstruct({ positions: two });
  assert.equal(mesh.report.components, 2);
  const center = (p) => (p[0] < 1.1 ? [0, 0, 0] : [1.7, 0, 0]);
  const away = (p) => p.map((x, k) => x - center(p)[k]);
  assert.ok(facing(mesh, away) > 0.999);
  const before = structuredClone(mesh);

  const other = flip(mesh);
  assert.ok(facing(other, away) < 0.001);
  assert.deepEqual(other.normals, mesh.normals.map((x) => -x));
  assert.deepEqual(other.cloud.normals, mesh.cloud.normals.map((x) => -x));
  assert.deepEqual(flip(other), mesh);

  const [small] = [...mesh.indices.keys()].filter((i) => i % 3 === 0 && mesh.positions[3 * mesh.indices[i]] > 1.2);
  const half = flip(mesh, { triangle: small / 3 });
  assert.ok(facing(half, (p) => away(p).map((x) => (p[0] < 1.1 ? x : -x))) > 0.999);
  for (const { positions, normals } of [half, half.cloud]) {
    for (let i = 0; i < positions.length; i += 3) {
      const p = [...positions.slice(i, i + 3)];
      const out = away(p).reduce((sum, x, k) => sum + x * normals[i + k], 0);
      assert.ok(p[0] < 1.1 ? out > 0 : out < 0, `${p}`);
    }
  }
  assert.deepEqual(mesh, before, 'what was given stays');

  for (const triangle of [-1, 0.5, mesh.indices.length / 3, '0']) assert.throws(() => flip(mesh, { triangle }), { code: 'bad-option' });
  for (const wrong of [undefined, null, {}, mesh.cloud]) assert.throws(() => flip(wrong), { code: 'bad-input' });
});

/** What the command line hands to the package. */
const said = (...args) => parse(['reconstruct', 'a.ply', '-o', 'b.glb', ...args]).cloud;

test('the command line says where a scan was seen from', () => {
  assert.deepEqual(said(), { viewpoints: [], up: undefined, unit: undefined });
  assert.deepEqual(said('--viewpoint', '1,2.5,-3e2', '--viewpoint=-1, 0, 0'), { viewpoints: [[1, 2.5, -300], [-1, 0, 0]], up: undefined, unit: undefined });
  for (const [word, axis] of [['y', [0, 1, 0]], ['-z', [0, 0, -1]], ['1,2,2', [1, 2, 2]]]) assert.deepEqual(said(`--up=${word}`).up, axis);
  assert.deepEqual(parse(['reconstruct', 'a.ply', '-o', 'b.glb', '--orientation', 'inward', '--flip']).own, { orientation: 'inward', flip: true });
  for (const [args, line] of [
    [['--viewpoint', '1,2'], /--viewpoint is '1,2': expected three numbers X,Y,Z/],
    [['--viewpoint', '1,,3'], /--viewpoint is '1,,3'/],
    [['--viewpoint', '1,2,inf'], /--viewpoint/],
    [['--viewpoint', '-1,2,3'], /--viewpoint needs a value; one that begins with - is given as --viewpoint=-…/],
    [['--up', 'w'], /--up is 'w': expected x, y, z, -x, -y, -z or a direction X,Y,Z/],
    [['--up', '0,0,0'], /--up is '0,0,0'/],
    [['--orientation', 'down'], /--orientation is 'down': expected one of 'auto'/],
  ]) assert.throws(() => said(...args), (error) => error instanceof UsageError && line.test(error.message), String(args));

  const cloud = { positions: Float32Array.of(0, 0, 0, 9, 0, 0, 4, 0, 0) };
  assert.deepEqual(withSaid(cloud, { viewpoints: [] }), cloud);
  assert.deepEqual(withSaid(cloud, { viewpoints: [[1, 0, 1]], up: [0, 1, 0] }), { ...cloud, viewpoints: { positions: Float64Array.of(1, 0, 1), of: undefined }, up: [0, 1, 0] });
  const two = withSaid({ ...cloud, up: [1, 0, 0], viewpoints: { positions: new Float64Array(3) } }, { viewpoints: [[10, 0, 0], [1, 0, 0]] });
  assert.deepEqual([two.viewpoints.of, two.up], [Uint32Array.of(1, 0, 1), [1, 0, 0]]);
});

test('the command line says what tells the side, and what is doubtful', async (t) => {
  const path = mkdtempSync(join(tmpdir(), 'pointweave-side-'));
  t.after(() => rmSync(path, { recursive: true }));
  writeFileSync(join(path, 'hills.xyz'), await write(hills(), { format: 'xyz' }));
  const cli = fileURLToPath(new URL('../../pkg/cli.js', import.meta.url));
  const run = (...args) => spawnSync(process.execPath, [cli, 'reconstruct', 'hills.xyz', ...args], { cwd: path, encoding: 'utf8' });

  const seen = run('-o', 'seen.ply', '--viewpoint', '0,0,9');
  assert.equal(seen.status, 0, seen.stderr);
  assert.match(seen.stderr, /^[^\n]*; what tells the outer side: where it was scanned from\n$/);
  const flipped = JSON.parse(run('--json', '--viewpoint', '0,0,-9', '--flip').stdout);
  assert.ok(share(flipped, 'viewpoints') > 0.99);
  assert.deepEqual(flipped.doubts, []);

  // Nothing is known of a sheet that stands.
  writeFileSync(join(path, 'hills.xyz'), await write({ positions: hills().positions.map((_, i, p) => p[3 * Math.floor(i / 3) + ((i + 1) % 3)]) }, { format: 'xyz' }));
  const guessed = run('-o', 'guessed.ply');
  assert.equal(guessed.status, 0, guessed.stderr);
  const { doubts } = JSON.parse(run('--json').stdout);
  assert.ok(doubts.length > 0 && doubts.every(({ code, message }) => /^[a-z-]+$/.test(code) && /^[A-Z].*\.$/.test(message)));
  assert.equal(guessed.stderr.split('\n').slice(1).join('\n'), doubts.map(({ message }) => `pointweave: hills.xyz: doubtful: ${message}\n`).join(''));
});

/** A direction from a point to a place. */
const to = (place) => (p) => place.map((x, k) => x - p[k]);

for (const [name, toward, source] of [
  ['geo_dem_up.ply', up, 'guess'], ['geo_dem_normals_up.ply', up, 'normals'], ['geo_depth_frame.ply', to([0, 0, 0]), 'camera'],
  ['geo_room_pose.e57', to([2.5, 2, 1.4]), 'viewpoints'], ['geo_room_normals_in.ply', to([2.5, 2, 1.3]), 'normals'],
]) {
  test(`the right side of ${name}`, async () => {
    const file = await sharedFile(`../field/cases/${name}`);
    if (!file) return;
    const { positions, indices, report } = await reconstruct(await read(file, { name }));
    assert.ok(facing({ positions, indices }, toward) > 0.98, `${facing({ positions, indices }, toward)}`);
    if (source !== 'camera') assert.equal(report.components, 1);
    assert.deepEqual(report.doubts.map(({ code }) => code), source === 'guess' ? ['side-guessed'] : []);
    assert.ok(share(report, source) > 0.9, JSON.stringify(report.orientation));
  });
}

test('the organised frame of a depth camera is seen from the origin', async () => {
  const file = await sharedFile('scans/pcl/milk_cartoon_all_small_clorox.pcd');
  if (!file) return;
  const { viewpoints } = await read(file);
  assert.deepEqual(viewpoints, { positions: Float64Array.of(0, 0, 0) });
});

test('airborne scans are seen from above', async () => {
  const file = await sharedFile('lidar/autzen_trim.laz');
  if (!file) return;
  const { up: axis, seenFromAbove, viewpoints } = await read(file);
  assert.deepEqual([axis, seenFromAbove, viewpoints], [[0, 0, 1], true, undefined]);
});
