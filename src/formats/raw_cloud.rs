//! [`RawCloud`]: the arrays of a file, in the file's frame. Readers make it, writers take it.

use super::faces::sampling::Sampling;
use crate::base::error::{Error, Result};
use crate::cloud::{Attribute, Cloud, Crs, Floor, Unit, Viewpoints};
#[cfg(feature = "stages")]
use crate::pipeline::Surface;

/// Coordinates `x y z x y z …`: single precision where that loses nothing that matters, else double.
#[derive(Debug, Clone, PartialEq)]
pub enum Positions {
    /// Rounding to single precision moves no coordinate by more than 2⁻²² of the diagonal (2.4e-7).
    F32(Vec<f32>),
    /// Single precision would not do: georeferenced coordinates, for one.
    F64(Vec<f64>),
}

impl Positions {
    /// Number of coordinates, three a point.
    pub fn len(&self) -> usize {
        match self {
            Positions::F32(values) => values.len(),
            Positions::F64(values) => values.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(super) fn get(&self, i: usize) -> f64 {
        match self {
            Positions::F32(values) => f64::from(values[i]),
            Positions::F64(values) => values[i],
        }
    }
}

/// Pictures on a mesh, and where its vertices are in them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Skin {
    /// Two a point, 0 to 1; the first row of a picture is at 0.
    pub uvs: Vec<f32>,
    /// Four a point: a unit vector, and the sign of the bitangent.
    pub tangents: Option<Vec<f32>>,
    /// The colours, as the bytes of a PNG file; in a GLB also of a JPEG, WebP or KTX2 file, as the others.
    pub color: Option<Vec<u8>>,
    /// The normals in the tangents' frames.
    pub normal: Option<Vec<u8>>,
    /// How open the surface is to the light around, in red.
    pub occlusion: Option<Vec<u8>>,
}

/// What a file holds, in the file's frame and unit: the caller's arrays, not yet a [`Cloud`]. May have no points.
#[derive(Debug, Clone, PartialEq)]
pub struct RawCloud {
    /// Finite coordinates.
    pub positions: Positions,
    /// `r g b` a point, 0-255.
    pub colors: Option<Vec<u8>>,
    /// `x y z` a point as in the file; zero where the file has none.
    pub normals: Option<Vec<f32>>,
    /// Other scalars, one value a point.
    pub attributes: Vec<Attribute>,
    /// Added to positions to give world coordinates.
    pub origin: Option<[f64; 3]>,
    /// Where the points were seen from.
    pub viewpoints: Option<Viewpoints>,
    /// Which way is up.
    pub up: Option<[f64; 3]>,
    /// Whether all was seen from above, as airborne scans are.
    pub seen_from_above: bool,
    /// What carried the object: a point and a normal.
    pub floor: Option<[[f64; 3]; 2]>,
    /// What a coordinate is.
    pub unit: Option<Unit>,
    /// The reference system of world coordinates.
    pub crs: Option<Crs>,
    /// Rows left out because a coordinate was NaN or infinite.
    pub dropped: usize,
    /// Values of colours, normals and attributes that were not finite and are now 0.
    pub replaced: usize,
    /// What a mesh wears besides.
    #[cfg(feature = "exports")]
    pub skin: Option<Box<Skin>>,
    /// Faces that the file says it has.
    pub faces: u64,
    /// What was made of them.
    pub sampling: Sampling,
    /// Points left out, by why: `not-finite`, `invalid`, `no-data`, `no-return`, `unused-vertices`; and `broken-faces`. The first
    /// two are `dropped`.
    pub skipped: Vec<(&'static str, u64)>,
    /// What the columns of a table of text were taken for, as [`crate::formats::ReadOptions::columns`] says it.
    pub columns: Vec<String>,
    /// What else is to be said of the points, in sentences.
    pub notes: Vec<String>,
}

impl RawCloud {
    /// Positions alone.
    pub fn new(positions: Positions) -> RawCloud {
        RawCloud {
            positions,
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
            dropped: 0,
            replaced: 0,
            #[cfg(feature = "exports")]
            skin: None,
            faces: 0,
            sampling: Sampling::default(),
            skipped: Vec::new(),
            columns: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// The points of a reduced cloud, in double precision.
    pub fn of_cloud(cloud: &Cloud) -> RawCloud {
        RawCloud {
            colors: cloud.colors.as_ref().map(|c| c.as_flattened().to_vec()),
            normals: cloud
                .normals
                .as_ref()
                .map(|n| n.iter().flat_map(|n| n.to_array()).collect()),
            attributes: cloud.attributes.clone(),
            origin: cloud.origin,
            viewpoints: cloud.viewpoints.clone(),
            up: cloud.up.map(|up| up.as_dvec3().to_array()),
            seen_from_above: cloud.seen_from_above,
            floor: cloud
                .floor
                .map(|floor| [floor.point, floor.normal.as_dvec3().to_array()]),
            unit: cloud.unit,
            crs: cloud.crs.clone(),
            ..RawCloud::new(Positions::F64(cloud.positions_f64()))
        }
    }

    /// The vertices of a mesh, in double precision; its triangles are [`Surface::indices`].
    #[cfg(feature = "stages")]
    pub fn of_surface(surface: &Surface) -> RawCloud {
        let cloud = &surface.cloud.reduced.cloud;
        RawCloud {
            colors: surface.colors.as_ref().map(|c| c.as_flattened().to_vec()),
            normals: Some(
                surface
                    .mesh
                    .normals
                    .iter()
                    .flat_map(|n| n.to_array())
                    .collect(),
            ),
            attributes: surface.attributes.clone(),
            origin: cloud.origin,
            up: cloud.up.map(|up| up.as_dvec3().to_array()),
            unit: cloud.unit,
            crs: cloud.crs.clone(),
            ..RawCloud::new(Positions::F64(surface.positions_f64()))
        }
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.positions.len() / 3
    }

    /// The cloud that the pipeline works on.
    ///
    /// # Errors
    /// [`Error::EmptyCloud`]; [`Error::BadLength`], [`Error::NonFinite`] and [`Error::BadOption`] for what no reader made.
    pub fn to_cloud(&self) -> Result<Cloud> {
        let mut cloud = match &self.positions {
            Positions::F32(values) => Cloud::from_f32(values)?,
            Positions::F64(values) => Cloud::from_f64(values)?,
        };
        if let Some(colors) = &self.colors {
            cloud = cloud.with_colors(colors)?;
        }
        if let Some(normals) = &self.normals {
            cloud = cloud.with_normals(normals)?;
        }
        for attribute in &self.attributes {
            cloud = cloud.with_attribute(&attribute.name, &attribute.values)?;
        }
        if let Some(Viewpoints { positions, of }) = &self.viewpoints {
            let positions: Vec<f64> = positions.iter().flat_map(|p| p.to_array()).collect();
            cloud = cloud.with_viewpoints(&positions, of.as_deref())?;
        }
        if let Some(up) = self.up {
            cloud = cloud.with_up(up)?;
        }
        if let Some([point, normal]) = self.floor {
            cloud = cloud.with_floor(Floor::new(point, normal)?);
        }
        cloud.origin = self.origin;
        cloud.unit = self.unit;
        cloud.crs = self.crs.clone();
        // Points of faces are no measurements, and the results say so.
        cloud.faces = if self.sampling.points > 0 {
            self.faces
        } else {
            0
        };
        Ok(cloud.with_seen_from_above(self.seen_from_above))
    }

    /// Builds without writers have none.
    pub(super) fn skin(&self) -> Option<&Skin> {
        #[cfg(feature = "exports")]
        let skin = self.skin.as_deref();
        #[cfg(not(feature = "exports"))]
        let skin = None;
        skin
    }

    /// Checks that every array has one entry a point.
    pub(super) fn check_lengths(&self) -> Result<()> {
        let points = self.points();
        let skin = self.skin();
        let tangents = skin.and_then(|skin| skin.tangents.as_ref());
        let arrays = [
            ("positions", Some(self.positions.len()), 3),
            ("colors", self.colors.as_ref().map(Vec::len), 3),
            ("normals", self.normals.as_ref().map(Vec::len), 3),
            ("uvs", skin.map(|skin| skin.uvs.len()), 2),
            ("tangents", tangents.map(Vec::len), 4),
        ];
        let attributes = self
            .attributes
            .iter()
            .map(|attribute| (attribute.name.as_str(), Some(attribute.values.len()), 1));
        for (array, found, each) in arrays.into_iter().chain(attributes) {
            let expected = points * each;
            match found {
                Some(found) if found != expected => {
                    return Err(Error::BadLength {
                        array: array.into(),
                        expected: format!("{expected} ({each} a point)"),
                        found,
                    });
                }
                _ => {}
            }
        }
        Ok(())
    }
}
