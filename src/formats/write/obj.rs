//! Wavefront OBJ: `v x y z r g b` with the colours from 0 to 1 that most programs know, `vn`, and `f` lines that name a
//! vertex and the normal of the same number. Points have no `f` lines. With a material, vertices have places in its pictures: `vt`.

use super::values::{is_double, triple, world};
use crate::formats::raw_cloud::{RawCloud, Skin};
use std::fmt::Write;

/// Writes vertices and, with `triangles`, faces, in text that reads back to the same bits; four digits of a colour do. `material` says
/// where the vertices are in its pictures, and what the library that has it is called.
pub(super) fn write(
    cloud: &RawCloud,
    triangles: Option<&[u32]>,
    material: Option<(&Skin, &str)>,
) -> Vec<u8> {
    let mut out = String::from("# Pointweave\n");
    if let Some((_, library)) = material {
        let _ = writeln!(out, "mtllib {library}");
    }
    let pictured = material.is_some_and(|(skin, _)| skin.color.is_some());
    let double = is_double(cloud);
    for i in 0..cloud.points() {
        out.push('v');
        for x in world(cloud, i) {
            // Writing to a string cannot fail.
            let _ = match double {
                true => write!(out, " {x:?}"),
                false => write!(out, " {:?}", x as f32),
            };
        }
        // Where there is a picture of them, they would be multiplied with it.
        let colors = if pictured { &None } else { &cloud.colors };
        for &c in triple(colors, i) {
            let _ = write!(out, " {:.4}", f64::from(c) / 255.0);
        }
        out.push('\n');
    }
    for normal in cloud.normals.as_deref().unwrap_or_default().chunks_exact(3) {
        let _ = writeln!(out, "vn {:?} {:?} {:?}", normal[0], normal[1], normal[2]);
    }
    if let Some((skin, _)) = material {
        // Up from the last row, not down from the first.
        for place in skin.uvs.as_chunks::<2>().0 {
            let _ = writeln!(out, "vt {:?} {:?}", place[0], 1.0 - place[1]);
        }
        out.push_str("usemtl scan\n");
    }
    for triangle in triangles.unwrap_or_default().chunks_exact(3) {
        out.push('f');
        for corner in triangle.iter().map(|&i| u64::from(i) + 1) {
            let _ = match (&cloud.normals, material) {
                (Some(_), Some(_)) => write!(out, " {corner}/{corner}/{corner}"),
                (Some(_), None) => write!(out, " {corner}//{corner}"),
                (None, Some(_)) => write!(out, " {corner}/{corner}"),
                (None, None) => write!(out, " {corner}"),
            };
        }
        out.push('\n');
    }
    out.into_bytes()
}
