//! What normals of the cloud are worth: the mean distance to the true surface without any, and with true ones and ones that are noisy
//! themselves.

use crate::grain::grain;
use crate::measure::{mark, reduced_to};
use glam::DVec3;
use pointweave::base::progress::Silent;
use pointweave::base::rng::Rng;
use pointweave::samples::{Model, sample_with_noise};
use pointweave::{Cloud, reconstruct};

/// Noise of the normals, in degrees a direction.
const TILTS: [f64; 4] = [0.0, 5.0, 15.0, 30.0];
/// Distance that is allowed of that without normals.
const MOST: f64 = 1.03;

pub fn run() {
    println!(
        "\nNORMALS of the cloud: mean distance to the true surface in 1e-4 of the diagonal, without -> with normals of so many degrees of noise"
    );
    for model in Model::ALL {
        for noise in [0.0, 3e-4, 1e-3, 5e-3] {
            for kept in [1, 3] {
                row(model, noise, kept);
            }
        }
    }
}

fn row(model: Model, noise: f64, kept: usize) {
    let scan = sample_with_noise(model, 36_000, 1, noise);
    let places = scan.positions.chunks_exact(3);
    let places = places.map(|p| DVec3::new(p[0].into(), p[1].into(), p[2].into()));
    let normals: Vec<DVec3> = places.map(|p| model.gradient(p).normalize()).collect();
    let error = |tilt: Option<f64>| {
        let mut cloud = Cloud::from_f32(&scan.positions).expect("a cloud");
        if let Some(tilt) = tilt {
            let mut rng = Rng::new(2);
            let mut aside =
                || tilt.to_radians() * DVec3::new(rng.normal(), rng.normal(), rng.normal());
            let tilted = normals
                .iter()
                .flat_map(|&n| (n + aside()).normalize().as_vec3().to_array());
            cloud = cloud
                .with_normals(&tilted.collect::<Vec<f32>>())
                .expect("normals");
        }
        let surface = reconstruct(&cloud, &reduced_to(kept), &mut Silent).expect("a surface");
        grain(model, &surface).z
    };
    let without = error(None);
    let with = TILTS.map(|tilt| error(Some(tilt)));
    let shown = |(tilt, with): (f64, f64)| format!("{tilt}°: {with:.3} ({:.3})", with / without);
    let all: Vec<String> = TILTS.into_iter().zip(with).map(shown).collect();
    let missed = with.iter().any(|&with| with > MOST * without);
    println!(
        "{:<5} {:>5} %, 1/{kept}: {without:.3} -> {}{}",
        model.name(),
        100.0 * noise,
        all.join("  "),
        mark(missed)
    );
}
