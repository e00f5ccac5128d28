//! What a result says of itself: nothing of clean scans, and what is wrong with others.

mod common;

use common::Shape;
use glam::DVec3;
use pointweave::base::params::{Boundary, Scatter};
use pointweave::base::progress::Silent;
use pointweave::base::rng::Rng;
use pointweave::{Cloud, Surface, SurfaceParams, reconstruct};

/// Codes about the surface; others are about sides and files.
const CODES: [&str; 6] = [
    "scatter",
    "thin",
    "far-area",
    "tunnels",
    "self-intersections",
    "islands-dropped",
];

fn surface(positions: &[f64], params: &SurfaceParams) -> Surface {
    let cloud = Cloud::from_f64(positions).unwrap();
    reconstruct(&cloud, params, &mut Silent).unwrap()
}

fn doubts(surface: &Surface) -> Vec<&'static str> {
    let all = surface.report.reduce.doubts.iter();
    all.map(|doubt| doubt.code)
        .filter(|code| CODES.contains(code))
        .collect()
}

fn direction(rng: &mut Rng) -> DVec3 {
    DVec3::new(rng.normal(), rng.normal(), rng.normal()).normalize()
}

/// A ball of radius 1, and `more` points that `at` makes.
fn ball_and(n: usize, more: usize, seed: u64, mut at: impl FnMut(&mut Rng) -> DVec3) -> Vec<f64> {
    let mut positions = Shape::Sphere.sample(n, 0.0, seed);
    let mut rng = Rng::new(seed + 100);
    for _ in 0..more {
        positions.extend(at(&mut rng).to_array());
    }
    positions
}

fn half_ball(n: usize, seed: u64) -> Vec<f64> {
    let all = Shape::Sphere.sample(2 * n, 0.0, seed);
    let half = all.chunks_exact(3).filter(|p| p[2] > 0.0);
    half.flatten().copied().collect()
}

/// Both sides and the rim of a plate of 2 by 1.4.
fn plate(n: usize, thickness: f64, seed: u64) -> Vec<f64> {
    let mut rng = Rng::new(seed);
    let mut positions = Vec::new();
    for i in 0..n {
        let (x, y) = (2.0 * rng.uniform() - 1.0, 1.4 * rng.uniform() - 0.7);
        let z = if i % 2 == 0 { thickness } else { 0.0 };
        positions.extend([x, y, z]);
    }
    positions
}

#[test]
fn nothing_is_said_of_fifty_clean_clouds() {
    for seed in 0..5 {
        for noise in [0.0, 2e-3] {
            for shape in Shape::ALL {
                let s = surface(&shape.sample(1500, noise, seed), &SurfaceParams::default());
                assert_eq!(doubts(&s), [""; 0], "{shape:?} {noise} {seed}");
                assert_eq!((s.report.scatter, s.report.self_intersections), (0, 0));
            }
        }
        let s = surface(&half_ball(1200, seed), &SurfaceParams::default());
        assert_eq!(doubts(&s), [""; 0], "half a ball {seed}");
        // As thick as six spacings.
        let s = surface(&plate(2400, 0.3, seed), &SurfaceParams::default());
        assert_eq!(doubts(&s), [""; 0], "plate {seed}");
    }
}

#[test]
fn fifty_bad_clouds_are_doubted() {
    type Made = (&'static str, &'static str, Vec<f64>, SurfaceParams);
    let cases = |seed: u64| -> Vec<Made> {
        let auto = SurfaceParams::default;
        let crown = DVec3::new(3.0, 0.0, 0.0);
        let in_ball = |rng: &mut Rng| direction(rng) * libm::cbrt(rng.uniform());
        let mut clump = DVec3::ZERO;
        let mut count = 0;
        let dust = move |rng: &mut Rng| {
            if count % 8 == 0 {
                clump = direction(rng) * (1.3 + rng.uniform());
            }
            count += 1;
            clump + direction(rng) * 5e-3
        };
        let mut bits = DVec3::ZERO;
        let mut bit = 0;
        let islands = move |rng: &mut Rng| {
            if bit % 20 == 0 {
                bits = direction(rng) * (2.0 + 2.0 * rng.uniform());
            }
            bit += 1;
            bits + DVec3::new(0.15 * rng.uniform(), 0.15 * rng.uniform(), 0.0)
        };
        let closed = SurfaceParams {
            boundary: Boundary::Closed,
            ..auto()
        };
        vec![
            (
                "more dust",
                "scatter",
                ball_and(1500, 800, seed, dust),
                auto(),
            ),
            (
                "crown",
                "scatter",
                ball_and(2400, 1200, seed, |rng| crown + in_ball(rng)),
                auto(),
            ),
            ("dust", "scatter", ball_and(1500, 400, seed, dust), auto()),
            (
                "kept crown",
                "scatter",
                ball_and(2400, 1200, seed, |rng| crown + in_ball(rng)),
                SurfaceParams {
                    scatter: Scatter::Keep,
                    ..auto()
                },
            ),
            ("plate", "thin", plate(2400, 0.05, seed), auto()),
            ("thinner plate", "thin", plate(1600, 0.06, seed), auto()),
            (
                "half ball, closed",
                "far-area",
                half_ball(1000, seed),
                closed.clone(),
            ),
            (
                "cap, closed",
                "far-area",
                half_ball(1500, seed)
                    .chunks_exact(3)
                    .filter(|p| p[2] > 0.4)
                    .flatten()
                    .copied()
                    .collect(),
                closed,
            ),
            (
                "islands",
                "islands-dropped",
                ball_and(1200, 240, seed, islands),
                auto(),
            ),
            (
                "more islands",
                "islands-dropped",
                ball_and(1500, 400, seed, islands),
                auto(),
            ),
        ]
    };
    for seed in 0..5 {
        for (name, code, positions, params) in cases(seed) {
            let s = surface(&positions, &params);
            assert!(
                doubts(&s).contains(&code),
                "{name} {seed}: {:?}",
                s.report.reduce.doubts
            );
            if code == "scatter" {
                assert_eq!(
                    s.report.scatter > 0,
                    params.scatter == Scatter::Drop,
                    "{name}"
                );
            }
        }
    }
}

#[test]
fn scatter_stays_in_the_cloud_and_out_of_the_mesh() {
    let crown = DVec3::new(3.0, 0.0, 0.0);
    let positions = ball_and(3000, 1500, 1, |rng| {
        crown + direction(rng) * libm::cbrt(rng.uniform())
    });
    let s = surface(&positions, &SurfaceParams::default());
    assert!(
        s.report.scatter > 900 && s.report.scatter < 1530,
        "{}",
        s.report.scatter
    );
    let cloud = s.cloud.reduced.cloud.positions_f64();
    assert_eq!(cloud.len(), positions.len() / 3);
    assert!(cloud.chunks_exact(3).any(|p| p[0] > 2.5));
}
