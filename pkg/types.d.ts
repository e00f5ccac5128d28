/**
 * Point clouds to reduced clouds, oriented normals and meshes.
 *
 * Lengths and tolerances that are called fractions are fractions of the diagonal of the input's bounding box; where at most
 * 2 % of the points are tens of diagonals away from all others, of that of the others.
 * Positions go in and come out in the caller's own frame and unit.
 */

/** Points with whatever is attached to them; every array has one entry (or triple) a point. */
export interface PointCloud<Positions extends Float32Array | Float64Array = Float32Array | Float64Array> {
  /** x y z x y z … `Float64Array` keeps georeferenced clouds exact. Results have the type of the input. */
  positions: Positions;
  /** r g b r g b …, 0-255. */
  colors?: Uint8Array;
  /** Unit vectors x y z …; their directions are taken for the surface's, their signs too where `orient` is false. */
  normals?: Float32Array;
  /** One value a point: intensity, classification, time … */
  attributes?: Record<string, Float32Array>;
  /** Added to the positions to give world coordinates; carried to every result. */
  origin?: [number, number, number];
}

/** The steps of a call, in the order in which they run. */
export type Stage = 'read' | 'octree' | 'features' | 'cluster' | 'place' | 'cells' | 'fit' | 'orient' | 'extract' | 'report';

export interface Progress {
  stage: Stage;
  /** Share of the stage that is done, 0 to 1. */
  fraction: number;
  /** Share of the whole call that is done; never decreases and ends at 1. */
  overall: number;
}

/** Options that every call takes. */
export interface CallOptions {
  /**
   * Aborting rejects the call with the signal's reason, within 100 ms where the engine has a worker. Without one
   * the caller's thread is busy computing, so only an abort from within `onProgress` is noticed before the end.
   */
  signal?: AbortSignal;
  /** Called from time to time. What it throws stops the call, which rejects with it. */
  onProgress?: (progress: Progress) => void;
  /** Take the buffers of the arrays handed in, which are detached, instead of copying them. Default `false`. */
  transfer?: boolean;
}

/** How much a reduction keeps: exactly one of them. */
export type Target =
  /** Share of the points, (0, 1]. The count of the result is exact. */
  | { ratio: number }
  /** Exactly this many points. */
  | { count: number }
  /**
   * The fewest points whose local surfaces have 99 % of the surface within this distance, a fraction, (0, 1). Takes mostly two
   * to six reductions, at most eleven. Noise hides surfaces finer than 1.5 times itself: `report.reason` then says what was taken.
   */
  | { tolerance: number }
  /** The paper's λ, (0, 1]: sub-domains whose surface variation is under it are reduced, the others kept. */
  | { flatness: number };

/** How the values of the input points become the value of the reduced point that stands for them. */
export type Carry =
  /** Their mean, weighted by membership: for measurements. */
  | 'mean'
  /** The value with the largest sum of memberships, of equals the smallest: for labels. A colour is one value. */
  | 'majority'
  /** That of the nearest input point. */
  | 'nearest';

export interface ReduceOptions {
  /** Default `{ ratio: 1/3 }`. */
  target?: Target;
  /** `'paper'` is sections 3.1-3.2 of the paper to the letter; `'adaptive'` (the default) is our best. */
  method?: 'adaptive' | 'paper';
  /** m of eq. 1-5, (1, 100]. Default 1.5 (`'adaptive'`), 2 (`'paper'`). */
  fuzzifier?: number;
  /**
   * ε of eq. 6, (0, 1]. `'paper'` stops when no membership changes by more, default 0.001; `'adaptive'` when no
   * centre moves by more than this share of the wanted spacing, default 0.01.
   */
  epsilon?: number;
  /** At least 1. Default 5 (`'adaptive'`), 100 (`'paper'`). */
  maxIterations?: number;
  /** The norm-inducing matrix A of eq. 1, for `'paper'`. Default `'euclidean'`. */
  norm?: 'euclidean' | 'diagonal' | 'mahalanobis';
  /** How many clusters a sub-domain gets: in proportion to the target (default), or by eq. 7. */
  clusters?: 'proportional' | 'validity';
  /** 0 = even spacing … 1 = strongest concentration on curved regions. Default 0.5. */
  curvatureWeight?: number;
  /**
   * Where a centre goes: `'implicit'` on the surface (default), `'mesh'` best for triangles between the points,
   * `'center'` the raw centre, `'sample'` the nearest input point.
   */
  placement?: 'implicit' | 'mesh' | 'center' | 'sample';
  /** Of the random memberships that the paper's method starts from, an integer from 0. Default 0. */
  seed?: number;
  /** Most points of a sub-domain, 8 to 65536. Default: follows the target (`'adaptive'`), 256 (`'paper'`). */
  cellPoints?: number;
  /** Deepest level of the octree, 1 to 21. Default 21. */
  maxDepth?: number;
  /**
   * How the cloud's attributes are carried to the reduced points and on to a mesh, by name; `colors` names the colours. Default `{}`:
   * every one is `'mean'`.
   */
  attributes?: Record<string, Carry>;
  /** Say of every input point which reduced point it belongs to ({@link ReducedCloud.assignment}). Default `false`. */
  assignment?: boolean;
  /** Say where the sub-domains of the octree are ({@link ReducedCloud.cells}). Default `false`. */
  cells?: boolean;
  /**
   * `'drop'` leaves out isolated points (stray returns, and clumps of up to eight far from the rest) before the
   * reduction, unless they are more than half of all; fractions are then of the diagonal of the others. Default `'keep'`.
   */
  outliers?: 'keep' | 'drop';
}

export interface ReconstructOptions {
  /**
   * How the cloud is reduced first; `false` sends every point to the fit, and attributes are means on the mesh. Default
   * {@link ReduceOptions}' defaults.
   */
  reduce?: ReduceOptions | false;
  /** Residual that the fit has to reach, a fraction, (0, 1). Default 6e-4, the paper's. */
  accuracy?: number;
  /** φ of eq. 9: r³ (`'triharmonic'`, the default), r (`'biharmonic'`), r² log r (`'thin-plate'`, the paper's). */
  kernel?: 'biharmonic' | 'triharmonic' | 'thin-plate';
  /** Ridge on the diagonal of eq. 11, from 0; `'auto'` (default) follows the noise that `inspect` estimates. */
  smoothing?: number | 'auto';
  /** Infer which side is out (default); `false` takes the cloud's own normals as they are. */
  orient?: boolean;
  /** `'paper'` is Algorithm 1 as printed; `'global'` (default) orients the strongest agreements first. */
  propagation?: 'global' | 'paper';
  /**
   * Edge length of the extraction grid, a fraction, 1e-4 to 0.25: the mesh is as dense everywhere. `'auto'` (default)
   * follows the spacing and has at most three triangles for each fitted point, more where the surface is curved.
   */
  resolution?: number | 'auto';
  /** Keep creases in the mesh. Default `true`. */
  sharp?: boolean;
  /** `'auto'` (default) trims the surface where there were no points, `'closed'` closes it, `'open'` always trims. */
  boundary?: 'auto' | 'closed' | 'open';
  /** Say of every input point and every vertex how far scan and mesh are apart there ({@link SurfaceMesh.distances}). Default `false`. */
  distances?: boolean;
  /**
   * Remember in the engine's worker what was measured of this cloud, and its reduction: the next `reconstruct` with `keep` does
   * not do again what would come out the same, and has no time for it in its report. The bytes are the same. Takes about 100
   * bytes a point until a call without it or another cloud. An abort keeps what was done before it where memory can be shared,
   * and forgets all elsewhere. Default `false`.
   */
  keep?: boolean;
}

/** Distances as fractions. */
export interface Distances {
  mean: number;
  rms: number;
  max: number;
}

/** What ran, where and for how long. */
export interface RunReport {
  /** Milliseconds by stage. */
  ms: Partial<Record<Stage, number>>;
  totalMs: number;
  /** The most memory that the WebAssembly instance has had so far; it never shrinks. */
  peakMemoryBytes: number;
  build: Build;
  threads: number;
  /** Why this build ran, and why something was not done as it was asked for. */
  reason: string;
}

export interface ReduceReport extends RunReport {
  /** Of the cloud that was given, those that were dropped too. */
  inputPoints: number;
  /** Isolated points that were dropped; all below is about the others. */
  outliers: number;
  outputPoints: number;
  /** Sub-domains of the octree. */
  cells: number;
  /** Sweeps of fuzzy c-means; the most in any sub-domain. */
  iterations: number;
  /** J of eq. 1 over the whole cloud, in squared diagonals. */
  objective: number;
  /** χ of eq. 7 over the whole cloud; 0 where it is not defined: one centre, or two at one place. */
  validity: number;
  /** Spread over mean of the distance to the nearest other centre in wanted spacings; 0 is perfectly even. */
  evenness: number;
  /** Estimated noise, a fraction. */
  noise: number;
  /** Points kept as they were, for a sharp feature. */
  sharpPoints: number;
  /** Of the input to the reduced surface. */
  distance: Distances;
}

export interface ReducedCloud<Positions extends Float32Array | Float64Array = Float32Array | Float64Array>
  extends PointCloud<Positions> {
  /** Unit; oriented outward where `orient` is true (the default of `reconstruct`), else of arbitrary sign. */
  normals: Float32Array;
  /** Surface variation λ0/(λ0+λ1+λ2) around the point. */
  variation: Float32Array;
  /** How many input points it stands for; they sum to the input's count, without the outliers that were dropped. */
  weights: Float32Array;
  /** Index of the nearest input point. */
  nearest: Uint32Array;
  /**
   * With `assignment`, one entry an input point: the index of the reduced point that it belongs to most, or 0xffffffff
   * for an outlier that was dropped.
   */
  assignment?: Uint32Array;
  /** With `cells`, six numbers a sub-domain: the lowest x y z of its input points, and the highest. */
  cells?: Positions;
  report: ReduceReport;
}

export interface SurfaceReport extends ReduceReport {
  triangles: number;
  components: number;
  boundaryEdges: number;
  nonManifoldEdges: number;
  /** One number a closed component. */
  genus: number[];
  /** How often a sub-domain was split because its fit was not within the accuracy. */
  refinements: number;
  /** Of the fit at the input points. */
  residual: Distances;
  /** Share of the input that stayed beyond the accuracy. */
  beyondAccuracy: number;
  /** How far the local functions disagree on which side is out: -1 where all agree, 1 where none do. */
  orientationEnergy: number;
  /** The same before conflicts were solved over the whole graph. */
  orientationEnergyBefore: number;
}

export interface SurfaceMesh<Positions extends Float32Array | Float64Array = Float32Array | Float64Array> {
  /** x y z of each vertex. */
  positions: Positions;
  /** Unit, outward. */
  normals: Float32Array;
  /** Three a triangle, counter-clockwise seen from outside. */
  indices: Uint32Array;
  colors?: Uint8Array;
  attributes?: Record<string, Float32Array>;
  origin?: [number, number, number];
  /** The points that the surface was fitted to. */
  cloud: ReducedCloud<Positions>;
  /** With `distances`, fractions: for a map of the error. */
  distances?: {
    /** One entry an input point, its distance to the mesh; NaN for an outlier that was dropped. */
    points: Float32Array;
    /** One entry a vertex: the mean over the points nearest to its triangles; NaN where the mesh spans a place without points. */
    vertices: Float32Array;
  };
  report: SurfaceReport;
}

/** What can be said of a cloud before anything is done to it. Lengths are in the caller's unit. */
export interface CloudInfo {
  /** Points, those that are not finite too. */
  count: number;
  bounds: { min: [number, number, number]; max: [number, number, number] };
  /** Of the bounding box. */
  diagonal: number;
  /** Median distance of neighbours on the surface. */
  spacing: number;
  /** Points that repeat an earlier one exactly. */
  duplicates: number;
  /** Points with a coordinate that is NaN or infinite; left out of everything else here. */
  nonFinite: number;
  /** Estimated standard deviation of the noise across the surface. */
  noise: number;
}

/** Formats that are read; LAS is LAZ, too, and `'xyz'` any rows of numbers as text. */
export type Format = 'ply' | 'xyz' | 'pcd' | 'obj' | 'off' | 'stl' | 'glb' | 'las' | 'e57' | 'ptx' | 'grid' | 'tif' | '3mf' | 'splat' | 'spz';

/** What a file held. Coordinates are the file's: `Float64Array` where single precision would move one by more than 2⁻²² of the diagonal, and for LAS. */
export interface FileCloud<Positions extends Float32Array | Float64Array = Float32Array | Float64Array> extends PointCloud<Positions> {
  /**
   * What the columns of a table of text were taken for, as `columns` of {@link ReadOptions} says it: `x y z`, `nx ny nz`,
   * `red green blue`, `rgb` for a packed colour, `-` for one that was passed over, or the attribute's name.
   */
  columns?: string[];
  /**
   * Points left out, by why: `not-finite`, `invalid` (the file marks them), `no-data` (a coordinate stands for a missing one,
   * such as -9999), `no-return` (many at exactly 0 0 0 or at the sensor).
   */
  skipped: Record<string, number>;
  file: {
    format: Format;
    /** Points left out because a coordinate was NaN or infinite, or marked as invalid. */
    dropped: number;
    /** Values of colours, normals and attributes that were NaN or infinite and are now 0. */
    replaced: number;
    /** Faces that the file has; they are not read. */
    faces: number;
    /** What else is to be said of the points, in sentences. */
    notes: string[];
    /** The first rows of a table of text, and how they were taken apart. */
    table?: {
      rows: string[][];
      /** What the file calls its columns; empty where it does not. */
      names: string[];
      delimiter: string;
      decimal: string;
      /** The columns were guessed, and could be something else: a person should look at `columns`. */
      weak: boolean;
    };
  };
}

export interface ReadOptions {
  /** The file's name; its extension decides between formats that look alike. A `File` brings its own. */
  name?: string;
  /** Default: recognised by content, then by name. */
  format?: Format;
  /**
   * Of a table of text: what each column holds, as {@link FileCloud.columns} says it. Columns beyond are passed over. Default:
   * told from its names, else from its values.
   */
  columns?: string[];
  /** Of a table of text: the character between values, `' '` for any number of blanks and tabs. Default: told from the first lines. */
  delimiter?: string;
  /** Of a table of text: the decimal mark. Default: told from the first lines. */
  decimal?: '.' | ',';
  /** Of a table of text: lines that are passed over before anything else. Default 0. */
  skip?: number;
  /** What becomes of points that stand for a missing measurement; see {@link FileCloud.skipped}. Default `'drop'`. */
  sentinels?: 'drop' | 'keep';
}

/** The formats that are written, and what of a result they hold: the others leave out what they have no place for. */
export type OutputFormat =
  /** Everything, in world coordinates: `double` where they need it. */
  | 'ply'
  /** Rows of text: everything but triangles, in world coordinates. */
  | 'xyz'
  /**
   * Binary glTF 2.0: everything. Positions are in single precision, and the origin is the node's translation in double
   * precision; a cloud in double precision gets an origin near its middle. Axes and unit stay yours. Colours become
   * linear, attributes `_NAME`; normals are left out where one is zero.
   */
  | 'glb'
  /** Everything but attributes, in world coordinates as text; colours from 0 to 1 stand behind the coordinates. */
  | 'obj'
  /** Binary: triangles alone, in single precision. Where there is an origin, the first 80 bytes say `at X Y Z`. */
  | 'stl';

export interface WriteOptions {
  /** Default `'ply'`. */
  format?: OutputFormat;
  /** Of a PLY file. Default `'binary'` (little-endian). */
  encoding?: 'binary' | 'ascii';
  /**
   * Of a GLB file: positions in steps of 1/65535 of the longest side and normals in steps of 1/127, which take half the room
   * (`KHR_mesh_quantization`, which viewers read without a decoder). Default `false`.
   */
  quantize?: boolean;
  /**
   * Of a GLB file: compressed without loss (`EXT_meshopt_compression`), vertices and triangles in another order; viewers need
   * a decoder. Needs `@gltf-transform/core`, `@gltf-transform/extensions` and `meshoptimizer`, which are loaded when asked for,
   * and computes in the caller's thread. Where a bundler makes the program, `compress` of `pointweave/meshopt` takes the place
   * of `true`. Default `false`.
   */
  meshopt?: boolean | ((glb: Uint8Array) => Promise<Uint8Array>);
}

export type Model = 'duck' | 'pig' | 'part';

export interface SampleOptions {
  /** 1 to 10,000,000. Default: the paper's, 35,647 (`'duck'`) and 171,875 (`'pig'`), and 60,000 (`'part'`). */
  count?: number;
  /** An integer from 0. Default 0. */
  seed?: number;
  /** Standard deviation of the range, a fraction of the bounding-box diagonal, 0 to 0.01. Default 5e-4, a good hand-held scanner. */
  noise?: number;
}

export type Build = 'threads' | 'single';

export interface EngineOptions {
  /**
   * `'auto'` (default) takes the wasm-threads build in Node and where the page is cross-origin isolated, with a
   * thread a core (16 at most), else the single-threaded one; 1 takes the single-threaded build. 64 at most.
   */
  threads?: 'auto' | number;
  /**
   * Compute in a worker, which keeps the caller's thread free. Default: `true` in a browser; in Node the
   * single-threaded build computes in the caller's thread. The threads build always has a worker, so `false` means
   * the single-threaded one.
   */
  worker?: boolean;
  /**
   * The folder that holds `single/`, `threads/`, `files/`, `las/`, `e57/` and `packed/`, or the URLs of the wasm files. All but the first two are
   * loaded when a file of theirs is read. Default: beside the package.
   */
  wasmUrl?: string | URL | { single?: string | URL; threads?: string | URL; files?: string | URL; las?: string | URL; e57?: string | URL; packed?: string | URL };
  /**
   * The worker's script, `pointweave/worker` or a module that imports it. Default: beside the package. A script on
   * another origin is started through a `blob:` URL.
   */
  workerUrl?: string | URL;
  /**
   * Milliseconds without a call after which the workers end and the memory is freed; the next call starts them anew.
   * Default 60,000; `Infinity` keeps them until `dispose`.
   */
  idleMs?: number;
}

/** The functions of the package with a queue, a worker and a build of their own. */
export interface Engine {
  /** Known from the start; `'single'` from then on where the threads build failed to start. */
  readonly build: Build;
  readonly threads: number;
  /** Why this build. */
  readonly reason: string;
  reduce<P extends Float32Array | Float64Array>(cloud: PointCloud<P>, options?: ReduceOptions & CallOptions): Promise<ReducedCloud<P>>;
  reconstruct<P extends Float32Array | Float64Array>(cloud: PointCloud<P>, options?: ReconstructOptions & CallOptions): Promise<SurfaceMesh<P>>;
  /** Looks at a cloud and changes nothing; the only call that accepts coordinates that are not finite. */
  inspect(cloud: PointCloud, options?: CallOptions): Promise<CloudInfo>;
  /**
   * Reads in slices, so a `File` is never in memory as a whole unless its format needs that (LAZ, E57, GLB, packed PCD). Bytes
   * beyond the first 4 MiB of a buffer are copied while it is read: leave them alone meanwhile.
   */
  read(data: File | Blob | ArrayBuffer | Uint8Array, options?: ReadOptions & CallOptions): Promise<FileCloud>;
  write(result: PointCloud | ReducedCloud | SurfaceMesh, options?: WriteOptions & CallOptions): Promise<Uint8Array>;
  /** A generated scan of a model whose true surface is known: several views, uneven density, noise. */
  sample(model: Model, options?: SampleOptions & CallOptions): Promise<PointCloud<Float32Array>>;
  /** Ends the worker and its threads. Calls under way reject with `disposed`, as every later one does. */
  dispose(): Promise<void>;
}

export const reduce: Engine['reduce'];
export const reconstruct: Engine['reconstruct'];
export const inspect: Engine['inspect'];
export const read: Engine['read'];
export const write: Engine['write'];
export const sample: Engine['sample'];

/** Resolves when the engine is ready to compute. */
export function createEngine(options?: EngineOptions): Promise<Engine>;

/** What is taken for each option that is not given; `undefined` where that follows from other options. */
export const DEFAULTS: { readonly reduce: Readonly<ReduceOptions>; readonly reconstruct: Readonly<ReconstructOptions> };

export type ErrorCode =
  | 'empty-cloud' | 'too-few-points' | 'bad-length' | 'non-finite' | 'bad-input' | 'bad-option' | 'degenerate'
  | 'unknown-format' | 'bad-file' | 'unsupported-file' | 'load-failed' | 'out-of-memory' | 'disposed' | 'internal'
  | 'bad-index' | 'needs-triangles' | 'missing-package' | 'no-webgl';

/** Thrown by every function of the package, except that an abort rejects with its signal's reason. */
export class PointweaveError extends Error {
  /** Stable, meant for programs; the message is meant for people and may change. */
  readonly code: ErrorCode;
  /** The point, line or byte that is wrong, where there is one. */
  readonly index?: number;
  /** What would have been right. */
  readonly expected?: unknown;
  /** What was there instead. */
  readonly found?: unknown;
}
