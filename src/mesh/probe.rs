//! Vertices and quads of the dual mesh, and how the field is asked about positions.

use crate::mesh::surface::Implicit;
use glam::{DVec3, Vec3};

/// A vertex keeps this share of the edge length away from its cell's faces: more than `f32` rounds at the finest
/// resolution (1e-4), less than any error that matters.
pub(crate) const MARGIN: f64 = 1e-3;

/// A vertex of the dual mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    pub(crate) position: Vec3,
    /// Unit, or zero where the field has no gradient.
    pub(crate) normal: Vec3,
    /// Crossed edges of its loop: the quads around it, if none is left out.
    pub(crate) degree: u8,
    /// The quads around it that are there.
    pub(crate) quads: u8,
    /// On a crease.
    pub(crate) sharp: bool,
}

/// The quad around a crossed edge, to be cut from its first corner to its third; counter-clockwise seen from outside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quad {
    pub(crate) vertices: [u32; 4],
    /// Axis of the lattice edge.
    pub(crate) axis: u8,
    /// Whether the edge runs from inside to outside.
    pub(crate) rising: bool,
    /// A cell around the edge has a corner whose value is not from a fitted function.
    pub(crate) filled: bool,
}

impl Vertex {
    /// Whether the surface ends here.
    pub(crate) fn is_at_end(&self) -> bool {
        self.quads < self.degree
    }
}

/// Positions and what the field has there; the memory of one worker.
pub(crate) struct Probe<'a, F: Implicit> {
    field: &'a F,
    scratch: F::Scratch,
    pub(crate) at: Vec<DVec3>,
    /// Value and gradient; `None` where there is none that can be divided by.
    pub(crate) found: Vec<Option<(f64, DVec3)>>,
}

impl<'a, F: Implicit> Probe<'a, F> {
    pub(crate) fn new(field: &'a F) -> Probe<'a, F> {
        Probe {
            field,
            scratch: field.scratch(),
            at: Vec::new(),
            found: Vec::new(),
        }
    }

    /// Fills `found` for the positions `at`.
    pub(crate) fn evaluate(&mut self) {
        self.found.clear();
        self.found.resize(self.at.len(), None);
        self.field
            .gradients(&self.at, &mut self.found, &mut self.scratch);
        for found in &mut self.found {
            *found = found.filter(|(value, gradient)| {
                let square = gradient.length_squared();
                value.is_finite() && square.is_finite() && square > 1e-20
            });
        }
    }
}

/// Coordinates inside of a cell (0-1), kept off its faces by [`MARGIN`].
pub(crate) fn clamp(inside: DVec3) -> DVec3 {
    inside.clamp(DVec3::splat(MARGIN), DVec3::splat(1.0 - MARGIN))
}
