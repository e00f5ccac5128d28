//! What a scanned object stood on.

use crate::base::error::{Error, Result};
use glam::Vec3;

/// A plane in the caller's frame that carried what was scanned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// A point of it.
    pub point: [f64; 3],
    /// Unit, to the side that the object is on.
    pub normal: Vec3,
}

impl Floor {
    /// The plane through a point; the normal is made unit length here.
    ///
    /// # Errors
    /// [`Error::BadOption`] (a number that is not finite, a normal of zeros).
    pub fn new(point: [f64; 3], normal: [f64; 3]) -> Result<Floor> {
        let longest = normal.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        let all = point.iter().chain(&normal);
        if !all.clone().all(|x| x.is_finite()) || longest == 0.0 {
            return Err(Error::BadOption {
                option: "floor".into(),
                expected: "a point and a normal of finite numbers, not all 0".into(),
                found: format!("{point:?} and {normal:?}"),
            });
        }
        let normal = Vec3::from_array(normal.map(|x| (x / longest) as f32)).normalize();
        Ok(Floor { point, normal })
    }
}
