//! A machined part with sharp edges: a plate with chamfered corners, four holes, a slot and a bored boss, a stepped
//! block with a chamfer, and a rib with a window. Centimetres, y up, the plate's underside at y = 0.
//!
//! Each body is an extruded or revolved profile with exact distances. Outside their union the least of them is exact;
//! inside it is exact but for the wedge behind an inner corner (where boss, block or rib meet the plate), where the
//! depth comes out too small by at most the factor √2. The sign is exact everywhere.

use super::solid::corner;
use glam::{DVec2, DVec3, dvec2};

/// Through holes: four, the slot, the bore of the boss, and the window of the rib.
pub(super) const GENUS: u32 = 7;

const THICKNESS: f64 = 1.2;
const OUTLINE: [DVec2; 8] = [
    dvec2(-7.0, -3.0),
    dvec2(-6.0, -4.0),
    dvec2(6.0, -4.0),
    dvec2(7.0, -3.0),
    dvec2(7.0, 3.0),
    dvec2(6.0, 4.0),
    dvec2(-6.0, 4.0),
    dvec2(-7.0, 3.0),
];
const HOLE: DVec2 = dvec2(6.0, 2.9);
const HOLE_RADIUS: f64 = 0.55;
const SLOT_X: f64 = 5.5;
const SLOT_HALF: f64 = 1.2;
const SLOT_RADIUS: f64 = 0.5;
const BOSS_X: f64 = 2.3;
const BORE_RADIUS: f64 = 1.0;
/// Half of the boss's section: radius, height.
const BOSS: [DVec2; 6] = [
    dvec2(BORE_RADIUS, 0.0),
    dvec2(1.9, 0.0),
    dvec2(1.9, 3.2),
    dvec2(1.5, 3.6),
    dvec2(1.2, 3.6),
    dvec2(BORE_RADIUS, 3.4),
];
/// The block's section in x and y, sunk into the plate.
const BLOCK: [DVec2; 7] = [
    dvec2(-5.1, 0.3),
    dvec2(-2.5, 0.3),
    dvec2(-2.5, 3.3),
    dvec2(-3.6, 3.3),
    dvec2(-3.6, 2.3),
    dvec2(-4.5, 2.3),
    dvec2(-5.1, 1.7),
];
const BLOCK_HALF: f64 = 2.6;
/// The rib's section, sunk into the plate and the block.
const RIB: [DVec2; 5] = [
    dvec2(-2.9, 0.6),
    dvec2(-0.2, 0.6),
    dvec2(-0.2, THICKNESS),
    dvec2(-2.5, 3.1),
    dvec2(-2.9, 3.1),
];
const RIB_HALF: f64 = 0.45;
const WINDOW: DVec2 = dvec2(-1.85, 1.85);
const WINDOW_RADIUS: f64 = 0.36;

/// Signed distance, negative inside.
pub(super) fn distance(p: DVec3) -> f64 {
    plate(p).min(boss(p)).min(block(p)).min(rib(p))
}

fn plate(p: DVec3) -> f64 {
    let q = dvec2(p.x, p.z);
    let hole = HOLE_RADIUS - (q.abs() - HOLE).length();
    let bore = BORE_RADIUS - (q - dvec2(BOSS_X, 0.0)).length();
    let along = (q.y.abs() - SLOT_HALF).max(0.0);
    let slot = SLOT_RADIUS - dvec2(q.x - SLOT_X, along).length();
    let profile = polygon(q, &OUTLINE).max(hole).max(bore).max(slot);
    corner(profile, (p.y - THICKNESS / 2.0).abs() - THICKNESS / 2.0)
}

fn boss(p: DVec3) -> f64 {
    let radius = dvec2(p.x - BOSS_X, p.z).length();
    polygon(dvec2(radius, p.y), &BOSS)
}

fn block(p: DVec3) -> f64 {
    corner(polygon(dvec2(p.x, p.y), &BLOCK), p.z.abs() - BLOCK_HALF)
}

fn rib(p: DVec3) -> f64 {
    let q = dvec2(p.x, p.y);
    let window = WINDOW_RADIUS - q.distance(WINDOW);
    corner(polygon(q, &RIB).max(window), p.z.abs() - RIB_HALF)
}

/// Exact signed distance of a simple polygon: the nearest edge, and the parity of the edges that a ray crosses.
fn polygon(p: DVec2, corners: &[DVec2]) -> f64 {
    let mut nearest = f64::INFINITY;
    let mut inside = false;
    let mut a = corners[corners.len() - 1];
    for &b in corners {
        let ab = b - a;
        let t = ((p - a).dot(ab) / ab.length_squared()).clamp(0.0, 1.0);
        nearest = nearest.min((p - a - ab * t).length_squared());
        if (a.y <= p.y) != (b.y <= p.y) && ((p - a).perp_dot(ab) > 0.0) == (ab.y < 0.0) {
            inside = !inside;
        }
        a = b;
    }
    if inside {
        -nearest.sqrt()
    } else {
        nearest.sqrt()
    }
}
