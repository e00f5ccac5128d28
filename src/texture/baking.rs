//! Each map from its places to its file.

use super::fill::{Pixel, fill};
use super::maps::{Map, Paint, Scan, Texture};
use super::texels::Texels;
use super::{color, occlusion, picture, relief};
use crate::base::error::Result;
use crate::light::carry::Spot;
use crate::mesh::Mesh;
use crate::report::distance::TriangleTree;
use png::ColorType;

/// Shade changes slowly: its picture is so many times less wide and high.
const SHADE: usize = 2;

/// What all maps of a mesh are made of.
pub(super) struct Baking<'a> {
    pub(super) full: &'a Mesh,
    /// Of the full mesh.
    pub(super) faces: &'a TriangleTree<'a>,
    /// As it was unwrapped.
    pub(super) light: &'a Mesh,
    pub(super) uvs: &'a [[f32; 2]],
    pub(super) tangents: &'a [[f32; 4]],
    pub(super) scan: Scan<'a>,
    /// Width and height of the pictures.
    pub(super) size: [usize; 2],
}

/// Told how much is done.
type Tell<'t> = &'t mut dyn FnMut(f32) -> Result<()>;

impl Baking<'_> {
    /// The maps that are asked for and that there is something to show of, in that order.
    pub(super) fn all(&self, maps: &[Map], tell: Tell) -> Result<Vec<Texture>> {
        let mut fine = None;
        let mut textures = Vec::new();
        let each = 1.0 / maps.len().max(1) as f32;
        for (i, &map) in maps.iter().enumerate() {
            let mut tell = |part: f32| tell((i as f32 + part) * each);
            let texture = match map {
                Map::Occlusion => {
                    let size = self.size.map(|n| n.div_ceil(SHADE));
                    Some(self.baked(map, &self.places(size, &mut tell)?, &mut tell)?)
                }
                Map::Color if matches!(self.scan.paint, Paint::Nothing) => None,
                Map::Color | Map::Normal => {
                    let places = match fine.take() {
                        Some(places) => places,
                        None => self.places(self.size, &mut tell)?,
                    };
                    Some(self.baked(map, fine.insert(places), &mut tell)?)
                }
            };
            textures.extend(texture);
        }
        tell(1.0)?;
        Ok(textures)
    }

    /// The texels of a picture, and where the full mesh is nearest to them.
    fn places(&self, size: [usize; 2], tell: Tell) -> Result<(Texels, Vec<Spot>)> {
        let texels = Texels::new(self.light, self.uvs, size);
        let mut tell = |part: f32| tell(0.5 * part);
        let spots = texels.spots(self.light, (self.full, self.faces), &mut tell)?;
        Ok((texels, spots))
    }

    fn baked(
        &self,
        map: Map,
        (texels, spots): &(Texels, Vec<Spot>),
        tell: Tell,
    ) -> Result<Texture> {
        let mut tell = |part: f32| tell(0.5 + 0.45 * part);
        let pixels = match map {
            Map::Color => {
                let Scan { points, paint } = &self.scan;
                let points = color::Points::new(points, paint, (self.full, self.faces));
                points.bake(texels, spots, self.full, &mut tell)?
            }
            Map::Normal => {
                let frames = (self.light, self.tangents);
                relief::bake(texels, spots, self.full, frames, &mut tell)?
            }
            Map::Occlusion => occlusion::bake(texels, spots, self.full, &mut tell)?,
        };
        let ramp = match (map, self.scan.paint) {
            (Map::Color, Paint::Scalars { ramp, .. }) => Some(ramp),
            _ => None,
        };
        file(map, pixels, texels.size, ramp)
    }
}

/// The file of a picture, with all of its texels; values become colours of the ramp.
fn file(
    map: Map,
    pixels: Vec<Option<Pixel>>,
    size: [usize; 2],
    ramp: Option<&[[u8; 3]]>,
) -> Result<Texture> {
    let filled = fill(pixels, size);
    let byte = |x: &f32| x.round() as u8;
    let (bytes, kind): (Vec<u8>, _) = match (map, ramp) {
        (Map::Occlusion, _) => (
            filled.iter().map(|[x, ..]| byte(x)).collect(),
            ColorType::Grayscale,
        ),
        (_, Some(ramp)) => {
            let color = |[x, ..]: &Pixel| ramp[(x * (ramp.len() - 1) as f32).round() as usize];
            (filled.iter().flat_map(color).collect(), ColorType::Rgb)
        }
        (Map::Color | Map::Normal, None) => (
            filled.as_flattened().iter().map(byte).collect(),
            ColorType::Rgb,
        ),
    };
    Ok(Texture {
        map,
        width: size[0],
        height: size[1],
        png: picture::png(&bytes, size, kind)?,
    })
}
