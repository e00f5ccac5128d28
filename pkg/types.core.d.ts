/**
 * The functions of the package without engine, queue and worker: synchronous calls into one single-threaded instance, in the
 * thread that makes them. For whoever has a worker of their own. Files and samples are wasm of their own, which is loaded when they
 * are asked for: `prepare`, `simplify`, `poster`, `read`, `write` and `sample` wait for it.
 */
import type {
  CallOptions, CloudInfo, EngineOptions, FileCloud, PointCloud, PosterOptions, ReadOptions, ReconstructOptions, ReduceOptions, ReducedCloud,
  Prepared, SampleOptions, Simplified, SimplifyOptions, Step, SurfaceMesh, Texture, TriangleMesh, WriteOptions, Model,
} from './types.js';

export { DEFAULTS, PointweaveError, autoCount, flip, sideInWords, splitOrigin } from './types.js';

export type CoreOptions = Pick<EngineOptions, 'wasmUrl'>;

/**
 * One instance. The calling thread is busy while it computes, so that only an abort from within `onProgress` stops a call.
 * After an error of code `internal` or `out-of-memory` it is broken, and {@link load} makes another.
 */
export interface Core {
  /** A reduction of a cloud that `prepare` gave has no option `prepare`. */
  prepare<P extends Float32Array | Float64Array>(cloud: PointCloud<P> | PointCloud<P>[], steps: Step[], options?: CallOptions): Promise<Prepared<P>>;
  /** A reconstruction has no option `triangles`: this comes after it. */
  simplify<T extends TriangleMesh>(mesh: T, options: SimplifyOptions & CallOptions): Promise<Simplified<T>>;
  poster(what: PointCloud | TriangleMesh, options?: PosterOptions & CallOptions): Promise<Texture>;
  reduce<P extends Float32Array | Float64Array>(cloud: PointCloud<P>, options?: ReduceOptions & CallOptions): ReducedCloud<P>;
  reconstruct<P extends Float32Array | Float64Array>(cloud: PointCloud<P>, options?: ReconstructOptions & CallOptions): SurfaceMesh<P>;
  inspect(cloud: PointCloud, options?: CallOptions): CloudInfo;
  read(data: File | Blob | ArrayBuffer | Uint8Array, options?: ReadOptions & CallOptions): Promise<FileCloud>;
  /** Without `meshopt`: `compress` of `pointweave/meshopt` takes the bytes of a GLB file. */
  write(result: PointCloud | ReducedCloud | SurfaceMesh, options?: Omit<WriteOptions, 'meshopt'> & CallOptions): Promise<Uint8Array>;
  sample(model: Model, options?: SampleOptions & CallOptions): Promise<PointCloud<Float32Array>>;
}

/** Makes an instance. Nothing keeps it, or its memory, but who holds it. */
export function load(options?: CoreOptions): Promise<Core>;
