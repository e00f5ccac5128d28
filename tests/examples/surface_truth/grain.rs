//! How grainy a first look is: the angle of the mesh to the true surface, as it is fitted and after fairing.

use crate::measure::{mark, reduced_to};
use glam::DVec3;
use pointweave::base::progress::Silent;
use pointweave::samples::{Model, Sample, sample, sample_with_noise};
use pointweave::{Cloud, Surface, SurfaceParams, reconstruct};

/// Share of the angle of before that is left at a first look of a sample, at most.
const MOST_LEFT: f64 = 0.7;
/// What a first look keeps of a sample: one point in so many.
const KEPT: usize = 3;

pub fn run() {
    println!(
        "\nGRAIN: mean angle in degrees of the triangles, and of the vertices' normals, to the true surface, by area, and mean distance in 1e-4"
    );
    println!("of the diagonal; without fairing -> with it");
    for model in Model::ALL {
        row(
            model,
            "as it is",
            &sample(model, model.default_points(), 1),
            KEPT,
        );
        for noise in [0.0, 3e-4, 1e-3, 5e-3] {
            let scan = sample_with_noise(model, 36_000, 1, noise);
            for kept in [1, KEPT] {
                row(model, &format!("{} %", 100.0 * noise), &scan, kept);
            }
        }
    }
}

fn row(model: Model, noise: &str, scan: &Sample, kept: usize) {
    let cloud = Cloud::from_f32(&scan.positions).expect("a cloud");
    let [before, after] = [false, true].map(|fairing| {
        let params = SurfaceParams {
            fairing,
            ..reduced_to(kept)
        };
        grain(
            model,
            &reconstruct(&cloud, &params, &mut Silent).expect("a surface"),
        )
    });
    let name = model.name();
    let missed = noise == "as it is" && after.x > MOST_LEFT * before.x || after.z > 1.05 * before.z;
    println!(
        "{name:<5} {noise:>8}, 1/{kept}: {:6.3} -> {:6.3} ({:.2})   {:6.3} -> {:6.3} ({:.2})   {:6.3} -> {:6.3} ({:.2}){}",
        before.x,
        after.x,
        after.x / before.x,
        before.y,
        after.y,
        after.y / before.y,
        before.z,
        after.z,
        after.z / before.z,
        mark(missed)
    );
}

/// Mean angles of triangles and of vertices' normals to the true surface, in degrees, and mean distance in 1e-4 of the diagonal.
pub fn grain(model: Model, s: &Surface) -> DVec3 {
    let frame = &s.cloud.reduced.cloud.frame;
    let at = |v: u32| DVec3::from_array(frame.to_caller(s.mesh.vertices[v as usize]));
    let off = |normal: DVec3, at: DVec3| normal.angle_between(model.gradient(at)).to_degrees();
    let (mut sums, mut area) = (DVec3::ZERO, 0.0);
    for triangle in &s.mesh.triangles {
        let [a, b, c] = triangle.map(at);
        let (cross, middle) = ((b - a).cross(c - a), (a + b + c) / 3.0);
        let slope = model.gradient(middle).length().max(0.5);
        let distance = model.distance(middle).abs() / slope / frame.diagonal;
        let normals = triangle.map(|v| off(s.mesh.normals[v as usize].as_dvec3(), at(v)));
        let vertices = normals.iter().sum::<f64>() / 3.0;
        sums += cross.length() * DVec3::new(off(cross, middle), vertices, 1e4 * distance);
        area += cross.length();
    }
    sums / area
}
