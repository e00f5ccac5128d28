//! Fuzzy c-means in one sub-domain: paper sections 3.1-3.2, equations 1-8.
//!
//! Names follow the paper. `x_k` (k < n) are the points, `v_i` (i < c) the centres, `μ_ki` the membership of
//! point k in cluster i, `m` the fuzzifier (the paper's `s` of eq. 1), `A` the norm-inducing matrix. A weight
//! `w_k` may multiply each point's terms; all ones is the paper's case.
//!
//! How the printed text is read:
//! - eq. 5 is printed without its sum index: `μ_ki = 1 / Σ_j (d_ki / d_kj)^(2/(m-1))`;
//! - where several centres coincide with a point (the set `I_k` of eq. 3 has more than one member) eq. 5 asks only
//!   that their memberships add up to 1: they share it equally;
//! - section 3.2 gives ε = 0.001 twice; the second is meant to be 0.01, which "works well in most cases" (the
//!   sentence is Babuška's, whose text the section follows).
//!
//! The norm costs nothing: with `A = B Bᵀ` the coordinates are multiplied by `Bᵀ` once, after which every distance is
//! Euclidean. Memberships are formed from `(d_min / d_i)²`, at most 1, so that no exponent and no distance overflows.
//!
//! Cost: one sweep touches every pair of point and centre once, and both updates U (eq. 5) and gathers the sums of
//! the next centres (eq. 2). Lanes run over points.

use glam::{DVec3, Vec3};
use wide::f64x4;

use crate::base::linalg::sym_eigen;
use crate::base::params::Norm;
use crate::base::power::{Fuzzifier, Power};
use crate::base::rng::Rng;

/// Points handled side by side by the inner loops.
const LANES: usize = 4;

/// Smallest variance along an axis, as a share of the largest, that the diagonal and Mahalanobis norms divide by.
/// A flat cell has almost none along its normal, where only noise would be stretched. 1e-4 lets one axis weigh at
/// most a hundred times another, in length.
const MIN_VARIANCE_SHARE: f64 = 1e-4;

/// What stops the iteration, and how fuzzy it is.
#[derive(Clone, Copy, Debug)]
pub struct FcmParams {
    /// Fuzzifier `m` > 1 (eq. 1-5).
    pub fuzzifier: f64,
    /// ε of eq. 6: stop when no membership changed by more.
    pub epsilon: f64,
    /// Sweeps at most.
    pub max_iterations: usize,
}

/// Where the iteration begins.
#[derive(Clone, Copy, Debug)]
pub enum Start<'a> {
    /// Step (a): `clusters` rows of random memberships, normalised for each point.
    Random {
        /// c, at least 1.
        clusters: usize,
        /// Same seed, same memberships.
        seed: u64,
    },
    /// U(0), row by row: `memberships[i * n + k]`.
    Memberships(&'a [f64]),
    /// The centres of the first sweep.
    Centers(&'a [DVec3]),
}

/// What one run found.
#[derive(Clone, Debug)]
pub struct Prototypes {
    /// `v_i`, in the frame of the points.
    pub centers: Vec<DVec3>,
    /// Objective `J` (eq. 1) of the final memberships and centres, in the norm that was used.
    pub objective: f64,
    /// Validity index χ (eq. 7); infinite where it is not defined: one cluster, or two centres at one place.
    pub validity: f64,
    /// Sweeps done.
    pub iterations: usize,
    /// `‖U(t) - U(t-1)‖` of the last sweep (eq. 6).
    pub change: f64,
}

/// The points of one sub-domain and everything a run needs; reused from cell to cell.
#[derive(Clone, Debug, Default)]
pub struct Fcm {
    points: usize,
    /// Coordinates after the norm's transform, and weights, padded to whole lanes with weight 0.
    x: [Vec<f64>; 3],
    weight: Vec<f64>,
    /// The points' mean, subtracted before the transform.
    origin: DVec3,
    /// Columns of B⁻ᵀ: back from transformed coordinates.
    back: [DVec3; 3],
    /// Centres in transformed coordinates.
    centers: Vec<DVec3>,
    /// Memberships, row i of `stride()` points after row i-1.
    u: Vec<f64>,
    /// Σ w u^m and Σ w u^m x of each centre, a lane each.
    sums: Vec<[f64x4; 4]>,
    /// One block's squared distances to, then its shares in, every centre.
    distance: Vec<f64x4>,
    share: Vec<f64x4>,
}

impl Fcm {
    /// Takes the points (`weights` empty: all 1) and applies the norm.
    pub fn load(&mut self, points: &[Vec3], weights: &[f32], norm: Norm) {
        let n = points.len();
        let padded = n.div_ceil(LANES) * LANES;
        self.points = n;
        self.weight.clear();
        if weights.is_empty() {
            self.weight.resize(n, 1.0);
        } else {
            self.weight.extend(weights.iter().map(|&w| f64::from(w)));
        }
        self.weight.resize(padded, 0.0);

        let sum: DVec3 = points.iter().map(|p| p.as_dvec3()).sum();
        self.origin = sum / n.max(1) as f64;
        let (forward, back) = norm_transform(norm, points, self.origin);
        self.back = back;
        for (axis, x) in self.x.iter_mut().enumerate() {
            x.clear();
            x.extend(
                points
                    .iter()
                    .map(|p| forward[axis].dot(p.as_dvec3() - self.origin)),
            );
            x.resize(padded, 0.0);
        }
    }

    /// Runs eq. 2 and eq. 5 in turn until eq. 6 holds.
    pub fn run(&mut self, start: Start, params: &FcmParams) -> Prototypes {
        self.begin(start, params.fuzzifier);
        match Fuzzifier::new(params.fuzzifier) {
            Fuzzifier::Two(power) => self.iterate(power, params),
            Fuzzifier::ThreeHalves(power) => self.iterate(power, params),
            Fuzzifier::FiveQuarters(power) => self.iterate(power, params),
            Fuzzifier::Any(power) => self.iterate(power, params),
        }
    }

    /// `μ_ki` of the last run for centre `i`, a value a point.
    pub fn memberships(&self, i: usize) -> &[f64] {
        &self.u[i * self.stride()..][..self.points]
    }

    fn stride(&self) -> usize {
        self.weight.len()
    }

    /// Step (a), and the first centres.
    fn begin(&mut self, start: Start, m: f64) {
        let (n, stride) = (self.points, self.stride());
        let clusters = match start {
            Start::Random { clusters, .. } => clusters,
            Start::Memberships(u) => u.len() / n.max(1),
            Start::Centers(centers) => centers.len(),
        };
        self.u.clear();
        self.u.resize(clusters * stride, 0.0);
        self.sums.resize(clusters, [f64x4::ZERO; 4]);
        self.distance.resize(clusters, f64x4::ZERO);
        self.share.resize(clusters, f64x4::ZERO);
        self.centers.clear();
        match start {
            Start::Centers(centers) => {
                let forward = invert(&self.back);
                let transform = |v: &DVec3| {
                    let v = *v - self.origin;
                    DVec3::new(forward[0].dot(v), forward[1].dot(v), forward[2].dot(v))
                };
                self.centers.extend(centers.iter().map(transform));
                return;
            }
            Start::Memberships(u) => {
                for i in 0..clusters {
                    self.u[i * stride..][..n].copy_from_slice(&u[i * n..][..n]);
                }
            }
            Start::Random { seed, .. } => {
                let mut rng = Rng::new(seed);
                for k in 0..n {
                    let mut total = 0.0;
                    for i in 0..clusters {
                        // Away from 0, so that a point's memberships can always be normalised.
                        let u = rng.uniform() + f64::EPSILON;
                        self.u[i * stride + k] = u;
                        total += u;
                    }
                    for i in 0..clusters {
                        self.u[i * stride + k] /= total;
                    }
                }
            }
        }
        self.centers.resize(clusters, DVec3::ZERO);
        let [x, y, z] = &self.x;
        for (i, center) in self.centers.iter_mut().enumerate() {
            let row = &self.u[i * stride..][..stride];
            let mut sums = [0.0; 4];
            for k in 0..n {
                let w = self.weight[k] * libm::pow(row[k], m);
                for (sum, term) in sums.iter_mut().zip([1.0, x[k], y[k], z[k]]) {
                    *sum += w * term;
                }
            }
            *center = weighted_mean(sums).unwrap_or(DVec3::ZERO);
        }
    }

    fn iterate<P: Power<f64x4>>(&mut self, power: P, params: &FcmParams) -> Prototypes {
        let mut iterations = 0;
        let mut change;
        loop {
            change = self.sweep(power);
            iterations += 1;
            if change < params.epsilon || iterations >= params.max_iterations {
                break;
            }
            self.update_centers();
        }
        let objective = self.objective(power);
        Prototypes {
            validity: validity(objective, &self.centers),
            centers: self.centers.iter().map(|&v| self.restore(v)).collect(),
            objective,
            iterations,
            change,
        }
    }

    /// One pass over all pairs: U from the centres (eq. 5) and the sums of eq. 2. Returns the change (eq. 6).
    fn sweep<P: Power<f64x4>>(&mut self, power: P) -> f64 {
        let stride = self.stride();
        self.sums.fill([f64x4::ZERO; 4]);
        let mut change = f64x4::ZERO;
        for block in (0..stride).step_by(LANES) {
            let [x, y, z] = [0, 1, 2].map(|axis| load(&self.x[axis][block..]));
            let weight = load(&self.weight[block..]);

            let mut nearest = f64x4::splat(f64::INFINITY);
            for (distance, v) in self.distance.iter_mut().zip(&self.centers) {
                let [dx, dy, dz] = [x - v.x, y - v.y, z - v.z];
                *distance = dx * dx + dy * dy + dz * dz;
                nearest = distance.fast_min(nearest);
            }
            let mut total = f64x4::ZERO;
            for (shares, distances) in self.share.chunks_mut(2).zip(self.distance.chunks(2)) {
                if let ([first, second], [a, b]) = (&mut *shares, distances) {
                    // One division for two; where a distance is 0 all shares are made again below.
                    let inverse = nearest / (*a * *b);
                    *first = power.share(*b * inverse);
                    *second = power.share(*a * inverse);
                    total += *first + *second;
                } else {
                    shares[0] = power.share(nearest / distances[0]);
                    total += shares[0];
                }
            }
            if nearest.simd_eq(f64x4::ZERO).any() {
                total = self.share_zero_distance(nearest, total);
            }
            let inverse = f64x4::ONE / total;
            let mut most = f64x4::ZERO;
            let rows = self.u.chunks_exact_mut(stride);
            for ((sums, share), row) in self.sums.iter_mut().zip(&self.share).zip(rows) {
                let u = *share * inverse;
                let row = &mut row[block..block + LANES];
                let moved = (u - load(row)).abs();
                most = moved.fast_max(most);
                row.copy_from_slice(&u.to_array());
                let w = weight * power.raise(u);
                for (sum, term) in sums.iter_mut().zip([w, w * x, w * y, w * z]) {
                    *sum += term;
                }
            }
            // Padding has weight 0 and no say in the change.
            let counted = f64x4::ZERO.simd_lt(weight) & change.simd_lt(most);
            change = counted.bitselect(most, change);
        }
        change.to_array().into_iter().fold(0.0, f64::max)
    }

    /// `J` (eq. 1) of the memberships and centres.
    fn objective<P: Power<f64x4>>(&self, power: P) -> f64 {
        let stride = self.stride();
        let mut sum = f64x4::ZERO;
        for block in (0..stride).step_by(LANES) {
            let [x, y, z] = [0, 1, 2].map(|axis| load(&self.x[axis][block..]));
            let weight = load(&self.weight[block..]);
            for (v, row) in self.centers.iter().zip(self.u.chunks_exact(stride)) {
                let [dx, dy, dz] = [x - v.x, y - v.y, z - v.z];
                let w = weight * power.raise(load(&row[block..]));
                sum += w * (dx * dx + dy * dy + dz * dz);
            }
        }
        sum.to_array().iter().sum()
    }

    /// The second case of eq. 5: points with a non-empty `I_k` (eq. 3) belong to those centres alone.
    fn share_zero_distance(&mut self, nearest: f64x4, total: f64x4) -> f64x4 {
        let zero = nearest.simd_eq(f64x4::ZERO);
        let mut count = f64x4::ZERO;
        for (share, distance) in self.share.iter_mut().zip(&self.distance) {
            let at = distance
                .simd_eq(f64x4::ZERO)
                .bitselect(f64x4::ONE, f64x4::ZERO);
            count += at;
            *share = zero.bitselect(at, *share);
        }
        zero.bitselect(count, total)
    }

    /// Eq. 2. A centre to which no point belongs any more (m near 1) stays where it is.
    fn update_centers(&mut self) {
        for (center, sums) in self.centers.iter_mut().zip(&self.sums) {
            if let Some(mean) = weighted_mean(sums.map(|sum| sum.to_array().iter().sum())) {
                *center = mean;
            }
        }
    }

    fn restore(&self, v: DVec3) -> DVec3 {
        self.origin + self.back[0] * v.x + self.back[1] * v.y + self.back[2] * v.z
    }
}

/// The first four of a slice.
#[inline(always)]
fn load(x: &[f64]) -> f64x4 {
    let mut lanes = [0.0; LANES];
    lanes.copy_from_slice(&x[..LANES]);
    f64x4::new(lanes)
}

/// Validity index χ (eq. 7) from the objective, which is its numerator: small is good.
fn validity(objective: f64, centers: &[DVec3]) -> f64 {
    let mut separation = f64::INFINITY;
    for (i, a) in centers.iter().enumerate() {
        for b in &centers[..i] {
            separation = separation.min(a.distance_squared(*b));
        }
    }
    if separation > 0.0 && separation.is_finite() {
        objective / (centers.len() as f64 * separation)
    } else {
        f64::INFINITY
    }
}

/// `Σ w x / Σ w` of `[Σ w, Σ w x, Σ w y, Σ w z]`.
fn weighted_mean([w, x, y, z]: [f64; 4]) -> Option<DVec3> {
    (w > 0.0).then(|| DVec3::new(x, y, z) / w)
}

/// Rows of `Bᵀ` with `A = B Bᵀ`, and columns of its inverse.
///
/// `A` is the identity (eq. 8), the inverse of the variances along the axes, or the inverse of the covariance; the
/// last two are scaled by the mean variance, so that distances and `J` keep their unit.
fn norm_transform(norm: Norm, points: &[Vec3], mean: DVec3) -> ([DVec3; 3], [DVec3; 3]) {
    let mut covariance = [0.0; 6];
    for p in points {
        let d = p.as_dvec3() - mean;
        let products = crate::base::linalg::outer(d);
        for (sum, product) in covariance.iter_mut().zip(products) {
            *sum += product / points.len() as f64;
        }
    }
    let (variances, axes) = match norm {
        Norm::Euclidean => ([1.0; 3], DVec3::AXES),
        Norm::Diagonal => ([covariance[0], covariance[3], covariance[5]], DVec3::AXES),
        Norm::Mahalanobis => {
            let eigen = sym_eigen(&covariance);
            (eigen.values, eigen.vectors)
        }
    };
    let scale = variances.iter().sum::<f64>() / 3.0;
    let largest = variances.iter().fold(0.0f64, |a, &b| a.max(b));
    let stretch = variances.map(|v| {
        if largest > 0.0 {
            (scale / v.max(MIN_VARIANCE_SHARE * largest)).sqrt()
        } else {
            1.0
        }
    });
    (
        std::array::from_fn(|a| axes[a] * stretch[a]),
        std::array::from_fn(|a| axes[a] / stretch[a]),
    )
}

/// Rows of the inverse of a matrix given by orthogonal columns.
fn invert(columns: &[DVec3; 3]) -> [DVec3; 3] {
    columns.map(|c| c / c.length_squared())
}
