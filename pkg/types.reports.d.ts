/** What every result says of itself. Lengths are fractions of the diagonal of the input's bounding box. */
import type { Build, Stage } from './types.js';

/** Distances as fractions. */
export interface Distances {
  mean: number;
  rms: number;
  max: number;
}

/** Something about a result that may not be as it should. */
export interface Doubt {
  /** Stable and meant for programs: {@link DoubtCode}, and more with time. */
  code: DoubtCode | (string & {});
  /** A sentence. */
  message: string;
  /** The share of the surface that it is about, 0 to 1, where that is known. */
  share?: number;
}

export type DoubtCode =
  /** Nothing says which side is out. */
  | 'side-guessed'
  /** Two things that are known of the cloud say different sides. */
  | 'sources-disagree'
  /** A region looks away from where it was seen from. */
  | 'contradicts-sensor'
  /** A large part hangs on little, and may be the wrong way round. */
  | 'weak-tie'
  /** The mesh is not close to the points: too few of them, or some lie far from the rest. */
  | 'far-from-points'
  /** The coordinates were rounded to steps coarser than the points are apart. */
  | 'steps'
  /** x and y look like degrees and z like metres. */
  | 'degrees-as-lengths'
  /** Points are on scan lines much farther apart than the points of a line. */
  | 'lines'
  /** The file is a mesh: points were taken from its faces. */
  | 'sampled-from-faces'
  /** Points lie as in foliage, dust or a filled volume, with no surface through them. */
  | 'scatter'
  /** Walls are about as thin as the points are apart, or as the noise. */
  | 'thin'
  /** A part of the area is far from any point. */
  | 'far-area'
  /** The surface has many tunnels. */
  | 'tunnels'
  /** Triangles cross others. */
  | 'self-intersections'
  /** Pieces too small to be a surface were left out. */
  | 'islands-dropped';

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
  /** What may not be as it should; empty for what is clear. */
  doubts: Doubt[];
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

export interface SurfaceReport extends ReduceReport {
  triangles: number;
  components: number;
  boundaryEdges: number;
  nonManifoldEdges: number;
  /** One number a closed component. */
  genus: number[];
  /** Holes that were closed and rims that were left open, the widest first. */
  holes: Hole[];
  /** Triangles that cross others, after what could be mended was. */
  selfIntersections: number;
  /** Input points that the mesh leaves out, as there is no surface through them: foliage, dust, filled volumes. */
  scatter: number;
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
  /** What decided which side is out. */
  orientation: OrientationReport;
  /**
   * With `triangles`, what that cost. Counts above are then of the mesh that is left. `distance` is of the surface before: with
   * `simplified.error` added, it bounds that of the mesh.
   */
  simplified?: LightReport;
}

/** What fewer triangles cost. */
export interface LightReport {
  /** Triangles that there were. */
  from: number;
  /** Triangles that are left. */
  triangles: number;
  /** Between both meshes, fractions of the diagonal: measured from the vertices and the middles of the triangles of each to the other. */
  error: Distances;
  components: number;
  boundaryEdges: number;
  nonManifoldEdges: number;
  /** One number a component. */
  genus: number[];
  /** Triangles that cross others. */
  selfIntersections: number;
  /** Why there are more triangles than were asked for; empty where there are not. */
  reason: string;
}

/** A hole of a surface, or the outer rim of an open one. */
export interface Hole {
  /**
   * Fraction of the diagonal. Of a hole that was closed, the diameter of the largest disc in it; of a rim, that of the disc whose
   * area it encloses.
   */
  diameter: number;
  /** Whether the surface goes on across it. */
  closed: boolean;
}

/** What decided which side is out. Shares are of the surface, 0 to 1. */
export interface OrientationReport {
  /** Every source that said anything, and how far the result agrees with it; the shares add up to 1. */
  sources: {
    source: OrientationSource;
    /** Of what it decided. */
    share: number;
    /** Of that about which it says anything, the share where the result agrees. */
    agreement: number;
  }[];
  /** Share whose side is a guess. */
  guessed: number;
  /** The part with over 1 % of the surface that hangs on the least. */
  weakestTie?: {
    /** Share that would turn. */
    share: number;
    /** What holds it to the others, by its size: parts of one smooth sheet have 1.5 and more. */
    strength: number;
  };
}

export type OrientationSource =
  /** The cloud's own normals. */
  | 'normals'
  | 'viewpoints'
  /** That it was seen from above. */
  | 'above'
  /** That it looks as a depth camera at 0 0 0 sees. */
  | 'camera'
  /** That it encloses something. */
  | 'shell'
  /** The option, or the rule for sheets, that up is out. */
  | 'up'
  /** Nothing. */
  | 'guess';
