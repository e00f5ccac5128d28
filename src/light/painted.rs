//! The type that goes in and comes out.

use crate::cloud::Attribute;
use crate::mesh::Mesh;

/// A mesh and what its vertices carry.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Painted {
    /// In the unit frame; without normals where nobody gave any.
    pub mesh: Mesh,
    /// One colour a vertex.
    pub colors: Option<Vec<[u8; 3]>>,
    /// One value a vertex each.
    pub attributes: Vec<Attribute>,
}
