//! The caller's arrays become a [`Cloud`]: checked, in the unit frame, and in an order in which neighbours are near.
//!
//! 1. [`Cloud`] checks lengths and finiteness and moves positions to the unit frame (`f32`, bounding box centred at the
//!    origin, diagonal 1); [`Frame`] takes them back.
//! 2. [`octree::Octree`] puts the points in Morton order ([`morton`]) and cuts them into cells: the paper's sub-domains
//!    (section 3) and the index of all neighbour queries ([`queries`]).
//! 3. [`neighborhood`] asks for the neighbours of a whole cell of points at once, `near` for those that a query gives to each.
//!
//! **In**: `x y z …` in the caller's frame and unit, `f32` or `f64`; per-point colours, normals, scalars; where and how it was
//! seen. **Out**: the same in the unit frame, in the caller's order; the tree has its own order and says which point is which.
//!
//! **Cost**: linear for the cloud, n log n for the tree; a query takes about log n + k steps for k neighbours.

pub(crate) mod copies;
mod crs;
mod floor;
pub mod morton;
pub(crate) mod near;
pub mod neighborhood;
pub mod octree;
pub mod queries;
mod unit;
mod viewpoints;

use crate::base::error::{Error, Result};
use glam::Vec3;
use std::ops::Range;

pub use crs::Crs;
pub use floor::Floor;
pub use unit::Unit;
pub use viewpoints::Viewpoints;

/// The bounding box is that of the others where a few points make it this many times as long: at 100 times a surface of
/// what is near was gone, at 10,000 single precision has nothing left for it. Beyond the end of the range squares overflow.
const FAR_OUT: Range<f64> = 10.0..1e15;
/// Those are less than this share of the points, on any side.
const A_FEW: f64 = 0.02;
/// Points that tell where most are.
const SAMPLE: usize = 4096;

/// Where the unit frame lies in the caller's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Centre of the bounding box, in the caller's frame and unit.
    pub center: [f64; 3],
    /// Diagonal of the bounding box in the caller's unit; 1 when all points are equal. Without the few points that
    /// make it more than ten times as long.
    pub diagonal: f64,
}

impl Frame {
    /// The frame of these points, or the index of the first coordinate that is not finite.
    fn of<T: Copy + Into<f64>>(positions: &[T]) -> std::result::Result<Frame, usize> {
        if let Some(i) = positions.iter().position(|&x| !x.into().is_finite()) {
            return Err(i);
        }
        let all = Frame::around(triples(positions));
        let most = Frame::around_most(positions);
        let far_out = |frame: &Frame| FAR_OUT.contains(&(all.diagonal / frame.diagonal));
        Ok(most.filter(far_out).unwrap_or(all))
    }

    /// The frame of the bounding box.
    fn around(points: impl Iterator<Item = [f64; 3]>) -> Frame {
        let (mut lo, mut hi) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in points {
            for a in 0..3 {
                lo[a] = lo[a].min(p[a]);
                hi[a] = hi[a].max(p[a]);
            }
        }
        // Halved before they are added or subtracted: extents up to the largest f64 do not overflow.
        let center = [0, 1, 2].map(|a| lo[a] * 0.5 + hi[a] * 0.5);
        let half = [0, 1, 2].map(|a| hi[a] * 0.5 - lo[a] * 0.5);
        let longest = half[0].max(half[1]).max(half[2]);
        let diagonal = if longest > 0.0 {
            let h = half.map(|x| x / longest);
            2.0 * longest * (h[0] * h[0] + h[1] * h[1] + h[2] * h[2]).sqrt()
        } else {
            1.0
        };
        Frame { center, diagonal }
    }

    /// The frame of the points near most of them; `None` where that would leave out more than [`A_FEW`], or where most are at
    /// one place.
    fn around_most<T: Copy + Into<f64>>(positions: &[T]) -> Option<Frame> {
        let count = positions.len() / 3;
        let stride = count.div_ceil(SAMPLE);
        let mut corners = [[0.0; 3]; 2];
        for a in 0..3 {
            let mut x: Vec<f64> = triples(positions).step_by(stride).map(|p| p[a]).collect();
            let few = (x.len() as f64 * A_FEW).ceil() as usize;
            let last = x.len().checked_sub(few + 1)?;
            for (corner, place) in corners.iter_mut().zip([few, last]) {
                corner[a] = *x.select_nth_unstable_by(place, f64::total_cmp).1;
            }
        }
        let inner = Frame::around(corners.into_iter());
        let near =
            |p: &[f64; 3]| (0..3).all(|a| (p[a] - inner.center[a]).abs() < 10.0 * inner.diagonal);
        let near = || triples(positions).filter(near);
        let most = (count as f64 * (1.0 - A_FEW)).ceil() as usize;
        (corners[0] != corners[1] && near().count() >= most).then(|| Frame::around(near()))
    }

    /// A point of the caller's frame in the unit frame.
    pub fn to_unit(&self, p: [f64; 3]) -> Vec3 {
        let q = [0, 1, 2].map(|a| ((p[a] - self.center[a]) / self.diagonal) as f32);
        Vec3::from_array(q)
    }

    /// A point of the unit frame in the caller's frame.
    pub fn to_caller(&self, p: Vec3) -> [f64; 3] {
        let p = p.to_array();
        [0, 1, 2].map(|a| p[a] as f64 * self.diagonal + self.center[a])
    }
}

/// Whether the unit frame's box has room for a point: it leaves out the few that are far from all others, which are no part
/// of a surface, nor of what is measured of one.
pub(crate) fn in_frame(p: Vec3) -> bool {
    p.abs().max_element() <= 1.0
}

/// One scalar a point: intensity, classification, time …
#[derive(Debug, Clone, PartialEq)]
pub struct Attribute {
    /// The caller's name for it.
    pub name: String,
    /// One value a point.
    pub values: Vec<f32>,
}

/// Points in the unit frame with whatever the caller attached to them. Every array has one entry a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Cloud {
    /// Bounding box centred at the origin, diagonal 1.
    pub points: Vec<Vec3>,
    /// Where the unit frame lies in the caller's.
    pub frame: Frame,
    /// Red, green, blue, 0-255.
    pub colors: Option<Vec<[u8; 3]>>,
    /// Unit normals.
    pub normals: Option<Vec<Vec3>>,
    /// Scalars, in the caller's order.
    pub attributes: Vec<Attribute>,
    /// Added to the caller's positions to give world coordinates; carried along.
    pub origin: Option<[f64; 3]>,
    /// Where the points were seen from.
    pub viewpoints: Option<Viewpoints>,
    /// Which way is up: a unit vector along the caller's axes.
    pub up: Option<Vec3>,
    /// Whether all was seen from high above, along `up` (z where there is none): airborne scans.
    pub seen_from_above: bool,
    /// What carried the object, where that is known.
    pub floor: Option<Floor>,
    /// What a coordinate of the caller's frame is.
    pub unit: Option<Unit>,
    /// The reference system of world coordinates; carried along.
    pub crs: Option<Crs>,
    /// How many faces the points were taken from; 0 for points that were measured.
    pub faces: u64,
}

impl Cloud {
    /// From `x y z x y z …` in the caller's frame.
    ///
    /// # Errors
    /// [`Error::EmptyCloud`], [`Error::BadLength`] (not a multiple of 3), [`Error::NonFinite`] (the point's index).
    pub fn from_f64(positions: &[f64]) -> Result<Cloud> {
        Cloud::from_positions(positions)
    }

    /// [`Cloud::from_f64`] for single precision.
    ///
    /// # Errors
    /// The same.
    pub fn from_f32(positions: &[f32]) -> Result<Cloud> {
        Cloud::from_positions(positions)
    }

    fn from_positions<T: Copy + Into<f64>>(positions: &[T]) -> Result<Cloud> {
        if !positions.len().is_multiple_of(3) {
            return Err(Error::BadLength {
                array: "positions".into(),
                expected: "a multiple of 3".into(),
                found: positions.len(),
            });
        }
        if positions.is_empty() {
            return Err(Error::EmptyCloud);
        }
        let frame = Frame::of(positions).map_err(|i| Error::NonFinite {
            array: "positions".into(),
            index: i / 3,
            found: positions[i].into(),
        })?;
        let points = triples(positions).map(|p| frame.to_unit(p)).collect();
        Ok(Cloud::in_frame(points, frame))
    }

    /// Of points that are in the unit frame.
    pub(crate) fn in_frame(points: Vec<Vec3>, frame: Frame) -> Cloud {
        Cloud {
            points,
            frame,
            colors: None,
            normals: None,
            attributes: Vec::new(),
            origin: None,
            viewpoints: None,
            up: None,
            seen_from_above: false,
            floor: None,
            unit: None,
            crs: None,
            faces: 0,
        }
    }

    /// Number of points, at least 1.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Never true for a cloud made by [`Cloud::from_f64`].
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Adds colours, `r g b` 0-255 a point.
    ///
    /// # Errors
    /// [`Error::BadLength`].
    pub fn with_colors(mut self, colors: &[u8]) -> Result<Cloud> {
        self.check_length("colors", colors.len(), 3)?;
        self.colors = Some(colors.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect());
        Ok(self)
    }

    /// Adds normals, `x y z` a point; made unit length here. One that is zero or not finite is none and becomes zero; without any
    /// other the cloud has none.
    ///
    /// # Errors
    /// [`Error::BadLength`].
    pub fn with_normals(mut self, normals: &[f32]) -> Result<Cloud> {
        self.check_length("normals", normals.len(), 3)?;
        let normals: Vec<Vec3> = normals
            .chunks_exact(3)
            .map(|n| Vec3::new(n[0], n[1], n[2]).normalize_or_zero())
            .collect();
        let has_any = normals.iter().any(|n| *n != Vec3::ZERO);
        self.normals = has_any.then_some(normals);
        Ok(self)
    }

    /// Adds a scalar, one value a point.
    ///
    /// # Errors
    /// [`Error::BadLength`], [`Error::NonFinite`].
    pub fn with_attribute(mut self, name: &str, values: &[f32]) -> Result<Cloud> {
        self.check_length(name, values.len(), 1)?;
        check_finite(name, values, 1)?;
        self.attributes.push(Attribute {
            name: name.into(),
            values: values.to_vec(),
        });
        Ok(self)
    }

    /// Sets the origin that is added to positions to give world coordinates.
    pub fn with_origin(mut self, origin: [f64; 3]) -> Cloud {
        self.origin = Some(origin);
        self
    }

    /// Says where the points were seen from: `x y z …` in the caller's frame, and for each point which of these saw it
    /// ([`Viewpoints::UNKNOWN`]: none of them); without `of` the first saw all.
    ///
    /// # Errors
    /// Those of [`Viewpoints::new`].
    pub fn with_viewpoints(mut self, positions: &[f64], of: Option<&[u32]>) -> Result<Cloud> {
        self.viewpoints = Some(Viewpoints::new(positions, of, self.len())?);
        Ok(self)
    }

    /// Says which way is up, along the caller's axes; made unit length here.
    ///
    /// # Errors
    /// [`Error::BadOption`] (zero or not finite).
    pub fn with_up(mut self, up: [f64; 3]) -> Result<Cloud> {
        let longest = up.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        if !up.iter().all(|x| x.is_finite()) || longest == 0.0 {
            return Err(Error::BadOption {
                option: "up".into(),
                expected: "three finite numbers that are not all 0".into(),
                found: format!("{}, {}, {}", up[0], up[1], up[2]),
            });
        }
        let up = Vec3::from_array(up.map(|x| (x / longest) as f32));
        self.up = Some(up.normalize());
        Ok(self)
    }

    /// Says whether all was seen from high above, as airborne scans are.
    pub fn with_seen_from_above(mut self, seen_from_above: bool) -> Cloud {
        self.seen_from_above = seen_from_above;
        self
    }

    /// Says what carried the object: the base of a mesh (`boundary: 'base'`) is there.
    pub fn with_floor(mut self, floor: Floor) -> Cloud {
        self.floor = Some(floor);
        self
    }

    /// Says what a coordinate of the caller's frame is.
    pub fn with_unit(mut self, unit: Unit) -> Cloud {
        self.unit = Some(unit);
        self
    }

    /// These points alone, in the unit frame of their own bounding box. Positions are rounded once more: by at most 2⁻²⁴ of
    /// this cloud's diagonal.
    ///
    /// # Errors
    /// [`Error::EmptyCloud`] without indices.
    pub fn select(&self, indices: &[u32]) -> Result<Cloud> {
        let each = || indices.iter().map(|&i| i as usize);
        let positions: Vec<f64> = each()
            .flat_map(|i| self.frame.to_caller(self.points[i]))
            .collect();
        Ok(Cloud {
            colors: self.colors.as_ref().map(|c| each().map(|i| c[i]).collect()),
            normals: self
                .normals
                .as_ref()
                .map(|n| each().map(|i| n[i]).collect()),
            attributes: self
                .attributes
                .iter()
                .map(|a| Attribute {
                    name: a.name.clone(),
                    values: each().map(|i| a.values[i]).collect(),
                })
                .collect(),
            origin: self.origin,
            viewpoints: self.viewpoints.as_ref().map(|v| v.select(each())),
            up: self.up,
            seen_from_above: self.seen_from_above,
            floor: self.floor,
            unit: self.unit,
            crs: self.crs.clone(),
            faces: self.faces,
            ..Cloud::from_f64(&positions)?
        })
    }

    /// `x y z …` in the caller's frame.
    pub fn positions_f64(&self) -> Vec<f64> {
        self.points
            .iter()
            .flat_map(|&p| self.frame.to_caller(p))
            .collect()
    }

    /// `x y z …` in the caller's frame, rounded to single precision.
    pub fn positions_f32(&self) -> Vec<f32> {
        self.points
            .iter()
            .flat_map(|&p| self.frame.to_caller(p).map(|x| x as f32))
            .collect()
    }

    fn check_length(&self, array: &str, found: usize, each: usize) -> Result<()> {
        let expected = self.len() * each;
        if found == expected {
            return Ok(());
        }
        Err(Error::BadLength {
            array: array.into(),
            expected: format!("{expected} ({each} a point)"),
            found,
        })
    }
}

fn triples<T: Copy + Into<f64>>(positions: &[T]) -> impl Iterator<Item = [f64; 3]> + Clone {
    positions
        .chunks_exact(3)
        .map(|p| [p[0].into(), p[1].into(), p[2].into()])
}

fn check_finite(array: &str, values: &[f32], each: usize) -> Result<()> {
    match values.iter().position(|v| !v.is_finite()) {
        None => Ok(()),
        Some(i) => Err(Error::NonFinite {
            array: array.into(),
            index: i / each,
            found: values[i] as f64,
        }),
    }
}
