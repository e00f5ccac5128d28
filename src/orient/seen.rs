//! Parts that are seen side by side from far away are taken to show the same side.

use crate::base::par;
use crate::base::sort_keys::{key, sort_by_key};
use crate::features::noise::quantile;
use crate::orient::domains::Domains;
use crate::orient::parts::Parts;
use glam::Vec3;

/// Directions from which the surface is looked at.
const DIRECTIONS: usize = 64;
/// Parts that are looked at, the largest ones.
const MOST: usize = 64;
/// A part that is looked at has so many sub-domains.
const LEAST: usize = 4;
/// Cells of a picture along the diagonal, at most.
const FINEST: f32 = 1000.0;

/// For every two large parts a, b how much of their outer, less their inner sides, is seen at once, against that of two
/// that are seen whole: −1 to 1, times √ the sub-domains of the smaller.
pub(crate) fn together(domains: &Domains, parts: &Parts, signs: &[f32]) -> Vec<(u32, u32, f32)> {
    let size = |p: u32| parts.members.of(p).len();
    let areas = parts.sums(|s| domains.area(s));
    let mut large: Vec<u32> = (0..parts.count() as u32)
        .filter(|&p| size(p) >= LEAST)
        .collect();
    sort_by_key(&mut large, |&p| !key(areas[p as usize]));
    large.truncate(MOST);
    if large.len() < 2 {
        return Vec::new();
    }
    let visible = visible(domains, parts, signs);
    let mut together = Vec::new();
    for (k, &p) in large.iter().enumerate() {
        for &q in &large[k + 1..] {
            let common: f32 = visible
                .iter()
                .map(|v| v[p as usize] * v[q as usize])
                .sum::<f32>();
            // A convex body shows a quarter of its area on average.
            let whole = areas[p as usize] * areas[q as usize] / 16.0;
            let share = (common / (DIRECTIONS as f32 * whole)).clamp(-1.0, 1.0);
            let weight = share * (size(p).min(size(q)) as f32).sqrt();
            together.push((p.min(q), p.max(q), weight));
        }
    }
    together
}

/// The area of every part that is seen from far away, by direction: of outer sides, less that of inner ones.
fn visible(domains: &Domains, parts: &Parts, signs: &[f32]) -> Vec<Vec<f32>> {
    let sites = domains.sites;
    let points = &sites.tree.points;
    let mut owner = vec![u32::MAX; points.len()];
    for (s, &p) in (0..).zip(&parts.of) {
        for (i, _) in domains.core(s) {
            owner[i as usize] = p;
        }
    }
    let normals = domains.site_normals(signs);
    let (lo, hi) = (sites.tree.nodes[0].lo, sites.tree.nodes[0].hi);
    let size = (hi - lo).length();
    let cell = (2.0 * quantile(sites.spacing.clone(), 2)).max(size / FINEST);
    let (center, radius) = ((lo + hi) * 0.5, size * 0.5 + cell);
    let side = (2.0 * radius / cell) as usize + 2;
    par::map(
        DIRECTIONS,
        || (),
        |k, ()| {
            // A spiral on the ball by the golden angle.
            let z = 1.0 - (2.0 * k as f32 + 1.0) / DIRECTIONS as f32;
            let (angle, r) = (2.399_963_2 * k as f32, (1.0 - z * z).sqrt());
            let d = Vec3::new(r * libm::cosf(angle), r * libm::sinf(angle), z);
            let (u, v) = d.any_orthonormal_pair();
            let place = |p: Vec3| {
                let q = p - center;
                let (x, y) = ((q.dot(u) + radius) / cell, (q.dot(v) + radius) / cell);
                (y as usize * side + x as usize, q.dot(d))
            };
            let mut front = vec![f32::NEG_INFINITY; side * side];
            for &p in points {
                let (c, depth) = place(p);
                front[c] = front[c].max(depth);
            }
            let mut seen = vec![0.0; parts.count()];
            for (i, &p) in points.iter().enumerate() {
                let (c, depth) = place(p);
                if owner[i] != u32::MAX && front[c] - depth < 2.0 * cell {
                    seen[owner[i] as usize] += normals[i].dot(d) * domains.site_area(i as u32);
                }
            }
            seen
        },
    )
}
