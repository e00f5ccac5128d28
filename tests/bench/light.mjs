// Light meshes for bench.mjs: fewer triangles beside those of others, and pictures beside colours of vertices.

import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { MeshoptSimplifier } from 'meshoptimizer';
import { createEngine } from 'pointweave';

const HERE = dirname(fileURLToPath(import.meta.url));
const DATA = join(process.env.POINTWEAVE_SHARED ?? resolve(HERE, '../../../shared'), 'data');
const PYTHON = process.env.SIMPLIFY_PYTHON;

/** Models with faces, as scans of their vertices, or of their faces where those are few; and the budgets. */
const MODELS = [['meshes/bun_zipper.ply', 'vertices'], ['meshes/fandisk.obj', 'sample'], ['meshes/armadillo_libigl.obj', 'vertices']];
const BUDGETS = [5_000, 20_000];
/** Scans with colours. */
const COLORED = ['scans/redwood_fragment_002.ply', 'scans/pcl/milk_color.pcd'];

/** Rows of the table: the same full mesh by everyone to the same number of triangles. */
export async function simplifyRows() {
  await MeshoptSimplifier.ready;
  const engine = await createEngine({ threads: 1 });
  const rows = [];
  for (const [file, faces] of MODELS.filter(([file]) => existsSync(join(DATA, file)))) {
    const scan = await engine.read(readFileSync(join(DATA, file)), { name: file, faces });
    const full = await engine.reconstruct(scan, { reduce: false });
    for (const triangles of BUDGETS) {
      const start = performance.now();
      const ours = await engine.simplify(full, { triangles });
      const ms = performance.now() - start;
      const [indices] = MeshoptSimplifier.simplify(full.indices, Float32Array.from(full.positions), 3, 3 * triangles, 1);
      const measured = await peers('simplify', [String(triangles)], (save) => {
        save('full', full);
        save('ours', ours);
        save('meshopt', { positions: full.positions, indices });
      });
      for (const [name, { triangles: left, mean, hausdorff }] of Object.entries(measured)) {
        rows.push([basename(file), full.indices.length / 3, name, left, (1e5 * mean).toFixed(2), (1e5 * hausdorff).toFixed(1), name === 'ours' ? ms.toFixed(0) : '–']);
      }
    }
  }
  await engine.dispose();
  return [['model', 'triangles', 'by', 'left', 'mean, 1e-5', 'largest, 1e-5', 'ms'], ...rows];
}

/** Rows of the table: how near the scan's colours and normals a model is, by pictures and by vertices. */
export async function textureRows() {
  const engine = await createEngine({ threads: 1 });
  const rows = [];
  const scans = [];
  for (const model of ['duck', 'pig', 'part']) scans.push([model, await engine.sample(model, model === 'pig' ? {} : { count: 100_000 })]);
  for (const file of COLORED.filter((file) => existsSync(join(DATA, file)))) {
    scans.push([basename(file), await engine.read(readFileSync(join(DATA, file)), { name: file })]);
  }
  for (const [name, scan] of scans) {
    // The scan's own normals, filtered: those of a fit of all points.
    const all = await engine.reconstruct(scan, { reduce: false });
    const normals = new Float32Array(scan.positions.length);
    all.cloud.nearest.forEach((i, k) => normals.set(all.cloud.normals.subarray(3 * k, 3 * k + 3), 3 * i));
    const start = performance.now();
    const textured = await engine.reconstruct(scan, { reduce: false, triangles: 5_000, texture: { size: 1024 } });
    const ms = performance.now() - start - all.report.totalMs;
    const measured = await peers('texture', [], (save, raw) => {
      raw('scan.xyz', Float32Array.from(scan.positions));
      raw('scan.rgb', scan.colors);
      raw('scan.nor', normals);
      save('pictures', textured);
    }, async (save) => {
      for (const triangles of [5_000, 50_000, 100_000]) {
        save(`vertices${triangles}`, await engine.simplify(all, { triangles }));
      }
    });
    for (const [by, { triangles, rms, angle }] of Object.entries(measured)) {
      rows.push([name, scan.positions.length / 3, by, triangles, rms.toFixed(2), angle.toFixed(2), by === 'pictures' ? ms.toFixed(0) : '–']);
    }
  }
  await engine.dispose();
  return [['scan', 'points', 'by', 'triangles', 'colour, rms of 255', 'normals, °', 'ms'], ...rows];
}

/** What Python measures of meshes that are saved for it. */
async function peers(what, more, ...savers) {
  const folder = mkdtempSync(join(tmpdir(), 'pointweave-'));
  const raw = (name, values) => writeFileSync(join(folder, name), new Uint8Array(values.buffer, values.byteOffset, values.byteLength));
  const save = (name, { positions, indices, normals, colors, uvs, tangents, textures }) => {
    raw(`${name}.xyz`, Float32Array.from(positions));
    raw(`${name}.tri`, indices);
    for (const [end, values] of Object.entries({ nor: normals, rgb: colors, uv: uvs, tan: tangents })) if (values) raw(`${name}.${end}`, values);
    for (const [map, { data }] of Object.entries(textures ?? {})) raw(`${name}.${map}.png`, data);
  };
  try {
    for (const saver of savers) await saver(save, raw);
    if (!PYTHON) throw new Error('SIMPLIFY_PYTHON names no Python with what tests/bench/simplify.txt lists');
    const { stdout, stderr, status } = spawnSync(PYTHON, [join(HERE, 'light_peers.py'), what, folder, ...more], { encoding: 'utf8', maxBuffer: 1 << 26 });
    if (status !== 0) throw new Error(stderr);
    return JSON.parse(stdout.trim().split('\n').at(-1));
  } finally {
    rmSync(folder, { recursive: true });
  }
}
