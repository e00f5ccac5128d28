//! Polygons to triangles.

use super::{area_normal, cross, dot, minus};

/// Polygons of more corners are cut as fans: to look for ears takes the cube of their number at worst.
const MOST_CORNERS: usize = 256;

/// Gives the triangles of a polygon as places in it. Quadrilaterals and larger ones are cut at ears, so that those that are
/// not convex come out right; as fans where a position is not known.
pub(super) fn cut(
    polygon: &[u32],
    position: impl Fn(u32) -> Option<[f64; 3]>,
    mut push: impl FnMut([usize; 3]),
) {
    match polygon.len() {
        0..3 => return,
        3 => return push([0, 1, 2]),
        4..=MOST_CORNERS => {}
        _ => return fan(polygon.len(), push),
    }
    let points: Option<Vec<[f64; 3]>> = polygon.iter().map(|&i| position(i)).collect();
    let Some(points) = points else {
        return fan(polygon.len(), push);
    };
    let normal = (1..points.len() - 1).fold([0.0; 3], |sum, i| {
        let part = area_normal([points[0], points[i], points[i + 1]]);
        [sum[0] + part[0], sum[1] + part[1], sum[2] + part[2]]
    });
    let mut left: Vec<usize> = (0..points.len()).collect();
    while left.len() > 3 {
        let count = left.len();
        let around = |i: usize| {
            [
                left[(i + count - 1) % count],
                left[i],
                left[(i + 1) % count],
            ]
        };
        let ear = (0..count).find(|&i| is_ear(around(i), &left, &points, normal));
        // Without an ear the polygon crosses itself.
        let ear = ear.unwrap_or(0);
        push(around(ear));
        left.remove(ear);
    }
    push([left[0], left[1], left[2]]);
}

fn fan(count: usize, mut push: impl FnMut([usize; 3])) {
    (1..count - 1).for_each(|i| push([0, i, i + 1]));
}

/// Whether the corner is convex and no other lies in its triangle.
fn is_ear(corner: [usize; 3], left: &[usize], points: &[[f64; 3]], normal: [f64; 3]) -> bool {
    let triangle = corner.map(|i| points[i]);
    let side = |a: [f64; 3], b: [f64; 3], p: [f64; 3]| dot(cross(minus(b, a), minus(p, a)), normal);
    let [a, b, c] = triangle;
    let inside = |p: [f64; 3]| side(a, b, p) >= 0.0 && side(b, c, p) >= 0.0 && side(c, a, p) >= 0.0;
    side(a, b, c) > 0.0
        && left
            .iter()
            .filter(|i| !corner.contains(i) && !triangle.contains(&points[**i]))
            .all(|&i| !inside(points[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangles(points: &[[f64; 3]]) -> Vec<[usize; 3]> {
        let polygon: Vec<u32> = (0..points.len() as u32).collect();
        let mut found = Vec::new();
        cut(
            &polygon,
            |i| points.get(i as usize).copied(),
            |t| found.push(t),
        );
        found
    }

    #[test]
    fn an_arrowhead_is_cut_along_its_inner_corner() {
        let arrow = [
            [0.0, 0.0, 0.0],
            [2.0, -1.0, 0.0],
            [1.0, 0.0, 0.0],
            [2.0, 1.0, 0.0],
        ];
        let found = triangles(&arrow);
        let area: f64 = found
            .iter()
            .map(|t| area_normal(t.map(|i| arrow[i]))[2])
            .sum();
        assert_eq!((found.len(), area), (2, 2.0));
        assert!(
            found
                .iter()
                .all(|t| area_normal(t.map(|i| arrow[i]))[2] > 0.0)
        );
    }

    #[test]
    fn large_polygons_and_unknown_corners_become_fans() {
        let ring: Vec<[f64; 3]> = (0..300)
            .map(|i| [f64::from(i), f64::from(i * i), 0.0])
            .collect();
        assert_eq!(triangles(&ring).len(), 298);
        let mut found = Vec::new();
        cut(
            &[0, 1, 2, 9],
            |i| (i < 3).then_some([f64::from(i), 0.0, 0.0]),
            |t| found.push(t),
        );
        assert_eq!(found, [[0, 1, 2], [0, 2, 3]]);
    }
}
