//! The opposite sheet: the other side of a thin wall, or of a narrow gap.
//!
//! Points of the opposite sheet are found among the neighbours. Their normals are nearly parallel to this one, and both normals
//! see the other point on the same side and far off their planes. On one sheet, however bent, one tangent plane sees the
//! other point above it and the other one below.

use crate::cloud::octree::Octree;
use glam::Vec3;

/// Cosine of the largest angle between normals of opposite sheets: 37°.
const PARALLEL: f32 = 0.8;
/// Smallest offset along the normals against the distance: 45° off the plane.
const ACROSS: f32 = 0.7;
/// Standard deviations of the noise that sheets are apart, at least: nearer ones cannot be told apart.
const NOISE: f32 = 3.0;
/// Points that make a sheet, and their share of all that are as far off the plane: within the noise of one sheet others are.
const LEAST: (usize, f32) = (3, 0.5);
/// The distance is the one that a quarter of the points are within: behind the opposite sheet there may be others.
const NEAREST: usize = 4;

/// From point `i` straight across to the opposite sheet, if there is one within `radius`; else zero. `sides` are unit normals of
/// any sign.
pub(crate) fn across(
    tree: &Octree,
    normals: &[Vec3],
    i: usize,
    (radius, noise): (f32, f32),
    steps: &mut Vec<f32>,
) -> Vec3 {
    let (p, normal) = (tree.points[i], normals[i]);
    steps.clear();
    let mut off = 0;
    if normal == Vec3::ZERO {
        return Vec3::ZERO;
    }
    tree.visit(
        |_, node| node.distance2(p) < radius * radius,
        |j| {
            let d = tree.points[j] - p;
            let own = normal.dot(d);
            let length2 = d.length_squared();
            if own * own < ACROSS * ACROSS * length2 || length2 > radius * radius {
                return;
            }
            off += usize::from(j != i);
            let along = normal.dot(normals[j]);
            let other = normals[j].dot(d) * along.signum();
            let step = own.abs().min(other.abs());
            if along.abs() >= PARALLEL && own * other > 0.0 && step > NOISE * noise {
                steps.push(step.copysign(own));
            }
        },
    );
    // The side that most of them are on.
    let above = steps.iter().filter(|step| **step > 0.0).count();
    let side = if 2 * above > steps.len() { 1.0 } else { -1.0 };
    steps.retain(|step| step * side > 0.0);
    if steps.len() < LEAST.0 || (steps.len() as f32) < LEAST.1 * off as f32 {
        return Vec3::ZERO;
    }
    let at = steps.len() / NEAREST;
    let (_, step, _) = steps.select_nth_unstable_by(at, |a, b| a.abs().total_cmp(&b.abs()));
    normal * *step
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Rng;

    #[test]
    fn the_other_side_of_a_wall() {
        let mut rng = Rng::new(4);
        let (mut points, thickness) = (Vec::new(), 0.02);
        for i in 0..8000 {
            let (x, y) = (0.6 * rng.uniform() - 0.3, 0.6 * rng.uniform() - 0.3);
            let z = 0.1 * x * x + if i % 2 == 0 { thickness } else { 0.0 };
            points.push(Vec3::new(x as f32, y as f32, z as f32));
        }
        let tree = Octree::build(&points);
        // Of any sign.
        let normals: Vec<Vec3> = (tree.points.iter().zip(0..))
            .map(|(p, i)| Vec3::new(-0.2 * p.x, 0.0, 1.0).normalize() * [1.0, -1.0][i % 2])
            .collect();
        let mut found = 0;
        for i in (0..8000).step_by(10) {
            let d = across(&tree, &normals, i, (0.04, 1e-3), &mut Vec::new());
            let up = tree.points[i].z < thickness as f32 / 2.0 + 0.1 * tree.points[i].x.powi(2);
            if d != Vec3::ZERO {
                found += 1;
                assert!((d.length() / thickness as f32 - 1.0).abs() < 0.2);
                assert_eq!(d.z > 0.0, up);
            }
            // Out of reach, and too near for the noise.
            let none = |r, noise| across(&tree, &normals, i, (r, noise), &mut Vec::new());
            assert_eq!(none(0.015, 0.0), Vec3::ZERO);
            assert_eq!(none(0.04, 0.01), Vec3::ZERO);
        }
        assert!(found > 760, "{found}");
    }
}
