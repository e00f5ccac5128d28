//! What a glTF file describes, as far as vertices need it, and where its nodes place them.

use super::super::input::Input;
use crate::base::error::Result;
use serde::Deserialize;
use std::collections::BTreeMap;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    #[serde(default)]
    pub(super) accessors: Vec<AccessorEntry>,
    #[serde(default)]
    pub(super) buffer_views: Vec<BufferView>,
    #[serde(default)]
    buffers: Vec<Buffer>,
    #[serde(default)]
    pub(super) materials: Vec<Material>,
    #[serde(default)]
    pub(super) textures: Vec<TextureEntry>,
    #[serde(default)]
    pub(super) images: Vec<Image>,
    #[serde(default)]
    pub(super) samplers: Vec<Sampler>,
    #[serde(default)]
    meshes: Vec<Mesh>,
    #[serde(default)]
    nodes: Vec<Node>,
    #[serde(default)]
    scenes: Vec<Scene>,
    scene: Option<usize>,
    #[serde(default)]
    extensions_required: Vec<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct AccessorEntry {
    pub(super) buffer_view: Option<usize>,
    #[serde(default)]
    pub(super) byte_offset: usize,
    pub(super) component_type: u32,
    #[serde(default)]
    pub(super) normalized: bool,
    pub(super) count: usize,
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) sparse: Option<Sparse>,
}

#[derive(Deserialize)]
pub(super) struct Sparse {
    pub(super) count: usize,
    pub(super) indices: SparsePart,
    pub(super) values: SparsePart,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparsePart {
    pub(super) buffer_view: usize,
    #[serde(default)]
    pub(super) byte_offset: usize,
    /// Of the indices.
    #[serde(default)]
    pub(super) component_type: u32,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: usize,
    #[serde(default)]
    pub(super) byte_offset: usize,
    pub(super) byte_length: usize,
    pub(super) byte_stride: Option<usize>,
}

#[derive(Deserialize)]
struct Buffer {
    uri: Option<String>,
}

#[derive(Deserialize)]
struct Mesh {
    primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
pub(super) struct Primitive {
    pub(super) attributes: BTreeMap<String, usize>,
    pub(super) indices: Option<usize>,
    pub(super) mode: Option<u32>,
    pub(super) material: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material {
    #[serde(default)]
    pub(super) pbr_metallic_roughness: Pbr,
    #[serde(default)]
    pub(super) alpha_mode: String,
    pub(super) alpha_cutoff: Option<f64>,
    #[serde(default)]
    pub(super) emissive_factor: [f64; 3],
    pub(super) emissive_texture: Option<TextureUse>,
    pub(super) normal_texture: Option<TextureUse>,
    pub(super) occlusion_texture: Option<TextureUse>,
    #[serde(default)]
    pub(super) extensions: MaterialExtensions,
}

impl Material {
    /// Whether it has no colour but that of its own light.
    pub(super) fn only_shines(&self) -> bool {
        let pbr = &self.pbr_metallic_roughness;
        let is_black = pbr
            .base_color_factor
            .is_some_and(|[r, g, b, _]| [r, g, b] == [0.0; 3]);
        is_black && pbr.base_color_texture.is_none() && self.emissive_factor != [0.0; 3]
    }
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct Pbr {
    pub(super) base_color_factor: Option<[f64; 4]>,
    pub(super) base_color_texture: Option<TextureUse>,
}

#[derive(Deserialize, Default)]
pub(super) struct MaterialExtensions {
    /// The materials of glTF 1.0, which photogrammetry still writes.
    #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
    pub(super) specular: Option<Specular>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Specular {
    pub(super) diffuse_factor: Option<[f64; 4]>,
    pub(super) diffuse_texture: Option<TextureUse>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureUse {
    pub(super) index: usize,
    #[serde(default)]
    pub(super) tex_coord: usize,
    #[serde(default)]
    pub(super) extensions: TextureExtensions,
}

#[derive(Deserialize, Default)]
pub(super) struct TextureExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub(super) transform: Option<TextureTransform>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureTransform {
    #[serde(default)]
    pub(super) offset: [f64; 2],
    #[serde(default)]
    pub(super) rotation: f64,
    pub(super) scale: Option<[f64; 2]>,
    pub(super) tex_coord: Option<usize>,
}

#[derive(Deserialize)]
pub(super) struct TextureEntry {
    pub(super) source: Option<usize>,
    pub(super) sampler: Option<usize>,
    #[serde(default)]
    pub(super) extensions: TextureSources,
}

#[derive(Deserialize, Default)]
pub(super) struct TextureSources {
    #[serde(rename = "EXT_texture_webp")]
    pub(super) webp: Option<TextureSource>,
    #[serde(rename = "KHR_texture_basisu")]
    pub(super) basis: Option<TextureSource>,
    #[serde(rename = "EXT_texture_avif")]
    pub(super) avif: Option<TextureSource>,
}

#[derive(Deserialize)]
pub(super) struct TextureSource {
    pub(super) source: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Image {
    pub(super) uri: Option<String>,
    pub(super) buffer_view: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Sampler {
    pub(super) mag_filter: Option<u32>,
    pub(super) wrap_s: Option<u32>,
    pub(super) wrap_t: Option<u32>,
}

#[derive(Deserialize)]
struct Node {
    mesh: Option<usize>,
    #[serde(default)]
    children: Vec<usize>,
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
}

#[derive(Deserialize)]
struct Scene {
    #[serde(default)]
    nodes: Vec<usize>,
}

/// A primitive where a node places it.
pub(super) struct Placed<'a> {
    pub(super) primitive: &'a Primitive,
    pub(super) transform: Transform,
}

/// The primitives of the scene; of a file without a scene those of all meshes, as they are.
pub(super) fn parts<'a>(document: &'a Document, input: &Input) -> Result<Vec<Placed<'a>>> {
    const COMPRESSED: [&str; 3] = [
        "KHR_draco_mesh_compression",
        "EXT_meshopt_compression",
        "KHR_meshopt_compression",
    ];
    if let Some(name) = document
        .extensions_required
        .iter()
        .find(|name| COMPRESSED.contains(&name.as_str()))
    {
        return Err(input.unsupported("meshes that are not compressed", name.clone()));
    }
    let instances = "EXT_mesh_gpu_instancing";
    if document
        .extensions_required
        .iter()
        .any(|name| name == instances)
    {
        return Err(input.unsupported("meshes that nodes place one by one", instances));
    }
    if document
        .buffers
        .first()
        .is_some_and(|buffer| buffer.uri.is_some())
    {
        return Err(input.unsupported("data within the file", "data in a file of its own"));
    }
    let all = || {
        let primitives = document.meshes.iter().flat_map(|mesh| &mesh.primitives);
        primitives
            .map(|primitive| Placed {
                primitive,
                transform: Transform::IDENTITY,
            })
            .collect()
    };
    let Some(scene) = document.scenes.get(document.scene.unwrap_or(0)) else {
        return Ok(all());
    };
    let mut parts = Vec::new();
    let mut waiting: Vec<(usize, Transform)> = scene
        .nodes
        .iter()
        .map(|&node| (node, Transform::IDENTITY))
        .collect();
    waiting.reverse();
    let mut visited = vec![false; document.nodes.len()];
    while let Some((index, above)) = waiting.pop() {
        let Some(node) = document.nodes.get(index) else {
            return Err(input.bad_byte(
                20,
                "nodes that the file has",
                format!("node {index} of {}", document.nodes.len()),
            ));
        };
        if std::mem::replace(&mut visited[index], true) {
            return Err(input.bad_byte(
                20,
                "nodes that form trees",
                format!("node {index} below two others, or itself"),
            ));
        }
        let transform = above.then(&node.transform());
        if let Some(mesh) = node.mesh {
            let Some(mesh) = document.meshes.get(mesh) else {
                return Err(input.bad_byte(
                    20,
                    "meshes that the file has",
                    format!("mesh {mesh} of {}", document.meshes.len()),
                ));
            };
            parts.extend(mesh.primitives.iter().map(|primitive| Placed {
                primitive,
                transform,
            }));
        }
        waiting.extend(node.children.iter().rev().map(|&child| (child, transform)));
    }
    Ok(parts)
}

impl Node {
    fn transform(&self) -> Transform {
        if let Some(m) = self.matrix {
            // Column after column.
            return Transform(std::array::from_fn(|row| {
                std::array::from_fn(|column| m[4 * column + row])
            }));
        }
        let [x, y, z, w] = self.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
        let s = self.scale.unwrap_or([1.0; 3]);
        let t = self.translation.unwrap_or_default();
        Transform([
            [
                s[0] * (1.0 - 2.0 * (y * y + z * z)),
                s[1] * 2.0 * (x * y - w * z),
                s[2] * 2.0 * (x * z + w * y),
                t[0],
            ],
            [
                s[0] * 2.0 * (x * y + w * z),
                s[1] * (1.0 - 2.0 * (x * x + z * z)),
                s[2] * 2.0 * (y * z - w * x),
                t[1],
            ],
            [
                s[0] * 2.0 * (x * z - w * y),
                s[1] * 2.0 * (y * z + w * x),
                s[2] * (1.0 - 2.0 * (x * x + y * y)),
                t[2],
            ],
        ])
    }
}

/// The upper three rows of a matrix.
#[derive(Clone, Copy)]
pub(super) struct Transform([[f64; 4]; 3]);

impl Transform {
    const IDENTITY: Transform = Transform([
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
    ]);

    /// First `inner`, then this.
    fn then(&self, inner: &Transform) -> Transform {
        let (a, b) = (&self.0, &inner.0);
        Transform(std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                let sum: f64 = (0..3).map(|k| a[row][k] * b[k][column]).sum();
                if column == 3 { sum + a[row][3] } else { sum }
            })
        }))
    }

    /// Whether it mirrors: triangles then run the other way round.
    pub(super) fn mirrors(&self) -> bool {
        let row = |i: usize| [self.0[i][0], self.0[i][1], self.0[i][2]];
        let [a, b, c] = [row(0), row(1), row(2)];
        let cross = [
            b[1] * c[2] - b[2] * c[1],
            b[2] * c[0] - b[0] * c[2],
            b[0] * c[1] - b[1] * c[0],
        ];
        a[0] * cross[0] + a[1] * cross[1] + a[2] * cross[2] < 0.0
    }

    pub(super) fn point(&self, p: [f64; 3]) -> [f64; 3] {
        self.0
            .map(|row| row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3])
    }

    /// A direction along the surface; unit.
    pub(super) fn direction(&self, d: [f64; 3]) -> [f64; 3] {
        let turned = self
            .0
            .map(|row| row[0] * d[0] + row[1] * d[1] + row[2] * d[2]);
        unit(turned)
    }

    /// A normal, by the matrix of cofactors; unit.
    pub(super) fn normal(&self, n: [f64; 3]) -> [f64; 3] {
        let m = &self.0;
        let cofactor = |row: usize, column: usize| {
            let (r1, r2, c1, c2) = (
                (row + 1) % 3,
                (row + 2) % 3,
                (column + 1) % 3,
                (column + 2) % 3,
            );
            m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
        };
        // Of a mirror the cofactors point the other way.
        let sign = if (0..3).map(|c| m[0][c] * cofactor(0, c)).sum::<f64>() < 0.0 {
            -1.0
        } else {
            1.0
        };
        let v = [0, 1, 2].map(|row| {
            sign * (0..3)
                .map(|column| cofactor(row, column) * n[column])
                .sum::<f64>()
        });
        unit(v)
    }
}

/// A vector without a direction stays as it is.
fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    if length > 0.0 {
        v.map(|x| x / length)
    } else {
        v
    }
}
