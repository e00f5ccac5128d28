//! Colours of texels from the scan's points, or the values that become colours.

use super::fill::Pixel;
use super::groups::{Gathered, groups};
use super::maps::Paint;
use super::texels::{Texels, in_parallel, mix, place};
use crate::base::error::Result;
use crate::base::par;
use crate::cloud::octree::Octree;
use crate::cloud::queries::Neighbor;
use crate::light::carry::Spot;
use crate::mesh::Mesh;
use crate::report::distance::TriangleTree;
use glam::{DVec3, Vec3};

/// Points that a texel asks for its colour.
const NEAREST: usize = 8;
/// Weights are those of distances beyond this share of a texel or of the points' spacing, the longer of the two: nearer points count
/// alike.
const SOFT: f64 = 0.2;
/// Texels farther from every point than so many spacings have no colour of their own.
const FAR: f64 = 5.0;
/// Points that one index of a parallel map takes.
const PER_TASK: usize = 256;

/// The scan's points where the full mesh has them.
pub(super) struct Points<'a> {
    tree: Octree,
    /// By place in the tree: a colour, or a value three times.
    shown: Vec<Pixel>,
    normals: Vec<Vec3>,
    /// Mean distance of neighbours.
    spacing: f64,
    full: &'a Mesh,
}

impl<'a> Points<'a> {
    /// `faces` is of the full mesh's triangles.
    pub(super) fn new(
        points: &[Vec3],
        paint: &Paint,
        (full, faces): (&'a Mesh, &TriangleTree),
    ) -> Points<'a> {
        let tree = Octree::build(points);
        let tasks: Vec<&[Vec3]> = tree.points.chunks(PER_TASK).collect();
        let normals: Vec<Vec<Vec3>> = par::map(
            tasks.len(),
            || 0,
            |k, hint| {
                let of = |&point: &Vec3| {
                    normal(full, &Spot::nearest(point, full, faces, hint)).as_vec3()
                };
                tasks[k].iter().map(of).collect()
            },
        );
        let area: f64 = full
            .triangles
            .iter()
            .map(|&t| full.cross(t).length() / 2.0)
            .sum();
        Points {
            shown: tree
                .order
                .iter()
                .map(|&i| shown(paint, i as usize))
                .collect(),
            normals: normals.concat(),
            spacing: (area / points.len().max(1) as f64).sqrt(),
            tree,
            full,
        }
    }

    /// The colour of each texel that has points near.
    pub(super) fn bake(
        &self,
        texels: &Texels,
        spots: &[Spot],
        mesh: &Mesh,
        progress: &mut dyn FnMut(f32) -> Result<()>,
    ) -> Result<Vec<Option<Pixel>>> {
        let soft = SOFT * texels.length(mesh).max(self.spacing);
        let at = |spot: &Spot| place(self.full, spot).as_vec3();
        let places: Vec<Vec3> = spots.iter().map(at).collect();
        let groups = groups(&places, texels.length(mesh));
        let found = in_parallel(&groups, progress, Gathered::default, |group, gathered| {
            let mut colors = Vec::with_capacity(group.len());
            gathered.points(&places[group.clone()], &self.tree, NEAREST, |k, near| {
                colors.push(self.at(&spots[group.start + k], soft, near));
            });
            colors
        })?;
        let mut pixels = vec![None; texels.size[0] * texels.size[1]];
        for (texel, color) in texels.all.iter().zip(found.iter().flatten()) {
            pixels[texel.pixel as usize] = *color;
        }
        Ok(pixels)
    }

    /// The mean of the nearest points.
    fn at(&self, spot: &Spot, soft: f64, near: &[Neighbor]) -> Option<Pixel> {
        let out = normal(self.full, spot);
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for neighbor in near {
            let i = neighbor.index as usize;
            let distance2 = f64::from(neighbor.distance2);
            let agrees = out.dot(self.normals[i].as_dvec3());
            let shown = self.shown[i];
            let shows = shown[0].is_finite();
            if !shows || agrees <= 0.0 || distance2 > (FAR * self.spacing) * (FAR * self.spacing) {
                continue;
            }
            let weight = agrees * agrees / (distance2 + soft * soft);
            sum += DVec3::from(shown.map(f64::from)) * weight;
            weights += weight;
        }
        (weights > 0.0).then(|| (sum / weights).to_array().map(|x| x as f32))
    }
}

/// What a point shows; nothing that is finite where it shows nothing.
fn shown(paint: &Paint, i: usize) -> Pixel {
    match paint {
        Paint::Nothing => [f32::NAN; 3],
        Paint::Colors(colors) => colors[i].map(f32::from),
        Paint::Scalars { values, .. } => [values[i].clamp(0.0, 1.0); 3],
    }
}

/// Unit normal of a spot, of its corners' where they have any.
pub(super) fn normal(mesh: &Mesh, spot: &Spot) -> DVec3 {
    let mean = match mesh.normals.is_empty() {
        true => DVec3::ZERO,
        false => mix(mesh, spot, |v| mesh.normals[v].as_dvec3()),
    };
    let face = || {
        mesh.cross(mesh.triangles[spot.triangle as usize])
            .normalize_or(DVec3::Z)
    };
    mean.try_normalize().unwrap_or_else(face)
}
