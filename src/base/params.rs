//! Every option with its unit, range, default and the paper's symbol. JS sees the same fields in camel case.

use crate::base::error::{Error, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How much a reduction keeps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Target {
    /// Share of the points, (0, 1]. The count is rounded to the nearest integer, at least 1, and met exactly.
    Ratio(f64),
    /// Exactly this many points, at least 1; more than there are means all of them.
    Count(usize),
    /// The fewest points whose local surfaces ([`crate::reduce::height_field`]) have 99 % of the surface within this distance (fraction
    /// of the diagonal), found by reducing and measuring, mostly one to five times; at least 1.5 times the noise (section 5).
    Tolerance(f64),
    /// The paper's λ: sub-domains whose surface variation is under it are reduced, the others keep their points.
    Flatness(f64),
}

impl Target {
    /// How many of `n` points it keeps, where that does not hang on the surface.
    pub fn count(self, n: usize) -> Option<usize> {
        match self {
            Target::Ratio(ratio) => Some(((n as f64 * ratio).round() as usize).clamp(1, n)),
            Target::Count(count) => Some(count.min(n)),
            Target::Tolerance(_) | Target::Flatness(_) => None,
        }
    }
}

/// Which reduction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Method {
    /// Weighted clusters, density by curvature, centres placed on the surface.
    Adaptive,
    /// Sections 3.1-3.2 to the letter.
    Paper,
}

/// The norm-inducing matrix A of eq. 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Norm {
    /// A = I (eq. 8).
    Euclidean,
    /// A = diag(1/σx², 1/σy², 1/σz²) of the sub-domain.
    Diagonal,
    /// A = the inverse covariance of the sub-domain.
    Mahalanobis,
}

/// How the number of clusters c of a sub-domain is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Clusters {
    /// In proportion to the target.
    Proportional,
    /// The best validity index (eq. 7) near the proportional number.
    Validity,
}

/// Where a centre goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Placement {
    /// On the surface: best for implicit fits.
    Implicit,
    /// Slightly outside of curved parts and on creases: best for triangles between the points.
    Mesh,
    /// The raw cluster centre (eq. 2).
    Center,
    /// The nearest input point.
    Sample,
}

/// What becomes of isolated input points ([`crate::features::outliers`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Outliers {
    /// They are points like all others.
    Keep,
    /// They are left out, unless they are more than half of all.
    Drop,
}

/// The name that stands for a cloud's colours in [`ReduceParams::attributes`].
pub const COLORS: &str = "colors";

/// How a scalar, or the colours, of the input points go to the reduced point that stands for them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Carry {
    /// The mean, weighted by membership: for measurements.
    Mean,
    /// The value with the largest sum of memberships, of equals the smallest: for labels. A colour is one value.
    Majority,
    /// The value of the nearest input point.
    Nearest,
}

/// Options of [`crate::reduce`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct ReduceParams {
    /// How much to keep. Default: a third.
    pub target: Target,
    /// Default: adaptive.
    pub method: Method,
    /// m of eq. 1-5 (the paper also writes s), > 1. Default 1.5 (`adaptive`), 2 (`paper`).
    pub fuzzifier: Option<f64>,
    /// ε of eq. 6: stop when no membership changes by more, > 0. Default: 0.01 of the wanted spacing as centre movement
    /// (`adaptive`), 0.001 (`paper`).
    pub epsilon: Option<f64>,
    /// At most this many iterations of steps (b) and (c), at least 1. Default 5 (`adaptive`), 100 (`paper`).
    pub max_iterations: Option<usize>,
    /// A of eq. 1, used by `paper`; `adaptive` has a matrix of its own for each point. Default: euclidean.
    pub norm: Norm,
    /// Default: proportional.
    pub clusters: Clusters,
    /// 0 = even spacing … 1 = strongest concentration on curved parts. Default 0.5.
    pub curvature_weight: f64,
    /// Default: implicit. `paper` takes its raw centres whatever stands here, unless it is `sample`.
    pub placement: Placement,
    /// Seed of the random memberships of step (a). Default 0.
    pub seed: u64,
    /// Most points of a sub-domain, at least 8. Default: follows the target, 64-512 (`adaptive`), 256 (`paper`).
    pub cell_points: Option<usize>,
    /// Deepest octree level, 1-21. Default 21.
    pub max_depth: u32,
    /// How scalars are carried to the reduced points, by name; `colors` names the colours. Those that are not named, by
    /// default all, are [`Carry::Mean`].
    pub attributes: BTreeMap<String, Carry>,
    /// Say of every input point which reduced point it belongs to most. Default `false`.
    pub assignment: bool,
    /// Say where the sub-domains of the octree are. Default `false`.
    pub cells: bool,
    /// Points far from all others and small clumps of them. Where some are dropped, the diagonal that lengths are fractions
    /// of is that of the others. Default: keep.
    pub outliers: Outliers,
}

impl Default for ReduceParams {
    fn default() -> Self {
        ReduceParams {
            target: Target::Ratio(1.0 / 3.0),
            method: Method::Adaptive,
            fuzzifier: None,
            epsilon: None,
            max_iterations: None,
            norm: Norm::Euclidean,
            clusters: Clusters::Proportional,
            curvature_weight: 0.5,
            placement: Placement::Implicit,
            seed: 0,
            cell_points: None,
            max_depth: 21,
            attributes: BTreeMap::new(),
            assignment: false,
            cells: false,
            outliers: Outliers::Keep,
        }
    }
}

/// φ of eq. 9.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kernel {
    /// φ(r) = r, the biharmonic spline of 3D.
    Biharmonic,
    /// φ(r) = r³, the triharmonic spline of 3D.
    Triharmonic,
    /// φ(r) = r² log r, the paper's thin plate.
    ThinPlate,
}

/// How much the local fits smooth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Smoothing {
    /// Follows the measured noise; none where there is none.
    Auto,
    /// The ridge on the diagonal of eq. 11, ≥ 0, in units of φ at the sub-domain's spacing.
    #[serde(untagged)]
    Ridge(f64),
}

/// Edge length of the extraction grid.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Resolution {
    /// Three quarters of the median spacing of the fitted points; then edges are collapsed where the surface is flat until
    /// at most three triangles a fitted point are left.
    Auto,
    /// Fraction of the diagonal, 1e-4 to 0.25. The mesh is as dense as the grid.
    #[serde(untagged)]
    Edge(f64),
}

/// What happens where there were no points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Boundary {
    /// Holes up to [`SurfaceParams::max_hole`] are closed, open sheets stay open.
    Auto,
    /// As `Open`, and every rim is capped by a membrane, which is flat where the rim is.
    Closed,
    /// The surface ends where the points end.
    Open,
}

/// Widest hole that is closed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum MaxHole {
    /// A tenth of the diagonal; a fifth where the surface goes on smoothly across the hole.
    Auto,
    /// Fraction of the diagonal, 0 to 1. A hole is as wide as the largest disc in it, and gaps of the sampling, up to some
    /// four spacings wide, are closed anyway.
    #[serde(untagged)]
    Diameter(f64),
}

/// Which inference chooses the signs of the local functions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Propagation {
    /// Strongest agreements first over the whole graph, then flips that lower the energy.
    Global,
    /// Algorithm 1: an advancing front with belief propagation on local graphs.
    Paper,
}

/// What decides which side is out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Orientation {
    /// Everything that is known, as far as it holds when it is checked: the cloud's normals, its viewpoints, that it was seen
    /// from above, a depth camera at the origin; then closed shapes look outward and sheets up.
    Auto,
    /// The cloud's own normals, unchecked.
    Normals,
    /// The cloud's viewpoints: what was seen looks to where it was seen from.
    Viewpoints,
    /// Along the cloud's `up`, z where it has none.
    Up,
    /// Away from the inside of what the surface encloses: objects.
    Outward,
    /// Into it: rooms.
    Inward,
}

/// Options of [`crate::reconstruct`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct SurfaceParams {
    /// How the cloud is reduced first; `None` (JS: `false`) sends every point to the fit. Default: [`ReduceParams`]'s.
    #[serde(with = "reduce_or_false")]
    pub reduce: Option<ReduceParams>,
    /// Largest rms residual of a sub-domain at its input points (fraction of the diagonal), > 0. Default 6e-4, the
    /// paper's.
    pub accuracy: f64,
    /// Default: triharmonic.
    pub kernel: Kernel,
    /// Default: auto.
    pub smoothing: Smoothing,
    /// Infer which side is out; `false` takes the cloud's own normals as they are. Default `true`.
    pub orient: bool,
    /// What decides which side is out; [`Propagation::Paper`] and `orient: false` have their own rules. Default: auto.
    pub orientation: Orientation,
    /// Turn the whole result to the other side in the end. Default `false`.
    pub flip: bool,
    /// Default: global.
    pub propagation: Propagation,
    /// Default: auto.
    pub resolution: Resolution,
    /// Keep creases in the mesh. Default `true`.
    pub sharp: bool,
    /// Default: auto.
    pub boundary: Boundary,
    /// With `boundary` auto, the widest hole that is closed. Default: auto.
    pub max_hole: MaxHole,
    /// Say of every input point and every vertex how far scan and mesh are apart there. Default `false`.
    pub distances: bool,
    /// For [`crate::pipeline::reconstruct_again`]: remember what was measured of the cloud and its reduction. Default
    /// `false`.
    pub keep: bool,
}

impl Default for SurfaceParams {
    fn default() -> Self {
        SurfaceParams {
            reduce: Some(ReduceParams::default()),
            accuracy: 6e-4,
            kernel: Kernel::Triharmonic,
            smoothing: Smoothing::Auto,
            orient: true,
            orientation: Orientation::Auto,
            flip: false,
            propagation: Propagation::Global,
            resolution: Resolution::Auto,
            sharp: true,
            boundary: Boundary::Auto,
            max_hole: MaxHole::Auto,
            distances: false,
            keep: false,
        }
    }
}

impl ReduceParams {
    /// Checks every range.
    pub fn validate(&self) -> Result<()> {
        match self.target {
            Target::Ratio(r) => {
                check("target.ratio", r, r > 0.0 && r <= 1.0, "a number in (0, 1]")?
            }
            Target::Count(c) => check("target.count", c, c >= 1, "an integer of at least 1")?,
            Target::Tolerance(t) => check(
                "target.tolerance",
                t,
                t > 0.0 && t < 1.0,
                "a number in (0, 1)",
            )?,
            Target::Flatness(l) => check(
                "target.flatness",
                l,
                l > 0.0 && l <= 1.0,
                "a number in (0, 1]",
            )?,
        }
        if let Some(m) = self.fuzzifier {
            check(
                "fuzzifier",
                m,
                m > 1.0 && m <= 100.0,
                "a number in (1, 100]",
            )?;
        }
        if let Some(e) = self.epsilon {
            check("epsilon", e, e > 0.0 && e <= 1.0, "a number in (0, 1]")?;
        }
        if let Some(n) = self.max_iterations {
            check(
                "maxIterations",
                n,
                (1..=100_000).contains(&n),
                "an integer from 1 to 100000",
            )?;
        }
        let w = self.curvature_weight;
        check(
            "curvatureWeight",
            w,
            (0.0..=1.0).contains(&w),
            "a number in [0, 1]",
        )?;
        if let Some(n) = self.cell_points {
            check(
                "cellPoints",
                n,
                (8..=65_536).contains(&n),
                "an integer from 8 to 65536",
            )?;
        }
        check(
            "maxDepth",
            self.max_depth,
            (1..=21).contains(&self.max_depth),
            "an integer from 1 to 21",
        )
    }
}

impl SurfaceParams {
    /// Checks every range, those of `reduce` too.
    pub fn validate(&self) -> Result<()> {
        if let Some(reduce) = &self.reduce {
            reduce.validate()?;
        }
        let a = self.accuracy;
        check("accuracy", a, a > 0.0 && a < 1.0, "a number in (0, 1)")?;
        if let Smoothing::Ridge(s) = self.smoothing {
            check(
                "smoothing",
                s,
                (0.0..=1e6).contains(&s),
                "'auto' or a number in [0, 1e6]",
            )?;
        }
        if let Resolution::Edge(e) = self.resolution {
            check(
                "resolution",
                e,
                (1e-4..=0.25).contains(&e),
                "'auto' or a number in [0.0001, 0.25]",
            )?;
        }
        if let MaxHole::Diameter(d) = self.max_hole {
            check(
                "maxHole",
                d,
                (0.0..=1.0).contains(&d),
                "'auto' or a number in [0, 1]",
            )?;
        }
        Ok(())
    }
}

fn check(option: &str, found: impl std::fmt::Display, ok: bool, expected: &str) -> Result<()> {
    if ok {
        return Ok(());
    }
    Err(Error::BadOption {
        option: option.into(),
        expected: expected.into(),
        found: found.to_string(),
    })
}

/// `reduce: false` in JS is `None` here.
mod reduce_or_false {
    use super::ReduceParams;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    #[derive(Serialize, Deserialize)]
    #[serde(untagged)]
    enum OrFalse {
        False(bool),
        Params(Box<ReduceParams>),
    }

    pub fn serialize<S: Serializer>(value: &Option<ReduceParams>, s: S) -> Result<S::Ok, S::Error> {
        match value {
            None => s.serialize_bool(false),
            Some(p) => p.serialize(s),
        }
    }

    pub fn deserialize<'a, D: Deserializer<'a>>(d: D) -> Result<Option<ReduceParams>, D::Error> {
        match OrFalse::deserialize(d)? {
            OrFalse::False(false) => Ok(None),
            OrFalse::False(true) => Err(D::Error::custom(
                "reduce is true: expected false or an object",
            )),
            OrFalse::Params(p) => Ok(Some(*p)),
        }
    }
}
