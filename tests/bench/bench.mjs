// `cargo xtask bench [tables] [growth] [fcm] [peer] [surface] [threads] [simplify] [texture] [tiles]`: what Pointweave costs, in this process.
//
//   tables   the paper's Tables 1 and 2 on scans of the same size, beside the paper's seconds
//   growth   the reduction of ten thousand to ten million points, a mesh of a hundred thousand to five million: time and
//            memory a point
//   fcm      our clustering beside scikit-fuzzy's
//   peer     the reduction beside meshoptimizer's simplifyPoints on the same cloud
//   surface  from points to a mesh beside Open3D: normals, their orientation, Poisson
//   threads  one thread beside two, the same bytes
//   simplify fewer triangles beside meshoptimizer's, Open3D's and PyMeshLab's: distances from one full mesh
//   tiles    `pointweave tiles` beside py3dtiles and a voxel grid on one survey: size, error and time
//   texture  5,000 triangles with pictures beside more of them with colours of vertices: how near the scan's colours and normals
//
// Times are medians of several runs; machines differ, so compare ratios.

import { spawnSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { MeshoptSimplifier } from 'meshoptimizer';
import { createEngine } from 'pointweave';
import { simplifyRows, textureRows } from './light.mjs';

const HERE = dirname(fileURLToPath(import.meta.url));
const SHARED = process.env.POINTWEAVE_SHARED ?? resolve(HERE, '../../../shared');

const RUNS = 3;

/** `tiles`: points of the survey. */
const TILES_POINTS = 1_000_000;

/** Table 1 and Table 2 of the paper: points, seconds on an Intel Core 2 at 2.93 GHz. */
const PAPER = {
  duck: { original: 35_647, reduced: 11_216, reduce: 2.32, normals: [6.45, 2.26], surface: [5.29, 1.17] },
  pig: { original: 171_875, reduced: 85_674, reduce: 4.84, normals: [13.76, 6.31], surface: [10.14, 5.73] },
};

/** `growth`: points, and how often each size runs. */
const SIZES = { reduce: [[1e4, 9], [1e5, 5], [1e6, 1], [1e7, 1]], reconstruct: [[1e5, 3], [1e6, 1], [5e6, 1]] };
/** The noise of a sample, as a fraction of its diagonal. */
const NOISE = 5e-4;

/** `fcm`: the same for both sides. */
const FCM = { ratio: 1 / 8, cellPoints: 256, fuzzifier: 2, epsilon: 1e-3, maxIterations: 100 };
/** An epsilon that no sweep meets: each side does all of them. */
const NEVER = Number.MIN_VALUE;
/** Cells on which scikit-fuzzy is timed. */
const TIMED_CELLS = 40;

const benches = { tables, growth, fcm, peer, surface, threads, simplify, texture, tiles };
const asked = process.argv.slice(2);
const unknown = asked.find((name) => !(name in benches));
if (unknown !== undefined) {
  console.error(`bench: there is no ${unknown}; there are ${Object.keys(benches).join(', ')}`);
  process.exit(2);
}
for (const name of asked.length ? asked : Object.keys(benches)) {
  await benches[name]();
}

async function tables() {
  const engine = await createEngine({ threads: 1 });
  const rows = [];
  for (const [model, paper] of Object.entries(PAPER)) {
    const scan = await engine.sample(model, { count: paper.original, seed: 0 });
    const target = { count: paper.reduced };
    const reduced = await repeat(() => engine.reduce(scan, { target }));
    const meshes = [];
    for (const reduce of [false, { target }]) {
      meshes.push(await repeat(() => engine.reconstruct(scan, { reduce })));
    }
    rows.push({ model, paper, reduced, meshes });
  }
  await engine.dispose();

  print('Table 1: reduction (seconds; the paper in brackets)', [
    ['model', 'original', 'reduced', 'time'],
    ...rows.map(({ model, paper, reduced }) => [
      model, paper.original, reduced.result.report.outputPoints, beside(reduced.ms / 1000, paper.reduce),
    ]),
  ]);
  // The paper's "normal computing" is the fit of the sub-surfaces with their normals, its "global surface adjusting" their
  // alignment and blending.
  const parts = [
    ['normal computing', ['octree', 'features', 'cells', 'fit'], 'normals'],
    ['global surface adjusting', ['orient', 'extract'], 'surface'],
  ];
  const cells = ({ paper, meshes }) => meshes.flatMap(({ result }, i) =>
    parts.map(([, stages, key]) => beside(sum(stages, result.report.ms) / 1000, paper[key][i])));
  print('Table 2: surface (seconds; the paper in brackets)', [
    ['model', ...['original: ', 'reduced: '].flatMap((data) => parts.map(([name]) => data + name))],
    ...rows.map((row) => [row.model, ...cells(row)]),
  ]);
  const mesh = (model, { result: { report }, ms }, data) => [
    model, data, report.outputPoints, report.triangles, report.components, report.boundaryEdges,
    (report.distance.mean * 1e4).toFixed(2), (ms / 1000).toFixed(2),
  ];
  print('The meshes (distance of the scan to the mesh in 1e-4 of the diagonal; whole job in seconds)', [
    ['model', 'data', 'points', 'triangles', 'components', 'open edges', 'distance', 'total'],
    ...rows.flatMap(({ model, meshes: [all, less] }) => [mesh(model, all, 'original'), mesh(model, less, 'reduced')]),
  ]);
}

async function growth() {
  // The noise of the pig stays while its points come closer, and points that are noisier for their spacing ask more
  // neighbours. The steady pig and the torus are alike at every size.
  const steadyPig = (count) => toyPig(count, NOISE * Math.sqrt(SIZES.reduce[1][0] / count));
  const jobs = [
    ['reduce', 'pig', toyPig], ['reduce', 'torus', bumpyTorus],
    ['reconstruct', 'pig', toyPig], ['reconstruct', 'steady pig', steadyPig],
  ];
  const rows = [];
  try {
    for (const [call, name, make] of jobs) {
      const smallest = await make(SIZES[call][0][0]);
      let unit;
      for (const [points, runs] of SIZES[call]) {
        const positions = await make(points);
        const engine = await createEngine({ threads: 1 }); // its own: wasm memory never shrinks
        const run = (positions) => engine[call]({ positions });
        const { result, ms } = await repeat(() => run(positions), { runs, first: () => run(smallest) });
        await engine.dispose();
        const perPoint = (ms * 1000) / points;
        const perLog = perPoint / Math.log2(points);
        unit ??= perLog;
        rows.push([
          call, name, points, runs, ms.toFixed(0), perPoint.toFixed(2), perLog.toFixed(3), (perLog / unit).toFixed(2),
          (result.report.peakMemoryBytes / points).toFixed(0),
        ]);
      }
    }
  } finally {
    print('Growth, defaults (single build, one thread; 1 or less beside the first: within n log n)', [
      ['call', 'cloud', 'points', 'runs', 'ms', 'µs a point', 'µs / (point log2 n)', 'beside the first', 'bytes a point'],
      ...rows,
    ]);
  }
}

async function fcm() {
  const engine = await createEngine({ threads: 1 });
  const pig = await toyPig(PAPER.pig.original);
  const cells = cellsApart(pig, FCM.cellPoints);
  const count = cells.length / 3 / FCM.cellPoints;
  const { ratio, ...own } = FCM;
  const settled = skfuzzy(cells, FCM.epsilon);
  const all = skfuzzy(cells, 0);
  const rows = [];
  for (const [name, positions, options, theirs] of [
    ['adaptive, its own settings', pig, {}, settled],
    ['adaptive', pig, own, settled],
    ['paper', pig, { ...own, method: 'paper' }, settled],
    ["paper, scikit-fuzzy's cells", cells, { ...own, method: 'paper' }, settled],
    ["paper, scikit-fuzzy's cells, all sweeps", cells, { ...own, method: 'paper', epsilon: NEVER }, all],
  ]) {
    const reduce = () => engine.reduce({ positions }, { target: { ratio }, ...options });
    const { result: { report }, ms } = await repeat(reduce);
    const [clustering, job] = [report.ms.cluster / 1000, ms / 1000];
    const seconds = theirs && (theirs.seconds / theirs.cells) * count;
    rows.push([
      name, report.cells, (report.inputPoints / report.cells).toFixed(0), clustering.toFixed(2), job.toFixed(2),
      ...(theirs
        ? [seconds.toFixed(2), (seconds / clustering).toFixed(1), (seconds / job).toFixed(1)]
        : ['–', '–', '–']),
    ]);
  }
  await engine.dispose();
  print(
    `Fuzzy c-means of the toy pig, ${pig.length / 3} points to 1/8 (single build, seconds on one thread; `
      + `m = ${FCM.fuzzifier}, ε = ${FCM.epsilon}, at most ${FCM.maxIterations} sweeps)`,
    [['method', 'cells', 'points a cell', 'clustering', 'whole job', 'scikit-fuzzy', '/ clustering', '/ job'], ...rows],
  );
  console.log(settled
    ? `  scikit-fuzzy ${settled.version}, in every row: ${settled.cells} cells of ${FCM.cellPoints} points and `
      + `${FCM.cellPoints * ratio} clusters, scaled up to ${count}.\n`
      + `  It stops (after ${settled.sweeps.toFixed(0)} sweeps) when the norm of all changes of U is under ε, `
      + '`paper` when each is; ε of `adaptive` is a movement of centres.'
    : '  scikit-fuzzy was not measured: `cargo xtask bench fcm` says why.');
}

async function peer() {
  await MeshoptSimplifier.ready;
  MeshoptSimplifier.useExperimentalFeatures = true;
  const engine = await createEngine({ threads: 1 });
  const armadillo = join(SHARED, 'bench/clouds/armadillo-uniform-0.001.f32');
  const shared = existsSync(armadillo);
  const positions = shared
    ? new Float32Array(new Uint8Array(readFileSync(armadillo)).buffer)
    : await toyPig(PAPER.pig.original);
  const points = positions.length / 3;
  const rows = [];
  for (const ratio of [2, 3, 10]) {
    const count = Math.floor(points / ratio);
    const ours = await repeat(() => engine.reduce({ positions }, { target: { count } }));
    const theirs = await repeat(async () => MeshoptSimplifier.simplifyPoints(positions, 3, count));
    rows.push([
      `1/${ratio}`, ours.result.positions.length / 3, theirs.result.length, ours.ms.toFixed(0), theirs.ms.toFixed(0),
      (ours.ms / theirs.ms).toFixed(1), (points / ours.ms / 1000).toFixed(2),
    ]);
  }
  await engine.dispose();
  const name = shared ? 'the Armadillo' : 'the toy pig';
  print(`Reduction of ${name}, ${points} points, beside meshoptimizer's simplifyPoints (single build, ms, one thread)`, [
    ['keep', 'points', "peer's", 'ms', "peer's", 'ratio', 'M points/s'], ...rows,
  ]);
}

async function surface() {
  const engine = await createEngine({ threads: 1 });
  const jobs = [];
  for (const [name, count, depth] of [['pig', 36_000, 8], ['duck', 36_000, 8], ['pig', PAPER.pig.original, 9]]) {
    jobs.push({ name, depth, scan: await engine.sample(name, { count, seed: 0 }) });
  }
  const rows = [];
  for (const { name, depth, scan } of jobs) {
    const positions = Float32Array.from(scan.positions);
    const ours = await repeat(() => engine.reconstruct({ positions }));
    const theirs = open3d(positions, depth);
    rows.push([
      name, positions.length / 3, ours.result.report.triangles, ours.ms.toFixed(0),
      ...(theirs
        ? [theirs.triangles, (1000 * theirs.seconds).toFixed(0), (ours.ms / 1000 / theirs.seconds).toFixed(3)]
        : ['–', '–', '–']),
    ]);
  }
  await engine.dispose();
  print(
    "Points to a mesh, defaults, beside Open3D's normals (k = 30), orientation (k = 15) and Poisson (single build, ms, one thread)",
    [['scan', 'points', 'triangles', 'ms', "peer's", 'ms', 'ratio'], ...rows],
  );
}

async function threads() {
  const engines = [await createEngine({ threads: 1 }), await createEngine({ threads: 2 })];
  const scan = await engines[0].sample('pig');
  const rows = [];
  for (const call of ['reduce', 'reconstruct']) {
    const runs = [];
    for (const engine of engines) {
      runs.push(await repeat(() => engine[call](scan)));
    }
    const same = Buffer.compare(...runs.map(({ result }) => Buffer.from(result.positions.buffer))) === 0;
    rows.push([call, ...runs.map(({ ms }) => ms.toFixed(0)), (runs[0].ms / runs[1].ms).toFixed(2), same ? 'yes' : 'NO']);
  }
  for (const engine of engines) {
    await engine.dispose();
  }
  print('Two threads (ms)', [['call', '1 thread', '2 threads', 'times as fast', 'same bytes'], ...rows]);
}

async function simplify() {
  print('Fewer triangles: distances between the meshes, both ways, as fractions of the diagonal (single build, one thread)', await simplifyRows());
}

async function texture() {
  print('Colours and normals at the scan\'s points (pictures of 1024 texels; ms are those after the reconstruction)', await textureRows());
}

function tiles() {
  const python = process.env.TILES_PYTHON;
  if (!python) return;
  const { stdout, stderr, status } = spawnSync(python, [join(HERE, 'tiles_peers.py'), resolve(HERE, '../../pkg/cli.js'), `${TILES_POINTS}`], { encoding: 'utf8' });
  if (status !== 0) throw new Error(stderr);
  const rows = JSON.parse(stdout).map(({ by, points, bytes, error, seconds }) => [by, points, (bytes / 1e6).toFixed(1), (1000 * error).toFixed(2), seconds.toFixed(1)]);
  print('A survey with 10 mm of noise as a tileset: error of the surface at the finest level (two jobs each, numpy for the grid)', [['', 'points', 'MB', 'rms error, mm', 's'], ...rows]);
}

/** The last result and the median time of some runs after a first one. */
async function repeat(job, { runs = RUNS, first = job } = {}) {
  await first();
  let result;
  const times = [];
  for (let run = 0; run < runs; run++) {
    const start = performance.now();
    result = await job();
    times.push(performance.now() - start);
  }
  times.sort((a, b) => a - b);
  return { result, ms: times[runs >> 1] };
}

/** Positions of a scan of the pig, made by an engine that is gone afterwards. */
async function toyPig(count, noise = NOISE) {
  const engine = await createEngine({ threads: 1 });
  const { positions } = await engine.sample('pig', { count, seed: 0, noise });
  await engine.dispose();
  return positions;
}

/** Random points of a torus with bumps, noise a fifth of their spacing. */
function bumpyTorus(count) {
  const random = mulberry32(1);
  const [ring, tube, turn] = [1, 0.3, 2 * Math.PI];
  const noise = 0.2 * Math.sqrt((turn * turn * ring * tube) / count);
  const positions = new Float32Array(3 * count);
  for (let i = 0; i < positions.length; i += 3) {
    const [u, v] = [turn * random(), turn * random()];
    const across = Math.sqrt(-2 * Math.log(1 - random())) * Math.cos(turn * random()); // Box and Muller's normal deviate
    const radius = tube * (1 + 0.1 * Math.sin(7 * u) * Math.sin(5 * v)) + noise * across;
    const out = ring + radius * Math.cos(v);
    positions.set([out * Math.cos(u), out * Math.sin(u), radius * Math.sin(v)], i);
  }
  return positions;
}

/** Tommy Ettinger's generator: numbers in [0, 1). */
function mulberry32(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t ^= t + Math.imul(t ^ (t >>> 7), 61 | t);
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

/**
 * Cells of `size` consecutive points in Morton order, drawn apart along x so that each is a sub-domain of the octree by
 * itself. There are a power of two of slots, the first and the last are taken, and a cell fills a quarter of its own:
 * every node of that level then holds one. Odd slots lie aside, for the octree's middle planes to pass between. Cells are
 * moved, scaled and turned, their longest side along x; clustering minds none of it.
 */
function cellsApart(positions, size) {
  const order = mortonOrder(positions);
  const count = Math.floor(order.length / size);
  const slots = 2 ** Math.ceil(Math.log2(count));
  const apart = new Float32Array(3 * count * size);
  for (let cell = 0; cell < count; cell++) {
    const slot = Math.floor((cell * (slots - 1)) / (count - 1));
    const members = order.subarray(cell * size, (cell + 1) * size);
    const { low, sides } = box(positions, members);
    const longest = Math.max(...sides);
    const turn = sides.indexOf(longest);
    members.forEach((k, i) => {
      for (let axis = 0; axis < 3; axis++) {
        const from = (axis + turn) % 3;
        const inside = (positions[3 * k + from] - low[from]) / longest;
        apart[3 * (cell * size + i) + axis] = (axis === 0 ? slot : slot % 2) + inside / 4;
      }
    });
  }
  return apart;
}

/** Indices of points along a Morton curve of 10 bits an axis. */
function mortonOrder(positions) {
  const indices = Uint32Array.from({ length: positions.length / 3 }, (_, k) => k);
  const { low, sides } = box(positions, indices);
  const scale = 1023 / Math.max(...sides);
  const keys = Array.from(indices, (k) => {
    const cell = low.map((x, axis) => (positions[3 * k + axis] - x) * scale);
    let key = 0;
    for (let bit = 9; bit >= 0; bit--) {
      for (const c of cell) {
        key = 2 * key + ((c >> bit) & 1);
      }
    }
    return key;
  });
  return indices.sort((a, b) => keys[a] - keys[b]);
}

/** Lower corner and sides of the bounding box of some points. */
function box(positions, indices) {
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (const k of indices) {
    for (let axis = 0; axis < 3; axis++) {
      const x = positions[3 * k + axis];
      low[axis] = Math.min(low[axis], x);
      high[axis] = Math.max(high[axis], x);
    }
  }
  return { low, sides: low.map((x, axis) => high[axis] - x) };
}

/** What fcm_skfuzzy.py measures on some cells, with one thread; `undefined` where xtask found no Python for it. */
function skfuzzy(cells, error) {
  const python = process.env.SKFUZZY_PYTHON;
  if (!python) {
    return undefined;
  }
  const { cellPoints, ratio, fuzzifier, maxIterations } = FCM;
  const numbers = [cellPoints, cellPoints * ratio, fuzzifier, error, maxIterations, TIMED_CELLS];
  return measured(python, 'fcm_skfuzzy.py', numbers, cells);
}

/** What surface_open3d.py measures on a cloud, with one thread; `undefined` where xtask found no Python for it. */
function open3d(positions, depth) {
  const python = process.env.OPEN3D_PYTHON;
  return python ? measured(python, 'surface_open3d.py', [depth, RUNS], positions) : undefined;
}

/** What a script prints as JSON when it gets some numbers, and floats on its standard input. */
function measured(python, script, numbers, floats) {
  const { stdout, status, error } = spawnSync(python, [join(HERE, script), ...numbers.map(String)], {
    input: new Uint8Array(floats.buffer, floats.byteOffset, floats.byteLength),
    stdio: ['pipe', 'pipe', 'inherit'],
    env: { ...process.env, OMP_NUM_THREADS: '1', OPENBLAS_NUM_THREADS: '1' },
  });
  if (status !== 0) {
    throw error ?? new Error(`${script} failed (${status}); its error is above`);
  }
  return JSON.parse(stdout.toString().trim().split('\n').at(-1));
}

/** Our seconds, and the paper's. */
function beside(ours, paper) {
  return `${ours.toFixed(2)} (${paper.toFixed(2)})`;
}

function sum(stages, ms) {
  return stages.reduce((total, stage) => total + (ms[stage] ?? 0), 0);
}

/** A table with its columns lined up. */
function print(title, rows) {
  const widths = rows[0].map((_, column) => Math.max(...rows.map((row) => String(row[column]).length)));
  console.log(`\n${title}`);
  for (const row of rows) {
    console.log('  ' + row.map((cell, column) => String(cell).padStart(widths[column])).join('  '));
  }
}
