//! PLY: a text header that names the columns, then rows, little endian or as text.

use super::names::{Column, names};
use super::values::{is_double, triple, world};
use crate::formats::raw_cloud::RawCloud;
use std::fmt::Debug;
use std::io::Write;

/// Writes points and, with `triangles`, faces. Positions are `double` where they or the origin need it.
pub(super) fn write(cloud: &RawCloud, triangles: Option<&[u32]>, ascii: bool) -> Vec<u8> {
    let double = is_double(cloud);
    let mut out = write_header(cloud, triangles, ascii, double).into_bytes();
    let mut sink = Sink {
        out: &mut out,
        ascii,
        first: true,
    };
    for i in 0..cloud.points() {
        for x in world(cloud, i) {
            if double {
                sink.f64(x)
            } else {
                sink.f32(x as f32)
            }
        }
        triple(&cloud.normals, i).iter().for_each(|&n| sink.f32(n));
        triple(&cloud.colors, i).iter().for_each(|&c| sink.u8(c));
        for attribute in &cloud.attributes {
            sink.f32(attribute.values[i]);
        }
        sink.end_row();
    }
    for triangle in triangles.unwrap_or_default().chunks_exact(3) {
        sink.u8(3);
        triangle.iter().for_each(|&index| sink.u32(index));
        sink.end_row();
    }
    out
}

fn write_header(cloud: &RawCloud, triangles: Option<&[u32]>, ascii: bool, double: bool) -> String {
    let encoding = if ascii {
        "ascii"
    } else {
        "binary_little_endian"
    };
    let mut header = format!(
        "ply\nformat {encoding} 1.0\ncomment Pointweave\nelement vertex {}\n",
        cloud.points()
    );
    for (name, column) in names(cloud) {
        let kind = match column {
            Column::Position if double => "double",
            Column::Position | Column::Float => "float",
            Column::Byte => "uchar",
        };
        header += &format!("property {kind} {name}\n");
    }
    if let Some(indices) = triangles {
        // Signed, as most readers expect.
        header += &format!(
            "element face {}\nproperty list uchar int vertex_indices\n",
            indices.len() / 3
        );
    }
    header + "end_header\n"
}

/// Values into rows: little endian bytes, or text that reads back to the same bits.
struct Sink<'a> {
    out: &'a mut Vec<u8>,
    ascii: bool,
    /// No value of the row was written yet.
    first: bool,
}

impl Sink<'_> {
    fn put(&mut self, bytes: &[u8], text: &dyn Debug) {
        if !self.ascii {
            self.out.extend(bytes);
            return;
        }
        if !self.first {
            self.out.push(b' ');
        }
        self.first = false;
        // Writing to a vector cannot fail.
        let _ = write!(self.out, "{text:?}");
    }

    fn f64(&mut self, value: f64) {
        self.put(&value.to_le_bytes(), &value);
    }

    fn f32(&mut self, value: f32) {
        self.put(&value.to_le_bytes(), &value);
    }

    fn u8(&mut self, value: u8) {
        self.put(&[value], &value);
    }

    fn u32(&mut self, value: u32) {
        self.put(&value.to_le_bytes(), &value);
    }

    fn end_row(&mut self) {
        if self.ascii {
            self.out.push(b'\n');
            self.first = true;
        }
    }
}
