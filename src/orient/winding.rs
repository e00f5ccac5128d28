//! The generalised winding number of oriented points (Jacobson, Kavan, Sorkine-Hornung, 2013), by a tree of dipoles
//! (Barill et al., "Fast winding numbers for soups and clouds", 2018): about 1 inside, 0 outside, between in a hole.

use crate::base::kernel::blurred_solid_angle;
use crate::base::lanes::{LANES, Lanes};
use crate::cloud::neighborhood::Block;
use crate::cloud::octree::{Node, Octree};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Oriented points seen from anywhere.
#[derive(Debug)]
pub(crate) struct Winding<'a> {
    tree: &'a Octree,
    dipoles: Vec<Dipole>,
    /// area · normal of each site.
    areas: Vec<Vec3>,
}

/// The sites of a node seen from far away.
#[derive(Debug, Clone, Copy)]
struct Dipole {
    center: DVec3,
    /// Σ area · normal.
    moment: DVec3,
    radius: f64,
}

/// A node farther away than this times its radius is a dipole. 2 gives the winding number to about 0.01 (Barill et al.,
/// section 4.4).
const FAR: f64 = 2.0;

impl<'a> Winding<'a> {
    /// Of a tree's points, each a patch of its spacing squared. Cost: n log n.
    pub(crate) fn new(tree: &'a Octree, normals: &[Vec3], spacing: &[f32]) -> Winding<'a> {
        let areas: Vec<Vec3> = normals
            .iter()
            .zip(spacing)
            .map(|(&n, &h)| n * (h * h))
            .collect();
        let dipole = |node: &Node| Dipole {
            center: ((node.lo + node.hi) * 0.5).as_dvec3(),
            moment: areas[node.range()].iter().map(|a| a.as_dvec3()).sum(),
            radius: ((node.hi - node.lo) * 0.5).as_dvec3().length(),
        };
        let dipoles = tree.nodes.iter().map(dipole).collect();
        Winding {
            tree,
            dipoles,
            areas,
        }
    }

    /// The winding number around `x`; sites much nearer than `blur` hardly count.
    pub(crate) fn around(&self, x: DVec3, blur: f64) -> f64 {
        let mut sum = 0.0;
        let mut stack = vec![0];
        while let Some(id) = stack.pop() {
            let (node, dipole) = (&self.tree.nodes[id], &self.dipoles[id]);
            let far = (dipole.center - x).length_squared() > (FAR * dipole.radius).powi(2);
            if far {
                sum += blurred_solid_angle(dipole.center - x, dipole.moment, blur);
            } else if node.is_leaf() {
                for i in node.range() {
                    let (p, a) = (self.tree.points[i].as_dvec3(), self.areas[i].as_dvec3());
                    sum += blurred_solid_angle(p - x, a, blur);
                }
            } else {
                stack.extend(node.child_ids());
            }
        }
        sum / (4.0 * PI)
    }

    /// [`Winding::around`] of up to eight positions in single precision: what each gets does not depend on the others.
    pub(crate) fn around_block(&self, block: &Block) -> Lanes {
        let (one, mut sum) = (Lanes::splat(1.0), Lanes::ZERO);
        let mut stack = vec![(0, one)];
        while let Some((id, asked)) = stack.pop() {
            let (node, dipole) = (&self.tree.nodes[id], &self.dipoles[id]);
            let (square, turns) = seen(dipole.center.as_vec3(), dipole.moment.as_vec3(), block);
            let limit = (FAR * dipole.radius).powi(2) as f32;
            let far = Lanes::splat(limit).less(square, asked, Lanes::ZERO);
            sum += far * turns;
            let near = asked - far;
            if near.at_most(Lanes::ZERO) == (1 << LANES) - 1 {
                continue;
            }
            if node.is_leaf() {
                for i in node.range() {
                    sum += near * seen(self.tree.points[i], self.areas[i], block).1;
                }
            } else {
                stack.extend(node.child_ids().map(|child| (child, near)));
            }
        }
        sum * Lanes::splat((0.25 / PI) as f32)
    }
}

/// The squared distances of a patch `p` of this area vector from a block's positions, and the solid angles under which they see it.
#[inline(always)]
fn seen(p: Vec3, area: Vec3, block: &Block) -> (Lanes, Lanes) {
    let [dx, dy, dz] = [0, 1, 2].map(|axis| Lanes::splat(p[axis]) - block.at[axis]);
    let [ax, ay, az] = area.to_array().map(Lanes::splat);
    let square = dx * dx + dy * dy + dz * dz;
    // A position at the patch itself sees nothing of it.
    let r2 = square.max(Lanes::splat(1e-20));
    (square, (dx * ax + dy * ay + dz * az) / (r2 * r2.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_at_once_are_what_each_is() {
        let on_ball = |k: usize| {
            let (z, turn) = (1.0 - (2 * k + 1) as f32 / 600.0, 2.4 * k as f32);
            let r = (1.0 - z * z).sqrt();
            Vec3::new(r * libm::cosf(turn), r * libm::sinf(turn), z)
        };
        let points: Vec<Vec3> = (0..600).map(on_ball).collect();
        let tree = Octree::build(&points);
        let spacing = vec![(4.0 * PI as f32 / 600.0).sqrt(); 600];
        let winding = Winding::new(&tree, &tree.points, &spacing);
        let asked: Vec<Vec3> = (0..8).map(|k| 0.3 * k as f32 * on_ball(70 * k)).collect();
        let together = winding.around_block(&Block::new(&asked, 0..8)).to_array();
        for (k, turns) in together.into_iter().enumerate() {
            let alone = winding.around_block(&Block::new(&asked, k..k + 1));
            assert_eq!(turns, alone.lane(0));
            let exact = winding.around(asked[k].as_dvec3(), 0.0);
            assert!(
                (f64::from(turns) - exact).abs() < 1e-5,
                "{k}: {turns} {exact}"
            );
            let inside = asked[k].length() < 0.8;
            assert!(
                inside == (turns > 0.9) || asked[k].length() < 1.3,
                "{k}: {turns}"
            );
        }
    }
}
