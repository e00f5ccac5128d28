//! Fuzzy c-means against a naive reading of the paper's equations, and against scikit-fuzzy.

use glam::{DVec3, Vec3};
use pointweave::base::params::Norm;
use pointweave::base::rng::Rng;
use pointweave::reduce::fcm::{Fcm, FcmParams, Prototypes, Start};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// The equations one by one, a loop for each sum.
mod naive {
    use glam::{DMat3, DVec3};

    pub fn distance2(x: DVec3, v: DVec3, a: &DMat3) -> f64 {
        (x - v).dot(*a * (x - v))
    }

    /// Eq. 1; `u[i][k]`.
    pub fn objective(
        x: &[DVec3],
        w: &[f64],
        u: &[Vec<f64>],
        v: &[DVec3],
        a: &DMat3,
        m: f64,
    ) -> f64 {
        let mut sum = 0.0;
        for i in 0..v.len() {
            for k in 0..x.len() {
                sum += w[k] * u[i][k].powf(m) * distance2(x[k], v[i], a);
            }
        }
        sum
    }

    /// Eq. 2.
    pub fn centers(x: &[DVec3], w: &[f64], u: &[Vec<f64>], m: f64) -> Vec<DVec3> {
        u.iter()
            .map(|row| {
                let (mut top, mut bottom) = (DVec3::ZERO, 0.0);
                for k in 0..x.len() {
                    top += w[k] * row[k].powf(m) * x[k];
                    bottom += w[k] * row[k].powf(m);
                }
                top / bottom
            })
            .collect()
    }

    /// Eq. 3-5.
    pub fn memberships(x: &[DVec3], v: &[DVec3], a: &DMat3, m: f64) -> Vec<Vec<f64>> {
        let mut u = vec![vec![0.0; x.len()]; v.len()];
        for k in 0..x.len() {
            let d: Vec<f64> = v.iter().map(|&v| distance2(x[k], v, a).sqrt()).collect();
            let at_zero: Vec<usize> = (0..v.len()).filter(|&i| d[i] == 0.0).collect();
            for i in 0..v.len() {
                u[i][k] = if at_zero.is_empty() {
                    1.0 / (0..v.len())
                        .map(|j| (d[i] / d[j]).powf(2.0 / (m - 1.0)))
                        .sum::<f64>()
                } else if at_zero.contains(&i) {
                    1.0 / at_zero.len() as f64
                } else {
                    0.0
                };
            }
        }
        u
    }

    /// Eq. 6.
    pub fn change(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
        let pairs = a.iter().flatten().zip(b.iter().flatten());
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// Eq. 7.
    pub fn validity(objective: f64, v: &[DVec3], a: &DMat3) -> f64 {
        let mut separation = f64::INFINITY;
        for i in 0..v.len() {
            for j in 0..v.len() {
                if i != j {
                    separation = separation.min(distance2(v[i], v[j], a));
                }
            }
        }
        objective / (v.len() as f64 * separation)
    }
}

fn cloud(n: usize, seed: u64) -> Vec<Vec3> {
    let mut rng = Rng::new(seed);
    let mut coordinate = |scale: f64| (rng.uniform() * scale) as f32;
    (0..n)
        .map(|_| Vec3::new(coordinate(0.1), coordinate(0.2), coordinate(0.02)))
        .collect()
}

fn fuzzy(m: f64, epsilon: f64, max_iterations: usize) -> FcmParams {
    FcmParams {
        fuzzifier: m,
        epsilon,
        max_iterations,
    }
}

fn rows(fcm: &Fcm, c: usize) -> Vec<Vec<f64>> {
    (0..c).map(|i| fcm.memberships(i).to_vec()).collect()
}

fn spread(n: usize, c: usize, seed: u64) -> Vec<f64> {
    let mut rng = Rng::new(seed);
    let mut u: Vec<f64> = (0..n * c).map(|_| rng.uniform() + 0.01).collect();
    for k in 0..n {
        let total: f64 = (0..c).map(|i| u[i * n + k]).sum();
        (0..c).for_each(|i| u[i * n + k] /= total);
    }
    u
}

fn assert_close(a: f64, b: f64, tolerance: f64, what: &str) {
    assert!(
        (a - b).abs() <= tolerance * b.abs().max(1.0),
        "{what}: {a} against {b}"
    );
}

fn assert_sane(p: &Prototypes, points: &[Vec3]) {
    let low = points.iter().copied().reduce(Vec3::min).unwrap().as_dvec3() - 1e-9;
    let high = points.iter().copied().reduce(Vec3::max).unwrap().as_dvec3() + 1e-9;
    for v in &p.centers {
        assert!(
            v.cmpge(low).all() && v.cmple(high).all(),
            "centre {v} outside the points' box"
        );
    }
    assert!(p.objective.is_finite() && p.objective >= 0.0 && !p.validity.is_nan());
}

#[test]
fn every_equation_agrees_with_its_naive_reading() {
    for (case, m) in [2.0, 1.5, 1.25, 1.7, 3.0].into_iter().enumerate() {
        for n in [9, 16, 30] {
            let c = 4;
            let points = cloud(n, case as u64);
            let weights: Vec<f32> = (0..n).map(|k| 0.5 + (k % 5) as f32).collect();
            let x: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
            let w: Vec<f64> = weights.iter().map(|&w| f64::from(w)).collect();
            let start = spread(n, c, 7);
            let u0: Vec<Vec<f64>> = start.chunks(n).map(<[f64]>::to_vec).collect();
            let identity = glam::DMat3::IDENTITY;

            let mut fcm = Fcm::default();
            fcm.load(&points, &weights, Norm::Euclidean);
            let one = fcm.run(Start::Memberships(&start), &fuzzy(m, 0.0, 1));
            let v1 = naive::centers(&x, &w, &u0, m);
            let u1 = naive::memberships(&x, &v1, &identity, m);
            for (a, b) in one.centers.iter().zip(&v1) {
                assert!(a.distance(*b) < 1e-12, "eq. 2, m = {m}: {a} against {b}");
            }
            assert!(naive::change(&rows(&fcm, c), &u1) < 1e-9, "eq. 5, m = {m}");
            assert_close(one.change, naive::change(&u1, &u0), 1e-9, "eq. 6");
            let j = naive::objective(&x, &w, &u1, &v1, &identity, m);
            assert_close(one.objective / j, 1.0, 1e-9, "eq. 1");
            assert_close(
                one.validity / naive::validity(j, &v1, &identity),
                1.0,
                1e-9,
                "eq. 7",
            );

            fcm.run(Start::Memberships(&start), &fuzzy(m, 0.0, 2));
            let v2 = naive::centers(&x, &w, &u1, m);
            let u2 = naive::memberships(&x, &v2, &identity, m);
            assert!(
                naive::change(&rows(&fcm, c), &u2) < 1e-8,
                "second sweep, m = {m}"
            );
        }
    }
}

#[test]
fn norms_are_the_matrices_they_claim() {
    let points = cloud(40, 3);
    let x: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
    let mean = x.iter().sum::<DVec3>() / x.len() as f64;
    let mut covariance = glam::DMat3::ZERO;
    for x in &x {
        let d = *x - mean;
        covariance +=
            glam::DMat3::from_cols(d * d.x, d * d.y, d * d.z) * (1.0 / points.len() as f64);
    }
    let diagonal = covariance.to_cols_array();
    let variances = DVec3::new(diagonal[0], diagonal[4], diagonal[8]);
    let scale = (variances.x + variances.y + variances.z) / 3.0;
    let start = spread(points.len(), 3, 11);
    for (norm, a) in [
        (
            Norm::Diagonal,
            glam::DMat3::from_diagonal(scale / variances),
        ),
        (Norm::Mahalanobis, covariance.inverse() * scale),
    ] {
        let mut fcm = Fcm::default();
        fcm.load(&points, &[], norm);
        let p = fcm.run(Start::Memberships(&start), &fuzzy(2.0, 0.0, 5));
        let u = naive::memberships(&x, &p.centers, &a, 2.0);
        assert!(naive::change(&rows(&fcm, 3), &u) < 1e-7, "{norm:?}");
        let ones = vec![1.0; points.len()];
        let j = naive::objective(&x, &ones, &u, &p.centers, &a, 2.0);
        assert_close(p.objective / j, 1.0, 1e-7, "objective in the norm");
    }
}

#[test]
fn agrees_with_scikit_fuzzy_from_the_same_start() {
    let mut lines = include_str!("fixtures/fcm_skfuzzy.txt").lines().peekable();
    let mut cases = 0;
    while let Some(header) = lines.next() {
        let numbers: Vec<f64> = header
            .split(' ')
            .skip(1)
            .map(|t| t.parse().unwrap())
            .collect();
        let [n, c, sweeps] = [numbers[0], numbers[1], numbers[3]].map(|v| v as usize);
        let m = numbers[2];
        let mut block = |rows: usize| -> Vec<Vec<f64>> {
            let row = |line: &str| line.split(' ').map(|t| t.parse().unwrap()).collect();
            lines.by_ref().take(rows).map(row).collect()
        };
        let points: Vec<Vec3> = block(n)
            .iter()
            .map(|r| DVec3::new(r[0], r[1], r[2]).as_vec3())
            .collect();
        let start = block(c).concat();
        let u = block(c);
        let centers: Vec<DVec3> = block(c)
            .iter()
            .map(|r| DVec3::new(r[0], r[1], r[2]))
            .collect();

        let mut fcm = Fcm::default();
        fcm.load(&points, &[], Norm::Euclidean);
        let p = fcm.run(Start::Memberships(&start), &fuzzy(m, 0.0, sweeps));
        assert_eq!(p.iterations, sweeps);
        assert!(
            naive::change(&rows(&fcm, c), &u) < 1e-6,
            "memberships, m = {m}"
        );
        for (a, b) in p.centers.iter().zip(&centers) {
            assert!(a.distance(*b) < 1e-6, "centre {a} against {b}, m = {m}");
        }
        cases += 1;
    }
    assert_eq!(cases, 5);
}

#[test]
fn a_point_at_a_centre_belongs_to_it_alone() {
    let points = cloud(12, 5);
    let centers = [
        points[3].as_dvec3(),
        points[9].as_dvec3(),
        DVec3::new(0.05, 0.05, 0.0),
    ];
    for m in [1.25, 1.5, 2.0, 2.5] {
        let mut fcm = Fcm::default();
        fcm.load(&points, &[], Norm::Euclidean);
        fcm.run(Start::Centers(&centers), &fuzzy(m, 0.0, 1));
        let column = |k: usize| [0, 1, 2].map(|i| fcm.memberships(i)[k]);
        // The transform moves centres by a rounding error, so the distance is zero or next to it.
        for (k, i) in [(3, 0), (9, 1)] {
            assert_close(column(k)[i], 1.0, 1e-9, "membership at distance zero");
        }
    }
}

#[test]
fn coincident_centres_share_equally_and_stay_finite() {
    let points = cloud(20, 6);
    let v = points[4].as_dvec3();
    for m in [1.25, 1.5, 2.0, 4.0] {
        let mut fcm = Fcm::default();
        fcm.load(&points, &[], Norm::Euclidean);
        let p = fcm.run(Start::Centers(&[v, v, DVec3::ZERO]), &fuzzy(m, 1e-3, 30));
        assert!((0..20).all(|k| (fcm.memberships(0)[k] - fcm.memberships(1)[k]).abs() < 1e-12));
        assert_sane(&p, &points);
        assert_eq!(p.validity, f64::INFINITY);
    }
}

#[test]
fn duplicates_and_more_clusters_than_points_are_survived() {
    let same = vec![Vec3::new(0.3, -0.2, 0.1); 10];
    let few = cloud(3, 8);
    for points in [&same, &few] {
        for norm in [Norm::Euclidean, Norm::Diagonal, Norm::Mahalanobis] {
            for c in [1, 2, 7] {
                let mut fcm = Fcm::default();
                fcm.load(points, &[], norm);
                let p = fcm.run(
                    Start::Random {
                        clusters: c,
                        seed: 1,
                    },
                    &fuzzy(2.0, 1e-3, 100),
                );
                assert_eq!(p.centers.len(), c);
                assert_sane(&p, points);
            }
        }
    }
}

#[test]
fn extreme_fuzzifiers_give_the_limits_of_section_3_2() {
    let points = cloud(60, 9);
    let mut fcm = Fcm::default();
    fcm.load(&points, &[], Norm::Euclidean);
    // m towards one: the partition becomes hard.
    let p = fcm.run(
        Start::Random {
            clusters: 5,
            seed: 2,
        },
        &fuzzy(1.0 + 1e-6, 1e-3, 100),
    );
    assert_sane(&p, &points);
    let hard = |u: f64| !(1e-6..=1.0 - 1e-6).contains(&u);
    assert!((0..5).all(|i| fcm.memberships(i).iter().all(|&u| hard(u))));
    // m towards infinity: all memberships 1/c, wherever the centres are.
    let centers = [0.01, 0.03, 0.05, 0.07, 0.09].map(DVec3::splat);
    fcm.run(Start::Centers(&centers), &fuzzy(500.0, 1e-9, 1));
    assert!((0..5).all(|i| fcm.memberships(i).iter().all(|&u| (u - 0.2).abs() < 0.02)));
}

#[test]
fn stops_by_epsilon_and_repeats_with_the_seed() {
    let points = cloud(200, 10);
    let run = |seed, epsilon| {
        let mut fcm = Fcm::default();
        fcm.load(&points, &[], Norm::Euclidean);
        fcm.run(
            Start::Random { clusters: 12, seed },
            &fuzzy(2.0, epsilon, 500),
        )
    };
    let (rough, fine) = (run(4, 1e-2), run(4, 1e-4));
    assert!(rough.change < 1e-2 && fine.change < 1e-4 && rough.iterations < fine.iterations);
    assert!(fine.objective <= rough.objective, "J never rises");
    assert_eq!(run(4, 1e-2).centers, rough.centers);
    assert_ne!(run(5, 1e-2).centers, rough.centers);
}
