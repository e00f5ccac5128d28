//! Binary glTF 2.0: one mesh, of triangles or of points, in one buffer.
//!
//! - `POSITION` in single precision; the origin is the node's `translation`, which JSON holds in double precision. Axes and
//!   unit stay the caller's.
//! - `NORMAL` where every normal has a direction: the format has no word for one that is not known.
//! - `COLOR_0` as four unsigned shorts, linear as the format wants: bytes would make one of many dark colours, shorts give
//!   every colour back.
//! - Attributes in single precision as `_NAME`, as the format wants its guests.
//! - With `quantize` positions are unsigned shorts over the longest side and normals bytes (`KHR_mesh_quantization`); a node
//!   of its own scales them back, so that the origin's stays exact.

use super::local::Local;
use super::material::Material;
use super::values::linear;
use crate::base::error::{Error, Result};
use crate::cloud::Attribute;
use crate::formats::raw_cloud::RawCloud;
use glam::Vec3;

/// Component types of accessors.
const BYTE: u32 = 5120;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

/// Targets of buffer views.
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// Writes points and, with `triangles`, a mesh.
pub(super) fn write(
    cloud: &RawCloud,
    triangles: Option<&[u32]>,
    quantize: bool,
) -> Result<Vec<u8>> {
    let local = Local::of(cloud)?;
    let points = cloud.points();
    // The format has no empty arrays.
    if points == 0 {
        return Err(Error::EmptyCloud);
    }
    let triangles = triangles.filter(|indices| !indices.is_empty());
    let mut file = File::default();
    let mut attributes = Vec::new();
    let mut attribute = |name: &str, accessor: usize| {
        attributes.push(format!("\"{name}\":{accessor}"));
    };

    let grid = quantize.then(|| Grid::over(&local.positions));
    attribute(
        "POSITION",
        match &grid {
            Some(grid) => file.quantized_positions(&local.positions, grid),
            None => file.positions(&local.positions),
        },
    );
    if let Some(normals) = unit_normals(cloud)? {
        attribute(
            "NORMAL",
            match quantize {
                true => file.quantized_normals(&normals),
                false => file.floats(&normals, VEC3, ""),
            },
        );
    }
    let skin = cloud.skin().filter(|_| triangles.is_some());
    if let Some(skin) = skin {
        check_finite("uvs", &skin.uvs, 2)?;
        attribute("TEXCOORD_0", file.floats(&skin.uvs, VEC2, ""));
        if let Some(tangents) = &skin.tangents {
            check_finite("tangents", tangents, 4)?;
            attribute("TANGENT", file.floats(tangents, VEC4, ""));
        }
    }
    // Where there is a picture of them, they would be multiplied with it.
    let pictured = skin.is_some_and(|skin| skin.color.is_some());
    if let Some(colors) = cloud.colors.as_ref().filter(|_| !pictured) {
        attribute("COLOR_0", file.colors(colors));
    }
    for (name, scalar) in names(&cloud.attributes).iter().zip(&cloud.attributes) {
        check_finite(&scalar.name, &scalar.values, 1)?;
        attribute(name, file.floats(&scalar.values, SCALAR, ""));
    }
    let primitive = match triangles {
        Some(indices) => format!("\"indices\":{}", file.indices(indices, points)),
        None => "\"mode\":0".into(),
    };
    let mesh = format!(
        "\"meshes\":[{{\"primitives\":[{{\"attributes\":{{{}}},{primitive},\"material\":0}}]}}]",
        attributes.join(",")
    );
    let mut material = Material::default();
    if let Some(skin) = skin {
        material.wear(skin, &mut |bytes| file.picture(bytes))?;
    }
    let nodes = nodes(local.origin, grid.as_ref());
    Ok(file.finish(&mesh, &nodes, &material, quantize))
}

/// The node of the mesh, and above it that of the origin where quantised positions have a place of their own.
fn nodes(origin: Option<[f64; 3]>, grid: Option<&Grid>) -> String {
    let translation = |t: [f64; 3]| format!("\"translation\":{t:?}");
    let scaled = |g: &Grid| {
        let start = translation(g.start.map(f64::from));
        format!("{{\"mesh\":0,{start},\"scale\":{:?}}}", [g.step; 3])
    };
    match (origin.map(translation), grid) {
        (None, None) => "{\"mesh\":0}".into(),
        (Some(origin), None) => format!("{{\"mesh\":0,{origin}}}"),
        (None, Some(grid)) => scaled(grid),
        (Some(origin), Some(grid)) => format!("{{\"children\":[1],{origin}}},{}", scaled(grid)),
    }
}

/// Where quantised positions lie: `start + step · integer`.
struct Grid {
    start: [f32; 3],
    step: f64,
}

impl Grid {
    /// The same step on every axis, so that normals keep their directions.
    fn over(positions: &[f32]) -> Grid {
        let [lo, hi] = bounds(positions);
        let sides = (0..3).map(|a| f64::from(hi[a]) - f64::from(lo[a]));
        let longest = sides.fold(0.0, f64::max);
        Grid {
            start: lo,
            step: if longest > 0.0 {
                longest / f64::from(u16::MAX)
            } else {
                1.0
            },
        }
    }

    fn of(&self, x: f32, axis: usize) -> u16 {
        ((f64::from(x) - f64::from(self.start[axis])) / self.step).round() as u16
    }
}

/// How many values one element has, and what that is called.
type Kind = (usize, &'static str);
const SCALAR: Kind = (1, "SCALAR");
const VEC2: Kind = (2, "VEC2");
const VEC3: Kind = (3, "VEC3");
const VEC4: Kind = (4, "VEC4");

/// The binary part as far as it is written, and what the JSON says of it.
#[derive(Default)]
struct File {
    bytes: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl File {
    /// Describes what was appended since `start` as a view and an accessor to it, padded to four bytes; gives the accessor's
    /// index. `view` and `also` are more of what the JSON says.
    fn finish_view(
        &mut self,
        start: usize,
        view: &str,
        component: u32,
        kind: &str,
        count: usize,
        also: &str,
    ) -> usize {
        let length = self.bytes.len() - start;
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(format!(
            "{{\"buffer\":0,\"byteOffset\":{start},\"byteLength\":{length},{view}}}"
        ));
        let index = self.accessors.len();
        self.accessors.push(format!(
            "{{\"bufferView\":{index},\"componentType\":{component},\"type\":\"{kind}\",\"count\":{count}{also}}}"
        ));
        index
    }

    /// Elements of vertices, each of `stride` bytes.
    fn vertices(
        &mut self,
        start: usize,
        stride: usize,
        component: u32,
        kind: &str,
        also: &str,
    ) -> usize {
        let count = (self.bytes.len() - start) / stride;
        let view = format!("\"byteStride\":{stride},\"target\":{ARRAY_BUFFER}");
        self.finish_view(start, &view, component, kind, count, also)
    }

    /// The bytes of a picture's file; gives the view's index.
    fn picture(&mut self, file: &[u8]) -> usize {
        let start = self.bytes.len();
        self.bytes.extend_from_slice(file);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let length = file.len();
        self.views.push(format!(
            "{{\"buffer\":0,\"byteOffset\":{start},\"byteLength\":{length}}}"
        ));
        self.views.len() - 1
    }

    fn floats(&mut self, values: &[f32], (size, kind): Kind, also: &str) -> usize {
        let start = self.bytes.len();
        for x in values {
            self.bytes.extend_from_slice(&x.to_le_bytes());
        }
        self.vertices(start, 4 * size, FLOAT, kind, also)
    }

    /// Elements of four shorts, the last of which `kind` may leave out.
    fn shorts(&mut self, values: &[[u16; 4]], (_, kind): Kind, also: &str) -> usize {
        let start = self.bytes.len();
        for x in values.as_flattened() {
            self.bytes.extend_from_slice(&x.to_le_bytes());
        }
        self.vertices(start, 8, UNSIGNED_SHORT, kind, also)
    }

    fn positions(&mut self, positions: &[f32]) -> usize {
        let [lo, hi] = bounds(positions).map(|corner| corner.map(f64::from));
        let range = format!(",\"min\":{lo:?},\"max\":{hi:?}");
        self.floats(positions, VEC3, &range)
    }

    fn quantized_positions(&mut self, positions: &[f32], grid: &Grid) -> usize {
        let place = |p: &[f32]| {
            let [x, y, z] = [0, 1, 2].map(|axis| grid.of(p[axis], axis));
            [x, y, z, 0]
        };
        let values: Vec<[u16; 4]> = positions.chunks_exact(3).map(place).collect();
        // The grid does not decrease, so it has the corners where the positions have them.
        let [[x, y, z, _], [u, v, w, _]] = bounds(positions).map(|corner| place(&corner));
        let range = format!(",\"min\":[{x},{y},{z}],\"max\":[{u},{v},{w}]");
        self.shorts(&values, VEC3, &range)
    }

    fn quantized_normals(&mut self, normals: &[f32]) -> usize {
        let start = self.bytes.len();
        for normal in normals.chunks_exact(3) {
            let [x, y, z] = [0, 1, 2].map(|axis| (normal[axis] * f32::from(i8::MAX)).round() as i8);
            self.bytes
                .extend_from_slice(&[x, y, z, 0].map(|byte| byte as u8));
        }
        self.vertices(start, 4, BYTE, "VEC3", NORMALIZED)
    }

    fn colors(&mut self, colors: &[u8]) -> usize {
        let short = |c| (linear(c) * f64::from(u16::MAX)).round() as u16;
        let linear: Vec<u16> = (0..=u8::MAX).map(short).collect();
        let of = |c: &[u8]| {
            let [r, g, b] = [0, 1, 2].map(|k| linear[usize::from(c[k])]);
            [r, g, b, u16::MAX]
        };
        let values: Vec<[u16; 4]> = colors.chunks_exact(3).map(of).collect();
        self.shorts(&values, VEC4, NORMALIZED)
    }

    /// As shorts where they suffice; the largest short means the end of a strip.
    fn indices(&mut self, indices: &[u32], points: usize) -> usize {
        let start = self.bytes.len();
        let short = points <= usize::from(u16::MAX);
        let (component, size) = if short {
            (UNSIGNED_SHORT, 2)
        } else {
            (UNSIGNED_INT, 4)
        };
        for i in indices {
            self.bytes.extend_from_slice(&i.to_le_bytes()[..size]);
        }
        let view = format!("\"target\":{ELEMENT_ARRAY_BUFFER}");
        self.finish_view(start, &view, component, "SCALAR", indices.len(), "")
    }

    /// Header, JSON, binary part.
    fn finish(self, mesh: &str, nodes: &str, material: &Material, quantized: bool) -> Vec<u8> {
        let mut needed = material.extensions.clone();
        needed.extend(quantized.then_some("KHR_mesh_quantization"));
        let list: Vec<String> = needed.iter().map(|name| format!("\"{name}\"")).collect();
        let list = list.join(",");
        let extensions = match needed.is_empty() {
            true => String::new(),
            false => format!("\"extensionsUsed\":[{list}],\"extensionsRequired\":[{list}],"),
        };
        let mut json = format!(
            "{{\"asset\":{{\"version\":\"2.0\",\"generator\":\"Pointweave {}\"}},{extensions}\"scene\":0,\
             \"scenes\":[{{\"nodes\":[0]}}],\"nodes\":[{nodes}],{mesh},\
             \"materials\":[{{\"pbrMetallicRoughness\":{{{}\"metallicFactor\":0,\"roughnessFactor\":0.9}},{}{}\"doubleSided\":true}}],{}\
             \"accessors\":[{}],\"bufferViews\":[{}],\"buffers\":[{{\"byteLength\":{}}}]}}",
            env!("CARGO_PKG_VERSION"),
            material.color,
            material.normal,
            material.occlusion,
            material.pictures(),
            self.accessors.join(","),
            self.views.join(","),
            self.bytes.len()
        );
        while json.len() % 4 != 0 {
            json.push(' ');
        }
        let chunks: [(&[u8; 4], &[u8]); 2] = [(b"JSON", json.as_bytes()), (b"BIN\0", &self.bytes)];
        let length = 12
            + chunks
                .iter()
                .map(|(_, chunk)| 8 + chunk.len())
                .sum::<usize>();
        let mut out = Vec::with_capacity(length);
        out.extend(b"glTF");
        out.extend(2u32.to_le_bytes());
        out.extend((length as u32).to_le_bytes());
        for (name, chunk) in chunks {
            out.extend((chunk.len() as u32).to_le_bytes());
            out.extend(name);
            out.extend(chunk);
        }
        out
    }
}

/// Of integers that stand for -1 to 1, or 0 to 1.
const NORMALIZED: &str = ",\"normalized\":true";

/// Lowest and highest coordinates.
pub(super) fn bounds(positions: &[f32]) -> [[f32; 3]; 2] {
    let (mut lo, mut hi) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for p in positions.chunks_exact(3) {
        for axis in 0..3 {
            lo[axis] = lo[axis].min(p[axis]);
            hi[axis] = hi[axis].max(p[axis]);
        }
    }
    [lo, hi]
}

/// The normals, those that are not of unit length made so; `None` without any, or where one is zero.
pub(super) fn unit_normals(cloud: &RawCloud) -> Result<Option<Vec<f32>>> {
    const ROUNDING: f32 = 1e-5;
    let Some(normals) = &cloud.normals else {
        return Ok(None);
    };
    check_finite("normals", normals, 3)?;
    let mut unit = Vec::with_capacity(normals.len());
    for normal in normals.chunks_exact(3) {
        let own = Vec3::from_slice(normal);
        let is_unit = (own.length_squared() - 1.0).abs() < ROUNDING;
        let Some(n) = (if is_unit {
            Some(own)
        } else {
            own.try_normalize()
        }) else {
            return Ok(None);
        };
        unit.extend_from_slice(&n.to_array());
    }
    Ok(Some(unit))
}

/// `_NAME` for each attribute: upper case letters, digits and underscores, which need no escapes; no name twice.
fn names(attributes: &[Attribute]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for Attribute { name, .. } in attributes {
        let known = |c: char| {
            if c.is_ascii_alphanumeric() {
                c.to_ascii_uppercase()
            } else {
                '_'
            }
        };
        let mut word: String = name.chars().map(known).collect();
        word.insert(0, '_');
        while names.contains(&word) {
            word.push('_');
        }
        names.push(word);
    }
    names
}

pub(super) fn check_finite(array: &str, values: &[f32], each: usize) -> Result<()> {
    match values.iter().position(|x| !x.is_finite()) {
        None => Ok(()),
        Some(i) => Err(Error::NonFinite {
            array: array.into(),
            index: i / each,
            found: values[i].into(),
        }),
    }
}
