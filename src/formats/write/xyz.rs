//! Rows of numbers as text: coordinates, normals, colours. A comment names the columns where there are attributes, which nothing
//! else could tell; without it the rows are the plain XYZ that other programs read.

use super::names::names;
use super::values::{is_double, triple, world};
use crate::formats::raw_cloud::RawCloud;
use std::fmt::Write;

/// Writes points in text that reads back to the same bits.
pub(super) fn write(cloud: &RawCloud) -> Vec<u8> {
    let names: Vec<String> = names(cloud).into_iter().map(|(name, _)| name).collect();
    let mut out = match cloud.attributes.is_empty() {
        true => String::new(),
        false => format!("# {}\n", names.join(" ")),
    };
    let double = is_double(cloud);
    for i in 0..cloud.points() {
        for (axis, x) in world(cloud, i).into_iter().enumerate() {
            let gap = if axis == 0 { "" } else { " " };
            // Writing to a string cannot fail.
            let _ = match double {
                true => write!(out, "{gap}{x:?}"),
                false => write!(out, "{gap}{:?}", x as f32),
            };
        }
        for n in triple(&cloud.normals, i) {
            let _ = write!(out, " {n:?}");
        }
        for c in triple(&cloud.colors, i) {
            let _ = write!(out, " {c}");
        }
        for attribute in &cloud.attributes {
            let _ = write!(out, " {:?}", attribute.values[i]);
        }
        out.push('\n');
    }
    out.into_bytes()
}
