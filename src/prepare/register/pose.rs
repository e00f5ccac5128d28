//! Rigid motions.

use crate::base::linalg::sym_eigen;
use glam::{DMat3, DQuat, DVec3, Vec3};

/// A turn, then a shift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// A rotation.
    pub turn: DMat3,
    /// Added after it.
    pub shift: DVec3,
}

impl Pose {
    /// Leaves everything where it is.
    pub const IDENTITY: Pose = Pose {
        turn: DMat3::IDENTITY,
        shift: DVec3::ZERO,
    };

    /// Where a point comes to lie.
    pub fn at(&self, p: DVec3) -> DVec3 {
        self.turn * p + self.shift
    }

    /// [`Pose::at`] in single precision.
    pub(crate) fn at_single(&self, p: Vec3) -> Vec3 {
        self.at(p.as_dvec3()).as_vec3()
    }

    /// Which way a direction points afterwards.
    pub fn along(&self, v: Vec3) -> Vec3 {
        (self.turn * v.as_dvec3()).as_vec3()
    }

    /// This motion after another.
    #[must_use]
    pub fn after(&self, first: &Pose) -> Pose {
        Pose {
            turn: self.turn * first.turn,
            shift: self.at(first.shift),
        }
    }

    /// The way back.
    #[must_use]
    pub fn back(&self) -> Pose {
        let turn = self.turn.transpose();
        Pose {
            turn,
            shift: -(turn * self.shift),
        }
    }

    /// This motion after a small one more: a turn about `turn`, in radians, and a shift. The turn is that of the quaternion
    /// (1, turn / 2), which is exact to second order and always a rotation.
    #[must_use]
    pub(crate) fn moved(&self, turn: DVec3, shift: DVec3) -> Pose {
        let half = turn / 2.0;
        let small = DQuat::from_xyzw(half.x, half.y, half.z, 1.0).normalize();
        let step = Pose {
            turn: DMat3::from_quat(small),
            shift,
        };
        let next = step.after(self);
        // Products of rotations drift.
        Pose {
            turn: upright(next.turn),
            ..next
        }
    }

    /// The motion that brings each first point nearest to its second in the mean of squares (Kabsch, "A solution for the best
    /// rotation to relate two sets of vectors", 1976), and each first direction nearest to its second, where a direction counts
    /// as a point that is `arm` away. `None` where they lie on one line.
    pub(crate) fn fit(pairs: &[Pair], arm: f64) -> Option<Pose> {
        let count = pairs.len() as f64;
        let a = pairs.iter().map(|pair| pair.from.0).sum::<DVec3>() / count;
        let b = pairs.iter().map(|pair| pair.to.0).sum::<DVec3>() / count;
        let mut product = DMat3::ZERO;
        for Pair { from, to } in pairs {
            let (p, q) = (from.0 - a, to.0 - b);
            let (m, n) = (from.1 * arm, to.1 * arm);
            product += DMat3::from_cols(q * p.x + n * m.x, q * p.y + n * m.y, q * p.z + n * m.z);
        }
        let square = product.transpose() * product;
        let [x, y, z] = [square.x_axis, square.y_axis, square.z_axis];
        let eigen = sym_eigen(&[x.x, x.y, x.z, y.y, y.z, z.z]);
        let [_, v, w] = eigen.vectors;
        let to_w = (product * w).try_normalize()?;
        let to_v = product * v;
        let to_v = (to_v - to_w * to_w.dot(to_v)).try_normalize()?;
        let from = DMat3::from_cols(v.cross(w), v, w);
        let to = DMat3::from_cols(to_v.cross(to_w), to_v, to_w);
        let turn = to * from.transpose();
        Some(Pose {
            turn,
            shift: b - turn * a,
        })
    }

    /// How far apart two motions put the points of a ball of this radius about this place, in the mean of squares.
    pub(crate) fn apart(&self, other: &Pose, (middle, radius): (DVec3, f64)) -> f64 {
        let shift = self.at(middle).distance_squared(other.at(middle));
        let d = self.turn - other.turn;
        let columns = [d.x_axis, d.y_axis, d.z_axis];
        let turn: f64 = columns.iter().map(|c| c.length_squared()).sum();
        (shift + turn * radius * radius / 5.0).sqrt()
    }
}

/// A point with its normal in two frames.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pair {
    pub(crate) from: (DVec3, DVec3),
    pub(crate) to: (DVec3, DVec3),
}

/// The rotation that a matrix nearly is.
fn upright(m: DMat3) -> DMat3 {
    let x = m.x_axis.normalize();
    let y = (m.y_axis - x * x.dot(m.y_axis)).normalize();
    DMat3::from_cols(x, y, x.cross(y))
}
