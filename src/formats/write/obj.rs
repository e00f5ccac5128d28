//! Wavefront OBJ: `v x y z r g b` with the colours from 0 to 1 that most programs know, `vn`, and `f` lines that name a
//! vertex and the normal of the same number. Points have no `f` lines.

use super::values::{is_double, triple, world};
use crate::formats::raw_cloud::RawCloud;
use std::fmt::Write;

/// Writes vertices and, with `triangles`, faces, in text that reads back to the same bits; four digits of a colour do.
pub(super) fn write(cloud: &RawCloud, triangles: Option<&[u32]>) -> Vec<u8> {
    let mut out = String::from("# Pointweave\n");
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
        for &c in triple(&cloud.colors, i) {
            let _ = write!(out, " {:.4}", f64::from(c) / 255.0);
        }
        out.push('\n');
    }
    for normal in cloud.normals.as_deref().unwrap_or_default().chunks_exact(3) {
        let _ = writeln!(out, "vn {:?} {:?} {:?}", normal[0], normal[1], normal[2]);
    }
    for triangle in triangles.unwrap_or_default().chunks_exact(3) {
        out.push('f');
        for corner in triangle.iter().map(|&i| u64::from(i) + 1) {
            let _ = match cloud.normals {
                Some(_) => write!(out, " {corner}//{corner}"),
                None => write!(out, " {corner}"),
            };
        }
        out.push('\n');
    }
    out.into_bytes()
}
