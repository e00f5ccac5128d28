//! `cargo run --release --example quality [fuzzifier=M] [curvatureWeight=A] [maxIterations=N] [cellPoints=N]`
//!
//! What a reduction's options do to its quality, on scans that are generated and so have a known truth. The constants of
//! the stages were chosen by tables like these, on these scans and on other models than those that the project is measured
//! by. Lengths in 1e-4 of the diagonal.

use glam::{DVec3, Vec3};
use pointweave::base::params::Target;
use pointweave::base::progress::Silent;
use pointweave::cloud::octree::Octree;
use pointweave::reduce::Reduced;
use pointweave::reduce::height_field::{Patches, cloud_distances};
use pointweave::reduce::shares::{SHARES, Shares};
use pointweave::samples::{Model, sample_with_noise};
use pointweave::{Cloud, ReduceParams, Result, SurfaceParams, reconstruct, reduce};

const POINTS: usize = 36_000;
const NOISE: [f64; 3] = [0.0, 1e-3, 5e-3];
const RATIOS: [usize; 2] = [3, 10];
const TOLERANCES: [f64; 3] = [3e-3, 1e-3, 5e-4];

fn main() -> Result<()> {
    let params = std::env::args().skip(1).fold(ReduceParams::default(), with);
    println!(
        "points: rms distance of the reduced points to the true surface; covered: mean distance, and that of the"
    );
    println!(
        "hundredth worst, of true points to the local surfaces; mesh: mean distance of its vertices; even: evenness"
    );
    println!(
        "{:>6} {:>7} {:>6} {:>8} {:>16} {:>7} {:>6}",
        "model", "noise", "kept", "points", "covered", "mesh", "even"
    );
    for model in Model::ALL {
        for noise in NOISE {
            let scan = Scan::new(model, noise)?;
            for ratio in RATIOS {
                let target = Target::Count(POINTS / ratio);
                let row = scan.row(&ReduceParams {
                    target,
                    ..params.clone()
                })?;
                println!(
                    "{:>6} {noise:>7} {:>6} {row}",
                    model.name(),
                    format!("1/{ratio}")
                );
            }
        }
    }
    println!(
        "\nfewest points within a tolerance, beside the fewest that a search over counts finds (a dash: not even all do)"
    );
    println!(
        "{:>6} {:>7} {:>9} {:>7} {:>7} {:>9}",
        "model", "noise", "tolerance", "points", "search", "worst 1 %"
    );
    for model in Model::ALL {
        for noise in [0.0, 5e-4] {
            let scan = Scan::new(model, noise)?;
            for tolerance in TOLERANCES {
                let target = Target::Tolerance(tolerance);
                let reduced = scan.reduce(&ReduceParams {
                    target,
                    ..params.clone()
                })?;
                let (_, worst) = scan.covered(&reduced);
                let search = scan
                    .search(tolerance, &params)?
                    .map_or("-".into(), |n| n.to_string());
                println!(
                    "{:>6} {noise:>7} {:>9.1} {:>7} {search:>7} {worst:>9.2}",
                    model.name(),
                    tolerance * 1e4,
                    reduced.cloud.len()
                );
            }
        }
    }
    Ok(())
}

/// The options with one `name=value` more.
fn with(params: ReduceParams, option: String) -> ReduceParams {
    let value = |name: &str| {
        option
            .strip_prefix(name)?
            .strip_prefix('=')?
            .parse::<f64>()
            .ok()
    };
    ReduceParams {
        fuzzifier: value("fuzzifier").or(params.fuzzifier),
        curvature_weight: value("curvatureWeight").unwrap_or(params.curvature_weight),
        max_iterations: value("maxIterations")
            .map(|n| n as usize)
            .or(params.max_iterations),
        cell_points: value("cellPoints")
            .map(|n| n as usize)
            .or(params.cell_points),
        ..params
    }
}

/// A scan, and points of the true surface that it has seen, in its unit frame.
struct Scan {
    model: Model,
    cloud: Cloud,
    truth: Vec<Vec3>,
}

impl Scan {
    fn new(model: Model, noise: f64) -> Result<Scan> {
        let cloud = Cloud::from_f32(&sample_with_noise(model, POINTS, 1, noise).positions)?;
        let seen = Octree::build(&cloud.points);
        let unit = |p: &[f32]| cloud.frame.to_unit([p[0], p[1], p[2]].map(f64::from));
        let truth = sample_with_noise(model, 2 * POINTS, 2, 0.0).positions;
        let near = |p: &Vec3| seen.nearest(*p).distance2.sqrt() < 0.01;
        Ok(Scan {
            model,
            truth: truth.chunks_exact(3).map(unit).filter(near).collect(),
            cloud,
        })
    }

    fn reduce(&self, params: &ReduceParams) -> Result<Reduced> {
        Ok(reduce(&self.cloud, params, &mut Silent)?.reduced)
    }

    fn row(&self, params: &ReduceParams) -> Result<String> {
        let result = reduce(&self.cloud, params, &mut Silent)?;
        let (mean, worst) = self.covered(&result.reduced);
        let surface = SurfaceParams {
            reduce: Some(params.clone()),
            ..Default::default()
        };
        let mesh = reconstruct(&self.cloud, &surface, &mut Silent)?.positions_f64();
        let points = self
            .off(&result.reduced.cloud.positions_f64(), |d| d * d)
            .sqrt();
        let vertices = self.off(&mesh, |d| d);
        Ok(format!(
            "{points:>8.2} {mean:>8.2} {worst:>7.2} {vertices:>7.2} {:>6.3}",
            result.report.evenness
        ))
    }

    /// Mean of `of` the distances of points in the caller's frame to the true surface.
    fn off(&self, positions: &[f64], of: fn(f64) -> f64) -> f64 {
        let distance = |p: &[f64]| {
            let p = DVec3::from_slice(p);
            let slope = self.model.gradient(p).length().max(0.5);
            of((self.model.distance(p) / slope).abs() / self.cloud.frame.diagonal * 1e4)
        };
        positions.chunks_exact(3).map(distance).sum::<f64>() / (positions.len() / 3) as f64
    }

    /// Mean distance of the true surface to the local surfaces, and what 99 % are within.
    fn covered(&self, reduced: &Reduced) -> (f64, f64) {
        let tree = Octree::build(&reduced.cloud.points);
        let patches = Patches::fit(&tree, reduced.cloud.normals.as_deref().unwrap_or_default());
        let mut found = Vec::new();
        let mut shares = |p: &Vec3| {
            tree.knn(*p, SHARES, &mut found);
            let near = |j: usize| tree.order[found[j.min(found.len() - 1)].index as usize];
            Shares {
                center: std::array::from_fn(near),
                u: [0.25; SHARES],
            }
        };
        let shares: Vec<Shares> = self.truth.iter().map(&mut shares).collect();
        let mut distances =
            cloud_distances(|k| self.truth[k], &shares, &patches, &mut Silent).unwrap_or_default();
        distances.sort_unstable_by(f32::total_cmp);
        let mean = distances.iter().map(|&d| f64::from(d)).sum::<f64>() / distances.len() as f64;
        (
            1e4 * mean,
            1e4 * f64::from(distances[distances.len() * 99 / 100]),
        )
    }

    /// The least count, to 2 %, whose local surfaces have 99 % of the truth within the tolerance.
    fn search(&self, tolerance: f64, params: &ReduceParams) -> Result<Option<usize>> {
        let (mut beyond, mut within) = (16, POINTS);
        let enough = |count| -> Result<bool> {
            let target = Target::Count(count);
            let reduced = self.reduce(&ReduceParams {
                target,
                ..params.clone()
            })?;
            Ok(self.covered(&reduced).1 <= 1e4 * tolerance)
        };
        if !enough(within)? {
            return Ok(None);
        }
        while within as f64 > 1.02 * beyond as f64 && within > beyond + 1 {
            let middle = ((within * beyond) as f64).sqrt() as usize;
            if enough(middle)? {
                within = middle;
            } else {
                beyond = middle;
            }
        }
        Ok(Some(within))
    }
}
