//! PCD 0.7, binary: a text header that names the fields, then rows, little endian. Positions are of eight bytes where they or
//! the origin need it; a colour is packed into four, as the Point Cloud Library has it; one viewpoint is `VIEWPOINT`.

use super::names::{Column, names};
use super::{is_double, triple, world};
use crate::formats::RawCloud;

/// Writes points.
pub(super) fn write(cloud: &RawCloud) -> Vec<u8> {
    let double = is_double(cloud);
    let mut fields: Vec<(String, char, usize)> = Vec::new();
    for (name, column) in names(cloud) {
        match (column, name.as_str()) {
            (Column::Position, _) => fields.push((name, 'F', if double { 8 } else { 4 })),
            (Column::Float, "nx" | "ny" | "nz") => {
                fields.push((format!("normal_{}", &name[1..]), 'F', 4))
            }
            (Column::Float, _) => fields.push((name, 'F', 4)),
            // Red stands for all three.
            (Column::Byte, "red") => fields.push(("rgb".into(), 'U', 4)),
            (Column::Byte, _) => {}
        }
    }
    let all = |value: &dyn Fn(&(String, char, usize)) -> String| {
        fields.iter().map(value).collect::<Vec<_>>().join(" ")
    };
    let points = cloud.points();
    let viewpoint = match &cloud.viewpoints {
        Some(views) if views.of.is_none() => {
            let origin = cloud.origin.unwrap_or_default();
            views.positions.first().map_or([0.0; 3], |p| {
                [p.x + origin[0], p.y + origin[1], p.z + origin[2]]
            })
        }
        _ => [0.0; 3],
    };
    let mut out = format!(
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\nCOUNT {}\nWIDTH {points}\nHEIGHT 1\n\
         VIEWPOINT {} {} {} 1 0 0 0\nPOINTS {points}\nDATA binary\n",
        all(&|field| field.0.clone()),
        all(&|field| field.2.to_string()),
        all(&|field| field.1.to_string()),
        all(&|_| "1".into()),
        viewpoint[0],
        viewpoint[1],
        viewpoint[2],
    )
    .into_bytes();
    for i in 0..points {
        for x in world(cloud, i) {
            match double {
                true => out.extend(x.to_le_bytes()),
                false => out.extend((x as f32).to_le_bytes()),
            }
        }
        triple(&cloud.normals, i)
            .iter()
            .for_each(|n| out.extend(n.to_le_bytes()));
        if let &[r, g, b] = triple(&cloud.colors, i) {
            out.extend([b, g, r, 0]);
        }
        cloud
            .attributes
            .iter()
            .for_each(|a| out.extend(a.values[i].to_le_bytes()));
    }
    out
}
