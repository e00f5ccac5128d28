//! The generalised winding number of oriented points (Jacobson, Kavan, Sorkine-Hornung, 2013), by a tree of dipoles
//! (Barill et al., "Fast winding numbers for soups and clouds", 2018): about 1 inside, 0 outside, between in a hole.

use crate::base::kernel::blurred_solid_angle;
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
}
