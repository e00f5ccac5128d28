//! Memberships of a point in its nearest centres (eq. 5).

use crate::base::power::Fuzzifier;
use glam::Vec3;

/// Centres that a point is shared among once they have settled.
pub const SHARES: usize = 4;

/// A point's memberships in its nearest centres; they add up to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    /// Centres, nearest first.
    pub center: [u32; SHARES],
    /// Memberships.
    pub u: [f32; SHARES],
}

impl Shares {
    /// Centres and memberships above 0.
    pub fn used(&self) -> impl Iterator<Item = (u32, f32)> {
        let all = self.center.into_iter().zip(self.u);
        all.filter(|&(_, u)| u > 0.0)
    }

    /// The centres that have a share; the nearest one in unused places.
    pub fn near(&self) -> [u32; SHARES] {
        std::array::from_fn(|j| self.center[if self.u[j] > 0.0 { j } else { 0 }])
    }

    /// Eq. 5 over the nearest centres of `reach` only.
    pub fn of(
        p: Vec3,
        centers: &[Vec3],
        reach: impl Iterator<Item = u32>,
        fuzzifier: Fuzzifier,
    ) -> Shares {
        let mut nearest = [(f32::INFINITY, 0); SHARES];
        for i in reach {
            let d = p.distance_squared(centers[i as usize]);
            if d < nearest[SHARES - 1].0 {
                let mut at = SHARES - 1;
                while at > 0 && d < nearest[at - 1].0 {
                    nearest[at] = nearest[at - 1];
                    at -= 1;
                }
                nearest[at] = (d, i);
            }
        }
        let closest = nearest[0].0;
        let u = nearest.map(|(d, _)| {
            if d == closest {
                1.0
            } else {
                fuzzifier.share(f64::from(closest) / f64::from(d))
            }
        });
        let total: f64 = u.iter().sum();
        Shares {
            center: nearest.map(|(_, i)| i),
            u: u.map(|u| (u / total) as f32),
        }
    }
}
