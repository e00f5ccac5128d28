/** Recipes: what is cut from a scan before it is reduced. Plain data, so that one can be saved, shared and used again. */

import type { PointCloud } from './types.js';

/**
 * One step, which looks at what those before it left. Lengths and places are in the frame and unit of the cloud's positions; `keep` of
 * a region, by default `true`, keeps what is inside, `false` drops it. A step that would leave no point is the error `bad-option`.
 */
export type Step =
  /**
   * Brings several clouds, each in a frame of its own, into the frame of the first that is placed, and evens their colours out. Clouds that
   * fit as they lie stay. One that fits no other is dropped; the report says why. It is the first step of a recipe for an array of clouds.
   */
  | { step: 'register' }
  /** Drops isolated points: stray returns, and clumps of up to eight far from the rest. */
  | { step: 'outliers' }
  /** Drops flying pixels: points beside a surface, and, where the cloud has viewpoints, between two on one line of sight. */
  | { step: 'flying' }
  /**
   * Drops planes: the floor (default), all that carry what was scanned (`'all'`: floors, tables, walls), none (to look at them), or
   * those of these numbers in the report. `behind`: with what is behind them; default `true` of `'floor'` and `'all'`. `minShare`:
   * least share of the scan's area that a plane has, above 0 to 1, default 0.05. `seed` of the search, default 0.
   */
  | { step: 'plane'; drop?: 'floor' | 'all' | 'none' | number[]; behind?: boolean; minShare?: number; seed?: number }
  /**
   * Keeps connected pieces: the largest (default), all (to look at them), so many of the largest, those with a share of the points, or
   * those of these numbers in the report. `gap`: how far apart points of one piece may be, in spacings, above 0 to 100, default 3.
   */
  | { step: 'pieces'; keep?: 'largest' | 'all' | number | { minShare: number } | number[]; gap?: number }
  /** A box; `turn` is a quaternion x y z w about its middle. */
  | { step: 'box'; min: [number, number, number]; max: [number, number, number]; turn?: [number, number, number, number]; keep?: boolean }
  | { step: 'sphere'; center: [number, number, number]; radius: number; keep?: boolean }
  /** The side of a plane that its normal points into. */
  | { step: 'half-space'; point: [number, number, number]; normal: [number, number, number]; keep?: boolean }
  /**
   * What a camera sees inside of a polygon, however far behind it: corners as x y x y … from -1 to 1, and the product of projection and view
   * as 16 numbers by columns, as WebGL has it.
   */
  | { step: 'polygon'; points: number[]; camera: number[]; keep?: boolean };

/** The option `prepare` of `reduce` and `reconstruct`. */
export interface PrepareOption {
  /** A recipe that is done first. Fractions are then of the diagonal of what is left. */
  prepare?: Step[];
}

/** What a recipe leaves of a cloud. */
export interface Prepared<Positions extends Float32Array | Float64Array = Float32Array | Float64Array> {
  /** The points that are left, with all that is theirs. */
  cloud: PointCloud<Positions>;
  /** Their indices in the cloud that was given, ascending. */
  kept: Uint32Array;
  /** For each point that was given 0, or the number of the step, from 1, that dropped it. */
  labels: Uint8Array;
  steps: StepReport[];
}

/** What a step did and saw. Lengths are in the cloud's unit. */
export interface StepReport {
  step: Step['step'];
  /** Points that are left after it. */
  kept: number;
  /** Points that it dropped. */
  dropped: number;
  /** Of `plane`: the planes, the largest first. */
  planes?: PlaneReport[];
  /** Of `pieces`: the hundred largest. */
  pieces?: PieceReport[];
  /** Of `pieces`: how many there are. */
  count?: number;
  /** Of `plane` and `pieces`, for each point that was given: the number of its plane or piece, or 0xffffffff. */
  labels?: Uint32Array;
  /** Of `register`: what became of each cloud, in their order. */
  scans?: ScanReport[];
  /** Of `register`: the pairs of placed clouds that overlap. */
  pairs?: PairReport[];
  /** Why it did less than a person may expect; else empty. */
  reason: string;
  ms: number;
}

/** What a step tells of a part of a scan. */
export interface PartReport {
  points: number;
  /** Of the points that the step found. */
  share: number;
}

/** A plane of a scan. */
export interface PlaneReport extends PartReport {
  /** Middle of its points. */
  point: [number, number, number];
  /** Unit, to the side that was seen or that most of the scan is on. */
  normal: [number, number, number];
  /** Standard deviation of its points across it. */
  spread: number;
  /** That its points stand for. */
  area: number;
  /** It is what `drop: 'floor'` drops. */
  floor: boolean;
  /** It is among those that `drop: 'all'` drops. */
  carries: boolean;
  /** This step dropped it. */
  dropped: boolean;
}

/** A piece of a scan. */
export interface PieceReport extends PartReport {
  /** Corners of its box. */
  min: [number, number, number];
  max: [number, number, number];
  kept: boolean;
}

/** What became of a cloud that was to be registered. */
export interface ScanReport {
  points: number;
  /** Its points are in the result. */
  placed: boolean;
  /**
   * From its own frame to that of the first placed cloud, as 16 numbers by columns; none where it is left out. Where the clouds' origins
   * differ, both are told from the first cloud's.
   */
  pose?: number[];
  /** What its red, green and blue were multiplied by; none where nothing told. */
  gain?: [number, number, number];
  /** Why it is left out; else empty. */
  reason: string;
}

/** How two placed clouds lie on each other. */
export interface PairReport {
  /** Their numbers in the array, from 0. */
  scans: [number, number];
  /** Share of a cloud's surface that lies on the other: that of the cloud of which it is more. */
  overlap: number;
  /** Root of the mean square of their distances across the surface, in the clouds' unit. */
  rms: number;
  /** The pair alone would be enough to trust its place. */
  trusted: boolean;
}
