//! The generated scans: the solids are what they claim to be, and the scanner measures them as it says.

use glam::{DVec3, Vec3, dvec3};
use pointweave::Cloud;
use pointweave::base::rng::Rng;
use pointweave::cloud::octree::Octree;
use pointweave::samples::{Model, NOISE, Sample, desk, sample, sample_with_noise};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn diagonal(model: Model) -> f64 {
    let (low, high) = model.bounds();
    low.distance(high)
}

fn positions(sample: &Sample) -> Vec<DVec3> {
    let point = |p: &[f32]| Vec3::from_slice(p).as_dvec3();
    sample.positions.chunks_exact(3).map(point).collect()
}

fn random_point(model: Model, rng: &mut Rng) -> DVec3 {
    let (low, high) = model.bounds();
    low + (high - low) * dvec3(rng.uniform(), rng.uniform(), rng.uniform())
}

/// Signed distance to first order: exact gradient length divided out.
fn first_order(model: Model, p: DVec3) -> f64 {
    model.distance(p) / model.gradient(p).length()
}

/// Random points of the surface, reached by descent from random points around it.
fn surface_points(model: Model, count: usize) -> Vec<DVec3> {
    let mut rng = Rng::new(5);
    let mut points = Vec::new();
    while points.len() < count {
        let mut p = random_point(model, &mut rng);
        for _ in 0..30 {
            if model.distance(p).abs() < 1e-7 * diagonal(model) {
                break;
            }
            let gradient = model.gradient(p);
            p -= gradient * (model.distance(p) / gradient.length_squared().max(0.1));
        }
        if model.distance(p).abs() < 1e-6 * diagonal(model) {
            points.push(p);
        }
    }
    points
}

#[test]
fn counts_are_exact_and_every_point_has_its_colour_and_normal() {
    for model in Model::ALL {
        for count in [0, 1, 2, 777, 5_000] {
            let scan = sample(model, count, 3);
            assert_eq!(scan.positions.len(), 3 * count, "{model:?}");
            assert_eq!(scan.colors.len(), 3 * count, "{model:?}");
            assert_eq!(scan.normals.len(), 3 * count, "{model:?}");
            assert!(scan.positions.iter().all(|x| x.is_finite()));
        }
    }
    assert_eq!(Model::Duck.default_points(), 35_647);
    assert_eq!(Model::Pig.default_points(), 171_875);
    assert_eq!(Model::from_name("pig"), Some(Model::Pig));
    assert_eq!(Model::from_name("cow"), None);
}

/// JavaScript names the models by hand: the package's check and type, the page's list and buttons.
#[cfg(not(target_arch = "wasm32"))]
#[test]
fn the_package_and_the_page_name_every_model() {
    for (path, start, end) in [
        ("pkg/engine/options.js", "const MODEL = choice(", ";"),
        ("pkg/types.d.ts", "export type Model =", ";"),
        ("www/src/controls/samples.js", "export const SAMPLES =", ";"),
        ("www/index.html", "id=\"samples\"", "</div>"),
    ] {
        let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
        let text = std::fs::read_to_string(file).expect(path);
        let (_, after) = text.split_once(start).expect(start);
        let (list, _) = after.split_once(end).expect(end);
        for model in Model::ALL {
            let name = model.name();
            let said = [
                format!("'{name}'"),
                format!(" {name}: {{"),
                format!("data-sample=\"{name}\""),
            ];
            assert!(said.iter().any(|s| list.contains(s)), "{name} in {path}");
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_seed_another_scan() {
    for model in Model::ALL {
        let scan = sample(model, 3_000, 9);
        assert_eq!(scan, sample(model, 3_000, 9));
        assert_ne!(scan.positions, sample(model, 3_000, 10).positions);
    }
}

#[test]
fn the_bits_are_the_same_on_every_machine() {
    // FNV-1a over the bits of all positions; native and wasm run this same test.
    let checksum = |scan: &Sample| {
        let bytes = scan.positions.iter().flat_map(|x| x.to_le_bytes());
        bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
        })
    };
    for (model, expected) in [
        (Model::Duck, 0xfd9d_5bf3_da01_0ac4),
        (Model::Pig, 0x0c2a_a257_6369_a2bf),
        (Model::Part, 0x85c3_e69d_c309_1eb3),
    ] {
        let found = checksum(&sample(model, 3_000, 9));
        assert_eq!(found, expected, "{model:?}: {found:#x}");
    }
    let found = checksum(&desk(3_000, 9, NOISE));
    assert_eq!(found, 0x5800_7a91_f34d_a7c4, "desk: {found:#x}");
}

#[test]
fn on_the_desk_are_duck_table_block_and_strays() {
    for count in [0, 1, 777, 6_000] {
        let scan = desk(count, 3, NOISE);
        assert_eq!(scan.positions.len(), 3 * count);
        assert_eq!(scan.colors.len(), 3 * count);
        assert_eq!(scan.normals.len(), 3 * count);
    }
    let points = positions(&desk(6_000, 3, NOISE));
    let share = |is: &dyn Fn(&DVec3) -> bool| {
        points.iter().filter(|p| is(p)).count() as f64 / points.len() as f64
    };
    let on_table = |p: &DVec3| (p.y + 2.25).abs() < 0.05;
    let on_duck = |p: &DVec3| first_order(Model::Duck, *p).abs() < 0.05 && !on_table(p);
    assert!((0.42..0.48).contains(&share(&on_table)));
    assert!((0.46..0.50).contains(&share(&on_duck)));
    let beneath = |p: &DVec3| on_table(p) && Model::Duck.distance(*p) < 0.0;
    assert_eq!(share(&beneath), 0.0, "what stands on it hides the table");
}

#[test]
fn the_noise_along_the_ray_is_what_was_asked_for() {
    for model in Model::ALL {
        for noise in [2e-4, NOISE, 2e-3] {
            let scan = sample_with_noise(model, 8_000, 4, noise);
            let errors: Vec<f64> = positions(&scan)
                .into_iter()
                .map(|p| first_order(model, p) / diagonal(model))
                .collect();
            let mean = errors.iter().sum::<f64>() / errors.len() as f64;
            let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
            // Across the surface the noise along the ray shrinks by the cosine of the incidence.
            assert!(
                (0.55..1.0).contains(&(rms / noise)),
                "{model:?} {noise}: rms {rms}"
            );
            assert!(mean.abs() < 0.05 * noise, "{model:?} {noise}: mean {mean}");
        }
    }
}

#[test]
fn without_noise_points_lie_on_the_surface_with_true_normals() {
    for model in Model::ALL {
        let scan = sample_with_noise(model, 8_000, 4, 0.0);
        let mut right = 0;
        for (p, n) in positions(&scan)
            .into_iter()
            .zip(scan.normals.chunks_exact(3))
        {
            assert!(
                first_order(model, p).abs() < 4e-6 * diagonal(model),
                "{model:?} {p}"
            );
            let normal = Vec3::from_slice(n);
            assert!((normal.length() - 1.0).abs() < 1e-5);
            right += usize::from(model.gradient(p).normalize().dot(normal.as_dvec3()) > 0.99);
        }
        // The few others lie on an edge.
        assert!(right >= 7_950, "{model:?}: {right}");
    }
}

#[test]
fn the_distance_is_negative_inside_and_never_more_than_the_true_one() {
    for model in Model::ALL {
        let mut rng = Rng::new(8);
        for _ in 0..20_000 {
            let a = random_point(model, &mut rng);
            // Half of the pairs far apart, half close together.
            let b = if rng.uniform() < 0.5 {
                random_point(model, &mut rng)
            } else {
                a + 0.05 * dvec3(rng.normal(), rng.normal(), rng.normal())
            };
            let change = (model.distance(a) - model.distance(b)).abs();
            assert!(
                change <= a.distance(b) * (1.0 + 1e-9) + 1e-12,
                "{model:?} {a} {b}"
            );
        }
    }
    assert!(Model::Duck.distance(DVec3::ZERO) < -2.0);
    assert!(Model::Pig.distance(DVec3::ZERO) < -2.0);
    assert!(Model::Part.distance(dvec3(0.0, 0.6, 3.0)) < -0.5);
}

#[test]
fn outside_the_machined_part_the_distance_is_exact() {
    let mut rng = Rng::new(2);
    let mut outside = 0;
    while outside < 5_000 {
        let p = random_point(Model::Part, &mut rng);
        let distance = Model::Part.distance(p);
        let gradient = Model::Part.gradient(p);
        // Where two nearest points are equally far the gradient is a mean of two.
        if distance < 0.02 || gradient.length() < 1.0 - 1e-6 {
            continue;
        }
        outside += 1;
        let foot = p - gradient.normalize() * distance;
        assert!(Model::Part.distance(foot).abs() < 1e-3 * distance, "{p}");
    }
}

#[test]
fn every_solid_is_closed_inside_its_box() {
    for model in Model::ALL {
        let (low, high) = model.bounds();
        let mut rng = Rng::new(1);
        let mut nearest = [f64::INFINITY; 6];
        for _ in 0..20_000 {
            let p = random_point(model, &mut rng);
            for (face, nearest) in nearest.iter_mut().enumerate() {
                let mut on_face = p;
                on_face[face / 2] = if face % 2 == 0 { low } else { high }[face / 2];
                *nearest = nearest.min(model.distance(on_face));
            }
        }
        assert!(
            nearest.iter().all(|&d| d >= -1e-12),
            "{model:?} {nearest:?}"
        );
        // And the box is not much too large.
        assert!(
            nearest.iter().all(|&d| d < 0.12 * diagonal(model)),
            "{model:?} {nearest:?}"
        );
    }
}

/// A solid as cubes of a grid that are inside at their centres, with an empty rim.
struct Voxels {
    size: [usize; 3],
    filled: Vec<bool>,
}

impl Voxels {
    fn of(model: Model, cube: f64) -> Voxels {
        let (low, high) = model.bounds();
        let size = [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / cube).ceil() as usize + 2);
        let mut filled = Vec::new();
        for i in 0..size[0] {
            for j in 0..size[1] {
                for k in 0..size[2] {
                    let cell = dvec3(i as f64, j as f64, k as f64) - 0.5;
                    filled.push(model.distance(low + cell * cube) < 0.0);
                }
            }
        }
        Voxels { size, filled }
    }

    fn at(&self, i: usize, j: usize, k: usize) -> bool {
        self.filled[(i * self.size[1] + j) * self.size[2] + k]
    }

    /// Euler characteristic of the union of the closed cubes: corners - edges + squares - cubes.
    fn euler(&self) -> i64 {
        let mut total = 0;
        for i in 1..self.size[0] {
            for j in 1..self.size[1] {
                for k in 1..self.size[2] {
                    // The corner between eight cubes, and what starts there in the positive directions.
                    let any = |di: usize, dj: usize, dk: usize| {
                        (0..=di).any(|a| {
                            (0..=dj).any(|b| (0..=dk).any(|c| self.at(i - a, j - b, k - c)))
                        })
                    };
                    let (corner, cube) = (any(1, 1, 1), any(0, 0, 0));
                    let edges = [any(0, 1, 1), any(1, 0, 1), any(1, 1, 0)];
                    let squares = [any(0, 0, 1), any(0, 1, 0), any(1, 0, 0)];
                    let count =
                        |cells: [bool; 3]| cells.iter().filter(|&&cell| cell).count() as i64;
                    total += i64::from(corner) - count(edges) + count(squares) - i64::from(cube);
                }
            }
        }
        total
    }

    /// Number of regions of filled (or empty) cubes that share faces.
    fn regions(&self, filled: bool) -> usize {
        let mut seen: Vec<bool> = self.filled.iter().map(|&cube| cube != filled).collect();
        let (along_j, along_i) = (self.size[2], self.size[1] * self.size[2]);
        let mut regions = 0;
        for start in 0..seen.len() {
            if seen[start] {
                continue;
            }
            regions += 1;
            seen[start] = true;
            let mut open = vec![start];
            while let Some(cube) = open.pop() {
                let [i, j, k] = [
                    cube / along_i,
                    cube / along_j % self.size[1],
                    cube % along_j,
                ];
                let neighbors = [
                    (i > 0, cube.wrapping_sub(along_i)),
                    (i + 1 < self.size[0], cube + along_i),
                    (j > 0, cube.wrapping_sub(along_j)),
                    (j + 1 < self.size[1], cube + along_j),
                    (k > 0, cube.wrapping_sub(1)),
                    (k + 1 < self.size[2], cube + 1),
                ];
                for (exists, next) in neighbors {
                    if exists && !seen[next] {
                        seen[next] = true;
                        open.push(next);
                    }
                }
            }
        }
        regions
    }
}

#[test]
fn every_solid_is_one_piece_with_the_handles_it_claims() {
    for model in Model::ALL {
        let voxels = Voxels::of(model, 0.117);
        assert_eq!(voxels.regions(true), 1, "{model:?} is in pieces");
        assert_eq!(voxels.regions(false), 1, "{model:?} has a hollow");
        // A solid with g handles has the Euler characteristic 1 - g.
        assert_eq!(voxels.euler(), 1 - i64::from(model.genus()), "{model:?}");
    }
}

#[test]
fn the_machined_part_has_the_volume_of_its_drawing() {
    use std::f64::consts::PI;
    let corners = 4.0 * 0.5;
    let openings = 4.0 * PI * 0.55f64.powi(2) + 2.0 * 0.5 * 2.4 + PI * 0.25 + PI;
    let plate = (14.0 * 8.0 - corners - openings) * 1.2;
    // Above the plate: a ring less its two chamfers (Pappus).
    let outer = 0.5 * 0.4 * 0.4 * 2.0 * PI * (1.9 - 0.4 / 3.0);
    let inner = 0.5 * 0.2 * 0.2 * 2.0 * PI * (1.0 + 0.2 / 3.0);
    let boss = PI * (1.9f64.powi(2) - 1.0) * 2.4 - outer - inner;
    let block = 5.2 * (2.6 * 2.1 - 1.5 * 1.0 - 0.5 * 0.6 * 0.6);
    let rib = 0.9 * (0.5 * 2.3 * 1.9 - PI * 0.36f64.powi(2));
    let drawing = plate + boss + block + rib;

    // One random point in each of two million cells.
    let (low, high) = Model::Part.bounds();
    let cell = (high - low) / dvec3(200.0, 50.0, 200.0);
    let mut rng = Rng::new(12);
    let mut inside = 0;
    for i in 0..200 * 50 * 200 {
        let index = [i / 10_000, i / 200 % 50, i % 200].map(f64::from);
        let offset = dvec3(rng.uniform(), rng.uniform(), rng.uniform());
        let p = low + (DVec3::from_array(index) + offset) * cell;
        inside += usize::from(Model::Part.distance(p) < 0.0);
    }
    let measured = inside as f64 * cell.x * cell.y * cell.z;
    assert!(
        (measured / drawing - 1.0).abs() < 2e-3,
        "{measured} is not {drawing}"
    );
}

/// Distance of each point to its eighth neighbour, sorted.
fn spacings(tree: &Octree) -> Vec<f32> {
    let mut found = Vec::new();
    let mut all: Vec<f32> = tree
        .points
        .iter()
        .map(|&p| {
            tree.knn(p, 9, &mut found);
            tree.points[found[8].index as usize].distance(p)
        })
        .collect();
    all.sort_by(f32::total_cmp);
    all
}

#[test]
fn the_density_is_uneven_but_no_large_part_of_the_surface_is_missing() {
    for model in Model::ALL {
        let scan = sample(model, 20_000, 6);
        let cloud = Cloud::from_f32(&scan.positions).unwrap();
        let tree = Octree::build(&cloud.points);
        let spacings = spacings(&tree);
        let (low, median, high) = (spacings[1_000], spacings[10_000], spacings[19_000]);
        let targets = surface_points(model, 4_000);
        let mut gaps: Vec<f32> = targets
            .iter()
            .map(|p| {
                let q = cloud.frame.to_unit(p.to_array());
                tree.points[tree.nearest(q).index as usize].distance(q)
            })
            .collect();
        gaps.sort_by(f32::total_cmp);
        println!(
            "{model:?}: 5 % {low:.4}, median {median:.4}, 95 % {high:.4}; gaps 99 % {:.4}, 99.9 % {:.4}, most {:.4}",
            gaps[3_960], gaps[3_996], gaps[3_999]
        );
        assert!(
            gaps[3_960] < 2.0 * median,
            "{model:?}: 99 % within {}",
            gaps[3_960]
        );
        assert!(
            gaps[3_999] < 0.03,
            "{model:?}: a hole of radius {}",
            gaps[3_999]
        );
    }
}
