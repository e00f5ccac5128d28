/**
 * Clouds, meshes and GLBs on a canvas. It needs three.js (an optional peer of the package).
 */
import type { PointCloud, ReducedCloud, SurfaceMesh, Unit } from './types.js';

/** An axis that points up. */
export type Axis = 'y' | 'z' | '-y' | '-z' | 'x' | '-x';
/** A side to look at straight; the front is where the first look comes from. */
export type Side = 'front' | 'back' | 'right' | 'left' | 'top' | 'bottom';
/** Who moved the camera. */
export type Mover = 'pointer' | 'keys' | 'program';

/** Positions in the caller's frame and unit. */
export interface Placed {
  positions: Float32Array | Float64Array;
  /** Added to positions to give world coordinates. Default 0 0 0. */
  origin?: [number, number, number];
}

/**
 * What a layer is made of: points, or a mesh where there are `indices`. Any cloud or mesh of the package is one. Nothing is changed;
 * normals, indices and colours are used as they are, so leave them alone while they are shown.
 */
export interface Drawable extends Placed {
  /** Unit vectors. A mesh without is given smooth ones; points without are shaded by depth alone. */
  normals?: Float32Array;
  /** The normals of points are directed outwards: the far side is let through. Default false. */
  oriented?: boolean;
  /** sRGB, one triple a point or vertex. */
  colors?: Uint8Array;
  /** Three a triangle. */
  indices?: Uint32Array;
  /** Two a vertex: where it is in the `textures`. */
  uvs?: Float32Array;
  /** Four a vertex: the frames that the picture of normals is told in. */
  tangents?: Float32Array;
  /** Pictures of a mesh, as `reconstruct` and `texture` make them; they come as soon as the browser has decoded them, in place of `colors`. */
  textures?: Partial<Record<'color' | 'normal' | 'occlusion', { data: Uint8Array; type: string }>>;
  /** Which way is up, where that is known. */
  up?: [number, number, number];
  /** It was scanned from the air: z is up. */
  seenFromAbove?: boolean;
}

/** A GLB that was read by {@link readGlb}. */
export interface Model {
  readonly kind: 'glb';
}

/** The box that pictures are fitted to, in world units. */
export interface Frame {
  center: [number, number, number];
  /** Edge lengths. */
  size: [number, number, number];
  /** 1 where all points coincide. */
  diagonal: number;
}

/** Two layers beside each other. */
export interface Split {
  left: string;
  right: string;
  /** Where they meet: a share of the width, 0 to 1. */
  at: number;
}

/** A plane that cuts what is drawn, in the coordinates of the data. */
export interface Section {
  point: [number, number, number];
  /** Of any length but 0, into the side that is drawn. */
  normal: [number, number, number];
}

/** Any CSS colours, for what has no colours of its own; `reduced` is for the layer of that name. */
export interface LayerColors {
  points: string;
  mesh: string;
  reduced: string;
  edges: string;
  boxes: string;
  /** Of a GLB's materials that are plain white: default white. */
  plain?: string;
}

/** Room at the edges of the canvas for what lies over the picture, in CSS pixels. At most 40 % of a side's length is given. */
export interface Insets {
  top: number;
  right: number;
  bottom: number;
  left: number;
}

/** Where one looks from. */
export interface Pose {
  /** Degrees around, 0 is the front, 90 the right. */
  azimuth: number;
  /** Degrees above the horizon. */
  elevation: number;
  /** 1 shows the whole, 2 is twice as near. */
  zoom: number;
}

/** In the unit of the data, or a share of the distance from which everything is seen. */
export type Distance = number | { share: number };

/** Where the first look is from, in degrees. What is not given is as usual: from the front, a little from the right and above. */
export interface FirstLook {
  /** Around the upright axis: 0 is the front, 90 the right. */
  azimuth?: number;
  /** Down from the upright axis: 90 is level. */
  polar?: number;
  /** From the target. */
  distance?: Distance;
  /** What is looked at, in the coordinates of the data; null is the middle along that axis. */
  target?: [number | null, number | null, number | null];
  /** Vertical. Default 32. */
  fieldOfView?: number;
}

/** The least and the most, each where it is given. Degrees. */
export interface Limits {
  azimuth?: [number | null, number | null];
  polar?: [number | null, number | null];
  distance?: [Distance | null, Distance | null];
  fieldOfView?: [number | null, number | null];
}

/** Where the camera stands now: degrees, and the unit and coordinates of the data. */
export interface Stance {
  azimuth: number;
  polar: number;
  distance: number;
  target: [number, number, number];
  fieldOfView: number;
}

export interface ViewerOptions {
  /** Pointer and keys move it. Default true. */
  interactive?: boolean;
  /**
   * While the canvas has the focus, arrow keys turn, `+` and `-` zoom, Home starts over. Default true; a canvas without a `tabindex`
   * gets one.
   */
  keys?: boolean;
  /**
   * The canvas is a part of a page that scrolls: a vertical swipe scrolls the page, and so does the wheel until the canvas has the
   * focus. Default true; false where the picture is the page.
   */
  embedded?: boolean;
  /** Turns slowly, unless the person prefers less motion. Default false. */
  autoRotate?: boolean;
  /** Default `'auto'`: what the data say; z of maps and of what is wide and flat; else y. */
  up?: Axis | [number, number, number] | 'auto';
  colors?: Partial<LayerColors>;
  insets?: Partial<Insets>;
}

/** How values are read from colours: low and high are the values at the ends of the colour map. */
export interface Scale {
  title: string;
  note: string;
  low: number;
  high: number;
  /** A value with its unit, in words. */
  words: (value: number) => string;
}

/** What a few colours mean: CSS colours and names. */
export interface Kinds {
  title: string;
  note: string;
  kinds: [color: string, name: string][];
}

/** The colours of a layer. */
export interface Paint {
  /** sRGB, one triple a point or vertex; null for the viewer's. */
  colors: Uint8Array | null;
  /** How they are read. What has a legend is shaded less, so that its colours can be compared. */
  legend: Scale | Kinds | null;
}

/** How a tileset is streamed. */
export interface StreamOptions {
  /**
   * Bytes of points, triangles and pictures that are held at most, at least 1 MiB. Default 268,435,456 (256 MiB). Where what is seen would
   * need more, it is coarser.
   */
  budget?: number;
  /**
   * The error that tiles may have on the screen, in CSS pixels, above 0: less shows more. The default is 2 for points and 6 for meshes of
   * `pointweave tiles`, whose error is the distance between points; 16 for other tilesets, as they are mostly made for.
   */
  errorTarget?: number;
  signal?: AbortSignal;
  /** Share of the way to the first picture, 0 to 1. */
  onProgress?: (share: number) => void;
}

/** What is shown and held of a tileset. */
export interface StreamState {
  /** In the picture. */
  points: number;
  triangles: number;
  /** Tiles in the picture. */
  tiles: number;
  /** Points of the finest level, where the tileset says so. */
  total: number | null;
  /** Of points, triangles and pictures in memory; the graphics card holds those again that were in a picture. */
  bytes: number;
  budget: number;
  /** Tiles in memory. */
  held: number;
  /** Tiles under way. */
  loading: number;
  /** Tiles that did not load, after three tries; what they are parts of is shown instead. */
  failed: number;
  /** The error on the screen now, in CSS pixels: larger than was asked for where there is no room. */
  error: number;
}

export interface ViewerEventMap {
  /** What streams is shown with other tiles, or something came or went; once a picture. `streamed` says what. */
  stream: Event;
  /** The picture was drawn. */
  draw: Event;
  /** The camera has moved; once a frame. */
  move: CustomEvent<{ by: Mover }>;
  /** The browser has taken WebGL away. The picture stays. */
  contextlost: Event;
  /** WebGL is there again, and the picture is drawn anew. */
  contextrestored: Event;
}

/** A canvas with layers. All viewers of a page share one WebGL context, and draw only when something changed and they are seen. */
export interface Viewer extends EventTarget {
  /**
   * Shows a cloud, a mesh or a GLB alone, whole, from the first look: as the layer `'points'` or `'mesh'`, of a GLB as both where it
   * holds both. What else is set later is placed beside it, in world coordinates.
   * Throws `bad-input`, `bad-length`, `bad-index` or `empty-cloud` where the arrays do not fit, and so does `set`.
   * @param options frame: what to fit, where it is known; default is the box of what is shown
   */
  show(what: Drawable | Model, options?: { frame?: Frame }): void;
  /**
   * Streams a tileset (OGC 3D Tiles 1.0 or 1.1) instead of what is shown: tiles come and go with the camera, as the layer `'points'` or
   * `'mesh'`, with at most 200 draw calls a picture. Coordinates are those of the tileset, exact in double precision, and z is up unless
   * `up` says otherwise. Resolves when there is something to see, which is asked for at once. It needs 3d-tiles-renderer (an optional peer
   * of the package). Indices that `pick` and `pickPoint` give are of what is shown now. `paint`, `showEdges` and `shadow` leave it alone.
   * Rejects with `missing-package`, `load-failed`, `bad-file`, `unsupported-file` or `bad-input`, and as an abort where something else is
   * shown meanwhile.
   */
  stream(url: string, options?: StreamOptions): Promise<void>;
  /** What is shown and held of a tileset; null where none is streamed. */
  readonly streamed: StreamState | null;
  /** Adds or replaces a layer, of at most 31; null removes it. What would be cut off is fitted in, unless somebody has looked around. */
  set(layer: string, what: Drawable | null): void;
  has(layer: string): boolean;
  readonly layers: string[];
  /** Points or vertices, and triangles, of a layer. */
  size(layer: string): { points: number; triangles: number };
  /** The layer that is seen, or two that meet at a divider. */
  view: string | Split;
  /** Colours a layer; those of a GLB keep their own. */
  paint(layer: string, paint: Paint): void;
  /** Draws the edges of triangles over meshes. Default no. */
  showEdges(shown: boolean): void;
  /** Draws boxes over every layer, by their lowest and highest corners; null for none. */
  showBoxes(corners: Placed | null): void;
  /** Assigning changes those that are given. */
  get colors(): LayerColors;
  set colors(colors: Partial<LayerColors>);
  /** Assigning changes those that are given. */
  get insets(): Insets;
  set insets(insets: Partial<Insets>);
  /** Assigning stands what is shown on that side, and fits it. */
  up: Axis | [number, number, number] | 'auto';
  /** What is up now, also where `up` is `'auto'`; of a direction the nearest axis. */
  readonly upright: Axis;
  interactive: boolean;
  /** Whether pointer and wheel come nearer, and move aside, where it is interactive. Default true. */
  zoomable: boolean;
  pannable: boolean;
  autoRotate: boolean;
  /** Milliseconds that it rests after a hand was on it. Default 3000. */
  autoRotateDelay: number;
  /** Where `home` goes; assigning goes there. */
  firstLook: FirstLook;
  /** How far one may go. */
  limits: Limits;
  readonly stance: Stance;
  /** What lights the materials of a GLB: a neutral studio (default), or a `Texture` of three.js, equirectangular. */
  surroundings: object | 'neutral';
  /** Of these materials, 1 as it is. */
  exposure: number;
  /** Of the shadow on the ground under meshes, 0 (default) to 1. */
  shadow: number;
  /** Edge lengths of the box of what is shown; null for nothing. */
  readonly dimensions: [number, number, number] | null;
  /**
   * Where a position of the data is on the canvas, in CSS pixels from its top left, and whether it can be seen: before the camera, and its
   * normal, where there is one, towards it. What stands before it is not looked for.
   */
  project(position: [number, number, number], normal?: [number, number, number]): { x: number; y: number; visible: boolean };
  /**
   * Draws only what is on the side of a plane that its normal points into, of every layer; `pick` and `pickPoint` find nothing else. It stays
   * where it is in the data when something else is shown. Default null: all. Throws `bad-input`.
   */
  section: Section | null;
  /** Parallel projection instead of perspective. Default false. */
  parallel: boolean;
  /** Points are drawn this many times as large as they are of themselves. Default 1. */
  pointSize: number;
  readonly pose: Pose;
  /** Turns around what is shown, in radians. */
  turn(right: number, over: number): void;
  /** Under 1 comes nearer. */
  zoom(factor: number): void;
  /** Back to the first look. */
  home(): void;
  /** Along the line of sight to where all is seen. */
  fit(): void;
  /** Turns around this place from now on, which comes to the middle, as far away as before; `fit` and `home` go back to the whole. */
  pivot(position: [number, number, number]): void;
  /** Straight at a side, in parallel projection. */
  lookFrom(side: Side): void;
  /**
   * The mesh that is seen at a place of the canvas, in CSS pixels from its top left, which of its triangles, where, and the unit normal of
   * the plane around that, towards the viewer, in the coordinates of the data; null for none. Costs a pass over the triangles.
   */
  pick(x: number, y: number): { layer: string; triangle: number; position: [number, number, number]; normal: [number, number, number] } | null;
  /**
   * The point of a cloud that is seen at a place of the canvas, in CSS pixels from its top left: its index in the layer and where it is; null
   * where none is within `reach` pixels (default 12). Costs a pass over the points.
   */
  pickPoint(x: number, y: number, reach?: number): { layer: string; index: number; position: [number, number, number] } | null;
  /**
   * The product of projection and view as 16 numbers by columns, as the step `polygon` of a recipe takes it: of positions in the
   * coordinates of the data, or of those that are counted from `origin`.
   */
  sight(origin?: [number, number, number]): number[];
  /** Draws at once; else it is drawn before the next frame. */
  draw(): void;
  /** The picture as it is shown, without background. Types and quality as `canvas.toBlob`. */
  toBlob(type?: string, quality?: number): Promise<Blob | null>;
  /** Removes all layers and boxes. */
  clear(): void;
  /** Frees the GPU and stops listening, as for a canvas that leaves the page; layers are kept. */
  suspend(): void;
  resume(): void;
  /** Ends it: layers are removed, nothing listens. */
  dispose(): void;

  addEventListener<Type extends keyof ViewerEventMap>(
    type: Type, listener: (this: Viewer, event: ViewerEventMap[Type]) => unknown, options?: boolean | AddEventListenerOptions): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
}

/**
 * A viewer for a canvas, which must not have a context of another kind than `'2d'`. Its pixels follow its size in the page; one
 * that is in no page keeps the pixels that it has. Throws `no-webgl` where there is no WebGL 2, and
 * `bad-input` for what is no such canvas.
 */
export function createViewer(canvas: HTMLCanvasElement, options?: ViewerOptions): Viewer;

/**
 * Reads a GLB for {@link Viewer.show}: textures, vertex colours, points and meshes, `EXT_meshopt_compression`. Rejects with
 * `bad-file`, `empty-cloud`, or `unsupported-file` where it needs Draco or Basis.
 */
export function readGlb(bytes: Uint8Array): Promise<Model>;

/** The box of all finite coordinates. */
export function frameOf(what: Placed): Frame;

/**
 * What colours can show: the scan's own, none, the direction of the surface, the distance between neighbours, the distance between
 * scan and mesh, and sharp places.
 */
export type PaintName = 'natural' | 'plain' | 'normals' | 'density' | 'error' | 'sharp';

/** In the order of a menu. */
export const PAINTS: readonly PaintName[];

/** What paints are made from. */
export interface Subject {
  cloud: PointCloud;
  /** For `'error'` and for what input points take from it: computed with `assignment: true`. */
  reduced?: ReducedCloud | null;
  /** For `'error'`, computed with `distances: true`. */
  mesh?: SurfaceMesh | null;
  /** Another mesh of the same cloud, to be compared: the scale of `'error'` suits both. */
  beside?: SurfaceMesh | null;
  /** Of the cloud, where it is known. */
  frame?: Frame;
}

/** Whether there is something to paint. */
export function canPaint(name: PaintName, subject: Subject): boolean;

/** The colours of a layer and how they are read. What is not possible is painted as `'natural'`. Cost: one pass over the points. */
export function paintOf(name: PaintName, layer: 'points' | 'reduced' | 'mesh', subject: Subject, words?: PaintWords): Paint;

/** Every word of paints and legends. */
export interface PaintWords {
  names: Record<PaintName, string>;
  /** A note may say the scan's unit, where it is known. */
  density: { title: string; note: string | ((unit?: Unit) => string) };
  error: { titles: Record<'points' | 'reduced' | 'mesh', string>; note: string | ((unit?: Unit) => string); unknown: string };
  sharp: { title: string; sharp: string; smooth: string; note: (share: string, layer: 'points' | 'reduced' | 'mesh') => string };
  /** A length in the scan's unit. */
  length: (value: number) => string;
  /** A share, as a percentage. */
  percent: (share: number) => string;
}

/** The words in English. */
export const PAINT_WORDS: PaintWords;

/** The sRGB bytes of the colour map at a share of the way from the least to the greatest. */
export function colorAt(share: number): [red: number, green: number, blue: number];

/** The whole map as a CSS gradient to the right. */
export function cssGradient(): string;
