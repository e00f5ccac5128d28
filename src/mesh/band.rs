//! The band of lattice cells that the surface crosses, found by walking along it.
//!
//! 1. Every cell that holds a fitted point is a seed; a seed without a sign change hands on to the cells around its
//!    corner of least value, at most [`WALKS`] times.
//! 2. A crossed cell asks for its neighbours across every face with a sign change, until none is missing. So whatever
//!    sheet is met is followed to its end, and the field is evaluated hardly anywhere else.
//! 3. Cells with a corner that no fitted function reaches wait. Where holes may be closed they come next, with the
//!    global values at those corners, and the walk goes on until the surface is closed: the hull of the lattice is
//!    outside. A whole brick away from what is fitted the global value is smooth: it is asked for at 27 of 512 vertices.

use crate::base::error::Result;
use crate::base::par;
use crate::base::params::Boundary;
use crate::base::progress::{Progress, Stage};
use crate::mesh::lattice::{Bits, Lattice, Place, corner};
use crate::mesh::loops::face_corners;
use crate::mesh::surface::Implicit;
use glam::{DVec3, IVec3, Vec3};

/// How many cells a seed may be away from the surface. Fitted points are off by their noise, a fraction of the spacing.
const WALKS: u8 = 3;
/// Vertices evaluated between two progress calls: some 10 ms.
const SLICE: usize = 8192;
/// `Auto` stops to close holes once they take more cells than the fitted surface has.
const MOST_FILLED_CELLS: f64 = 1.0;
/// Cells a seed leads to, on average; only the progress bar rests on it.
const CELLS_PER_SEED: usize = 4;

/// A cell whose corners are to be evaluated.
#[derive(Clone, Copy)]
struct Task {
    cell: Place,
    /// How often it may hand on if the surface does not cross it.
    walks: u8,
}

/// A brick with vertices that are to be evaluated.
struct Asked {
    brick: u32,
    /// How many.
    vertices: usize,
    /// It is away from what is fitted: see [`Smooth`].
    far: bool,
}

struct Band<'a, F: Implicit> {
    field: &'a F,
    lattice: Lattice,
    pending: Vec<Task>,
    /// Cells with a corner that no fitted function reaches.
    waiting: Vec<Place>,
    /// Corners that no function reaches take the global value.
    closing: bool,
    /// By brick, vertices that are to be evaluated; empty between two rounds.
    wanted: Vec<Bits>,
    crossed: usize,
    evaluated: usize,
}

/// Grows the band around `points`; `reach` are the radii of the fitted functions' supports (unit frame).
pub(crate) fn grow<F: Implicit>(
    field: &F,
    (points, reach): (&[Vec3], &[f32]),
    edge: f64,
    boundary: Boundary,
    progress: &mut dyn FnMut(f32) -> Result<()>,
) -> Result<Lattice> {
    let lattice = lattice_around(points, reach, edge);
    let mut band = Band {
        field,
        lattice,
        pending: Vec::new(),
        waiting: Vec::new(),
        closing: false,
        wanted: Vec::new(),
        crossed: 0,
        evaluated: 0,
    };
    for &point in points {
        let cell = band.lattice.cell_at(point);
        band.ask(cell, WALKS);
    }
    let expected = 2 * CELLS_PER_SEED * band.pending.len();
    let mut report =
        |evaluated: usize| progress((evaluated as f32 / expected.max(1) as f32).min(1.0));
    while !band.pending.is_empty() {
        band.advance(&mut report)?;
    }
    if boundary == Boundary::Auto {
        let most = band.crossed + (MOST_FILLED_CELLS * band.crossed as f64) as usize;
        band.closing = true;
        band.pending = band
            .waiting
            .drain(..)
            .map(|cell| Task { cell, walks: 0 })
            .collect();
        while !band.pending.is_empty() && band.crossed <= most {
            band.advance(&mut report)?;
        }
    }
    Ok(band.lattice)
}

/// A lattice over everything that the fitted functions reach, and two cells more.
fn lattice_around(points: &[Vec3], reach: &[f32], edge: f64) -> Lattice {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (point, &radius) in points.iter().zip(reach) {
        low = low.min(point.as_dvec3() - radius as f64);
        high = high.max(point.as_dvec3() + radius as f64);
    }
    Lattice::new(low - 2.0 * edge, high + 2.0 * edge, edge)
}

impl<F: Implicit> Band<'_, F> {
    /// Puts a cell on the list unless it was there before.
    fn ask(&mut self, cell: Place, walks: u8) {
        if self.lattice.bricks[cell.0 as usize].seen.insert(cell.1) {
            self.pending.push(Task { cell, walks });
        }
    }

    /// One round: evaluates the corners of the pending cells, then lets each cell ask for its neighbours.
    fn advance(&mut self, report: &mut impl FnMut(usize) -> Result<()>) -> Result<()> {
        let tasks = std::mem::take(&mut self.pending);
        self.evaluate(&tasks, report)?;
        for task in tasks {
            self.follow(task);
        }
        Ok(())
    }

    /// Evaluates the corners of these cells that are not known yet, brick by brick.
    fn evaluate(
        &mut self,
        tasks: &[Task],
        report: &mut impl FnMut(usize) -> Result<()>,
    ) -> Result<()> {
        let mut wanted = std::mem::take(&mut self.wanted);
        wanted.resize(self.lattice.bricks.len(), Bits::default());
        let mut bricks: Vec<Asked> = Vec::new();
        for task in tasks {
            for c in 0..8 {
                let (b, i) = self.lattice.shifted_or_new(task.cell, corner(c));
                wanted.resize(self.lattice.bricks.len(), Bits::default());
                let brick = &self.lattice.bricks[b as usize];
                let is_open = !brick.known.has(i) || self.closing && brick.value[i].is_nan();
                if is_open && wanted[b as usize].insert(i) && wanted[b as usize].len() == 1 {
                    bricks.push(Asked {
                        brick: b,
                        vertices: 0,
                        far: self.closing && self.lattice.is_far(b),
                    });
                }
            }
        }
        for asked in &mut bricks {
            let wanted = &mut wanted[asked.brick as usize];
            if asked.far {
                let unknown = self.lattice.bricks[asked.brick as usize].known.others();
                unknown.iter().for_each(|i| _ = wanted.insert(i));
            }
            asked.vertices = wanted.len();
        }
        let mut rest = &bricks[..];
        while !rest.is_empty() {
            let mut vertices = 0;
            let fitting = rest.iter().take_while(|asked| {
                vertices += asked.vertices;
                vertices <= SLICE
            });
            let (slice, later) = rest.split_at(fitting.count().max(1));
            let values = par::map(
                slice.len(),
                || (self.field.scratch(), Vec::new(), Vec::new()),
                |k, (scratch, at, values)| {
                    let wanted = &wanted[slice[k].brick as usize];
                    self.brick_values(&slice[k], wanted, (at, values), scratch)
                },
            );
            for (asked, values) in slice.iter().zip(values) {
                let brick = &mut self.lattice.bricks[asked.brick as usize];
                for (i, (value, fitted)) in wanted[asked.brick as usize].iter().zip(values) {
                    brick.value[i] = value;
                    brick.known.insert(i);
                    if fitted {
                        brick.fitted.insert(i);
                    }
                }
                self.evaluated += asked.vertices;
            }
            report(self.evaluated)?;
            rest = later;
        }
        for asked in bricks {
            wanted[asked.brick as usize] = Bits::default();
        }
        self.wanted = wanted;
        Ok(())
    }

    /// The values at some vertices of a brick, each with whether it comes from a fitted function.
    fn brick_values(
        &self,
        &Asked { brick: b, far, .. }: &Asked,
        wanted: &Bits,
        (at, values): (&mut Vec<DVec3>, &mut Vec<f64>),
        scratch: &mut F::Scratch,
    ) -> Vec<(f32, bool)> {
        at.clear();
        at.extend(wanted.iter().map(|i| self.lattice.position((b, i))));
        values.clear();
        values.resize(at.len(), f64::NAN);
        let smooth = far.then(|| {
            let at = |d: IVec3| self.lattice.beyond(b, d);
            Smooth::new(|d| self.field.global(at(d), scratch))
        });
        // A known vertex is asked for again only where no fitted function reaches it.
        let known = &self.lattice.bricks[b as usize].known;
        if !far && !wanted.iter().all(|i| known.has(i)) {
            self.field.locals(at, values, scratch);
        }
        let result = |(k, i): (usize, usize)| {
            let on_hull = self.lattice.is_on_hull((b, i));
            if values[k].is_finite() && !on_hull {
                (values[k] as f32, true)
            } else if !self.closing {
                (f32::NAN, false)
            } else if on_hull {
                (self.lattice.edge as f32, false)
            } else if let Some(smooth) = &smooth {
                (smooth.at(i) as f32, false)
            } else {
                (self.field.global(at[k], scratch) as f32, false)
            }
        };
        wanted.iter().enumerate().map(result).collect()
    }

    /// Marks an evaluated cell if the surface crosses it, and asks for the cells in which it goes on.
    fn follow(&mut self, Task { cell, walks }: Task) {
        let values = self.lattice.corners(cell);
        if values.iter().any(|v| v.is_nan()) {
            self.waiting.push(cell);
            return;
        }
        let inside = values.map(|v| v < 0.0);
        if inside.iter().all(|&s| s == inside[0]) {
            if walks > 0 {
                let nearest = (0..8)
                    .min_by(|&a, &b| values[a].abs().total_cmp(&values[b].abs()))
                    .unwrap_or(0);
                for c in (0..8).filter(|&c| c != nearest) {
                    self.ask_shifted(cell, corner(nearest) - corner(c), walks - 1);
                }
            }
            return;
        }
        self.crossed += 1;
        self.lattice.bricks[cell.0 as usize].crossed.insert(cell.1);
        for face in 0..6 {
            let corners = face_corners(face);
            if corners.iter().any(|&c| inside[c] != inside[corners[0]]) {
                let mut d = IVec3::ZERO;
                d[face / 2] = if face % 2 == 1 { 1 } else { -1 };
                self.ask_shifted(cell, d, 0);
            }
        }
    }

    fn ask_shifted(&mut self, cell: Place, d: IVec3, walks: u8) {
        let at = self.lattice.at(cell) + d;
        if at.min_element() >= 0 && (self.lattice.size - at).min_element() >= 2 {
            let next = self.lattice.shifted_or_new(cell, d);
            self.ask(next, walks);
        }
    }
}

/// A function at a brick's vertices, quadratic along each axis between its values at the first, the fifth and the one after
/// the last.
struct Smooth([f64; 27]);

impl Smooth {
    /// `value` is asked for by offsets from the brick's first vertex.
    fn new(mut value: impl FnMut(IVec3) -> f64) -> Smooth {
        let node = |k: i32| 4 * IVec3::new(k % 3, k / 3 % 3, k / 9);
        Smooth(std::array::from_fn(|k| value(node(k as i32))))
    }

    fn at(&self, i: usize) -> f64 {
        let [x, y, z] = [i & 7, i >> 3 & 7, i >> 6].map(|place| {
            let t = place as f64 / 4.0;
            [
                (1.0 - t) * (2.0 - t) / 2.0,
                t * (2.0 - t),
                t * (t - 1.0) / 2.0,
            ]
        });
        let nodes = self.0.iter().enumerate();
        nodes
            .map(|(k, value)| x[k % 3] * y[k / 3 % 3] * z[k / 9] * value)
            .sum()
    }
}

/// [`Stage::Extract`] from `start` to `end`, never going back.
pub(crate) fn span<'a>(
    progress: &'a mut dyn Progress,
    start: f32,
    end: f32,
) -> impl FnMut(f32) -> Result<()> + 'a {
    let mut most = start;
    move |fraction| {
        most = most.max(start + (end - start) * fraction);
        progress.update(Stage::Extract, most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::kernel::solid_angle;
    use std::f64::consts::PI;

    /// The winding number beside the end of a sheet that is a brick away.
    #[test]
    fn a_far_brick_is_smooth() {
        let sheet =
            (-60..8).flat_map(|x| (-60..60).map(move |z| DVec3::new(x.into(), 16.0, z.into())));
        let turns = |d: IVec3| {
            let angles = sheet
                .clone()
                .map(|p| solid_angle(p - d.as_dvec3(), DVec3::Y));
            angles.sum::<f64>() / (4.0 * PI)
        };
        let smooth = Smooth::new(turns);
        for i in 0..512 {
            let d = IVec3::new(i as i32 & 7, i as i32 >> 3 & 7, i as i32 >> 6);
            let (turns, exact) = (smooth.at(i), turns(d));
            assert!((turns - exact).abs() < 0.002, "{d}: {turns} {exact}");
        }
    }
}
