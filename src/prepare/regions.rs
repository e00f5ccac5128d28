//! Regions of space: boxes, spheres, half spaces, and what a polygon on a screen encloses.
//!
//! All in the caller's frame and unit, in double precision. A region's border belongs to it.

use crate::base::error::{Error, Result};
use glam::{DMat4, DQuat, DVec2, DVec3, DVec4};

/// A region.
#[derive(Debug, Clone, PartialEq)]
pub enum Region {
    /// A box of any direction.
    Box {
        /// Its middle.
        center: DVec3,
        /// Half of its sides, not negative.
        half: DVec3,
        /// Turns its axes from the frame's; of length 1.
        turn: DQuat,
    },
    /// A ball.
    Sphere {
        /// Its middle.
        center: DVec3,
        /// Not negative.
        radius: f64,
    },
    /// One side of a plane.
    HalfSpace {
        /// Any point of the plane.
        point: DVec3,
        /// Points into the region; any length but 0.
        normal: DVec3,
    },
    /// What a camera sees inside of a polygon, however far behind it.
    Screen {
        /// Corners, in the camera's x and y from -1 to 1; where it crosses itself, what is wound an odd number of times is inside.
        polygon: Vec<DVec2>,
        /// From the frame to homogeneous coordinates of the screen, as a projection times a view.
        camera: DMat4,
    },
}

impl Region {
    /// A box from its lowest to its highest corner, turned about its middle by a quaternion x y z w.
    ///
    /// # Errors
    /// [`Error::BadOption`]: a corner that is not finite or lies beyond the other, a turn of length 0.
    pub fn cuboid(min: [f64; 3], max: [f64; 3], turn: Option<[f64; 4]>) -> Result<Region> {
        let (lo, hi) = (DVec3::from(min), DVec3::from(max));
        if !(lo.is_finite() && hi.is_finite() && lo.cmple(hi).all()) {
            let expected = "finite numbers, min nowhere beyond max";
            return Err(Error::bad_option(
                "min, max",
                expected,
                &format!("{min:?}, {max:?}"),
            ));
        }
        let turn = turn.unwrap_or([0.0, 0.0, 0.0, 1.0]);
        let quaternion = DQuat::from_array(turn);
        let length = quaternion.length();
        if !(length.is_finite() && length > 0.0) {
            return Err(Error::bad_option(
                "turn",
                "four numbers that are not all 0",
                &format!("{turn:?}"),
            ));
        }
        Ok(Region::Box {
            center: (lo + hi) / 2.0,
            half: (hi - lo) / 2.0,
            turn: quaternion / length,
        })
    }

    /// A ball.
    ///
    /// # Errors
    /// [`Error::BadOption`]: not finite, or a negative radius.
    pub fn sphere(center: [f64; 3], radius: f64) -> Result<Region> {
        let center = DVec3::from(center);
        if !(radius.is_finite() && radius >= 0.0 && center.is_finite()) {
            let found = format!("{center}, {radius}");
            return Err(Error::bad_option(
                "center, radius",
                "finite numbers, radius at least 0",
                &found,
            ));
        }
        Ok(Region::Sphere { center, radius })
    }

    /// The side of a plane that its normal points into.
    ///
    /// # Errors
    /// [`Error::BadOption`]: not finite, or a normal of length 0.
    pub fn half_space(point: [f64; 3], normal: [f64; 3]) -> Result<Region> {
        let (point, normal) = (DVec3::from(point), DVec3::from(normal));
        let normal = normal.normalize_or_zero();
        if !point.is_finite() || normal == DVec3::ZERO {
            let expected = "finite numbers, normal of a length that is not 0";
            return Err(Error::bad_option(
                "point, normal",
                expected,
                &format!("{point}, {normal}"),
            ));
        }
        Ok(Region::HalfSpace { point, normal })
    }

    /// What a camera sees inside of a polygon: its corners as `x y x y …`, and a matrix of 16 numbers by columns, as WebGL has it.
    ///
    /// # Errors
    /// [`Error::BadOption`]: fewer than three corners, numbers that are not finite, or another count of them.
    pub fn screen(polygon: &[f64], camera: &[f64]) -> Result<Region> {
        let finite = |values: &[f64]| values.iter().all(|x| x.is_finite());
        if polygon.len() < 6 || !polygon.len().is_multiple_of(2) || !finite(polygon) {
            let expected = "x y of three corners or more, finite";
            return Err(Error::bad_option(
                "polygon",
                expected,
                &format!("{} numbers", polygon.len()),
            ));
        }
        let columns: Option<[f64; 16]> = camera.try_into().ok().filter(|_| finite(camera));
        let Some(columns) = columns else {
            let found = format!("{} numbers", camera.len());
            return Err(Error::bad_option("camera", "16 finite numbers", &found));
        };
        Ok(Region::Screen {
            polygon: polygon.chunks_exact(2).map(DVec2::from_slice).collect(),
            camera: DMat4::from_cols_array(&columns),
        })
    }

    /// Whether a point of the caller's frame is inside.
    pub fn holds(&self, p: [f64; 3]) -> bool {
        let p = DVec3::from(p);
        match self {
            Region::Box { center, half, turn } => {
                let q = turn.conjugate() * (p - *center);
                q.abs().cmple(*half).all()
            }
            Region::Sphere { center, radius } => p.distance_squared(*center) <= radius * radius,
            Region::HalfSpace { point, normal } => (p - *point).dot(*normal) >= 0.0,
            Region::Screen { polygon, camera } => {
                let DVec4 { x, y, w, .. } = *camera * p.extend(1.0);
                // What is behind the camera is not seen.
                w > 0.0 && encloses(polygon, DVec2::new(x / w, y / w))
            }
        }
    }
}

/// Whether a ray from `p` crosses the polygon an odd number of times.
fn encloses(polygon: &[DVec2], p: DVec2) -> bool {
    let before = polygon.iter().cycle().skip(polygon.len() - 1);
    let crosses = |(b, a): (&DVec2, &DVec2)| {
        (a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x
    };
    polygon
        .iter()
        .zip(before)
        .filter(|&pair| crosses(pair))
        .count()
        % 2
        == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_hold_what_is_inside_of_them() {
        let cuboid = Region::cuboid([-1.0, -2.0, 0.0], [1.0, 2.0, 5.0], None).unwrap();
        assert!(cuboid.holds([1.0, -2.0, 5.0]) && cuboid.holds([0.0, 0.0, 2.0]));
        assert!(!cuboid.holds([1.01, 0.0, 2.0]) && !cuboid.holds([0.0, 0.0, -0.01]));
        // A quarter turn about z, of any length: the long side lies along x.
        let turned = Region::cuboid(
            [-1.0, -2.0, 0.0],
            [1.0, 2.0, 5.0],
            Some([0.0, 0.0, 7.0, 7.0]),
        );
        let turned = turned.unwrap();
        assert!(turned.holds([1.9, 0.9, 1.0]) && !turned.holds([0.9, 1.9, 1.0]));
        let ball = Region::sphere([1.0, 1.0, 1.0], 2.0).unwrap();
        assert!(ball.holds([1.0, 3.0, 1.0]) && !ball.holds([2.5, 2.5, 1.0]));
        let above = Region::half_space([0.0, 0.0, 1.0], [0.0, 0.0, 9.0]).unwrap();
        assert!(above.holds([5.0, 5.0, 1.0]) && !above.holds([0.0, 0.0, 0.99]));
    }

    #[test]
    fn a_polygon_on_the_screen_holds_what_the_camera_sees_in_it() {
        // A camera at the origin looks along -z with a right angle of view: x / -z and y / -z are on the screen.
        #[rustfmt::skip]
        let camera = [
            1.0, 0.0, 0.0, 0.0,
            0.0, 1.0, 0.0, 0.0,
            0.0, 0.0, -1.0, -1.0,
            0.0, 0.0, -0.2, 0.0,
        ];
        // A triangle, and the same with a notch.
        let triangle = Region::screen(&[-0.5, -0.5, 0.5, -0.5, 0.0, 0.5], &camera).unwrap();
        let notched =
            Region::screen(&[-0.5, -0.5, 0.0, 0.0, 0.5, -0.5, 0.0, 0.5], &camera).unwrap();
        for far in [1.0, 100.0] {
            let at = |x: f64, y: f64| [x * far, y * far, -far];
            assert!(triangle.holds(at(0.0, 0.0)) && notched.holds(at(0.0, 0.2)));
            assert!(triangle.holds(at(0.0, -0.4)) && !notched.holds(at(0.0, -0.4)));
            assert!(!triangle.holds(at(0.5, 0.5)) && !triangle.holds(at(0.0, 0.6)));
        }
        assert!(!triangle.holds([0.0, 0.0, 1.0]), "behind the camera");
    }

    #[test]
    fn what_is_no_region_is_an_error() {
        let wrong = [
            Region::cuboid([0.0; 3], [1.0, -1.0, 1.0], None),
            Region::cuboid([f64::NAN; 3], [1.0; 3], None),
            Region::cuboid([0.0; 3], [1.0; 3], Some([0.0; 4])),
            Region::sphere([0.0; 3], -1.0),
            Region::half_space([0.0; 3], [0.0; 3]),
            Region::screen(&[0.0; 4], &[0.0; 16]),
            Region::screen(&[0.0; 7], &[0.0; 16]),
            Region::screen(&[0.0; 6], &[0.0; 15]),
        ];
        for region in wrong {
            assert_eq!(region.unwrap_err().code(), "bad-option");
        }
    }
}
