//! The duck and the pig: round toys, built from smoothly joined primitives. Centimetres, y up, facing +x.

use super::solid::{Part, Shape};
use glam::{DVec3, dvec3};

/// A bath duck.
pub(super) fn duck() -> Vec<Part> {
    const YELLOW: [u8; 3] = [250, 205, 45];
    const WING: [u8; 3] = [243, 184, 30];
    const ORANGE: [u8; 3] = [238, 112, 34];
    vec![
        // Body, breast, tail, cut flat below so that it stands.
        Part::add(Shape::Ellipsoid(dvec3(4.1, 2.75, 3.15))).color(YELLOW),
        Part::add(Shape::Ellipsoid(dvec3(2.2, 2.4, 2.35)))
            .at(2.1, 0.3, 0.0)
            .blend(1.4)
            .color(YELLOW),
        Part::add(Shape::RoundCone(
            dvec3(-2.6, 0.9, 0.0),
            1.35,
            dvec3(-4.75, 2.55, 0.0),
            0.38,
        ))
        .blend(1.3)
        .color(YELLOW),
        Part::cut(Shape::Block(dvec3(8.0, 2.0, 8.0), 0.0))
            .at(0.0, -4.25, 0.0)
            .blend(0.5)
            .color(YELLOW),
        // Head on a short neck, with a curl on top.
        Part::add(Shape::Ellipsoid(dvec3(2.2, 2.1, 2.1)))
            .at(2.15, 4.25, 0.0)
            .blend(0.9)
            .color(YELLOW),
        Part::add(Shape::RoundCone(
            dvec3(1.9, 6.1, 0.0),
            0.5,
            dvec3(1.15, 6.85, 0.0),
            0.22,
        ))
        .blend(0.5)
        .color(YELLOW),
        // Wings: a plump drop and three feather tips each.
        Part::add(Shape::Ellipsoid(dvec3(2.15, 1.3, 0.75)))
            .at(-0.35, 0.75, 2.75)
            .turned(DVec3::Z, -14.0)
            .turned(DVec3::Y, 8.0)
            .mirrored()
            .blend(0.22)
            .color(WING),
        Part::add(Shape::RoundCone(
            dvec3(-0.9, 1.15, 2.8),
            0.8,
            dvec3(-2.95, 1.85, 2.5),
            0.42,
        ))
        .mirrored()
        .blend(0.18)
        .color(WING),
        Part::add(Shape::RoundCone(
            dvec3(-0.8, 0.6, 2.9),
            0.74,
            dvec3(-2.75, 1.05, 2.7),
            0.4,
        ))
        .mirrored()
        .blend(0.18)
        .color(WING),
        Part::add(Shape::RoundCone(
            dvec3(-0.7, 0.15, 2.9),
            0.62,
            dvec3(-2.35, 0.3, 2.8),
            0.36,
        ))
        .mirrored()
        .blend(0.18)
        .color(WING),
        // Beak: upper and lower half, slightly open.
        Part::add(Shape::Ellipsoid(dvec3(1.35, 0.42, 1.1)))
            .at(4.35, 3.95, 0.0)
            .turned(DVec3::Z, 9.0)
            .blend(0.25)
            .color(ORANGE),
        Part::add(Shape::Ellipsoid(dvec3(1.1, 0.34, 0.85)))
            .at(4.15, 3.42, 0.0)
            .turned(DVec3::Z, -9.0)
            .blend(0.2)
            .color(ORANGE),
        // Eyes.
        Part::add(Shape::Ellipsoid(dvec3(0.42, 0.52, 0.42)))
            .at(3.55, 4.95, 1.3)
            .mirrored()
            .blend(0.06)
            .color([34, 32, 36]),
        Part::add(Shape::Ellipsoid(DVec3::splat(0.16)))
            .at(3.84, 5.2, 1.42)
            .mirrored()
            .blend(0.03)
            .color([250, 250, 250]),
    ]
}

/// A money pig: legs with trotters, ears, snout with nostrils, smile, curly tail, and a blind slot in its back.
pub(super) fn pig() -> Vec<Part> {
    const PINK: [u8; 3] = [246, 172, 180];
    const ROSE: [u8; 3] = [236, 134, 150];
    const HOOF: [u8; 3] = [128, 88, 84];
    const DARK: [u8; 3] = [150, 70, 86];
    let mut parts = vec![
        // Trunk, head, cheeks.
        Part::add(Shape::Ellipsoid(dvec3(5.1, 3.7, 3.75))).color(PINK),
        Part::add(Shape::Ellipsoid(dvec3(2.7, 2.75, 2.85)))
            .at(4.3, 1.1, 0.0)
            .blend(1.3)
            .color(PINK),
        Part::add(Shape::Ellipsoid(DVec3::splat(1.15)))
            .at(5.35, 0.35, 1.55)
            .mirrored()
            .blend(0.9)
            .color(PINK),
    ];
    for (x, z, lean) in [(2.6, 1.85, 0.35), (-2.7, 1.9, -0.35)] {
        let foot = dvec3(x + lean, -4.55, z + 0.15);
        parts.extend([
            Part::add(Shape::RoundCone(dvec3(x, -2.2, z), 1.35, foot, 0.95))
                .mirrored()
                .blend(0.8)
                .color(PINK),
            // The trotter: a rounded foot, flat below and split in front.
            Part::add(Shape::Ellipsoid(dvec3(1.12, 0.72, 1.05)))
                .at(foot.x + 0.12, foot.y - 0.35, foot.z)
                .mirrored()
                .blend(0.12)
                .color(HOOF),
            Part::cut(Shape::Block(dvec3(2.0, 0.5, 1.6), 0.0))
                .at(foot.x, -5.75, foot.z)
                .mirrored()
                .blend(0.15)
                .color(HOOF),
            Part::cut(Shape::Ellipsoid(dvec3(0.6, 0.75, 0.2)))
                .at(foot.x + 1.25, foot.y - 0.35, foot.z)
                .mirrored()
                .blend(0.1)
                .color(HOOF),
        ]);
    }
    parts.extend([
        // Snout: a disc with a raised rim and two nostrils.
        Part::add(Shape::Disc(1.0, 1.3, 0.3))
            .at(6.85, 0.75, 0.0)
            .turned(DVec3::Z, 5.0)
            .blend(0.45)
            .color(ROSE),
        Part::add(Shape::Torus(1.12, 0.24))
            .turned(DVec3::Z, -85.0)
            .at(7.72, 0.83, 0.0)
            .blend(0.15)
            .color(ROSE),
        Part::cut(Shape::Ellipsoid(dvec3(0.6, 0.42, 0.27)))
            .at(7.95, 0.9, 0.45)
            .mirrored()
            .blend(0.1)
            .color(DARK),
        // Smile: a groove under the snout.
        Part::cut(Shape::Arc(1.25, [0.92, 0.392], 0.21))
            .turned(DVec3::Y, 90.0)
            .turned(DVec3::Z, -24.0)
            .at(6.35, -0.25, 0.0)
            .blend(0.12)
            .color(DARK),
        // Ears: bent leaves, hollow in front.
        Part::add(Shape::Ellipsoid(dvec3(0.5, 1.65, 1.05)))
            .turned(DVec3::X, 28.0)
            .turned(DVec3::Z, -18.0)
            .at(4.2, 3.75, 1.85)
            .mirrored()
            .blend(0.35)
            .color(PINK),
        Part::cut(Shape::Ellipsoid(dvec3(0.42, 1.25, 0.7)))
            .turned(DVec3::X, 28.0)
            .turned(DVec3::Z, -18.0)
            .at(4.65, 3.85, 1.85)
            .mirrored()
            .blend(0.2)
            .color(ROSE),
        Part::add(Shape::RoundCone(
            dvec3(4.45, 4.75, 2.4),
            0.5,
            dvec3(5.3, 4.85, 2.75),
            0.3,
        ))
        .mirrored()
        .blend(0.5)
        .color(PINK),
        // Eyes with a glint.
        Part::add(Shape::Ellipsoid(dvec3(0.38, 0.5, 0.4)))
            .at(6.3, 2.1, 1.25)
            .mirrored()
            .blend(0.06)
            .color([36, 30, 34]),
        Part::add(Shape::Ellipsoid(DVec3::splat(0.15)))
            .at(6.62, 2.32, 1.3)
            .mirrored()
            .blend(0.03)
            .color([250, 250, 250]),
        // Slot for coins.
        Part::cut(Shape::Block(dvec3(1.5, 0.9, 0.28), 0.12))
            .at(-0.4, 3.7, 0.0)
            .blend(0.12)
            .color(DARK),
        // Tail: one and a half turns of a helix that grows out of the back.
        Part::add(Shape::Tube(curl(), 0.32)).blend(0.3).color(ROSE),
    ]);
    parts
}

/// Centre line of the tail: a helix along -x, its start sunk in the trunk.
fn curl() -> Vec<DVec3> {
    const STEPS: usize = 72;
    const TURNS: f64 = 1.6;
    const RADIUS: f64 = 0.85;
    const PITCH: f64 = 1.15;
    (0..=STEPS)
        .map(|i| {
            let turn = TURNS * i as f64 / STEPS as f64;
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * turn);
            dvec3(
                -4.75 - PITCH * turn,
                1.0 + RADIUS * (1.0 - cos),
                RADIUS * sin,
            )
        })
        .collect()
}
