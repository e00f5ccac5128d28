/**
 * Point clouds to reduced clouds, oriented normals and meshes.
 *
 * Lengths and tolerances that are called fractions are fractions of the diagonal of the input's bounding box; where at most
 * 2 % of the points are tens of diagonals away from all others, of that of the others.
 * Positions go in and come out in the caller's own frame and unit.
 */

import type { ReconstructOptions, ReduceOptions } from './types.options.js';
import type { PrepareOption, Prepared, Step } from './types.prepare.js';
import type { LightReport, ReduceReport, SurfaceReport } from './types.reports.js';

/** Points with whatever is attached to them; every array has one entry (or triple) a point. */
export interface PointCloud<Positions extends Float32Array | Float64Array = Float32Array | Float64Array> {
  /** x y z x y z … `Float64Array` keeps georeferenced clouds exact. Results have the type of the input. */
  positions: Positions;
  /** r g b r g b …, 0-255. */
  colors?: Uint8Array;
  /**
   * Unit vectors x y z …; their directions count where the points are noisy and they themselves are not, and their signs as far as they
   * agree with each other, all of them where `orient` is false. Zero, NaN and infinite ones are none.
   */
  normals?: Float32Array;
  /** One value a point: intensity, classification, time … */
  attributes?: Record<string, Float32Array>;
  /** Added to the positions to give world coordinates; carried to every result. */
  origin?: [number, number, number];
  /** Where the points were seen from; carried to every reduced cloud. */
  viewpoints?: Viewpoints;
  /** Which way is up, in the positions' frame, of any length but 0; carried to every result as a unit vector. */
  up?: [number, number, number];
  /** All was seen from high above, along `up` (z without it), as airborne scans are; carried to every reduced cloud. */
  seenFromAbove?: boolean;
  /**
   * What the object stood on: a point of a plane, and its normal, of any length but 0, to the side that the object is on. A step `plane`
   * that drops the floor leaves it, for `boundary: 'base'`; carried to every reduced cloud.
   */
  floor?: { point: [number, number, number]; normal: [number, number, number] };
  /** What a coordinate is; carried to every result. */
  unit?: Unit;
  /** The reference system of world coordinates, as a LAS file describes it; carried to every result, and written to LAS and LAZ. */
  crs?: Crs;
  /** How many faces of a mesh the points were taken from; carried to every result. Measured points have none. */
  faces?: number;
}

/** Millimetre, centimetre, metre, inch, foot, foot of the US survey; and the degree of longitude and latitude, which is no length. */
export type Unit = 'mm' | 'cm' | 'm' | 'in' | 'ft' | 'us-ft' | 'deg';

/** A direction along an axis, or any as three numbers that are not all 0. */
export type Direction = 'x' | 'y' | 'z' | '-x' | '-y' | '-z' | [number, number, number];

/** A coordinate reference system in the words of a file. */
export interface Crs {
  /** Well-known text. */
  wkt?: string;
  /** GeoTIFF's keys with their directory, their floating-point values and their texts. */
  keys?: Uint16Array;
  doubles?: Float64Array;
  ascii?: string;
}

/** Places of a scanner or camera. */
export interface Viewpoints {
  /** x y z of each, in the frame and unit of the cloud's positions; at least one. */
  positions: Float64Array;
  /** For each point the index of the place that it was seen from, or 0xffffffff where that is not known. Default: the first saw all. */
  of?: Uint32Array;
}

/** The steps of a call, in the order in which they run. */
export type Stage = 'read' | 'octree' | 'features' | 'prepare' | 'cluster' | 'place' | 'cells' | 'fit' | 'orient' | 'extract' | 'report' | 'simplify' | 'texture';

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

export * from './types.options.js';
export * from './types.reports.js';
export * from './types.prepare.js';

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
  /** With `prepare`: what the recipe did. `nearest` and `assignment` are of the points that were given. */
  prepared?: Pick<Prepared, 'labels' | 'steps'>;
  report: ReduceReport;
}

/** Vertices with what they carry, and triangles over them. */
export interface TriangleMesh<Positions extends Float32Array | Float64Array = Float32Array | Float64Array> extends PointCloud<Positions> {
  /** Three a triangle. */
  indices: Uint32Array;
}

/** How light a mesh becomes: one of the two, or both. */
export interface SimplifyOptions {
  /** At most so many triangles, from 1. The mesh has at least 98 % of them, or as many as it had. */
  triangles?: number;
  /** As few triangles as keep both meshes within this distance of each other, a fraction of the diagonal, above 0 to 1. */
  error?: number;
}

/** How a poster is drawn. */
export interface PosterOptions {
  /** Width and height in pixels, 16 to 4096. Default `[800, 600]`. */
  size?: [number, number];
  /**
   * From where, as `camera-orbit` of the element: an angle around the upright axis, one down from straight above (`deg` or `rad`), and
   * a distance (`%` of that at which it reaches to the edges, or `m`), each `auto` where it is the default: `'30deg 75deg 110%'`.
   */
  camera?: string;
  /** `'#rrggbb'`, or `'transparent'` (default). */
  background?: string;
}

/** A mesh with fewer triangles: what it had, and in its report what that cost. */
export type Simplified<T> = T & { report: LightCounts & { simplified: LightReport } };

/** A mesh with pictures: what it had, and where its vertices are in them. The report is there where `triangles` were asked for. */
export type Textured<T> = T & Required<Pick<SurfaceMesh, 'uvs' | 'tangents' | 'textures'>> & { report?: Partial<Simplified<T>['report']> };

/** What a report says of the triangles that are left. */
export type LightCounts = Pick<LightReport, 'triangles' | 'components' | 'boundaryEdges' | 'nonManifoldEdges' | 'genus' | 'selfIntersections'>;

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
  up?: [number, number, number];
  unit?: Unit;
  crs?: Crs;
  faces?: number;
  /** With `texture`, two a vertex, from 0 to 1: where it is in the pictures, whose first row is at 0. Vertices on cuts are there twice. */
  uvs?: Float32Array;
  /** With `texture`, four a vertex: a unit vector, and the sign of the bitangent `cross(normal, tangent)`, as glTF has them. */
  tangents?: Float32Array;
  /** With `texture`. */
  textures?: Partial<Record<TextureMap, Texture>>;
  /** With `lods`: the meshes of the other budgets. */
  lods?: SurfaceMesh<Positions>[];
  /** The points that the surface was fitted to. */
  cloud: ReducedCloud<Positions>;
  /** With `distances`, fractions: for a map of the error. */
  distances?: {
    /** One entry an input point, its distance to the mesh; NaN for an outlier that was dropped. */
    points: Float32Array;
    /** One entry a vertex: the mean over the points nearest to its triangles; NaN where the mesh spans a place without points. */
    vertices: Float32Array;
  };
  /** With `prepare`: what the recipe did. */
  prepared?: Pick<Prepared, 'labels' | 'steps'>;
  report: SurfaceReport;
}

/** What a picture on a mesh shows. */
export type TextureMap = 'color' | 'normal' | 'occlusion';

/** A picture on a mesh. */
export interface Texture {
  /** In texels. */
  width: number;
  height: number;
  /** The bytes of a file of that type. */
  data: Uint8Array;
  type: 'image/png' | 'image/jpeg' | 'image/webp' | 'image/ktx2';
  /** With `scalar`: the values that the ends of the colours stand for. */
  range?: [number, number];
}

/** Of a reconstruction: pictures of what the points show, so that a mesh of few triangles looks like one of many. */
export interface TextureOption {
  /**
   * Instead of `triangles`: several meshes, of at most so many triangles each, the first with the most. The result is the first, and has
   * the others as `lods`. 1 to 8 numbers, each less than the one before.
   */
  lods?: number[];
  texture?: TextureOptions;
}

export interface TextureOptions {
  /** Width in texels, 64 to 8192; the height is what the charts need. Default: two texels a point along each axis, 256 to 4096. */
  size?: number;
  /**
   * `'color'`: the colours of the points, where they have any. `'normal'`: the surface as it was before `triangles`, in tangent space.
   * `'occlusion'`: how much of the light around comes to the surface, what is in its way within a fourth of the diagonal; half as wide.
   * Default: `'color'` and `'normal'`.
   */
  maps?: TextureMap[];
  /**
   * Values in the place of the points' colours, as colours from blue to yellow: the name of an attribute, or `'height'`, which is along `up`.
   * Default: the colours of the points.
   */
  scalar?: string;
  /** With `scalar`: the values that the ends of the colours stand for. Default: where all but a fiftieth at each end lie. */
  range?: [number, number];
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
  /** With `faces: 'mesh'`, of a file with faces: three a triangle. */
  indices?: Uint32Array;
  /** With `faces: 'mesh'`, of a GLB whose triangles all wear the same pictures: as of {@link SurfaceMesh}. */
  uvs?: Float32Array;
  tangents?: Float32Array;
  textures?: Partial<Record<TextureMap, Texture>>;
  /**
   * What the columns of a table of text were taken for, as `columns` of {@link ReadOptions} says it: `x y z`, `nx ny nz`,
   * `red green blue`, `rgb` for a packed colour, `-` for one that was passed over, or the attribute's name.
   */
  columns?: string[];
  /**
   * Points left out, by why: `not-finite`, `invalid` (the file marks them), `no-data` (a coordinate stands for a missing one,
   * such as -9999), `no-return` (many at exactly 0 0 0 or at the sensor), `unused-vertices` (no face names them). Faces that name a
   * vertex that there is not are `broken-faces`.
   */
  skipped: Record<string, number>;
  file: {
    format: Format;
    /** Points left out because a coordinate was NaN or infinite, or marked as invalid. */
    dropped: number;
    /** Values of colours, normals and attributes that were NaN or infinite and are now 0. */
    replaced: number;
    /** Faces that the file has. */
    faces: number;
    /** Points that were taken from them; missing where the points are the file's own. */
    sampled?: number;
    /** Files that the faces name and that were not there (`beside`), and pictures that are no PNG, JPEG or WebP: their colours are missing. */
    missing?: string[];
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
   * Of a file with faces: `'sample'` (default) takes points from them, evenly over their area and never close together, four a
   * triangle, at least 100,000 and at most 2,000,000, with normals, colours (of vertices, faces, materials and textures) and
   * attributes; `'vertices'` takes the vertices; `'mesh'` takes the vertices, with the colours of their faces, and the triangles as
   * `indices`.
   */
  faces?: 'sample' | 'vertices' | 'mesh';
  /** The files that a mesh may name, its material library and pictures: those dropped along, or what gives the data of a name. */
  beside?: Beside;
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

/** Files by their names, folders and case aside; or a function, which gives `undefined` for what there is not. */
export type Beside =
  | File[]
  | ((name: string) => Blob | ArrayBuffer | Uint8Array | undefined | Promise<Blob | ArrayBuffer | Uint8Array | undefined>);

/** The formats that are written, and what of a result they hold: the others leave out what they have no place for. */
export type OutputFormat =
  /** Everything, in world coordinates: `double` where they need it. */
  | 'ply'
  /** Rows of text: everything but triangles, in world coordinates. With attributes, a comment at the top names the columns. */
  | 'xyz'
  /**
   * Binary glTF 2.0: everything. Positions are in single precision, and the origin is the node's translation in double
   * precision; a cloud in double precision gets an origin near its middle. y is up, and the unit is the metre, where the
   * cloud says its own. Colours become linear, attributes `_NAME`; normals are left out where one is zero.
   */
  | 'glb'
  /** Everything but attributes, in world coordinates as text; colours from 0 to 1 stand behind the coordinates. */
  | 'obj'
  /**
   * Binary: triangles alone, in single precision. Where there is an origin, the first 80 bytes say `at X Y Z`. z is up, and the
   * unit is the millimetre, where the cloud says its own.
   */
  | 'stl'
  /** Binary: points with everything, in world coordinates: in double precision where they need it. */
  | 'pcd'
  /**
   * LAS 1.4, point formats 6 to 8, and LAZ: points with everything, in world coordinates, and the reference system. Attributes go to the
   * fields of their names (`intensity`, `classification` …) where those hold them, else with normals to extra bytes. z is up.
   */
  | 'las'
  | 'laz'
  /** Triangles and colours; the origin is the item's transform. z is up, and the unit is the millimetre, where the cloud says its own. */
  | '3mf'
  /**
   * USDZ, one layer as text: everything. Positions are in single precision, and the origin is a translation in double precision. y is
   * up, and the unit is the metre, where the cloud says its own. Colours are linear, attributes primvars.
   */
  | 'usdz'
  /** An OBJ file with its material library and its pictures. */
  | 'zip';

export interface WriteOptions {
  /** Default `'ply'`. */
  format?: OutputFormat;
  /** Of a PLY file. Default `'binary'` (little-endian). */
  encoding?: 'binary' | 'ascii';
  /** Which way is up in the file: the result is turned there from its own `up`. Default: what the format asks for, or as it is. */
  up?: Direction;
  /** The unit of the file: the result is scaled to it from its own. Default: what the format asks for, or as it is. */
  unit?: Unit;
  /**
   * Of a GLB file: positions in steps of 1/65535 of the longest side and normals in steps of 1/127, which take half the room
   * (`KHR_mesh_quantization`, which viewers read without a decoder). Default `false`.
   */
  quantize?: boolean;
  /**
   * Of a GLB file: what the pictures of a textured mesh are. `'webp'` (`EXT_texture_webp`, a third of the bytes) needs `@jsquash/webp`, `'ktx2'`
   * (`KHR_texture_basisu`, which stays compressed in graphics memory) needs `ktx2-encoder`; they are loaded when asked for, and compute in
   * the caller's thread. Where a bundler makes the program, `webp` of `pointweave/webp` or `ktx2` of `pointweave/ktx2` takes the place of the
   * name. Default `'png'`.
   */
  pictures?: 'png' | 'webp' | 'ktx2' | PictureEncoder;
  /**
   * Of a GLB file: compressed without loss (`EXT_meshopt_compression`), vertices and triangles in another order; viewers need
   * a decoder. Needs `@gltf-transform/core`, `@gltf-transform/extensions` and `meshoptimizer`, which are loaded when asked for,
   * and computes in the caller's thread. Where a bundler makes the program, `compress` of `pointweave/meshopt` takes the place
   * of `true`. Default `false`.
   */
  meshopt?: boolean | ((glb: Uint8Array) => Promise<Uint8Array>);
}

/** Makes a file of a picture: four bytes a pixel, red, green, blue and alpha, rows from the top. */
export type PictureEncoder = (picture: { map: TextureMap; width: number; height: number; pixels: Uint8Array }) => Promise<Uint8Array>;

/** `'desk'`: the duck as one gets it, on a table with a block, with shadows, a hole, strays and uneven light. */
export type Model = 'duck' | 'pig' | 'part' | 'desk';

export interface SampleOptions {
  /** 1 to 10,000,000. Default: the paper's, 35,647 (`'duck'`) and 171,875 (`'pig'`), and 60,000 (`'part'`, `'desk'`). */
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
   * The folder that holds `single/`, `threads/`, `files/`, `las/`, `e57/`, `packed/`, `pictures/`, `exports/`, `prepare/`, `light/` and `samples/`, or
   * an object with the URLs of wasm files; those that it does not name lie beside the package. All but the first two are loaded when a file of theirs is read or written, a recipe done, a mesh made light, or a sample made. Default: beside the package.
   */
  wasmUrl?: string | URL | { single?: string | URL; threads?: string | URL; files?: string | URL; las?: string | URL; e57?: string | URL; packed?: string | URL; pictures?: string | URL; exports?: string | URL; prepare?: string | URL; light?: string | URL; samples?: string | URL };
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
  /**
   * Cuts the object out of a scan, step by step: floors, pieces, strays, regions. Several clouds of one frame become one first,
   * and labels are of their points one cloud after the other.
   */
  prepare<P extends Float32Array | Float64Array>(cloud: PointCloud<P> | PointCloud<P>[], steps: Step[], options?: CallOptions): Promise<Prepared<P>>;
  /**
   * Takes any mesh to fewer triangles: of the same topology, with creases and borders where they were. Vertices at one place become
   * one; they keep normals, colours and attributes. In a mesh of `reconstruct`, the cloud and the report stay, but for its counts.
   */
  simplify<T extends TriangleMesh>(mesh: T, options: SimplifyOptions & CallOptions): Promise<Simplified<T>>;
  /**
   * Textures a mesh that is there, of at most so many `triangles` where they are given, with the colours of a scan of the same thing, and
   * with what is lost of the mesh. Both are in the same coordinates, each with its `origin`.
   */
  texture<T extends TriangleMesh>(mesh: T, cloud: PointCloud, options?: TextureOptions & { triangles?: number } & CallOptions): Promise<Textured<T>>;
  /**
   * A picture as `<point-weave>` shows it, drawn without a browser: a mesh as its GLB file, with its pictures or the colours of its
   * vertices, a cloud as a scan. The same bytes everywhere.
   */
  poster(what: PointCloud | TriangleMesh, options?: PosterOptions & CallOptions): Promise<Texture>;
  reduce<P extends Float32Array | Float64Array>(cloud: PointCloud<P>, options?: ReduceOptions & PrepareOption & CallOptions): Promise<ReducedCloud<P>>;
  reconstruct<P extends Float32Array | Float64Array>(cloud: PointCloud<P>, options?: ReconstructOptions & PrepareOption & TextureOption & CallOptions): Promise<SurfaceMesh<P>>;
  /** Looks at a cloud and changes nothing; the only call that accepts coordinates that are not finite. */
  inspect(cloud: PointCloud, options?: CallOptions): Promise<CloudInfo>;
  /**
   * Reads in slices, so a `File` is never in memory as a whole unless its format needs that (LAZ, E57, GLB, 3MF, GeoTIFF, SPZ, packed PCD, archives). Bytes
   * beyond the first 4 MiB of a buffer are copied while it is read: leave them alone meanwhile.
   */
  read(data: File | Blob | ArrayBuffer | Uint8Array, options?: ReadOptions & CallOptions): Promise<FileCloud>;
  write(result: PointCloud | ReducedCloud | SurfaceMesh, options?: WriteOptions & CallOptions): Promise<Uint8Array>;
  /** A generated scan of a model whose true surface is known: several views, uneven density, noise. */
  sample(model: Model, options?: SampleOptions & CallOptions): Promise<PointCloud<Float32Array>>;
  /** Ends the worker and its threads. Calls under way reject with `disposed`, as every later one does. */
  dispose(): Promise<void>;
}

export const prepare: Engine['prepare'];
export const simplify: Engine['simplify'];
export const texture: Engine['texture'];
export const poster: Engine['poster'];
export const reduce: Engine['reduce'];
export const reconstruct: Engine['reconstruct'];
export const inspect: Engine['inspect'];
export const read: Engine['read'];
export const write: Engine['write'];
export const sample: Engine['sample'];

/** Resolves when the engine is ready to compute. */
export function createEngine(options?: EngineOptions): Promise<Engine>;

/**
 * The mesh with its other side out: triangles and normals, those of its cloud too. With `triangle`, an index, only the piece that this
 * triangle belongs to. The other arrays are those of `mesh`.
 */
export function flip<T extends SurfaceMesh>(mesh: T, options?: { triangle?: number }): T;

/** What told which side is out, for people: `report.orientation` as part of a sentence. */
export function sideInWords(report: Pick<SurfaceReport, 'orientation'>, say?: (text: string) => string): string;

/**
 * Splits an origin of whole numbers off a cloud in double precision whose coordinates are far from zero for its size, as those of maps
 * are: positions become differences from it, in place, and it goes into all that is made of the cloud. No bit is lost. Others stay as they are.
 */
export function splitOrigin<T extends { positions: Float32Array | Float64Array; origin?: [number, number, number] }>(cloud: T): T;

/** How many points `target: 'auto'` keeps of so many, on this device. */
export function autoCount(points: number): number;

/** What is taken for each option that is not given; `undefined` where that follows from other options. */
export const DEFAULTS: { readonly reduce: Readonly<ReduceOptions>; readonly reconstruct: Readonly<ReconstructOptions> };

export type ErrorCode =
  | 'empty-cloud' | 'too-few-points' | 'bad-length' | 'non-finite' | 'bad-input' | 'detached' | 'bad-option' | 'degenerate'
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
  /** Of a table of text that could not be read: its first rows, for a person who knows what its `columns` are. */
  readonly table?: FileCloud['file']['table'];
}
