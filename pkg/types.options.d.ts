// Written by `cargo xtask build` from src/base/params/table.rs: change an option there.
import type { ReducedCloud, SurfaceMesh } from './types.js';

/** How much a reduction keeps: exactly one of them. */
export type Target =
  /** Share of the points. The count is rounded to the nearest integer, at least 1, and met exactly. In (0, 1]. */
  | { ratio: number }
  /** Exactly this many points; more than there are means all of them. At least 1. */
  | { count: number }
  /**
   * The fewest points whose local surfaces have 99 % of the surface within this distance, a fraction of the diagonal. Takes
   * mostly two to six reductions, at most eleven. Noise hides surfaces finer than 1.5 times itself: the report's `reason`
   * then says what was taken. In (0, 1).
   */
  | { tolerance: number }
  /** The paper's λ: sub-domains whose surface variation is under it are reduced, the others keep their points. In (0, 1]. */
  | { flatness: number }
  /**
   * As many points as suit the scan and the device: a third, at least 2,000, and at most 60,000, on a phone 20,000. The same
   * scan can thus give two devices different results.
   */
  | 'auto';

/** How a scalar, or the colours, of the input points go to the reduced point that stands for them. */
export type Carry =
  /** The mean, weighted by membership: for measurements. */
  | 'mean'
  /** The value with the largest sum of memberships, of equals the smallest: for labels. A colour is one value. */
  | 'majority'
  /** The value of the nearest input point. */
  | 'nearest';

/** What decides which side is out. */
export type Orientation =
  /**
   * Everything that is known, as far as it holds when it is checked: the cloud's normals, its viewpoints, that it was seen
   * from above, a depth camera at the origin; then closed shapes look outward and sheets up.
   */
  | 'auto'
  /** The cloud's own normals, unchecked; the error `bad-option` where it has none. */
  | 'normals'
  /** The cloud's viewpoints: what was seen looks to where it was seen from. The error `bad-option` where it has none. */
  | 'viewpoints'
  /** Along the cloud's up axis, z where it has none. */
  | 'up'
  /** Away from the inside of what the surface encloses: objects. */
  | 'outward'
  /** Into it: rooms. */
  | 'inward';

/** Options of a reduction. */
export interface ReduceOptions {
  /** How much to keep. Default `{ ratio: 1/3 }`. */
  target?: Target;
  /**
   * Which reduction.
   * - `'adaptive'` (default): Weighted clusters, density by curvature, centres placed on the surface.
   * - `'paper'`: Sections 3.1-3.2 of the paper to the letter.
   */
  method?: 'adaptive' | 'paper';
  /** m of eq. 1-5 (the paper also writes s). In (1, 100]. Default 1.5 (`'adaptive'`), 2 (`'paper'`). */
  fuzzifier?: number;
  /**
   * ε of eq. 6. `'paper'` stops when no membership changes by more; `'adaptive'` when no centre moves by more than this
   * share of the wanted spacing. In (0, 1]. Default 1e-2 (`'adaptive'`), 1e-3 (`'paper'`).
   */
  epsilon?: number;
  /** At most this many iterations of steps (b) and (c). 1 to 100000. Default 5 (`'adaptive'`), 100 (`'paper'`). */
  maxIterations?: number;
  /**
   * The norm-inducing matrix A of eq. 1. Used by `'paper'`; `'adaptive'` has a matrix of its own for each point.
   * - `'euclidean'` (default): A = I (eq. 8).
   * - `'diagonal'`: A = diag(1/σx², 1/σy², 1/σz²) of the sub-domain.
   * - `'mahalanobis'`: A = the inverse covariance of the sub-domain.
   */
  norm?: 'euclidean' | 'diagonal' | 'mahalanobis';
  /**
   * How the number of clusters c of a sub-domain is chosen.
   * - `'proportional'` (default): In proportion to the target.
   * - `'validity'`: The best validity index (eq. 7) near the proportional number.
   */
  clusters?: 'proportional' | 'validity';
  /**
   * Concentration of the points: 0 is even spacing, 1 the strongest concentration on curved regions. In [0, 1]. Default 0.5.
   */
  curvatureWeight?: number;
  /**
   * Where a centre goes. `'paper'` takes its raw centres whatever stands here, unless it is `'sample'`.
   * - `'implicit'` (default): On the surface: best for implicit fits.
   * - `'mesh'`: Slightly outside of curved parts and on creases: best for triangles between the points.
   * - `'center'`: The raw cluster centre (eq. 2).
   * - `'sample'`: The nearest input point.
   */
  placement?: 'implicit' | 'mesh' | 'center' | 'sample';
  /** Seed of the random memberships of step (a), which `'paper'` starts from. At least 0. Default 0. */
  seed?: number;
  /** Most points of a sub-domain. 8 to 65536. Default: follows the target, 64 to 512 (`'adaptive'`), 256 (`'paper'`). */
  cellPoints?: number;
  /** Deepest level of the octree. 1 to 21. Default 21. */
  maxDepth?: number;
  /**
   * How the cloud's attributes are carried to the reduced points and on to a mesh, by name; `colors` names the colours. One
   * that is not named is `'mean'`. Default `{}`.
   */
  attributes?: Record<string, Carry>;
  /** Say of every input point which reduced point it belongs to most: {@link ReducedCloud.assignment}. Default `false`. */
  assignment?: boolean;
  /** Say where the sub-domains of the octree are: {@link ReducedCloud.cells}. Default `false`. */
  cells?: boolean;
  /**
   * What becomes of isolated input points: stray returns, and clumps of up to eight far from the rest.
   * - `'keep'` (default): They are points like all others.
   * - `'drop'`: They are left out, unless they are more than half of all; fractions are then of the diagonal of the others.
   */
  outliers?: 'keep' | 'drop';
}

/** Options of a reconstruction. */
export interface ReconstructOptions {
  /**
   * How the cloud is reduced first. Without a reduction every point goes to the fit, and attributes are means on the mesh.
   * `false` is no reduction. Default {@link ReduceOptions}' defaults.
   */
  reduce?: ReduceOptions | false;
  /**
   * Largest rms residual of a sub-domain at its input points, a fraction of the diagonal. The default is the paper's. In
   * (0, 1). Default 6e-4.
   */
  accuracy?: number;
  /**
   * φ of eq. 9.
   * - `'triharmonic'` (default): φ(r) = r³, the triharmonic spline of 3D.
   * - `'biharmonic'`: φ(r) = r, the biharmonic spline of 3D.
   * - `'thin-plate'`: φ(r) = r² log r, the paper's thin plate.
   */
  kernel?: 'triharmonic' | 'biharmonic' | 'thin-plate';
  /**
   * How much the local fits smooth.
   * - `'auto'` (default): Follows the measured noise; none where there is none.
   * - a number: The ridge on the diagonal of eq. 11, in units of φ at the sub-domain's spacing. In [0, 1000000].
   */
  smoothing?: number | 'auto';
  /** Infer which side is out; `false` takes the cloud's own normals as they are. Default `true`. */
  orient?: boolean;
  /**
   * What decides which side is out. `propagation: 'paper'` and `orient: false` have their own rules. The report's
   * `orientation` says what did decide. Default `'auto'`.
   */
  orientation?: Orientation;
  /** Turn the whole result to its other side in the end. Default `false`. */
  flip?: boolean;
  /**
   * Which inference chooses the signs of the local functions.
   * - `'global'` (default): The signs of least energy over the whole graph, and every part by what is known of its outer
   *   side.
   * - `'paper'`: Algorithm 1: an advancing front with belief propagation on local graphs.
   */
  propagation?: 'global' | 'paper';
  /**
   * Edge length of the extraction grid.
   * - `'auto'` (default): Three quarters of the median spacing of the fitted points; then edges are collapsed where the
   *   surface is flat until at most three triangles a fitted point are left.
   * - a number: Fraction of the diagonal. The mesh is as dense as the grid everywhere. In [0.0001, 0.25].
   */
  resolution?: number | 'auto';
  /**
   * The mesh has at most so many triangles, at least 98 % of them, and of the same topology: edges are collapsed by what
   * that costs. The report's `simplified` says how far the mesh is then from what it was. At least 1. Default: as many as
   * the points need.
   */
  triangles?: number;
  /** Keep creases in the mesh. Default `true`. */
  sharp?: boolean;
  /**
   * Take the grain that noise left out of the mesh. No vertex moves farther than twice the noise of the fitted points;
   * creases stay, and so does relief that is more than noise. Default `true`.
   */
  fairing?: boolean;
  /**
   * What happens where there were no points.
   * - `'auto'` (default): Holes up to `maxHole` are closed, open sheets stay open.
   * - `'closed'`: As `'open'`, and every rim is capped by a membrane, which is flat where the rim is.
   * - `'base'`: As `'closed'`, and where the surface stands on the floor it goes straight down to it and ends in a flat
   *   base, for a 3D print. The floor is the cloud's `floor`, which a step `plane` of `prepare` leaves; without it the
   *   lowest place, across `'up'` (z without).
   * - `'open'`: The surface ends where the points end.
   */
  boundary?: 'auto' | 'closed' | 'base' | 'open';
  /**
   * Widest hole that is closed. With `boundary: 'auto'`, the widest hole that is closed. The report's `holes` lists them.
   * - `'auto'` (default): A tenth of the diagonal; a fifth where the surface goes on smoothly across the hole.
   * - a number: Fraction of the diagonal. A hole is as wide as the largest disc in it; gaps of the sampling, up to four
   *   spacings wide, are closed anyway. In [0, 1].
   */
  maxHole?: number | 'auto';
  /**
   * What becomes of points through which there is no surface: foliage, dust, filled volumes.
   * - `'drop'` (default): The mesh has none of them. They stay in the reduced cloud, without a side, and the report's
   *   `scatter` counts them.
   * - `'keep'`: They are points of the surface like all others.
   */
  scatter?: 'drop' | 'keep';
  /**
   * Say of every input point and every vertex how far scan and mesh are apart there: {@link SurfaceMesh.distances}. Default
   * `false`.
   */
  distances?: boolean;
  /**
   * Remember what was measured of this cloud, and its reduction: the next call with `keep` does not do again what would come
   * out the same, and has no time for it in its report. The bytes are the same. Takes about 100 bytes a point until a call
   * without it or another cloud. In Rust the caller holds the memory (`pipeline::reconstruct_again`); in JavaScript the
   * engine's worker does: an abort keeps what was done before it where memory can be shared, and forgets all elsewhere.
   * Default `false`.
   */
  keep?: boolean;
}
