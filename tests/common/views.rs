//! A sample model as it is seen from one side after the other, every view in a frame of its own.

use glam::{DMat3, DQuat, DVec3};
use pointweave::Cloud;
use pointweave::base::rng::Rng;
use pointweave::prepare::register::Pose;
use pointweave::samples::{Model, sample_with_noise};

/// Cosine of the flattest incidence that is seen.
const LEAST_COSINE: f64 = 0.15;

/// One view.
pub struct View {
    pub cloud: Cloud,
    /// From the view's frame to the model's.
    pub truth: Pose,
}

/// How a model is looked at.
#[derive(Debug, Clone, Copy)]
pub struct Views {
    pub model: Model,
    /// Points of the whole model; a view has a third of them or so.
    pub points: usize,
    /// Standard deviation of the range, a fraction of the diagonal.
    pub noise: f64,
    /// Degrees of azimuth from one view to the next.
    pub turn: f64,
    pub seed: u64,
}

impl Views {
    /// The first views of a round. Heights take turns.
    pub fn first(&self, count: usize) -> Vec<View> {
        (0..count).map(|k| self.view(k)).collect()
    }

    fn view(&self, k: usize) -> View {
        let elevation = [12.0f64, 38.0][k % 2].to_radians();
        let azimuth = (self.turn * k as f64).to_radians();
        let toward = DVec3::new(
            elevation.cos() * azimuth.cos(),
            elevation.sin(),
            elevation.cos() * azimuth.sin(),
        );
        let seed = self.seed + k as u64;
        let scan = sample_with_noise(self.model, self.points, seed, self.noise);
        let truth = random_pose(&mut Rng::new(seed ^ 0x7669_6577), 30.0);
        let to_view = truth.back();
        let triple = |values: &[f32], i: usize| {
            DVec3::from_array([0, 1, 2].map(|a| values[3 * i + a].into()))
        };
        let (mut positions, mut colors) = (Vec::new(), Vec::new());
        // Each view has a light of its own.
        let light = 1.0 - 0.08 * (k % 3) as f64;
        for i in 0..self.points {
            let (p, n) = (triple(&scan.positions, i), triple(&scan.normals, i));
            if n.dot(toward) > LEAST_COSINE && self.is_free(p, n, toward) {
                positions.extend(to_view.at(p).to_array());
                colors.extend([0, 1, 2].map(|a| (light * f64::from(scan.colors[3 * i + a])) as u8));
            }
        }
        let cloud = Cloud::from_f64(&positions).and_then(|cloud| cloud.with_colors(&colors));
        View {
            cloud: cloud.expect("a cloud"),
            truth,
        }
    }

    /// Whether nothing stands before a point.
    fn is_free(&self, p: DVec3, normal: DVec3, toward: DVec3) -> bool {
        let (low, high) = self.model.bounds();
        let diagonal = low.distance(high);
        let start = p + normal * (0.004 * diagonal);
        let mut range = 0.0;
        while range < diagonal {
            let gap = self.model.distance(start + toward * range);
            if gap < 1e-4 * diagonal {
                return false;
            }
            range += gap;
        }
        true
    }
}

/// A turn of any kind and a shift.
pub fn random_pose(rng: &mut Rng, reach: f64) -> Pose {
    let mut number = || rng.normal();
    let turn = DQuat::from_xyzw(number(), number(), number(), number()).normalize();
    Pose {
        turn: DMat3::from_quat(turn),
        shift: reach * DVec3::new(number(), number(), number()),
    }
}

/// The mean distance between where each scan was put and where it is, in the frame of the first, as shares of a length. `None`: left out.
pub fn errors(
    clouds: &[Cloud],
    truth: &[Pose],
    found: &[Option<Pose>],
    length: f64,
) -> Vec<Option<f64>> {
    let Some(first) = found.iter().position(|pose| pose.is_some()) else {
        return vec![None; clouds.len()];
    };
    // Where a scan lies is known up to one motion of all: the one that leaves least.
    let points = |k: usize| {
        let all = clouds[k].positions_f64();
        let each = all.chunks_exact(3).step_by(1 + clouds[k].len() / 500);
        each.map(DVec3::from_slice).collect::<Vec<_>>()
    };
    let mut whole = truth[first].after(&found[first].expect("it is placed").back());
    for _ in 0..30 {
        let (mut turn, mut shift, mut squares, mut count) = (DVec3::ZERO, DVec3::ZERO, 0.0, 0.0);
        let placed = || (0..clouds.len()).filter_map(|k| Some((k, found[k]?)));
        let pairs: Vec<(DVec3, DVec3)> = placed()
            .flat_map(|(k, pose)| {
                points(k)
                    .into_iter()
                    .map(move |p| (pose.at(p), truth[k].at(p)))
            })
            .map(|(p, q)| (whole.at(p), q))
            .collect();
        let middle = pairs.iter().map(|(p, _)| *p).sum::<DVec3>() / pairs.len() as f64;
        for &(p, q) in &pairs {
            shift += q - p;
            turn += (p - middle).cross(q - p);
            squares += (p - middle).length_squared();
            count += 1.0;
        }
        let half = 0.5 * 1.5 * turn / squares;
        let turn = DMat3::from_quat(DQuat::from_xyzw(half.x, half.y, half.z, 1.0).normalize());
        let step = Pose {
            turn,
            shift: middle + shift / count - turn * middle,
        };
        whole = step.after(&whole);
    }
    let error = |k: usize| {
        let pose = whole.after(&found[k]?);
        let points = points(k);
        let sum: f64 = points
            .iter()
            .map(|&p| pose.at(p).distance(truth[k].at(p)))
            .sum();
        Some(sum / points.len() as f64 / length)
    };
    (0..clouds.len()).map(error).collect()
}
