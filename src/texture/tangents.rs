//! The frames that normal maps are told in, by MikkTSpace.

use crate::base::error::{Error, Result};
use crate::mesh::Mesh;
use bevy_mikktspace::{Geometry, Ops, TangentSpace, generate_tangents};
use glam::Vec3;

/// The same bits on every machine.
struct Exact;

impl Ops for Exact {
    fn sqrt(x: f32) -> f32 {
        libm::sqrtf(x)
    }

    fn acos(x: f32) -> f32 {
        libm::acosf(x)
    }
}

struct Frames<'a> {
    mesh: &'a Mesh,
    uvs: &'a [[f32; 2]],
    tangents: Vec<[f32; 4]>,
}

impl Frames<'_> {
    fn corner(&self, face: usize, corner: usize) -> usize {
        self.mesh.triangles[face][corner] as usize
    }
}

impl Geometry<Exact> for Frames<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangles.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.vertices[self.corner(face, corner)].to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.corner(face, corner)].to_array()
    }

    /// From the bottom up, as MikkTSpace has it.
    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let [u, v] = self.uvs[self.corner(face, corner)];
        [u, 1.0 - v]
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        let vertex = self.corner(face, corner);
        if let Some(space) = space {
            self.tangents[vertex] = space.tangent_encoded();
        }
    }
}

/// A tangent a vertex, of unit length, and the sign of its bitangent.
///
/// # Errors
/// [`Error::Internal`].
pub(super) fn tangents(mesh: &Mesh, uvs: &[[f32; 2]]) -> Result<Vec<[f32; 4]>> {
    let mut frames = Frames {
        mesh,
        uvs,
        tangents: vec![[0.0; 4]; mesh.vertices.len()],
    };
    generate_tangents::<_, Exact>(&mut frames)
        .map_err(|_| Error::Internal("the tangents cannot be told".into()))?;
    let whole = |(tangent, normal): (&[f32; 4], &Vec3)| {
        let [x, y, z, w] = *tangent;
        let unit = Vec3::new(x, y, z).try_normalize();
        let [x, y, z] = unit
            .unwrap_or_else(|| normal.any_orthonormal_vector())
            .to_array();
        [x, y, z, if w < 0.0 { -1.0 } else { 1.0 }]
    };
    Ok(frames
        .tangents
        .iter()
        .zip(&mesh.normals)
        .map(whole)
        .collect())
}
