//! Binary STL: 80 bytes of any text, a count, then 50 bytes a triangle. It has single precision and no place for an
//! origin, so the text says `at X Y Z` where one has to be added.

use super::local::Local;
use crate::base::error::Result;
use crate::formats::raw_cloud::RawCloud;
use glam::Vec3;

const HEADER: usize = 80;
const TRIANGLE: usize = 50;

/// Writes the triangles with normals of their own.
pub(super) fn write(cloud: &RawCloud, triangles: &[u32]) -> Result<Vec<u8>> {
    let Local { origin, positions } = Local::of(cloud)?;
    let mut out = Vec::with_capacity(HEADER + 4 + triangles.len() / 3 * TRIANGLE);
    // The longest three numbers have 24 characters each, so the text always fits.
    out.extend(match origin {
        Some([x, y, z]) => format!("at {x:?} {y:?} {z:?}").into_bytes(),
        None => b"Pointweave".to_vec(),
    });
    out.resize(HEADER, b' ');
    out.extend((triangles.len() as u32 / 3).to_le_bytes());
    for triangle in triangles.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|k| Vec3::from_slice(&positions[3 * triangle[k] as usize..]));
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for x in [normal, a, b, c].iter().flat_map(|v| v.to_array()) {
            out.extend(x.to_le_bytes());
        }
        out.extend([0; 2]);
    }
    Ok(out)
}
