//! Scenes to be in or to look down at: terrain, towns, rooms, streets, depth frames.

use super::shapes::{boxed, gauss, noisy, range, rectangle, seen};
use super::{Row, Scene, Sure};
use glam::DVec3;
use pointweave::base::rng::Rng;
use std::sync::Arc;

pub const RECIPES: &[Row] = &[
    ("terrain", "hills", |r| terrain(r, 0.5, Sure::Guess)),
    ("terrain", "steep hills", |r| terrain(r, 1.0, Sure::Guess)),
    ("terrain", "hills from above", |r| {
        terrain(r, 0.8, Sure::Told).seen_from_above()
    }),
    ("terrain", "hills with up", |r| {
        terrain(r, 0.8, Sure::Told).with_up(DVec3::Z)
    }),
    ("terrain", "hills with normals", |r| {
        let scene = terrain(r, 0.8, Sure::Told);
        let normals = vec![DVec3::Z; scene.points.len()];
        scene.with_normals(normals)
    }),
    ("terrain", "hills seen from below, with normals", |r| {
        let mut scene = terrain(r, 0.8, Sure::Told);
        let normals = vec![-DVec3::Z; scene.points.len()];
        scene.truth = Arc::new(|_, n| Some(n.z < 0.0));
        scene.with_normals(normals)
    }),
    ("terrain", "hills over the origin", |r| {
        let mut scene = terrain(r, 0.5, Sure::Guess);
        let lift = range(r, 60.0, 150.0) * if r.uniform() < 0.5 { 1.0 } else { -1.0 };
        scene
            .points
            .iter_mut()
            .for_each(|p| *p += DVec3::new(-25.0, -25.0, lift));
        scene
    }),
    ("town", "town", |r| town(r, Sure::Told)),
    ("town", "town from above", |r| {
        town(r, Sure::Told).seen_from_above()
    }),
    ("town", "town with up", |r| {
        town(r, Sure::Told).with_up(DVec3::Z)
    }),
    ("town", "roofs from above", |r| roofs(r).seen_from_above()),
    ("room with a pose", "closed room", |r| room(r, &[], true)),
    ("room with a pose", "room without a ceiling", |r| {
        room(r, &[5], true)
    }),
    ("room with a pose", "room without a wall", |r| {
        room(r, &[1], true)
    }),
    ("room with a pose", "furnished room", |r| {
        let scene = room(r, &[], true);
        furnished(r, scene)
    }),
    ("room with a pose", "closed room with normals", |r| {
        let scene = room(r, &[], false);
        let normals = scene.points.iter().map(|&p| inward(p)).collect();
        Scene {
            sure: Sure::Told,
            truth: Arc::new(looks_in),
            ..scene.with_normals(normals)
        }
    }),
    ("room without a pose", "closed room", |r| {
        room(r, &[], false)
    }),
    ("room without a pose", "room without a ceiling", |r| {
        room(r, &[5], false)
    }),
    ("room without a pose", "corner", |r| {
        let points = boxed(r, 3000, DVec3::ZERO, DVec3::ONE, &[1, 3, 5]);
        let lift = |_: DVec3, n: DVec3| Some(n.dot(DVec3::ONE) > 0.0);
        Scene::new(Sure::Guess, noisy(r, 0.003, points), lift)
    }),
    ("several setups", "two rooms", two_rooms),
    ("several setups", "street", street),
    ("several setups", "thin wall from both sides", thin_wall),
    ("several setups", "block from four corners", block),
    ("depth frame", "wall and balls", |r| frame(r, 9.0, 1.0)),
    ("depth frame", "wall and balls, backwards", |r| {
        frame(r, 9.0, -1.0)
    }),
    ("depth frame", "floor and balls", |r| frame(r, 0.6, 1.0)),
    ("depth frame", "floor and balls, backwards", |r| {
        frame(r, 0.6, -1.0)
    }),
    ("depth frame", "floor and balls with a viewpoint", |r| {
        frame(r, 0.6, -1.0).seen_from(DVec3::ZERO)
    }),
];

fn up(_: DVec3, n: DVec3) -> Option<bool> {
    Some(n.z > 0.0)
}

fn terrain(r: &mut Rng, steep: f64, sure: Sure) -> Scene {
    let a: Vec<f64> = (0..6).map(|_| 2.0 * r.uniform()).collect();
    let height = |x: f64, y: f64| {
        let wave = (x / (12.0 + 10.0 * a[1]) + a[2]).sin() * (y / (10.0 + 9.0 * a[3]) + a[4]).cos();
        8.0 * steep * a[0] * wave + 0.05 * a[5] * x
    };
    let mut points = Vec::new();
    for j in 0..55 {
        for i in 0..55 {
            let (x, y) = (
                f64::from(i) + 0.2 * r.normal(),
                f64::from(j) + 0.2 * r.normal(),
            );
            points.push(DVec3::new(x, y, height(x, y) + 0.05 * r.normal()));
        }
    }
    Scene::new(sure, points, up)
}

/// Boxes of a town: corners and height.
fn blocks(r: &mut Rng) -> Vec<[f64; 5]> {
    let block = |k: usize, r: &mut Rng| {
        let x = (k % 2) as f64 * 30.0 + range(r, 4.0, 10.0);
        let y = (k / 2) as f64 * 30.0 + range(r, 4.0, 10.0);
        let (w, d) = (range(r, 9.0, 16.0), range(r, 9.0, 16.0));
        [x, y, x + w, y + d, range(r, 5.0, 14.0)]
    };
    (0..4).map(|k| block(k, r)).collect()
}

/// Ground and roofs, walls perhaps.
fn town_points(r: &mut Rng, n: usize, walls: f64) -> Vec<DVec3> {
    let blocks = blocks(r);
    let mut points = Vec::new();
    for _ in 0..n {
        let (x, y) = (range(r, -6.0, 66.0), range(r, -6.0, 66.0));
        let block = blocks
            .iter()
            .find(|b| x > b[0] && x < b[2] && y > b[1] && y < b[3]);
        points.push(DVec3::new(x, y, block.map_or(0.0, |b| b[4])));
    }
    for b in &blocks {
        let (lo, hi) = (DVec3::new(b[0], b[1], 0.0), DVec3::new(b[2], b[3], b[4]));
        let area = 2.0 * b[4] * (b[2] - b[0] + b[3] - b[1]);
        let count = walls * area * n as f64 / 72.0 / 72.0;
        points.extend(boxed(r, count as usize, lo, hi, &[4, 5]));
    }
    noisy(r, 0.05, points)
}

fn lying(_: DVec3, n: DVec3) -> Option<bool> {
    (n.z.abs() > 0.5).then_some(n.z > 0.0)
}

fn town(r: &mut Rng, sure: Sure) -> Scene {
    Scene::new(sure, town_points(r, 3200, 0.8), lying)
}

fn roofs(r: &mut Rng) -> Scene {
    Scene::new(Sure::Told, town_points(r, 3200, 0.0), lying)
}

const ROOM: DVec3 = DVec3::new(5.0, 4.0, 2.8);

/// From a wall, floor or ceiling into the room.
fn inward(p: DVec3) -> DVec3 {
    let (low, high) = (p, ROOM - p);
    let mut best = (f64::INFINITY, DVec3::ZERO);
    for a in 0..3 {
        for (distance, sign) in [(low[a], 1.0), (high[a], -1.0)] {
            if distance.abs() < best.0 {
                let mut n = DVec3::ZERO;
                n[a] = sign;
                best = (distance.abs(), n);
            }
        }
    }
    best.1
}

fn looks_in(p: DVec3, n: DVec3) -> Option<bool> {
    Some(n.dot(inward(p)) > 0.0)
}

/// A room; from its points alone it is a body that looks out.
fn room(r: &mut Rng, without: &[usize], has_pose: bool) -> Scene {
    let points = boxed(r, 3600, DVec3::ZERO, ROOM, without);
    let points = noisy(r, 0.008, points);
    if has_pose {
        let eye = ROOM * DVec3::new(range(r, 0.3, 0.7), range(r, 0.3, 0.7), 0.5);
        Scene::new(Sure::Told, points, looks_in).seen_from(eye)
    } else {
        let looks_out = |p, n| looks_in(p, n).map(|is_in| !is_in);
        Scene::new(Sure::Told, points, looks_out)
    }
}

/// With boxes that stand on the floor.
fn furnished(r: &mut Rng, mut scene: Scene) -> Scene {
    let lo = DVec3::new(range(r, 0.4, 0.9), range(r, 0.4, 0.8), 0.0);
    let hi = lo + DVec3::new(1.2, 0.8, 0.8);
    let covered = move |p: &DVec3| {
        p.z < 0.05
            && p.cmpgt(lo - 1.0).all()
            && p.x > lo.x
            && p.x < hi.x
            && p.y > lo.y
            && p.y < hi.y
    };
    scene.points.retain(|p| !covered(p));
    // The faces that the eye, above it in the room, sees.
    let eye = scene.told.viewpoints[0];
    let hidden = [eye.x > lo.x, eye.x < hi.x, eye.y > lo.y, eye.y < hi.y];
    let hidden: Vec<usize> = (0..4).filter(|&f| hidden[f]).chain([4]).collect();
    let table = boxed(r, 450, lo, hi, &hidden);
    scene.points.extend(noisy(r, 0.008, table));
    scene.truth = Arc::new(move |p, n| {
        let (a, b) = (lo - 0.08, hi + 0.08);
        if p.cmpgt(a).all() && p.cmplt(b).all() {
            return (p.z > 0.12).then_some(n.dot(p - (lo + hi) / 2.0) > 0.0);
        }
        looks_in(p, n)
    });
    scene
}

fn two_rooms(r: &mut Rng) -> Scene {
    let mut points = room(r, &[], false).points;
    let count = points.len();
    let shift = DVec3::new(ROOM.x + range(r, 0.4, 0.8), 0.0, 0.0);
    points.extend(room(r, &[], false).points.iter().map(|&p| p + shift));
    let of = (0..points.len()).map(|i| u32::from(i >= count)).collect();
    let truth = move |p: DVec3, n| looks_in(if p.x > ROOM.x + 0.2 { p - shift } else { p }, n);
    let eyes = vec![ROOM / 2.0, ROOM / 2.0 + shift];
    Scene::new(Sure::Told, points, truth).seen_from_each(eyes, of)
}

/// Two rows of houses and the ground between them, from three places on it.
fn street(r: &mut Rng) -> Scene {
    let (length, width) = (24.0, range(r, 5.0, 8.0));
    let along = DVec3::X * length;
    let mut points = rectangle(r, 1400, DVec3::ZERO, along, DVec3::Y * width);
    points.extend(rectangle(r, 1100, DVec3::ZERO, along, DVec3::Z * 6.0));
    points.extend(rectangle(r, 1100, DVec3::Y * width, along, DVec3::Z * 6.0));
    let eyes: Vec<DVec3> = (0..3)
        .map(|k| DVec3::new(4.0 + 8.0 * f64::from(k), width / 2.0, 1.7))
        .collect();
    let nearest = |p: &DVec3| (p.x / 8.0) as u32;
    let of = points.iter().map(|p| nearest(p).min(2)).collect();
    let truth = move |p: DVec3, n: DVec3| {
        let middle = DVec3::new(p.x, width / 2.0, 1.7);
        Some(n.dot(middle - p) > 0.0)
    };
    Scene::new(Sure::Told, noisy(r, 0.02, points), truth).seen_from_each(eyes, of)
}

/// A free-standing wall of which both faces were seen.
fn thin_wall(r: &mut Rng) -> Scene {
    let thick = range(r, 0.2, 0.4);
    let (u, v) = (DVec3::X * 6.0, DVec3::Z * 3.0);
    let mut points = rectangle(r, 1800, DVec3::ZERO, u, v);
    points.extend(rectangle(r, 1800, DVec3::Y * thick, u, v));
    let of = (0..3600).map(|i| u32::from(i >= 1800)).collect();
    let eyes = vec![DVec3::new(3.0, -5.0, 1.5), DVec3::new(3.0, 5.0, 1.5)];
    let truth =
        move |p: DVec3, n: DVec3| (n.y.abs() > 0.7).then_some((n.y > 0.0) == (p.y > thick / 2.0));
    Scene::new(Sure::Told, noisy(r, 0.005, points), truth).seen_from_each(eyes, of)
}

/// A block on the ground, each of its sides seen from the corner that is nearest.
fn block(r: &mut Rng) -> Scene {
    let (lo, hi) = (
        DVec3::new(-2.0, -1.5, 0.0),
        DVec3::new(2.0, 1.5, range(r, 1.5, 3.0)),
    );
    let mut points = boxed(r, 2200, lo, hi, &[4]);
    let ground = rectangle(
        r,
        2200,
        DVec3::new(-5.0, -5.0, 0.0),
        DVec3::X * 10.0,
        DVec3::Y * 10.0,
    );
    points.extend(
        ground
            .into_iter()
            .filter(|p| p.x.abs() > 2.0 || p.y.abs() > 1.5),
    );
    let corner = |k: u32| {
        DVec3::new(
            if k & 1 == 1 { 6.0 } else { -6.0 },
            if k & 2 == 2 { 6.0 } else { -6.0 },
            5.0,
        )
    };
    let of = points
        .iter()
        .map(|p| u32::from(p.x > 0.0) + 2 * u32::from(p.y > 0.0))
        .collect();
    let truth = move |p: DVec3, n: DVec3| {
        if p.z < 0.12 {
            return (n.z.abs() > 0.8).then_some(n.z > 0.0);
        }
        Some(n.dot(p - DVec3::Z * (hi.z / 2.0)) > 0.0)
    };
    Scene::new(Sure::Told, noisy(r, 0.01, points), truth)
        .seen_from_each((0..4).map(corner).collect(), of)
}

/// What a camera at the origin sees: a wall, a floor perhaps, balls.
fn frame(r: &mut Rng, floor: f64, forward: f64) -> Scene {
    let ball = |r: &mut Rng| {
        let center = DVec3::new(range(r, -0.6, 0.6), range(r, -0.4, 0.4), range(r, 1.2, 2.2));
        (center, range(r, 0.15, 0.4))
    };
    let count = 1 + r.next_u64() % 3;
    let balls: Vec<(DVec3, f64)> = (0..count).map(|_| ball(r)).collect();
    let tilt = range(r, -0.4, 0.4);
    let mut points = Vec::new();
    let mut normals = Vec::new();
    let turn = DVec3::new(1.0, forward, forward);
    for v in 0..54 {
        for u in 0..68 {
            let d = DVec3::new(
                (f64::from(u) - 33.5) / 67.0,
                (f64::from(v) - 26.5) / 67.0,
                1.0,
            );
            let mut t = 2.6 / (1.0 - tilt * d.x);
            let mut normal = DVec3::new(tilt, 0.0, -1.0);
            if d.y > 0.0 && floor / d.y < t {
                (t, normal) = (floor / d.y, -DVec3::Y);
            }
            for &(c, radius) in &balls {
                let (b, l) = (d.dot(c) / d.length_squared(), d.length_squared());
                let h = b * b - (c.length_squared() - radius * radius) / l;
                if h > 0.0 && b - h.sqrt() < t {
                    t = b - h.sqrt();
                    normal = d * t - c;
                }
            }
            points.push(d * t * (1.0 + 0.0008 * r.normal()) * turn);
            normals.push(normal * turn);
        }
    }
    let scanned = points.clone();
    let truth = move |p: DVec3, n: DVec3| {
        let distance = |q: &DVec3| q.distance_squared(p);
        let pairs = scanned.iter().map(distance).zip(&normals);
        let nearest = pairs.reduce(|best, x| if x.0 < best.0 { x } else { best });
        nearest.map(|(_, normal)| n.dot(*normal) > 0.0)
    };
    Scene::new(Sure::Told, points, truth)
}

/// For [`super::objects`]: points with their normals, from several eyes, each with the eye that saw it.
pub fn scanned(
    r: &mut Rng,
    body: &[(DVec3, DVec3)],
    eyes: &[DVec3],
    noise: f64,
) -> (Vec<(DVec3, DVec3)>, Vec<u32>) {
    let mut all = Vec::new();
    let mut of = Vec::new();
    for (k, &eye) in (0u32..).zip(eyes) {
        for i in seen(body, eye, 0.02) {
            let (p, n) = body[i];
            // Half of what an eye sees, so that no two saw the same points.
            if r.uniform() < 0.5 {
                all.push((p + gauss(r) * noise, n));
                of.push(k);
            }
        }
    }
    (all, of)
}
