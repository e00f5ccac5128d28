//! Extraction on functions whose zero set is known, and on some that have none worth the name.

use glam::{DVec3, Vec3};
use pointweave::base::params::{Boundary, MaxHole};
use pointweave::base::progress::Silent;
use pointweave::base::rng::Rng;
use pointweave::mesh::{ExtractParams, Extracted, Ground, Implicit, extract};
use pointweave::report::{Topology, area, topology, volume};
use pointweave::{Error, Stage};
use std::collections::HashSet;
use std::f64::consts::PI;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// A function, the region in which it counts as fitted, and its extension.
struct Analytic<V, C, G> {
    value: V,
    covered: C,
    global: G,
}

impl<V, C, G> Implicit for Analytic<V, C, G>
where
    V: Fn(DVec3) -> f64 + Sync,
    C: Fn(DVec3) -> bool + Sync,
    G: Fn(DVec3) -> f64 + Sync,
{
    type Scratch = ();

    fn scratch(&self) {}

    fn global(&self, at: DVec3, (): &mut ()) -> f64 {
        (self.global)(at)
    }

    fn locals(&self, at: &[DVec3], values: &mut [f64], (): &mut ()) {
        for (&x, value) in at.iter().zip(values) {
            *value = if (self.covered)(x) {
                (self.value)(x)
            } else {
                f64::NAN
            };
        }
    }

    fn gradients(&self, at: &[DVec3], found: &mut [Option<(f64, DVec3)>], (): &mut ()) {
        for (&x, found) in at.iter().zip(found) {
            *found = (self.covered)(x).then(|| ((self.value)(x), gradient(&self.value, x)));
        }
    }
}

/// A function whose points were all seen from far above.
struct SeenFromAbove<F>(F);

impl<F: Implicit> Implicit for SeenFromAbove<F> {
    type Scratch = F::Scratch;

    fn scratch(&self) -> F::Scratch {
        self.0.scratch()
    }

    fn global(&self, at: DVec3, scratch: &mut F::Scratch) -> f64 {
        self.0.global(at, scratch)
    }

    fn locals(&self, at: &[DVec3], values: &mut [f64], scratch: &mut F::Scratch) {
        self.0.locals(at, values, scratch);
    }

    fn gradients(
        &self,
        at: &[DVec3],
        found: &mut [Option<(f64, DVec3)>],
        scratch: &mut F::Scratch,
    ) {
        self.0.gradients(at, found, scratch);
    }

    fn sensor(&self, _: usize) -> Vec3 {
        Vec3::Z
    }
}

fn gradient(value: &impl Fn(DVec3) -> f64, at: DVec3) -> DVec3 {
    let e = 1e-6;
    let slope = |d: DVec3| (value(at + e * d) - value(at - e * d)) / (2.0 * e);
    DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z))
}

fn random(rng: &mut Rng) -> DVec3 {
    DVec3::new(rng.uniform(), rng.uniform(), rng.uniform()) - 0.5
}

/// About `n` points of the zero set within the cube [-0.5, 0.5]³: random ones led there by Newton steps.
fn sample(value: &impl Fn(DVec3) -> f64, n: usize) -> Vec<Vec3> {
    let mut rng = Rng::new(7);
    let project = |_| {
        let mut x = random(&mut rng);
        for _ in 0..6 {
            let g = gradient(value, x);
            x -= g * (value(x) / g.length_squared().max(1e-9));
        }
        x
    };
    let points = (0..n)
        .map(project)
        .filter(|&x| value(x).abs() < 1e-5 && x.abs().max_element() < 0.5);
    points.map(|x| x.as_vec3()).collect()
}

const GROUND: Ground = Ground {
    normal: DVec3::Z,
    height: None,
};
const SMOOTH: ExtractParams = ExtractParams {
    resolution: 0.01,
    boundary: Boundary::Auto,
    ground: GROUND,
    max_hole: MaxHole::Auto,
    sharp: false,
    most: None,
    fairing: false,
};
const SHARP: ExtractParams = ExtractParams {
    sharp: true,
    ..SMOOTH
};

struct Run {
    out: Extracted,
    topology: Topology,
}

/// Extracts, and checks what holds for every field.
fn check(field: &impl Implicit, points: &[Vec3], params: ExtractParams) -> Run {
    let out = extract(
        field,
        points,
        &vec![0.05; points.len()],
        &params,
        &mut Silent,
    )
    .expect("not cancelled");
    let mesh = &out.mesh;
    let topology = topology(&mesh.triangles, mesh.vertices.len());
    assert!(topology.is_manifold(), "{topology:?}");
    let mut used = vec![false; mesh.vertices.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| mesh.vertices[v as usize].as_dvec3());
        assert!(
            (b - a).cross(c - a).length() > 0.0,
            "degenerate: {a} {b} {c}"
        );
        triangle.iter().for_each(|&v| used[v as usize] = true);
    }
    assert!(used.iter().all(|&u| u), "unused vertex");
    assert_eq!(mesh.normals.len(), mesh.vertices.len());
    assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4));
    if params.boundary == Boundary::Closed {
        assert_eq!(topology.boundary_edges, 0);
    }
    Run { out, topology }
}

/// A function that is fitted everywhere.
fn check_everywhere(value: impl Fn(DVec3) -> f64 + Sync, params: ExtractParams) -> Run {
    let points = sample(&value, 8000);
    check(
        &Analytic {
            value: &value,
            covered: |_| true,
            global: &value,
        },
        &points,
        params,
    )
}

impl Run {
    fn volume(&self) -> f64 {
        volume(&self.out.mesh.vertices, &self.out.mesh.triangles)
    }

    fn area(&self) -> f64 {
        area(&self.out.mesh.vertices, &self.out.mesh.triangles)
    }

    /// The length of all boundary edges.
    fn rim_length(&self) -> f64 {
        let mesh = &self.out.mesh;
        let edges = |t: &[u32; 3]| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
        let all: HashSet<(u32, u32)> = mesh.triangles.iter().flat_map(edges).collect();
        let length = |&(a, b): &(u32, u32)| {
            mesh.vertices[a as usize].distance(mesh.vertices[b as usize]) as f64
        };
        all.iter()
            .filter(|&&(a, b)| !all.contains(&(b, a)))
            .map(length)
            .sum()
    }

    /// The largest of `distance` over vertices, and over the triangles' centres.
    fn errors(&self, distance: impl Fn(DVec3) -> f64) -> (f64, f64) {
        let mesh = &self.out.mesh;
        let at = |v: u32| mesh.vertices[v as usize].as_dvec3();
        let centres = mesh
            .triangles
            .iter()
            .map(|t| t.iter().map(|&v| at(v)).sum::<DVec3>() / 3.0);
        let vertices = (0..mesh.vertices.len() as u32).map(at);
        let largest = |points: &mut dyn Iterator<Item = DVec3>| {
            points.map(|p| distance(p).abs()).fold(0.0, f64::max)
        };
        (
            largest(&mut vertices.into_iter()),
            largest(&mut centres.into_iter()),
        )
    }
}

fn sphere(x: DVec3) -> f64 {
    x.length() - 0.3
}

fn torus(x: DVec3) -> f64 {
    DVec3::new(DVec3::new(x.x, x.y, 0.0).length() - 0.3, x.z, 0.0).length() - 0.1
}

/// Turned so that its faces, edges and corners lie across the lattice.
fn cube(x: DVec3) -> f64 {
    let (u, v) = (
        DVec3::new(2.0, 1.0, 0.5).normalize(),
        DVec3::new(-1.0, 2.0, 0.0).normalize(),
    );
    let q = DVec3::new(u.dot(x), v.dot(x), u.cross(v).dot(x)).abs() - 0.2;
    q.max(DVec3::ZERO).length() + q.max_element().min(0.0)
}

#[test]
fn sphere_is_exact_to_second_order() {
    let r = check_everywhere(sphere, SMOOTH);
    assert_eq!(
        (
            r.topology.components,
            r.topology.boundary_edges,
            &r.topology.genus[..]
        ),
        (1, 0, &[0][..])
    );
    let (at_vertices, at_centres) = r.errors(sphere);
    // A chord of length h leaves the sphere by h²/8r; cells have diagonals of √3 h.
    assert!(
        at_vertices < 2e-5 && at_centres < 3.0 * 1e-4 / (8.0 * 0.3),
        "{at_vertices} {at_centres}"
    );
    assert!((r.volume() / (4.0 / 3.0 * PI * 0.027) - 1.0).abs() < 1e-3);
    assert!((r.area() / (4.0 * PI * 0.09) - 1.0).abs() < 1e-3);
    for (vertex, normal) in r.out.mesh.vertices.iter().zip(&r.out.mesh.normals) {
        assert!(vertex.normalize().dot(*normal) > 0.999);
    }
    for t in &r.out.mesh.triangles {
        let [a, b, c] = t.map(|v| r.out.mesh.vertices[v as usize]);
        assert!((b - a).cross(c - a).dot(a) > 0.0, "flipped");
    }
    assert_eq!((r.out.filled, r.out.closed, r.out.open), (0.0, 0, 0));
    // The option to keep creases finds none.
    assert_eq!(check_everywhere(sphere, SHARP).out, r.out);
}

#[test]
fn torus_has_its_hole() {
    let r = check_everywhere(torus, SMOOTH);
    assert_eq!(
        (
            r.topology.components,
            r.topology.boundary_edges,
            &r.topology.genus[..]
        ),
        (1, 0, &[1][..])
    );
    assert!((r.volume() / (2.0 * PI * PI * 0.3 * 0.01) - 1.0).abs() < 2e-3);
    assert!((r.area() / (4.0 * PI * PI * 0.03) - 1.0).abs() < 2e-3);
    assert!(r.errors(torus).0 < 1e-4);
}

#[test]
fn sharp_keeps_the_edges_and_corners_of_a_cube() {
    let r = check_everywhere(cube, SHARP);
    assert_eq!(
        (
            r.topology.components,
            r.topology.boundary_edges,
            &r.topology.genus[..]
        ),
        (1, 0, &[0][..])
    );
    // Where an edge passes just beside the cell whose loop sees both faces, its vertex stays in the cell.
    let (at_vertices, _) = r.errors(cube);
    assert!(at_vertices < 0.15 * SHARP.resolution, "{at_vertices}");
    let off = |v: &&Vec3| cube(v.as_dvec3()).abs() > 1e-5;
    let share =
        r.out.mesh.vertices.iter().filter(off).count() as f64 / r.out.mesh.vertices.len() as f64;
    assert!(share < 2e-3, "{share}");
    assert!((r.volume() / 0.064 - 1.0).abs() < 1e-4, "{}", r.volume());
    assert!((r.area() / 0.96 - 1.0).abs() < 5e-4, "{}", r.area());
    let corner = r
        .out
        .mesh
        .vertices
        .iter()
        .map(|v| v.length())
        .fold(0.0, f32::max);
    assert!((corner as f64 - 0.2 * 3f64.sqrt()).abs() < 1e-4, "{corner}");
    // Nor does a coarse lattice throw a corner off.
    let coarse = check_everywhere(
        cube,
        ExtractParams {
            resolution: 0.02,
            ..SHARP
        },
    );
    let (at_vertices, _) = coarse.errors(cube);
    assert!(at_vertices < 0.25 * 0.02, "{at_vertices}");
    // Without it they are cut off by less than a cell.
    let smooth = check_everywhere(cube, SMOOTH);
    let loss = smooth.volume() / 0.064 - 1.0;
    assert!(loss < -1e-4 && loss > -1e-2, "{loss}");
}

#[test]
fn two_spheres_near_each_other_stay_two() {
    let at = |x: DVec3| {
        (x - DVec3::X * 0.2)
            .length()
            .min((x + DVec3::X * 0.2).length())
            - 0.19
    };
    let r = check_everywhere(at, SMOOTH);
    assert_eq!(
        (
            r.topology.components,
            r.topology.boundary_edges,
            &r.topology.genus[..]
        ),
        (2, 0, &[0, 0][..])
    );
    assert!((r.volume() / (8.0 / 3.0 * PI * 0.19f64.powi(3)) - 1.0).abs() < 2e-3);
}

#[test]
fn touching_spheres_are_manifold() {
    let at = |x: DVec3| {
        (x - DVec3::X * 0.2)
            .length()
            .min((x + DVec3::X * 0.2).length())
            - 0.2
    };
    check_everywhere(at, SMOOTH);
}

/// Plates of 2 to 0.5 cells: whole where a lattice vertex is always inside, in pieces below that, and manifold anyhow.
#[test]
fn thin_plates() {
    let normal = DVec3::new(1.0, 0.7, 0.4).normalize();
    for cells in [2.0, 1.0, 0.5] {
        let thickness = cells * SMOOTH.resolution;
        let plate = |x: DVec3| {
            let across = normal.dot(x);
            let along = (x - across * normal).length() - 0.3;
            (across.abs() - thickness / 2.0).max(along)
        };
        for boundary in [Boundary::Auto, Boundary::Closed] {
            let r = check_everywhere(plate, ExtractParams { boundary, ..SHARP });
            assert_eq!(r.topology.boundary_edges, 0);
            let exact = PI * 0.09 * thickness;
            let whole = (r.volume() / exact - 1.0).abs() < 0.05;
            assert!(whole || cells < 1.0, "{cells}: {} of {exact}", r.volume());
        }
    }
}

#[test]
fn gyroid_has_its_tunnels() {
    let k = 14.0;
    let gyroid = |x: DVec3| {
        let p = x * k;
        let s = libm::sin(p.x) * libm::cos(p.y)
            + libm::sin(p.y) * libm::cos(p.z)
            + libm::sin(p.z) * libm::cos(p.x);
        (s / k).max(x.length() - 0.4)
    };
    let r = check_everywhere(gyroid, SHARP);
    assert_eq!(r.topology.boundary_edges, 0);
    assert!(r.topology.genus[0] >= 10, "{:?}", r.topology.genus);
    let coarse = check_everywhere(
        gyroid,
        ExtractParams {
            resolution: 0.0125,
            ..SHARP
        },
    );
    assert_eq!(r.topology.genus[0], coarse.topology.genus[0]);
}

/// Of a torus and a cube as many triangles are left as are asked for, where they matter, and vertices as exact as before.
#[test]
fn triangles_as_many_as_asked_for() {
    for (params, value) in [(SMOOTH, torus as fn(DVec3) -> f64), (SHARP, cube)] {
        let all = check_everywhere(value, params);
        let count = all.out.mesh.triangles.len();
        for share in [2, 4] {
            let most = Some(count / share);
            let few = check_everywhere(value, ExtractParams { most, ..params });
            let left = few.out.mesh.triangles.len();
            assert!(
                left <= count / share && left + 2 > count / share,
                "{left} of {count}"
            );
            assert_eq!(few.topology, all.topology);
            assert!(few.errors(value).0 <= all.errors(value).0);
            assert!((few.volume() / all.volume() - 1.0).abs() < 2e-3);
            let kept = |v: &Vec3| all.out.mesh.vertices.contains(v);
            assert!(few.out.mesh.vertices.iter().step_by(50).all(kept));
        }
        // Fewer than there can be: what is left is still the same surface, and manifold.
        let least = check_everywhere(
            value,
            ExtractParams {
                most: Some(0),
                ..params
            },
        );
        assert_eq!(least.topology, all.topology);
    }
}

/// White noise at the lattice's own scale: every ambiguous configuration, many at once.
#[test]
fn noise_is_manifold() {
    // Browsers do the same arithmetic: one seed of it there.
    let seeds = if cfg!(target_arch = "wasm32") { 1 } else { 3 };
    for seed in 0..seeds {
        let h = 1.0 / 60.0;
        let noise = |x: DVec3| {
            let p = (x / h).round().as_ivec3() + 1000;
            let mut rng = Rng::new(seed + ((p.x as u64) << 40 | (p.y as u64) << 20 | p.z as u64));
            rng.next_u64();
            h * (rng.uniform() - 0.5)
        };
        let mut rng = Rng::new(seed);
        let points: Vec<Vec3> = (0..2000)
            .map(|_| (0.4 * random(&mut rng)).as_vec3())
            .collect();
        // Patches of it only: boundaries and bow ties.
        let patches =
            |x: DVec3| libm::sin(40.0 * x.x) + libm::sin(50.0 * x.y) + libm::sin(60.0 * x.z) > -0.3;
        for boundary in [Boundary::Open, Boundary::Auto, Boundary::Closed] {
            for (sharp, most) in [(false, None), (true, None), (true, Some(1000))] {
                let params = ExtractParams {
                    resolution: h,
                    boundary,
                    ground: GROUND,
                    max_hole: MaxHole::Auto,
                    sharp,
                    most,
                    fairing: false,
                };
                let all = check(
                    &Analytic {
                        value: noise,
                        covered: |_| true,
                        global: noise,
                    },
                    &points,
                    params,
                );
                assert!(most.is_some() || all.out.mesh.triangles.len() > 10_000);
                let some = check(
                    &Analytic {
                        value: noise,
                        covered: patches,
                        global: noise,
                    },
                    &points,
                    params,
                );
                assert!(most.is_some() || some.out.mesh.triangles.len() > 1_000);
            }
        }
    }
}

/// A ball of which only the part above `z` was measured.
fn cut_ball(z: f64, boundary: Boundary) -> Run {
    let points: Vec<Vec3> = sample(&sphere, 8000)
        .into_iter()
        .filter(|p| p.z as f64 > z)
        .collect();
    // The zero set of the winding number of such a cap closes it with a flat disk.
    let covered = move |x: DVec3| x.z > z - 0.02 && sphere(x).abs() < 0.05;
    let closed = move |x: DVec3| sphere(x).max(z - 0.02 - x.z);
    check(
        &Analytic {
            value: sphere,
            covered,
            global: closed,
        },
        &points,
        ExtractParams { boundary, ..SMOOTH },
    )
}

#[test]
fn an_open_surface_ends_where_the_points_end() {
    let r = cut_ball(0.0, Boundary::Open);
    assert_eq!(
        (r.topology.components, &r.topology.genus[..]),
        (1, &[0][..])
    );
    assert!(r.topology.boundary_edges > 0);
    assert!(r.out.mesh.vertices.iter().all(|v| v.z > -0.03) && r.out.filled == 0.0);
    // One rim, about as long as the circle: steps along the lattice would make it a quarter longer.
    let rim = r.rim_length() / (2.0 * PI * 0.3);
    assert!((0.97..1.05).contains(&rim), "{rim}");
    assert!((r.area() / (2.0 * PI * 0.09) - 1.0).abs() < 0.1);
}

/// Functions that reach too far do not carry the surface along.
#[test]
fn an_open_surface_is_trimmed_near_its_points() {
    let points: Vec<Vec3> = sample(&sphere, 8000)
        .into_iter()
        .filter(|p| p.z > 0.0)
        .collect();
    let covered = |x: DVec3| x.z > -0.15 && sphere(x).abs() < 0.05;
    let field = Analytic {
        value: sphere,
        covered,
        global: sphere,
    };
    let r = check(
        &field,
        &points,
        ExtractParams {
            boundary: Boundary::Open,
            ..SMOOTH
        },
    );
    let lowest = r.out.mesh.vertices.iter().map(|v| v.z).fold(0.0, f32::min);
    // 0.6 of the reach of 0.05 beyond the points, and a cell.
    assert!(lowest < -0.02 && lowest > -0.03 - 0.015, "{lowest}");
    assert_eq!(
        (r.topology.components, &r.topology.genus[..]),
        (1, &[0][..])
    );
}

/// A blob that fewer stray points lie near than a sub-domain has is no component; with a few more it is one.
#[test]
fn phantoms_are_dropped() {
    let blob = DVec3::new(0.4, 0.0, 0.0);
    let value = |x: DVec3| sphere(x).min((x - blob).length() - 0.03);
    let field = Analytic {
        value,
        covered: |_| true,
        global: value,
    };
    let mut points = sample(&sphere, 8000);
    for (count, components) in [(12, 1), (12, 2)] {
        points
            .extend((0..count).map(|i| (blob + DVec3::new(0.0, 0.03, 0.001 * i as f64)).as_vec3()));
        assert_eq!(
            check(&field, &points, SMOOTH).topology.components,
            components
        );
    }
}

#[test]
fn a_closed_surface_has_no_boundary() {
    let r = cut_ball(0.0, Boundary::Closed);
    assert_eq!(
        (
            r.topology.components,
            r.topology.boundary_edges,
            r.out.closed,
            r.out.open
        ),
        (1, 0, 1, 0)
    );
    assert!((r.out.filled - 1.0 / 3.0).abs() < 0.03, "{}", r.out.filled);
    assert!((r.volume() / (2.0 / 3.0 * PI * 0.027) - 1.0).abs() < 0.15);
}

#[test]
fn auto_closes_small_holes_and_leaves_large_ones() {
    let small = cut_ball(-0.285, Boundary::Auto);
    assert_eq!(
        (
            small.topology.boundary_edges,
            small.out.closed,
            small.out.open
        ),
        (0, 1, 0)
    );
    assert!(
        small.out.filled > 0.002 && small.out.filled < 0.1,
        "{}",
        small.out.filled
    );
    let [hole] = small.out.holes[..] else {
        panic!("{:?}", small.out.holes)
    };
    let wide = 2.0 * (0.3f64 * 0.3 - 0.285 * 0.285).sqrt();
    assert!(
        hole.closed && (hole.diameter / wide - 1.0).abs() < 0.15,
        "{hole:?}"
    );
    // What a hole takes away of the ball does not count, only how wide it is.
    for z in [-0.2, 0.15] {
        let large = cut_ball(z, Boundary::Auto);
        assert_eq!(
            (large.out.closed, large.out.open, large.out.filled),
            (0, 1, 0.0)
        );
        assert_eq!(large.out.mesh, cut_ball(z, Boundary::Open).out.mesh);
        let [rim] = large.out.holes[..] else {
            panic!("{:?}", large.out.holes)
        };
        let wide = 2.0 * (0.09 - z * z).sqrt();
        assert!(
            !rim.closed && (rim.diameter / wide - 1.0).abs() < 0.15,
            "{rim:?}"
        );
    }
}

#[test]
fn a_closed_surface_is_the_open_one_and_caps() {
    for z in [-0.2, 0.0, 0.15] {
        let [open, closed] =
            [Boundary::Open, Boundary::Closed].map(|boundary| cut_ball(z, boundary).out.mesh);
        let (vertices, triangles) = (open.vertices.len(), open.triangles.len());
        assert_eq!(closed.vertices[..vertices], open.vertices);
        assert_eq!(closed.normals[..vertices], open.normals);
        assert_eq!(closed.triangles[..triangles], open.triangles);
        // The rim is flat but for its steps, and so is the lid.
        let lid = &closed.vertices[vertices..];
        assert!(
            !lid.is_empty() && lid.len() < vertices / 10,
            "{}",
            lid.len()
        );
        let heights = || lid.iter().map(|v| f64::from(v.z));
        let (lo, hi) = (
            heights().fold(1.0, f64::min),
            heights().fold(-1.0, f64::max),
        );
        assert!(hi - lo < 0.02 && (lo - z + 0.02).abs() < 0.025, "{lo} {hi}");
    }
}

/// `Auto` decides for each component: of a whole ball and a bowl only the bowl stays open.
#[test]
fn auto_decides_for_each_component() {
    let (left, right) = (DVec3::X * 0.25, DVec3::X * -0.25);
    let balls = move |x: DVec3| (x - left).length().min((x - right).length()) - 0.2;
    let covered = move |x: DVec3| balls(x).abs() < 0.05 && (x.x > 0.0 || x.z > 0.05);
    let closed = move |x: DVec3| {
        if x.x > 0.0 {
            balls(x)
        } else {
            balls(x).max(0.05 - x.z)
        }
    };
    let points: Vec<Vec3> = sample(&balls, 8000)
        .into_iter()
        .filter(|p| p.x > 0.0 || p.z > 0.05)
        .collect();
    let r = check(
        &Analytic {
            value: balls,
            covered,
            global: closed,
        },
        &points,
        SMOOTH,
    );
    assert_eq!((r.topology.components, r.out.open), (2, 1));
    assert!(r.topology.boundary_edges > 0);
    let whole = 4.0 * PI * 0.04;
    assert!(r.area() > whole + 0.3 * whole && r.area() < whole + 0.5 * whole);
}

/// Caps know rims only, whatever the field says beyond them: the lid of a flat sheet lies on it.
#[test]
fn a_flat_sheet_closes_to_both_of_its_sides() {
    let value = |x: DVec3| x.z;
    let points: Vec<Vec3> = (0..400)
        .map(|i| Vec3::new((i % 20) as f32 * 0.01, (i / 20) as f32 * 0.01, 0.0))
        .collect();
    let covered = |x: DVec3| x.x.abs() < 0.25 && x.y.abs() < 0.25 && x.z.abs() < 0.03;
    let field = Analytic {
        value,
        covered,
        global: |_| -1.0,
    };
    let with = |boundary| check(&field, &points, ExtractParams { boundary, ..SMOOTH });
    let [open, closed] = [Boundary::Open, Boundary::Closed].map(with);
    assert!(open.topology.boundary_edges > 0);
    assert_eq!(closed.topology.boundary_edges, 0);
    assert!((closed.area() / open.area() - 2.0).abs() < 0.02);
    assert!(closed.volume().abs() < 1e-5);
}

#[test]
fn points_off_the_surface_and_their_order_do_not_matter() {
    let points = sample(&sphere, 8000);
    let field = Analytic {
        value: sphere,
        covered: |_| true,
        global: sphere,
    };
    let whole = check(&field, &points, SMOOTH);
    let reversed: Vec<Vec3> = points.iter().rev().copied().collect();
    assert_eq!(check(&field, &reversed, SMOOTH).out, whole.out);
    // One point in a hundred, off by a cell: the walk along the surface finds the rest.
    let mut rng = Rng::new(3);
    let off = |&p: &Vec3| p + (0.01 * random(&mut rng)).as_vec3();
    let few: Vec<Vec3> = points.iter().step_by(100).map(off).collect();
    let sparse = check(&field, &few, SMOOTH);
    assert_eq!(sparse.topology, whole.topology);
    assert!((sparse.area() / whole.area() - 1.0).abs() < 1e-4);
}

#[test]
fn no_points_and_no_surface_make_an_empty_mesh() {
    let field = Analytic {
        value: |_| 1.0,
        covered: |_| true,
        global: |_| 1.0,
    };
    assert_eq!(check(&field, &[], SMOOTH).out, Extracted::default());
    assert_eq!(
        check(&field, &[Vec3::ZERO], SMOOTH).out,
        Extracted::default()
    );
    let blind = Analytic {
        value: |_| f64::NAN,
        covered: |_| true,
        global: |_| 1.0,
    };
    assert_eq!(
        check(&blind, &[Vec3::ZERO], SMOOTH).out,
        Extracted::default()
    );
}

#[test]
fn progress_rises_to_one_and_can_cancel() {
    let points = sample(&sphere, 8000);
    let field = Analytic {
        value: sphere,
        covered: |_| true,
        global: sphere,
    };
    let reach = vec![0.05; points.len()];
    let mut heard = vec![0.0];
    let mut listen = |stage: Stage, fraction: f32| {
        assert!(stage == Stage::Extract && fraction >= heard[heard.len() - 1] && fraction <= 1.0);
        heard.push(fraction);
        true
    };
    assert!(extract(&field, &points, &reach, &SMOOTH, &mut listen).is_ok());
    assert!(
        heard.len() > 5 && heard[heard.len() - 1] == 1.0,
        "{heard:?}"
    );
    for stop_at in 1..heard.len() {
        let mut calls = 0;
        let mut stop = |_: Stage, _: f32| {
            calls += 1;
            calls < stop_at
        };
        assert_eq!(
            extract(&field, &points, &reach, &SMOOTH, &mut stop),
            Err(Error::Cancelled)
        );
    }
}

#[test]
fn a_second_layer_is_dropped_and_a_piece_farther_off_stays() {
    // A ball and a small open sheet over it, whose points reach 0.05.
    for (radius, components) in [(0.338, 1), (0.4, 2)] {
        let is_sheet = |x: DVec3| (x.length() - radius).abs() < 0.0185 && x.z > 0.95 * x.length();
        let value = |x: DVec3| x.length() - if is_sheet(x) { radius } else { 0.3 };
        let mut points = sample(&|x: DVec3| x.length() - 0.3, 4000);
        let sheet: Vec<Vec3> = points
            .iter()
            .map(|&p| p * (radius / 0.3) as f32)
            .filter(|p| is_sheet(p.as_dvec3()))
            .collect();
        assert!(sheet.len() > 60, "{}", sheet.len());
        points.extend(sheet);
        let field = Analytic {
            value,
            covered: |x: DVec3| is_sheet(x) || (x.length() - 0.3).abs() < 0.0185,
            global: value,
        };
        let params = ExtractParams {
            boundary: Boundary::Open,
            ..SMOOTH
        };
        let found = check(&field, &points, params).topology;
        assert_eq!(found.components, components, "at {radius}");
        assert_eq!(found.boundary_edges == 0, components == 1);
    }
}

#[test]
fn a_rim_that_shows_the_sensor_its_back_is_trimmed() {
    let ball = |x: DVec3| x.length() - 0.3;
    let down_to = |lowest: f64| {
        let covered = move |x: DVec3| x.z > lowest;
        let mut points = sample(&ball, 8000);
        points.retain(|p| covered(p.as_dvec3()));
        let field = || Analytic {
            value: ball,
            covered,
            global: ball,
        };
        let params = ExtractParams {
            boundary: Boundary::Open,
            ..SMOOTH
        };
        let lowest = |run: Run| {
            let vertices = run.out.mesh.vertices.iter();
            vertices.map(|v| v.z).fold(f32::INFINITY, f32::min)
        };
        [
            lowest(check(&field(), &points, params)),
            lowest(check(&SeenFromAbove(field()), &points, params)),
        ]
    };
    let [before, after] = down_to(-0.05);
    assert!(before < -0.03 && after > -0.015, "{before} {after}");
    // What has no end is left alone.
    let [before, after] = down_to(-1.0);
    assert_eq!(before, after);
}
