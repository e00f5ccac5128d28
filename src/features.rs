//! What the points say of the surface around them: spacing, unoriented normal, curvature, surface variation, noise.

use crate::error::Result;
use crate::linalg::{SymEigen, sym_eigen};
use crate::octree::{Neighbor, Octree};
use crate::par;
use crate::progress::{Progress, Stage};
use glam::{DVec3, Vec3};
use nalgebra::{SMatrix, SVector};

/// Per-point features in the octree's (Morton) order; lengths in the unit frame.
#[derive(Debug, Clone)]
pub struct Features {
    /// Wanted distance of neighbours on the surface, √(area a point), from the area of the disc that holds k neighbours.
    pub spacing: Vec<f32>,
    /// Unit normal of arbitrary sign: direction of least variance of the neighbours; zero where there is none.
    pub normals: Vec<Vec3>,
    /// Frobenius norm of the Hessian of the local quadric, 1/length; 1/fit radius at most.
    pub curvature: Vec<f32>,
    /// Surface variation λ0/(λ0+λ1+λ2) of the neighbours, 0 (flat) to 1/3 (Pauly, Gross, Kobbelt, "Efficient
    /// simplification of point-sampled surfaces", 2002).
    pub variation: Vec<f32>,
    /// Distance of the point to its local quadric.
    pub residual: Vec<f32>,
    /// Estimated standard deviation of the noise across the surface.
    pub noise: f32,
}

/// Neighbours that are asked for at first; noisy clouds get more.
const NEIGHBORS: usize = 16;
/// Most neighbours of a noisy cloud.
const MAX_NEIGHBORS: usize = 64;
/// Unknowns of the quadric z = a + bx + cy + dx² + exy + fy².
const QUADRIC: usize = 6;

impl Features {
    /// Measures them. Cost: one k-nearest query and one 6×6 solve a point; twice where there is noise.
    pub fn measure(tree: &Octree, progress: &mut dyn Progress) -> Result<Features> {
        let first = Features::with_neighbors(tree, NEIGHBORS, progress)?;
        let k = neighbors_for(&first);
        if k == NEIGHBORS {
            Ok(first)
        } else {
            Features::with_neighbors(tree, k, progress)
        }
    }

    fn with_neighbors(tree: &Octree, k: usize, progress: &mut dyn Progress) -> Result<Features> {
        let n = tree.points.len();
        let local = par::map_progress(
            n,
            0.2 * k as f32,
            (Stage::Features, progress),
            Vec::new,
            |i, found: &mut Vec<Neighbor>| {
                tree.knn(tree.points[i], k, found);
                Local::of(tree, i, found)
            },
        )?;
        let mut residuals: Vec<f32> = local.iter().map(|l| l.residual.abs()).collect();
        residuals.sort_unstable_by(f32::total_cmp);
        // The median absolute residual of a normal variable is 0.6745 σ; a fit of k points with 6 unknowns keeps
        // (k - 6)/k of the variance.
        let kept = ((k - QUADRIC) as f32 / k as f32).sqrt();
        let noise = residuals[n / 2] / 0.6745 / kept;
        Ok(Features {
            spacing: local.iter().map(|l| l.spacing).collect(),
            normals: local.iter().map(|l| l.normal).collect(),
            curvature: local.iter().map(|l| l.curvature).collect(),
            variation: local.iter().map(|l| l.variation).collect(),
            residual: local.iter().map(|l| l.residual).collect(),
            noise,
        })
    }

    /// Median of the spacing.
    pub fn median_spacing(&self) -> f32 {
        let mut s = self.spacing.clone();
        s.sort_unstable_by(f32::total_cmp);
        s[s.len() / 2]
    }
}

/// Neighbours so that the noise tilts a normal no more than without noise: the tilt is about σ/(r √k), r ∝ √k.
fn neighbors_for(features: &Features) -> usize {
    let relative = features.noise / features.median_spacing().max(f32::MIN_POSITIVE);
    // Measured on the bench clouds: 16 up to a tenth of a spacing, 48 to 64 at one spacing.
    ((16.0 + 48.0 * (relative - 0.1)) as usize).clamp(NEIGHBORS, MAX_NEIGHBORS)
}

/// The features of one point.
struct Local {
    spacing: f32,
    normal: Vec3,
    curvature: f32,
    variation: f32,
    residual: f32,
}

impl Local {
    fn of(tree: &Octree, i: usize, found: &[Neighbor]) -> Local {
        let radius2 = found.last().map_or(0.0, |n| n.distance2 as f64);
        let spacing = (std::f64::consts::PI * radius2 / found.len() as f64).sqrt();
        let (mean, eigen) = covariance(tree, found);
        let total = eigen.values[0].max(0.0) + eigen.values[1] + eigen.values[2];
        // Fewer than three points, or all on a line, have no normal.
        if eigen.values[1] <= 1e-12 * radius2 || radius2 == 0.0 {
            let variation = 0.0;
            return Local {
                spacing: spacing as f32,
                normal: Vec3::ZERO,
                curvature: 0.0,
                variation,
                residual: 0.0,
            };
        }
        let variation = (eigen.values[0].max(0.0) / total) as f32;
        let radius = radius2.sqrt();
        let p = tree.points[i].as_dvec3();
        let (curvature, residual, normal) = match quadric(tree, found, mean, &eigen, radius, p) {
            Some(q) => q,
            None => (0.0, (p - mean).dot(eigen.vectors[0]), eigen.vectors[0]),
        };
        Local {
            spacing: spacing as f32,
            normal: normal.as_vec3(),
            curvature: curvature.min(1.0 / radius) as f32,
            variation,
            residual: residual as f32,
        }
    }
}

fn covariance(tree: &Octree, found: &[Neighbor]) -> (DVec3, SymEigen) {
    let position = |n: &Neighbor| tree.points[n.index as usize].as_dvec3();
    let mean = found.iter().map(position).sum::<DVec3>() / found.len() as f64;
    let mut m = [0.0; 6];
    for n in found {
        let d = position(n) - mean;
        for (sum, product) in m.iter_mut().zip([
            d.x * d.x,
            d.x * d.y,
            d.x * d.z,
            d.y * d.y,
            d.y * d.z,
            d.z * d.z,
        ]) {
            *sum += product;
        }
    }
    (mean, sym_eigen(&m))
}

/// Least-squares quadric over the tangent plane: curvature (Frobenius norm of its Hessian), residual of `p`, and its
/// normal at `p`. `None` with too few points or a singular system.
fn quadric(
    tree: &Octree,
    found: &[Neighbor],
    mean: DVec3,
    eigen: &SymEigen,
    radius: f64,
    p: DVec3,
) -> Option<(f64, f64, DVec3)> {
    if found.len() < QUADRIC + 2 {
        return None;
    }
    let [normal, u, v] = eigen.vectors;
    let mut ata = SMatrix::<f64, QUADRIC, QUADRIC>::zeros();
    let mut atz = SVector::<f64, QUADRIC>::zeros();
    let row = |x: f64, y: f64| [1.0, x, y, x * x, x * y, y * y];
    let frame = |q: DVec3| (q.dot(u) / radius, q.dot(v) / radius, q.dot(normal) / radius);
    for n in found {
        let (x, y, z) = frame(tree.points[n.index as usize].as_dvec3() - mean);
        let r = row(x, y);
        for a in 0..QUADRIC {
            for b in a..QUADRIC {
                ata[(b, a)] += r[a] * r[b];
            }
            atz[a] += r[a] * z;
        }
    }
    // Keeps the system regular when the neighbours lie on a conic; far below any curvature that matters.
    for a in 0..QUADRIC {
        ata[(a, a)] += 1e-9 * found.len() as f64;
    }
    let c = nalgebra::Cholesky::new(ata)?.solve(&atz);
    let (x, y, z) = frame(p - mean);
    let fitted: f64 = row(x, y).iter().zip(c.iter()).map(|(r, c)| r * c).sum();
    let hessian = (4.0 * c[3] * c[3] + 2.0 * c[4] * c[4] + 4.0 * c[5] * c[5]).sqrt() / radius;
    let (dx, dy) = (
        c[1] + 2.0 * c[3] * x + c[4] * y,
        c[2] + c[4] * x + 2.0 * c[5] * y,
    );
    Some((
        hessian,
        (z - fitted) * radius,
        (normal - dx * u - dy * v).normalize(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::Silent;
    use crate::rng::Rng;

    /// `n` points of a sphere of radius 0.25 with noise across it.
    fn sphere(n: usize, noise: f64) -> Vec<Vec3> {
        let mut rng = Rng::new(7);
        (0..n)
            .map(|_| {
                let d = DVec3::new(rng.normal(), rng.normal(), rng.normal()).normalize();
                (d * (0.25 + noise * rng.normal())).as_vec3()
            })
            .collect()
    }

    #[test]
    fn a_sphere_has_its_curvature_normals_and_noise() {
        for noise in [0.0, 1e-3, 4e-3] {
            let tree = Octree::build(&sphere(8000, noise));
            let f = Features::measure(&tree, &mut Silent).unwrap();
            let median = |v: &[f32]| {
                let mut v = v.to_vec();
                v.sort_unstable_by(f32::total_cmp);
                v[v.len() / 2] as f64
            };
            assert!(
                (f.noise as f64 - noise).abs() < 0.15 * noise + 2e-5,
                "{} for {noise}",
                f.noise
            );
            let tilt: Vec<f32> = tree
                .points
                .iter()
                .zip(&f.normals)
                .map(|(p, n)| 1.0 - p.normalize().dot(*n).abs())
                .collect();
            assert!(
                median(&tilt) < if noise < 2e-3 { 0.002 } else { 0.02 },
                "{}",
                median(&tilt)
            );
            if noise == 0.0 {
                // Both principal curvatures are 4: the Frobenius norm is 4 √2.
                assert!((median(&f.curvature) - 4.0 * 2f64.sqrt()).abs() < 0.3);
            }
            // Area a point: 4π 0.0625 / 8000.
            let spacing = (4.0 * std::f64::consts::PI * 0.0625 / 8000.0f64).sqrt();
            assert!((median(&f.spacing) / spacing - 1.0).abs() < 0.15);
        }
    }

    #[test]
    fn degenerate_clouds_have_finite_features() {
        let line: Vec<Vec3> = (0..50)
            .map(|i| Vec3::new(i as f32 / 50.0 - 0.5, 0.0, 0.0))
            .collect();
        for points in [vec![Vec3::ZERO], vec![Vec3::ZERO; 40], line] {
            let f = Features::measure(&Octree::build(&points), &mut Silent).unwrap();
            assert!(f.normals.iter().all(|n| *n == Vec3::ZERO));
            assert!(
                f.curvature
                    .iter()
                    .chain(&f.spacing)
                    .chain(&f.variation)
                    .all(|x| x.is_finite())
            );
            assert!(f.noise.is_finite());
        }
    }
}
