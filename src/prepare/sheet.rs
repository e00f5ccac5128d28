//! Where a plane's points are on it, as a grid: its inside, its rim, and what stands there.

use crate::base::linalg::Spread;
use glam::{DVec2, DVec3, Vec3};

/// Cells along the longer side, at most.
const CELLS: f64 = 256.0;
/// Side of a cell in spacings of the plane's points, so that cells inside are seldom empty.
const CELL: f64 = 2.5;

/// A plane with the part of it that points cover.
#[derive(Debug)]
pub(super) struct Sheet {
    middle: DVec3,
    axes: [DVec3; 2],
    normal: DVec3,
    low: DVec2,
    /// Side of a cell.
    pub(super) cell: f64,
    size: [usize; 2],
    state: Vec<State>,
}

/// What a cell is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum State {
    Outside,
    /// Inside, and next to what is outside.
    Rim,
    /// Inside: points are there, or all around.
    Inside,
}

impl Sheet {
    /// The sheet of these points of a plane.
    pub(super) fn of(points: &[Vec3], normal: DVec3) -> Sheet {
        let spread = Spread::of(points.iter().map(|p| p.as_dvec3()));
        let [_, _, long] = spread.eigen.vectors;
        let first =
            (long - normal * long.dot(normal)).normalize_or(normal.any_orthonormal_vector());
        let axes = [first, normal.cross(first)];
        let middle = spread.mean;
        let flat = |p: &Vec3| flat(*p, middle, axes);
        let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (lo, hi) = points
            .iter()
            .map(flat)
            .fold(none, |(lo, hi), p| (lo.min(p), hi.max(p)));
        let side = hi - lo;
        let even = (side.x * side.y / points.len() as f64).sqrt();
        let cell = (CELL * even).max(side.max_element() / CELLS).max(1e-9);
        // More than a cell on every side, however it is rounded: the outside goes around.
        let low = lo - 1.5 * cell;
        let size = [0, 1].map(|a| (side[a] / cell) as usize + 4);
        let mut sheet = Sheet {
            middle,
            axes,
            normal,
            low,
            cell,
            size,
            state: vec![State::Outside; size[0] * size[1]],
        };
        let mut taken = vec![false; sheet.state.len()];
        for p in points {
            if let Some(at) = sheet.cell_of(flat(p)) {
                taken[at] = true;
            }
        }
        sheet.fill(&taken);
        sheet
    }

    /// What no way over empty cells leads to from the border is inside.
    fn fill(&mut self, taken: &[bool]) {
        let mut outside = vec![false; taken.len()];
        let mut open = vec![0];
        outside[0] = true;
        while let Some(at) = open.pop() {
            for next in self.around(at) {
                if !taken[next] && !outside[next] {
                    outside[next] = true;
                    open.push(next);
                }
            }
        }
        for at in 0..taken.len() {
            let is_rim = || self.around(at).any(|next| outside[next]);
            self.state[at] = match outside[at] {
                true => State::Outside,
                false if is_rim() => State::Rim,
                false => State::Inside,
            };
        }
    }

    /// The cells beside one.
    fn around(&self, at: usize) -> impl Iterator<Item = usize> + use<> {
        let [columns, rows] = self.size;
        let (x, y) = (at % columns, at / columns);
        let beside = [
            (x > 0).then(|| at - 1),
            (x + 1 < columns).then(|| at + 1),
            (y > 0).then(|| at - columns),
            (y + 1 < rows).then(|| at + columns),
        ];
        beside.into_iter().flatten()
    }

    fn cell_beneath(&self, p: Vec3) -> Option<usize> {
        self.cell_of(flat(p, self.middle, self.axes))
    }

    fn cell_of(&self, flat: DVec2) -> Option<usize> {
        let at = ((flat - self.low) / self.cell).floor();
        let (x, y) = (at.x as usize, at.y as usize);
        let is_in = at.min_element() >= 0.0 && x < self.size[0] && y < self.size[1];
        is_in.then_some(y * self.size[0] + x)
    }

    /// Signed distance of a point to the plane.
    pub(super) fn height(&self, p: Vec3) -> f64 {
        (p.as_dvec3() - self.middle).dot(self.normal)
    }

    /// Whether the sheet, or its rim, is beneath a point.
    pub(super) fn is_beneath(&self, p: Vec3) -> bool {
        let cell = self.cell_beneath(p);
        cell.is_some_and(|at| self.state[at] != State::Outside)
    }

    /// Whether the sheet is beneath a point and goes on all around.
    pub(super) fn is_around(&self, p: Vec3) -> bool {
        let is_inside = |at: usize| self.state[at] == State::Inside;
        let cell = self.cell_beneath(p);
        cell.is_some_and(|at| is_inside(at) && self.around(at).all(is_inside))
    }

    /// Share of the rim at which none of these points is, which are those of other surfaces near the plane.
    pub(super) fn free_rim(&self, near: impl Iterator<Item = Vec3>) -> f64 {
        let mut bound = vec![false; self.state.len()];
        for at in near.filter_map(|p| self.cell_beneath(p)) {
            bound[at] = true;
            for next in self.around(at) {
                bound[next] = true;
            }
        }
        let rim = || (0..bound.len()).filter(|&at| self.state[at] == State::Rim);
        let free = rim().filter(|&at| !bound[at]).count();
        free as f64 / rim().count().max(1) as f64
    }
}

/// Where a point is above a plane through `middle`, along its axes.
fn flat(p: Vec3, middle: DVec3, axes: [DVec3; 2]) -> DVec2 {
    let q = p.as_dvec3() - middle;
    DVec2::new(q.dot(axes[0]), q.dot(axes[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_are_inside_and_what_stands_around_binds_the_rim() {
        // A square plate of 40 by 40 with a hole of 10 by 10 in its middle, turned out of the axes.
        let turn = glam::Quat::from_rotation_x(0.7) * glam::Quat::from_rotation_z(0.4);
        let at = |x: f32, y: f32, z: f32| turn * Vec3::new(x, y, z);
        let grid = (0..1600).map(|i| ((i % 40) as f32, (i / 40) as f32));
        let hole = |v: f32| (15.0..25.0).contains(&v);
        let plate: Vec<Vec3> = grid
            .filter(|&(x, y)| !(hole(x) && hole(y)))
            .map(|(x, y)| at(x, y, 0.0))
            .collect();
        let normal = (turn * Vec3::Z).as_dvec3();
        let sheet = Sheet::of(&plate, normal);
        assert!(sheet.is_around(at(20.0, 20.0, 7.0)) && sheet.is_beneath(at(1.0, 1.0, 5.0)));
        assert!(!sheet.is_around(at(0.0, 20.0, 1.0)) && !sheet.is_beneath(at(50.0, 20.0, 0.0)));
        assert!((sheet.height(at(3.0, 30.0, 2.0)) - 2.0).abs() < 1e-5);
        assert_eq!(sheet.free_rim(std::iter::empty()), 1.0);
        // A wall along one of four sides.
        let wall = (0..160).map(|i| at(0.0, i as f32 / 4.0, 1.0));
        assert!((sheet.free_rim(wall) - 0.72).abs() < 0.1);
    }
}
