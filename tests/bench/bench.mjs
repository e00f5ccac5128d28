// `cargo xtask bench [tables] [peer] [threads]`: what Pointweave costs, in this process.
//
//   tables   the paper's Tables 1 and 2 on scans of the same size, beside the paper's seconds
//   peer     the reduction beside meshoptimizer's simplifyPoints on the same cloud
//   threads  one thread beside two, the same bytes
//
// Times are medians of several runs; machines differ, so compare ratios.

import { existsSync, readFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { MeshoptSimplifier } from 'meshoptimizer';
import { createEngine } from 'pointweave';

const HERE = dirname(fileURLToPath(import.meta.url));
const SHARED = process.env.POINTWEAVE_SHARED ?? resolve(HERE, '../../../shared');

const RUNS = 3;

/** Table 1 and Table 2 of the paper: points, seconds on an Intel Core 2 at 2.93 GHz. */
const PAPER = {
  duck: { original: 35_647, reduced: 11_216, reduce: 2.32, normals: [6.45, 2.26], surface: [5.29, 1.17] },
  pig: { original: 171_875, reduced: 85_674, reduce: 4.84, normals: [13.76, 6.31], surface: [10.14, 5.73] },
};

const benches = { tables, peer, threads };
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

/** The last result and the median time of some runs after a first one. */
async function repeat(job) {
  let result = await job();
  const times = [];
  for (let run = 0; run < RUNS; run++) {
    const start = performance.now();
    result = await job();
    times.push(performance.now() - start);
  }
  times.sort((a, b) => a - b);
  return { result, ms: times[RUNS >> 1] };
}

/** Positions of a scan of the pig, made by an engine that is gone afterwards. */
async function toyPig(count) {
  const engine = await createEngine({ threads: 1 });
  const { positions } = await engine.sample('pig', { count, seed: 0 });
  await engine.dispose();
  return positions;
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
