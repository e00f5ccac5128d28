//! Extraction on functions whose zero set is known.

use glam::{DVec3, Vec3};
use pointweave::extract::{ExtractParams, Extracted, Implicit, extract};
use pointweave::params::Boundary;
use pointweave::progress::Silent;
use pointweave::report::{Topology, area, topology, volume};
use pointweave::rng::Rng;
use std::f64::consts::PI;

/// A function with a region in which it counts as fitted.
struct Analytic<V, C> {
    value: V,
    covered: C,
}

impl<V: Fn(DVec3) -> f64 + Sync, C: Fn(DVec3) -> bool + Sync> Implicit for Analytic<V, C> {
    type Scratch = ();

    fn scratch(&self) {}

    fn local(&self, at: DVec3, (): &mut ()) -> Option<f64> {
        (self.covered)(at).then(|| (self.value)(at))
    }

    fn global(&self, at: DVec3, (): &mut ()) -> f64 {
        (self.value)(at)
    }

    fn gradient(&self, at: DVec3, (): &mut ()) -> Option<(f64, DVec3)> {
        let e = 1e-6;
        let slope = |d: DVec3| ((self.value)(at + e * d) - (self.value)(at - e * d)) / (2.0 * e);
        (self.covered)(at).then(|| {
            (
                (self.value)(at),
                DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z)),
            )
        })
    }
}

/// Points on the zero set: random ones of the cube [-0.5, 0.5]³ led there by Newton steps.
fn sample(
    value: &(impl Fn(DVec3) -> f64 + Sync),
    covered: &impl Fn(DVec3) -> bool,
    n: usize,
) -> Vec<Vec3> {
    let mut rng = Rng::new(7);
    let mut points = Vec::new();
    let field = Analytic {
        value,
        covered: |_| true,
    };
    for _ in 0..20 * n {
        let mut x = DVec3::new(rng.uniform(), rng.uniform(), rng.uniform()) - 0.5;
        for _ in 0..5 {
            if let Some((v, g)) = field.gradient(x, &mut ()) {
                x -= g * (v / g.length_squared().max(1e-9));
            }
        }
        if value(x).abs() < 1e-6 && covered(x) && x.abs().max_element() < 0.5 && points.len() < n {
            points.push(x.as_vec3());
        }
    }
    points
}

struct Run {
    out: Extracted,
    topology: Topology,
}

fn run_on(
    points: &[Vec3],
    value: impl Fn(DVec3) -> f64 + Sync,
    covered: impl Fn(DVec3) -> bool + Sync,
    params: ExtractParams,
) -> Run {
    let reach = vec![0.05; points.len()];
    let field = Analytic { value, covered };
    let out = extract(&field, points, &reach, &params, &mut Silent).expect("not cancelled");
    let topology = topology(&out.mesh.triangles, out.mesh.vertices.len());
    assert!(topology.is_manifold(), "{topology:?}");
    Run { out, topology }
}

fn run(value: impl Fn(DVec3) -> f64 + Sync, params: ExtractParams) -> Run {
    let points = sample(&value, &|_| true, 4000);
    run_on(&points, value, |_| true, params)
}

const FINE: ExtractParams = ExtractParams {
    resolution: 0.01,
    boundary: Boundary::Auto,
    sharp: false,
};

/// Mean and maximum of |value| over vertices.
fn errors(run: &Run, value: impl Fn(DVec3) -> f64) -> (f64, f64) {
    let d: Vec<f64> = run
        .out
        .mesh
        .vertices
        .iter()
        .map(|v| value(v.as_dvec3()).abs())
        .collect();
    (
        d.iter().sum::<f64>() / d.len() as f64,
        d.iter().copied().fold(0.0, f64::max),
    )
}

#[test]
fn sphere() {
    let value = |x: DVec3| x.length() - 0.3;
    let r = run(value, FINE);
    println!("{:?} {:?}", r.topology, errors(&r, value));
    assert_eq!(
        (
            r.topology.components,
            r.topology.boundary_edges,
            r.topology.genus.clone()
        ),
        (1, 0, vec![0])
    );
    let (v, a) = (
        volume(&r.out.mesh.vertices, &r.out.mesh.triangles),
        area(&r.out.mesh.vertices, &r.out.mesh.triangles),
    );
    println!(
        "{} {}",
        v / (4.0 / 3.0 * PI * 0.027) - 1.0,
        a / (4.0 * PI * 0.09) - 1.0
    );
}

#[test]
fn noise() {
    for seed in 0..4 {
        let value = |x: DVec3| {
            let p = (x * 60.0).round().as_ivec3();
            let mut rng = Rng::new(
                seed * 1000 + ((p.x * 73856093) ^ (p.y * 19349663) ^ (p.z * 83492791)) as u64,
            );
            rng.next_u64();
            rng.uniform() - 0.5
        };
        let mut rng = Rng::new(5);
        let points: Vec<Vec3> = (0..3000)
            .map(|_| {
                (DVec3::new(rng.uniform(), rng.uniform(), rng.uniform()) * 0.4 - 0.2).as_vec3()
            })
            .collect();
        let params = ExtractParams {
            resolution: 1.0 / 60.0,
            boundary: Boundary::Closed,
            sharp: false,
        };
        let r = run_on(&points, value, |_| true, params);
        println!(
            "{:?}",
            Topology {
                genus: vec![],
                ..r.topology
            }
        );
    }
}
