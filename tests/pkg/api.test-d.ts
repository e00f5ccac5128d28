// Never run: `tsc` checks that the package's types say what its documentation does, and that the modules agree.

import {
  DEFAULTS, PointweaveError, createEngine, flip, inspect, prepare, read, reconstruct, reduce, sample, sideInWords, simplify, texture, write,
  type CloudInfo, type Engine, type FileCloud, type Format, type OutputFormat, type PointCloud, type ReducedCloud, type Stage,
  type Prepared, type Step, type SurfaceMesh,
} from 'pointweave';
import { compress } from 'pointweave/meshopt';
import type * as browser from '../../pkg/index.js';
import type * as node from '../../pkg/index.node.js';
import type * as directBrowser from '../../pkg/direct.js';
import type * as directNode from '../../pkg/direct.node.js';
import type { Engine as Made } from '../../pkg/engine/engine.js';
import { load, type Core } from 'pointweave/core';

type Declared = typeof import('pointweave');
type Same<A, B> = [keyof A, keyof B] extends [keyof B, keyof A] ? true : never;

type Direct = typeof import('pointweave/core');
export const direct: [Same<typeof directBrowser, Direct>, Same<typeof directNode, Direct>] = [true, true];
export function conformDirect(web: typeof directBrowser, server: typeof directNode): [Pick<Direct, 'load' | 'DEFAULTS'>, Pick<Direct, 'load' | 'DEFAULTS'>] {
  return [web, server];
}

/** Both entries export exactly what is declared, with the declared types. */
export const exported: [Same<typeof browser, Declared>, Same<typeof node, Declared>] = [true, true];
type Functions = Omit<Declared, 'PointweaveError'>;
export function conform(web: typeof browser, server: typeof node): [Functions, Functions] {
  return [web, server];
}

type Equal<A, B> = (<T>() => T extends A ? 1 : 2) extends <T>() => T extends B ? 1 : 2 ? true : false;
type Method = Exclude<keyof Engine, 'build' | 'threads' | 'reason'>;
/** The module behind an engine declares the same: `any` in it would agree with everything. */
export const behind: { [name in Method]: Equal<Parameters<Made[name]>, Parameters<Engine[name]>> } & { [name in Method]: Equal<ReturnType<Made[name]>, ReturnType<Engine[name]>> } =
  { prepare: true, simplify: true, texture: true, poster: true, reduce: true, reconstruct: true, inspect: true, read: true, write: true, sample: true, dispose: true };

export async function use(positions: Float32Array, precise: Float64Array, signal: AbortSignal, file: File) {
  const reduced: ReducedCloud<Float32Array> = await reduce({ positions }, { target: { ratio: 0.3 }, signal });
  const exact: ReducedCloud<Float64Array> = await reduce({ positions: precise }, { target: { count: 10 }, method: 'paper' });
  const labelled = await reduce(exact, { attributes: { label: 'majority', colors: 'nearest' }, assignment: true, outliers: 'drop' });
  const members: Uint32Array | undefined = labelled.assignment;
  const mesh: SurfaceMesh<Float32Array> = await reconstruct(reduced, { reduce: false, smoothing: 'auto', resolution: 0.01 });
  const viewpoints = { positions: Float64Array.of(0, 0, 2), of: new Uint32Array(positions.length / 3) };
  const seen: SurfaceMesh<Float32Array> = await reconstruct({ positions, viewpoints, up: [0, 0, 1], seenFromAbove: false }, { orientation: 'viewpoints', flip: true });
  const light: SurfaceMesh<Float32Array> = await simplify(await reconstruct({ positions }, { triangles: 1000 }), { triangles: 100 });
  const painted: SurfaceMesh<Float32Array> = await texture(light, { positions }, { triangles: 100, size: 256, maps: ['color'] });
  const bare = await simplify({ positions, indices: light.indices }, { error: 0.01 });
  console.log(bare.positions, bare.report.triangles, light.report.simplified?.error.max, painted.textures?.color?.data);
  // @ts-expect-error no triangles
  await simplify({ positions }, { triangles: 100 });
  const other: SurfaceMesh<Float32Array> = flip(seen, { triangle: 0 });
  const places: Float64Array | undefined = other.cloud.viewpoints?.positions;
  console.log(sideInWords(seen.report), seen.report.orientation.sources[0].share, seen.report.doubts[0]?.message, places);
  // @ts-expect-error no such evidence
  await reconstruct({ positions }, { orientation: 'down' });
  // @ts-expect-error viewpoints are precise
  await reconstruct({ positions, viewpoints: { positions } });
  const recipe: Step[] = [{ step: 'plane', drop: [0] }, { step: 'pieces', keep: { minShare: 0.1 } }, { step: 'sphere', center: [0, 0, 0], radius: 1, keep: false }];
  const object: Prepared<Float64Array> = await prepare([exact, exact], recipe, { signal });
  await reconstruct({ positions }, { prepare: recipe, reduce: { target: { count: object.kept.length } } });
  // @ts-expect-error a recipe is of the whole call
  await reconstruct({ positions }, { reduce: { prepare: recipe } });
  // @ts-expect-error no such step
  await prepare(exact, [{ step: 'roof' }]);
  const info: CloudInfo = await inspect(exact);
  const cloud: PointCloud = await read(file, { name: 'a.ply' });
  const scan: FileCloud = await read(file, { format: 'las', signal, onProgress: ({ stage }) => console.log(stage) });
  const format: Format = scan.file.format;
  const bytes: Uint8Array = await write(mesh, { format: 'ply', encoding: 'ascii' });
  const glb: Uint8Array = await write(reduced, { format: 'glb' satisfies OutputFormat, quantize: true, meshopt: compress });
  const engine: Engine = await createEngine({ threads: 'auto', worker: true, wasmUrl: new URL('https://example.org/wasm/'), workerUrl: '/worker.js', idleMs: Infinity });
  const duck: PointCloud<Float32Array> = await engine.sample('duck', { count: 1000, seed: 1 });
  await engine.reconstruct(duck, { onProgress: ({ stage, overall }) => console.log(stage satisfies Stage, overall.toFixed()) });
  const share: number | undefined = DEFAULTS.reconstruct.accuracy;

  const core: Core = await load({ wasmUrl: '/wasm/' });
  const now: SurfaceMesh<Float64Array> = core.reconstruct(core.reduce(exact), { reduce: false });
  // @ts-expect-error threads need an engine
  await load({ threads: 2 });
  // @ts-expect-error files are waited for
  const early: PointCloud = core.read(file);
  // @ts-expect-error one target only: a string is none
  await reduce(cloud, { target: '0.3' });
  // @ts-expect-error no such option
  await reduce(cloud, { ratio: 0.3 });
  // @ts-expect-error no such format
  await read(file, { format: 'dae' });
  // @ts-expect-error no such way to carry an attribute
  await reduce(cloud, { attributes: { label: 'median' } });
  // @ts-expect-error a plain array holds no positions
  await reduce({ positions: [1, 2, 3] });
  // @ts-expect-error the defaults cannot be changed
  DEFAULTS.reduce.seed = 1;
  try {
    await sample('pig');
  } catch (error) {
    if (error instanceof PointweaveError && error.code === 'out-of-memory') return error.index;
  }
  return [now, early, info.bounds.min[0], bytes.length + glb.length, mesh.cloud.report.distance.rms, mesh.report.genus, share, members, labelled.report.outliers, format];
}
