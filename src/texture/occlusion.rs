//! How open the surface is to the light around it: ambient occlusion, 1 where nothing is in its way.
//!
//! The mean over the directions of the half space above a place, weighted by the cosine (S. Zhukov et al., "An ambient light
//! illumination model", 1998). What is in the way counts less the farther it is, and not at all beyond [`REACH`]: a scan of a room is
//! not dark. The directions are the same for all places, so that a line of each direction is followed once for all of them
//! ([`super::layers`]).

use super::color::normal;
use super::fill::Pixel;
use super::layers::Layers;
use super::texels::{Texels, in_parallel, place};
use crate::base::error::Result;
use crate::base::par;
use crate::light::carry::Spot;
use crate::mesh::Mesh;
use glam::DVec3;
use std::f64::consts::PI;

/// Directions of lines, each of which is followed both ways.
const DIRECTIONS: usize = 64;
/// Directions whose lines are there at once.
const AT_ONCE: usize = 8;
/// What is farther is not in the way: a fraction of the diagonal.
const REACH: f64 = 0.25;

/// 0 to 255 for each texel.
pub(super) fn bake(
    texels: &Texels,
    spots: &[Spot],
    full: &Mesh,
    progress: &mut dyn FnMut(f32) -> Result<()>,
) -> Result<Vec<Option<Pixel>>> {
    let stand = |spot: &Spot| Seen {
        at: place(full, spot),
        normal: normal(full, spot),
        face: full
            .cross(full.triangles[spot.triangle as usize])
            .normalize_or_zero(),
        open: 0.0,
        all: 0.0,
    };
    let mut seen: Vec<Seen> = spots.iter().map(stand).collect();
    let directions: Vec<DVec3> = (0..DIRECTIONS).map(direction).collect();
    for (batch, some) in directions.chunks(AT_ONCE).enumerate() {
        let done = |part: f32| (batch as f32 + part) * AT_ONCE as f32 / DIRECTIONS as f32;
        progress(done(0.0))?;
        let layers = par::map(some.len(), || (), |k, ()| Layers::new(full, some[k]));
        let mut tell = |part: f32| progress(done(0.5 + 0.5 * part));
        seen = in_parallel(
            &seen,
            &mut tell,
            || (),
            |seen, ()| {
                layers.iter().fold(*seen, |seen, layers| {
                    let (free, cosine) = layers.free(seen.at, seen.normal, seen.face);
                    Seen {
                        open: seen.open + cosine * (free / REACH).min(1.0),
                        all: seen.all + cosine,
                        ..seen
                    }
                })
            },
        )?;
    }
    let mut pixels = vec![None; texels.size[0] * texels.size[1]];
    for (texel, Seen { open, all, .. }) in texels.all.iter().zip(seen) {
        let value = if all > 0.0 {
            (255.0 * open / all) as f32
        } else {
            255.0
        };
        pixels[texel.pixel as usize] = Some([value; 3]);
    }
    progress(1.0)?;
    Ok(pixels)
}

/// What was seen from a place so far.
#[derive(Clone, Copy)]
struct Seen {
    at: DVec3,
    normal: DVec3,
    /// The normal of the triangle that it lies on.
    face: DVec3,
    open: f64,
    all: f64,
}

/// Evenly over half a sphere: a Fibonacci lattice (R. Swinbank, R. J. Purser, "Fibonacci grids", 2006).
fn direction(k: usize) -> DVec3 {
    const GOLDEN: f64 = 2.399_963_229_728_653;
    let height = (k as f64 + 0.5) / DIRECTIONS as f64;
    let flat = (1.0 - height * height).sqrt();
    let turn = (k as f64 * GOLDEN) % (2.0 * PI);
    DVec3::new(flat * libm::cos(turn), flat * libm::sin(turn), height)
}
