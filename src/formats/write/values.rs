//! The values of one point of a cloud, as writers take them.

use crate::base::srgb;
use crate::formats::raw_cloud::{Positions, RawCloud};

/// Whether world coordinates need double precision.
pub(super) fn is_double(cloud: &RawCloud) -> bool {
    cloud.origin.is_some() || matches!(cloud.positions, Positions::F64(_))
}

/// A point in world coordinates.
pub(super) fn world(cloud: &RawCloud, i: usize) -> [f64; 3] {
    let origin = cloud.origin.unwrap_or_default();
    [0, 1, 2].map(|axis| cloud.positions.get(3 * i + axis) + origin[axis])
}

/// The three values of point `i`, or none where there is no such array.
pub(super) fn triple<T>(array: &Option<Vec<T>>, i: usize) -> &[T] {
    array
        .as_ref()
        .map_or(&[], |values| &values[3 * i..3 * i + 3])
}

/// An sRGB component in linear light, 0 to 1 (IEC 61966-2-1).
pub(super) fn linear(component: u8) -> f64 {
    srgb::linear(f64::from(component) / 255.0)
}
