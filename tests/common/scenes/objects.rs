//! Scenes that are looked at from outside: closed, half and open objects, on tables or alone, sheets, raw scans.

use super::places::scanned;
use super::shapes::{ball, boxed, direction, disc, gauss, noisy, range, rectangle, strays, turned};
use super::{Row, Scene, Sure};
use glam::DVec3;
use pointweave::base::rng::Rng;
use std::f64::consts::{PI, TAU};

pub const RECIPES: &[Row] = &[
    ("half object", "half ball", |r| half_ball(r, |_| 1.0)),
    ("half object", "half lumpy ball", |r| half_ball(r, lumpy)),
    ("half object", "half lumpy ball with a viewpoint", |r| {
        let scene = half_ball(r, lumpy);
        scene.seen_from(DVec3::new(0.0, -6.0, 0.5))
    }),
    ("half object", "half pipe", half_pipe),
    ("half object", "front of a box with a viewpoint", |r| {
        let points = boxed(r, 3000, -DVec3::ONE, DVec3::ONE, &[0, 2, 4]);
        out_of_origin(r, points, 0.004).seen_from(DVec3::new(6.0, 5.0, 4.0))
    }),
    ("bowl or vase", "vase without top and bottom", |r| {
        vase_scene(r, Foot::None)
    }),
    ("bowl or vase", "vase", |r| vase_scene(r, Foot::Bottom)),
    ("bowl or vase", "vase upside down", |r| {
        vase_scene(r, Foot::Lid)
    }),
    ("bowl or vase", "bowl", |r| {
        let rim = range(r, -0.35, 0.1);
        let points = ball(r, 3000, |d| d.z < rim);
        out_of_origin(r, points, 0.003)
    }),
    ("bowl or vase", "bin", |r| {
        let high = DVec3::new(1.0, 1.0, range(r, 0.5, 1.5));
        let points = boxed(r, 3200, -DVec3::ONE, high, &[5]);
        out_of_origin(r, points, 0.004)
    }),
    ("bowl or vase", "pipe", |r| {
        let points = turned(r, 3000, |_| 0.1);
        let truth = |p: DVec3, n: DVec3| Some(n.x * p.x + n.y * p.y > 0.0);
        Scene::new(Sure::Told, noisy(r, 0.001, points), truth)
    }),
    ("on a table", "vase on a disc", |r| on_disc(r, 0, 0)),
    ("on a table", "vase on a disc, a strand of strays", |r| {
        on_disc(r, 80, 0)
    }),
    ("on a table", "vase on a disc, two strands of strays", |r| {
        on_disc(r, 120, 60)
    }),
    ("on a table", "boxes on a table", boxes_on_table),
    ("on a table", "half balls on a table", balls_on_table),
    ("leaf or wall", "leaf", |r| leaf(r, 0.0)),
    ("leaf or wall", "tilted leaf", |r| leaf(r, 1.0)),
    ("leaf or wall", "upright leaf", |r| leaf(r, PI / 2.0)),
    ("leaf or wall", "wall with a viewpoint", |r| {
        walls(r, false, 1.0)
    }),
    ("leaf or wall", "L wall from outside", |r| {
        walls(r, true, -1.0)
    }),
    ("leaf or wall", "L wall from inside", |r| {
        walls(r, true, 1.0)
    }),
    ("nested or separate", "three shells", |r| {
        let mut points = ball(r, 2600, |_| true);
        points.extend(ball(r, 1300, |_| true).into_iter().map(|d| d * 0.66));
        points.extend(ball(r, 600, |_| true).into_iter().map(|d| d * 0.33));
        let truth = |p: DVec3, n: DVec3| {
            let is_cave = p.length() > 0.5 && p.length() < 0.83;
            Some((n.dot(p) > 0.0) != is_cave)
        };
        Scene::new(Sure::Closed, noisy(r, 0.002, points), truth)
    }),
    ("nested or separate", "two balls", |r| {
        let mut points = ball(r, 2000, |_| true);
        let at = direction(r) * range(r, 2.3, 4.0);
        points.extend(ball(r, 1500, |_| true).into_iter().map(|d| d * 0.8 + at));
        let truth = move |p: DVec3, n: DVec3| {
            let center = if p.distance(at) < p.length() {
                at
            } else {
                DVec3::ZERO
            };
            Some(n.dot(p - center) > 0.0)
        };
        Scene::new(Sure::Closed, noisy(r, 0.002, points), truth)
    }),
    ("nested or separate", "ball and half ball", |r| {
        let mut points = ball(r, 2000, |_| true);
        let at = direction(r) * range(r, 2.5, 4.0);
        points.extend(ball(r, 1200, |d| d.y < 0.1).into_iter().map(|d| d + at));
        let truth = move |p: DVec3, n: DVec3| {
            let center = if p.distance(at) < p.length() {
                at
            } else {
                DVec3::ZERO
            };
            Some(n.dot(p - center) > 0.0)
        };
        Scene::new(Sure::Told, noisy(r, 0.002, points), truth)
    }),
    ("nested or separate", "ball over a turntable", |r| {
        let mut points = ball(r, 2400, |_| true);
        let below = -range(r, 1.25, 1.6);
        points.extend(disc(r, 1600, 1.6, below));
        let truth = |p: DVec3, n: DVec3| {
            Some(if p.length() < 1.1 {
                n.dot(p) > 0.0
            } else {
                n.z > 0.0
            })
        };
        Scene::new(Sure::Guess, noisy(r, 0.003, points), truth)
    }),
    ("raw scan", "statue with viewpoints", |r| {
        statue(r, Knows::Viewpoints)
    }),
    ("raw scan", "statue with normals", |r| {
        statue(r, Knows::Normals)
    }),
    ("raw scan", "statue, nothing known", |r| {
        statue(r, Knows::Nothing)
    }),
    ("raw scan", "statue with random normals", |r| {
        statue(r, Knows::Rubbish)
    }),
    ("raw scan", "statue with some normals turned", |r| {
        statue(r, Knows::Mostly)
    }),
    ("closed object", "ball", |r| {
        let points = ball(r, 3000, |_| true);
        closed(r, points, 0.0)
    }),
    ("closed object", "lumpy ball", |r| {
        let points = ball(r, 3000, |_| true)
            .into_iter()
            .map(|d| d * lumpy(d))
            .collect();
        closed(r, points, 0.004)
    }),
    ("closed object", "box", |r| {
        let size = DVec3::new(1.0, range(r, 0.5, 1.0), range(r, 0.3, 1.0));
        let points = boxed(r, 3200, -size, size, &[]);
        closed(r, points, 0.002)
    }),
    ("closed object", "ball before a camera", |r| {
        let shift = DVec3::Z * range(r, 1.6, 3.0);
        let points = ball(r, 3000, |_| true)
            .into_iter()
            .map(|d| d * 0.5 + shift)
            .collect();
        let truth = move |p: DVec3, n: DVec3| Some(n.dot(p - shift) > 0.0);
        Scene::new(Sure::Closed, noisy(r, 0.002, points), truth)
    }),
    ("closed object", "ball from above", |r| {
        let points = ball(r, 3000, |_| true);
        closed(r, points, 0.002).seen_from_above()
    }),
    ("closed object", "torus", |r| {
        let round = |r: &mut Rng| {
            let (a, b) = (TAU * r.uniform(), TAU * r.uniform());
            let ring = 1.0 + 0.35 * b.cos();
            DVec3::new(ring * a.cos(), ring * a.sin(), 0.35 * b.sin())
        };
        let points = (0..3000).map(|_| round(r)).collect();
        let truth = |p: DVec3, n: DVec3| {
            let ring = DVec3::new(p.x, p.y, 0.0).normalize();
            Some(n.dot(p - ring) > 0.0)
        };
        Scene::new(Sure::Closed, noisy(r, 0.002, points), truth)
    }),
];

fn lumpy(d: DVec3) -> f64 {
    1.0 + 0.15 * (3.0 * d.x + 1.0).sin() * (2.0 * d.y).cos() + 0.1 * (4.0 * d.z + d.x).sin()
}

/// Away from the origin; what is much nearer to it than the surface are caps of holes.
fn out_of_origin(r: &mut Rng, points: Vec<DVec3>, noise: f64) -> Scene {
    let truth = |p: DVec3, n: DVec3| (p.length() > 0.7).then_some(n.dot(p) > 0.0);
    Scene::new(Sure::Told, noisy(r, noise, points), truth)
}

fn closed(r: &mut Rng, points: Vec<DVec3>, noise: f64) -> Scene {
    let truth = |p: DVec3, n: DVec3| Some(n.dot(p) > 0.0);
    Scene::new(Sure::Closed, noisy(r, noise, points), truth)
}

fn half_ball(r: &mut Rng, radius: impl Fn(DVec3) -> f64) -> Scene {
    let points = ball(r, 2800, |d| d.y < 0.15).into_iter();
    let points = points.map(|d| d * radius(d)).collect();
    out_of_origin(r, points, 0.003)
}

fn half_pipe(r: &mut Rng) -> Scene {
    let along = |r: &mut Rng| {
        let a = PI * r.uniform();
        DVec3::new(0.4 * a.cos(), 3.0 * r.uniform(), 0.4 * a.sin())
    };
    let points = (0..3000).map(|_| along(r)).collect();
    let truth = |p: DVec3, n: DVec3| {
        let q = DVec3::new(p.x, 0.0, p.z);
        (q.length() > 0.3).then_some(n.dot(q) > 0.0)
    };
    Scene::new(Sure::Told, noisy(r, 0.002, points), truth)
}

#[derive(PartialEq)]
enum Foot {
    None,
    Bottom,
    Lid,
}

/// The radius of a vase by height, with lumps of a scene's own.
fn vase_radius(t: f64, shape: f64) -> f64 {
    0.22 + 0.14 * (t * (4.5 + shape)).sin() * (1.0 - 0.4 * t) + 0.05 * t
}

fn is_at_vase(p: DVec3, shape: f64) -> bool {
    p.z > 0.04 && p.z < 0.96 && (p.truncate().length() - vase_radius(p.z, shape)).abs() < 0.04
}

fn vase_scene(r: &mut Rng, foot: Foot) -> Scene {
    let shape = r.uniform();
    let mut points = turned(r, 2700, |t| vase_radius(t, shape));
    match foot {
        Foot::None => {}
        Foot::Bottom => points.extend(disc(r, 300, vase_radius(0.0, shape), 0.0)),
        Foot::Lid => points.extend(disc(r, 300, vase_radius(1.0, shape), 1.0)),
    }
    let truth =
        move |p, n: DVec3| is_at_vase(p, shape).then_some(n.truncate().dot(p.truncate()) > 0.0);
    Scene::new(Sure::Told, noisy(r, 0.002, points), truth)
}

/// A vase without a bottom on a disc; strays in strands to the vase and to the disc.
fn on_disc(r: &mut Rng, to_vase: usize, to_disc: usize) -> Scene {
    let shape = r.uniform();
    let vase = turned(r, 4000, |t| vase_radius(t, shape));
    let table = disc(r, 4000, 0.8, 0.0);
    let mut points = noisy(r, 0.002, [vase, table].concat());
    let a = TAU * r.uniform();
    let around = DVec3::new(a.cos(), a.sin(), 0.0);
    let at = around * 0.7 + DVec3::Z * range(r, 0.3, 0.9);
    if to_vase > 0 {
        let t = range(r, 0.2, 0.9);
        let to = around * vase_radius(t, shape) + DVec3::Z * t;
        points.extend(strays(r, to_vase, at, to));
    }
    if to_disc > 0 {
        points.extend(strays(r, to_disc, at, around * 0.7));
    }
    let truth = move |p: DVec3, n: DVec3| {
        let q = p.truncate().length();
        if is_at_vase(p, shape) {
            Some(n.truncate().dot(p.truncate()) > 0.0)
        } else {
            let is_table = p.z.abs() < 0.02 && q > vase_radius(0.0, shape) + 0.04 && q < 0.8;
            is_table.then_some(n.z > 0.0)
        }
    };
    Scene::new(Sure::Told, points, truth)
}

fn boxes_on_table(r: &mut Rng) -> Scene {
    let mut points = rectangle(
        r,
        2600,
        DVec3::new(-1.0, -1.0, 0.0),
        DVec3::X * 2.0,
        DVec3::Y * 2.0,
    );
    for k in 0..3 {
        let x = -0.65 + 0.6 * f64::from(k) + range(r, -0.05, 0.05);
        let y = range(r, -0.5, 0.4);
        let half = range(r, 0.17, 0.22);
        points.retain(|p| (p.x - x).abs() > half || (p.y - y).abs() > half || p.z > 0.0);
        let (lo, hi) = (
            DVec3::new(x - half, y - half, 0.0),
            DVec3::new(x + half, y + half, 2.0 * half),
        );
        points.extend(boxed(r, 550, lo, hi, &[4]));
    }
    let truth = |_: DVec3, n: DVec3| (n.z.abs() > 0.8).then_some(n.z > 0.0);
    Scene::new(Sure::Told, noisy(r, 0.002, points), truth)
}

fn balls_on_table(r: &mut Rng) -> Scene {
    let mut points = rectangle(
        r,
        2400,
        DVec3::new(-1.0, -1.0, 0.0),
        DVec3::X * 2.0,
        DVec3::Y * 2.0,
    );
    for k in 0..2 {
        let at = DVec3::new(-0.5 + f64::from(k), range(r, -0.4, 0.4), 0.0);
        points.retain(|p| p.distance(at) > 0.35 || p.z > 0.0);
        points.extend(
            ball(r, 800, |d| d.z > 0.0)
                .into_iter()
                .map(|d| d * 0.35 + at),
        );
    }
    let truth = |_: DVec3, n: DVec3| (n.z.abs() > 0.8).then_some(n.z > 0.0);
    Scene::new(Sure::Guess, noisy(r, 0.002, points), truth)
}

/// A bent sheet, tilted about x.
fn leaf(r: &mut Rng, tilt: f64) -> Scene {
    let bend = range(r, 0.05, 0.25);
    let turn = glam::DQuat::from_rotation_x(tilt);
    let one = |r: &mut Rng| loop {
        let (x, y) = (range(r, -1.0, 1.0), range(r, -0.6, 0.6));
        if x * x + (y / 0.6).powi(2) < 1.0 {
            return turn * DVec3::new(x, y, bend * (x * x + (2.0 * y).sin() * 0.4));
        }
    };
    let points = (0..2800).map(|_| one(r)).collect();
    let up = turn * DVec3::Z;
    Scene::new(Sure::Guess, noisy(r, 0.003, points), move |_, n| {
        Some(n.dot(up) > 0.0)
    })
}

/// One wall or two at a right angle, and an eye at one side.
fn walls(r: &mut Rng, has_second: bool, side: f64) -> Scene {
    let mut points = rectangle(r, 1800, DVec3::ZERO, DVec3::X * 4.0, DVec3::Z * 2.5);
    if has_second {
        points.extend(rectangle(
            r,
            1800,
            DVec3::ZERO,
            DVec3::Y * 4.0,
            DVec3::Z * 2.5,
        ));
    }
    let eye = DVec3::new(range(r, 2.0, 4.0), range(r, 2.0, 4.0), 1.5) * DVec3::new(side, side, 1.0);
    let truth = move |_: DVec3, n: DVec3| {
        let side = side * if has_second { n.x + n.y } else { n.y };
        (n.z.abs() < 0.7).then_some(side > 0.0)
    };
    Scene::new(Sure::Told, noisy(r, 0.004, points), truth).seen_from(eye)
}

enum Knows {
    Nothing,
    Viewpoints,
    Normals,
    /// Normals in random directions.
    Rubbish,
    /// Normals of which one in ten points the other way.
    Mostly,
}

/// A lumpy body from six places around it, none below: what is hidden was never scanned.
fn statue(r: &mut Rng, knows: Knows) -> Scene {
    let bump =
        |d: DVec3, phase: f64| lumpy(d) + 0.12 * (5.0 * d.x + phase).sin() * (4.0 * d.z).cos();
    let phase = range(r, 0.0, TAU);
    let body: Vec<(DVec3, DVec3)> = ball(r, 6000, |_| true)
        .into_iter()
        .map(|d| {
            let (u, v) = d.any_orthonormal_pair();
            let at = |d: DVec3| d.normalize() * bump(d.normalize(), phase);
            let e = 1e-4;
            let normal = (at(d + u * e) - at(d - u * e)).cross(at(d + v * e) - at(d - v * e));
            (at(d), normal.normalize() * normal.dot(d).signum())
        })
        .collect();
    let start = range(r, 0.0, TAU);
    let eye = |k: usize| {
        let a = start + TAU * k as f64 / 6.0;
        DVec3::new(
            4.0 * a.cos(),
            4.0 * a.sin(),
            if k.is_multiple_of(2) { 0.6 } else { 2.0 },
        )
    };
    let eyes: Vec<DVec3> = (0..6).map(eye).collect();
    let (seen, of) = scanned(r, &body, &eyes, 0.003);
    let (points, normals): (Vec<DVec3>, Vec<DVec3>) = seen.into_iter().unzip();
    let truth = |p: DVec3, n: DVec3| Some(n.dot(p) > 0.0);
    let scene = Scene::new(Sure::Told, points, truth);
    match knows {
        Knows::Nothing => scene,
        Knows::Viewpoints => scene.seen_from_each(eyes, of),
        Knows::Normals => scene.with_normals(normals),
        Knows::Rubbish => {
            let random = normals.iter().map(|_| gauss(r).normalize()).collect();
            scene.with_normals(random)
        }
        Knows::Mostly => {
            let turned = |n: DVec3| if r.uniform() < 0.1 { -n } else { n };
            let normals = normals.into_iter().map(turned).collect();
            scene.with_normals(normals)
        }
    }
}
