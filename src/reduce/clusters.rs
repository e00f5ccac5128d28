//! Weighted fuzzy c-means over a whole cloud, a cell at a time, without seams.
//!
//! The objective is the paper's eq. 1 with a weight for each point: `Σ w_k u_ki^m |x_k - v_i|²`. Centres of weighted
//! c-means settle with a density ∝ √(w f), f the density of the points (Gersho, "Asymptotically optimal block
//! quantization", 1979), so `w = ρ²/f` gives the wanted density ρ whatever the scanner's own was.
//!
//! Cells only cut the work into pieces: a point's memberships are formed over the centres of its own cell and those of
//! others within reach, and the sums of eq. 2 are added over cells before a centre moves. U is never stored.

use std::ops::Range;

use glam::{DVec3, Vec3};

use crate::base::error::Result;
use crate::base::lanes::{LANES, Lanes, places_within};
use crate::base::par;
use crate::base::power::{Fuzzifier, Power};
use crate::base::progress::{Part, Progress, Stage};
use crate::cloud::octree::Octree;
use crate::features::Features;
use crate::reduce::farthest_first;
use crate::reduce::shares::Shares;

/// How far from the box of a cell, or of a block of its points, centres still count, in wanted spacings. Every point of the
/// box has its nearest centre within about 0.7 spacings; at 1.25 a centre's share is (0.7/1.25)^(2/(m-1)), 10 % at m = 1.5.
/// 1.5 gives the same surfaces, at four models that the bench does not use, and takes longer.
const REACH: f32 = 1.25;

/// How far a centre goes, in steps of eq. 2 (over-relaxation): five sweeps are then as even and as near to the surface as eight
/// of step 1, on three models that the bench does not use.
const RELAXATION: f64 = 1.7;

/// Added to squared distances, in units of the squared spacing: keeps ratios finite at distance zero.
const TINY: f32 = 1e-6;

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub struct Settling {
    /// m of eq. 1-5.
    pub fuzzifier: f64,
    /// No centre moved by more than this many wanted spacings.
    pub epsilon: f64,
    /// Sweeps at most.
    pub max_iterations: usize,
}

/// What is clustered, in the octree's order.
#[derive(Clone, Copy)]
pub struct Samples<'a> {
    /// Positions.
    pub tree: &'a Octree,
    /// By which they are denoised; their spacing is used too.
    pub features: &'a Features,
    /// The wanted spacing.
    pub spacing: &'a [f32],
}

impl Samples<'_> {
    fn point(&self, k: usize) -> Vec3 {
        self.features.denoised(self.tree, k)
    }
}

/// The centres of all cells.
#[derive(Debug, Clone)]
pub struct Clusters {
    /// `v_i`, in the unit frame, cells in Morton order.
    pub centers: Vec<Vec3>,
    /// For every point the centres it is shared among, nearest first, and how much each has; unused places have
    /// membership 0.
    pub shares: Vec<Shares>,
    /// A tree of the centres.
    pub index: Octree,
    /// Sweeps done.
    pub iterations: usize,
}

/// One cell: its points, and the centres within their reach.
struct Cell {
    range: Range<usize>,
    /// Middle of the box and mean wanted spacing: coordinates inside are (x - origin) / unit.
    origin: Vec3,
    unit: f32,
    /// Centres farther than this from the middle along any axis are out of reach.
    half: Vec3,
    /// The others, in ascending order.
    reach: Vec<u32>,
}

/// The points of one cell and the centres within its reach in the cell's coordinates, structure of arrays in whole lanes,
/// and what one block of points needs.
#[derive(Default)]
struct Scratch {
    /// Lanes beyond the last point repeat it with weight 0.
    x: [Vec<f32>; 3],
    weight: Vec<f32>,
    /// Wanted spacing.
    spacing: Vec<f32>,
    /// Lanes beyond the last centre are [`FAR`].
    center: [Vec<f32>; 3],
    sums: Vec<[Lanes; 4]>,
    /// Centres within reach of the block, as places in the cell's `reach`.
    near: Vec<u32>,
    /// Squared distance of the nearest centre over that of each one near.
    ratio: Vec<Lanes>,
}

/// Coordinate of a padding centre: out of reach, and small enough to be squared.
const FAR: f32 = 1e6;

/// Clusters the cloud: `quotas[i]` centres start in `cells[i]`.
pub fn cluster(
    samples: Samples,
    (ranges, quotas): (&[Range<usize>], &[usize]),
    settling: &Settling,
    progress: &mut dyn Progress,
) -> Result<Clusters> {
    let point = |k: usize| samples.point(k);
    let mut centers = farthest_first::start(ranges, quotas, samples.spacing, point);
    let mut cells: Vec<Cell> = ranges
        .iter()
        .map(|range| Cell::new(samples, range.clone()))
        .collect();
    let mut iterations = 0;
    while iterations < settling.max_iterations {
        progress.update(
            Stage::Cluster,
            0.9 * iterations as f32 / settling.max_iterations as f32,
        )?;
        // The start is uneven; after two sweeps centres hardly leave a cell's reach any more.
        if iterations == 0 || iterations == 2 {
            gather(&mut cells, &centers);
        }
        let moved = match Fuzzifier::new(settling.fuzzifier) {
            Fuzzifier::Two(power) => sweep(power, samples, &cells, &mut centers),
            Fuzzifier::ThreeHalves(power) => sweep(power, samples, &cells, &mut centers),
            Fuzzifier::FiveQuarters(power) => sweep(power, samples, &cells, &mut centers),
            Fuzzifier::Any(power) => sweep(power, samples, &cells, &mut centers),
        };
        iterations += 1;
        if moved < settling.epsilon {
            break;
        }
    }
    let index = gather(&mut cells, &centers);
    let fuzzifier = Fuzzifier::new(settling.fuzzifier);
    let share = |i: usize, scratch: &mut Scratch| {
        let cell: &Cell = &cells[i];
        scratch.load(samples, cell, &centers);
        let mut shares = Vec::with_capacity(cell.range.len());
        for start in cell.range.clone().step_by(LANES) {
            scratch.narrow(start - cell.range.start);
            for k in start..(start + LANES).min(cell.range.end) {
                let near = scratch.near.iter().map(|&c| cell.reach[c as usize]);
                shares.push(Shares::of(samples.point(k), &centers, near, fuzzifier));
            }
        }
        shares
    };
    let mut last = Part::new(progress, 0.9..1.0);
    let shares = par::flat_map_progress(
        cells.len(),
        samples.tree.points.len(),
        20.0,
        (Stage::Cluster, &mut last),
        Scratch::default,
        share,
    )?;
    Ok(Clusters {
        centers,
        shares,
        index,
        iterations,
    })
}

impl Cell {
    fn new(samples: Samples, range: Range<usize>) -> Cell {
        let (mut lo, mut hi) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let (mut sum, mut widest) = (0.0, 0.0f32);
        for k in range.clone() {
            let p = samples.point(k);
            lo = lo.min(p);
            hi = hi.max(p);
            sum += samples.spacing[k];
            widest = widest.max(samples.spacing[k]);
        }
        Cell {
            origin: 0.5 * (lo + hi),
            half: 0.5 * (hi - lo) + REACH * widest,
            unit: (sum / range.len() as f32).max(f32::MIN_POSITIVE),
            range,
            reach: Vec::new(),
        }
    }
}

/// Finds the centres within each cell's reach; at least the nearest one.
fn gather(cells: &mut [Cell], centers: &[Vec3]) -> Octree {
    for cell in &mut *cells {
        cell.reach = Vec::new();
    }
    let index = Octree::build(centers);
    let reaches = par::map(
        cells.len(),
        || (),
        |i, ()| {
            let cell = &cells[i];
            let (lo, hi) = (cell.origin - cell.half, cell.origin + cell.half);
            let mut reach = Vec::new();
            index.gather(lo, hi, usize::MAX, &mut reach);
            if reach.is_empty() {
                reach.push(index.nearest(cell.origin).index);
            }
            for i in &mut reach {
                *i = index.order[*i as usize];
            }
            reach.sort_unstable();
            reach
        },
    );
    for (cell, reach) in cells.iter_mut().zip(reaches) {
        cell.reach = reach;
    }
    index
}

/// One pass of eq. 5 and eq. 2 over all cells. Returns the largest movement, in wanted spacings.
fn sweep<P: Power<Lanes> + Send + Sync>(
    power: P,
    samples: Samples,
    cells: &[Cell],
    centers: &mut [Vec3],
) -> f64 {
    // Σ w, Σ w (x - v), as the movement is small against the position, and Σ w · unit.
    let mut weights = vec![0.0f64; centers.len()];
    let mut steps = vec![DVec3::ZERO; centers.len()];
    let mut units = vec![0.0f64; centers.len()];
    par::map_each(
        cells.len(),
        Scratch::default,
        |i, scratch| {
            scratch.load(samples, &cells[i], centers);
            scratch.accumulate(power);
            let total = |sums: &[Lanes; 4]| sums.map(Lanes::sum);
            scratch.sums.iter().map(total).collect::<Vec<[f32; 4]>>()
        },
        |i, part| {
            let cell = &cells[i];
            for (&i, [w, x, y, z]) in cell.reach.iter().zip(part) {
                let i = i as usize;
                let local = (centers[i] - cell.origin).as_dvec3();
                let (w, unit) = (f64::from(w), f64::from(cell.unit));
                weights[i] += w;
                steps[i] += DVec3::new(f64::from(x), f64::from(y), f64::from(z)) * unit - w * local;
                units[i] += w * unit;
            }
        },
    );
    let mut moved = 0.0f64;
    for (i, center) in centers.iter_mut().enumerate() {
        if weights[i] > 0.0 {
            let step = steps[i] / weights[i];
            moved = moved.max(step.length() * weights[i] / units[i]);
            *center = (center.as_dvec3() + RELAXATION * step).as_vec3();
        }
    }
    moved
}

impl Scratch {
    fn load(&mut self, samples: Samples, cell: &Cell, centers: &[Vec3]) {
        let padded = cell.range.len().next_multiple_of(LANES);
        let local = |p: Vec3| (p - cell.origin) / cell.unit;
        let last = local(samples.point(cell.range.end - 1));
        self.x.iter_mut().for_each(Vec::clear);
        for k in cell.range.clone() {
            for (x, at) in self.x.iter_mut().zip(local(samples.point(k)).to_array()) {
                x.push(at);
            }
        }
        for (x, last) in self.x.iter_mut().zip(last.to_array()) {
            x.resize(padded, last);
        }
        self.spacing.clear();
        self.weight.clear();
        for k in cell.range.clone() {
            // w = ρ²/f with ρ = 1/h² and 1/f the area of surface that the point stands for.
            let h = samples.spacing[k] / cell.unit;
            let area = (samples.features.spacing[k] / cell.unit).powi(2);
            self.spacing.push(h);
            self.weight.push(area / (h * h * h * h));
        }
        self.spacing.resize(padded, 0.0);
        self.weight.resize(padded, 0.0);
        for (axis, x) in self.center.iter_mut().enumerate() {
            x.clear();
            x.extend(cell.reach.iter().map(|&i| local(centers[i as usize])[axis]));
            x.resize(cell.reach.len().next_multiple_of(LANES), FAR);
        }
        self.sums.clear();
        self.sums.resize(cell.reach.len(), [Lanes::ZERO; 4]);
    }

    /// Finds the centres within [`REACH`] of the block of points that starts at `block`; all where there is none.
    fn narrow(&mut self, block: usize) {
        let fold = |x: &[f32], pick: fn(f32, f32) -> f32| {
            let lanes = &x[block..block + LANES];
            lanes.iter().copied().reduce(pick).unwrap_or(0.0)
        };
        let reach = REACH * fold(&self.spacing, f32::max);
        let corners = [0, 1, 2].map(|axis| {
            let x = &self.x[axis];
            [fold(x, f32::min), fold(x, f32::max)].map(Lanes::splat)
        });
        let count = self.sums.len();
        let center = &self.center;
        let distance2 = |start: usize| {
            let mut sum = Lanes::ZERO;
            for (center, [lo, hi]) in center.iter().zip(corners) {
                let x = Lanes::load(&center[start..]);
                let away = (lo - x).max(x - hi).max(Lanes::ZERO);
                sum += away * away;
            }
            sum
        };
        places_within(count, reach * reach, distance2, &mut self.near);
        if self.near.is_empty() {
            self.near.extend(0..count as u32);
        }
    }

    /// Memberships of eq. 5 block by block, summed for eq. 2 as they come.
    fn accumulate<P: Power<Lanes>>(&mut self, power: P) {
        for block in (0..self.weight.len()).step_by(LANES) {
            self.narrow(block);
            let [x, y, z] = [0, 1, 2].map(|axis| Lanes::load(&self.x[axis][block..]));
            let weight = Lanes::load(&self.weight[block..]);

            self.ratio.clear();
            let mut nearest = Lanes::splat(f32::INFINITY);
            for &near in &self.near {
                let v = [0, 1, 2].map(|axis| Lanes::splat(self.center[axis][near as usize]));
                let (dx, dy, dz) = (x - v[0], y - v[1], z - v[2]);
                let distance2 = dx * dx + dy * dy + dz * dz + Lanes::splat(TINY);
                nearest = nearest.min(distance2);
                self.ratio.push(distance2);
            }
            let mut total = Lanes::ZERO;
            for ratio in &mut self.ratio {
                *ratio = nearest / *ratio;
                total += power.share(*ratio);
            }
            // u = share/total, and u^m = share r / total^m, as share^m = r^(m/(m-1)).
            let scale = weight * power.raise(Lanes::splat(1.0) / total);
            for (&ratio, &near) in self.ratio.iter().zip(&self.near) {
                let w = scale * ratio * power.share(ratio);
                let sums = &mut self.sums[near as usize];
                sums[0] += w;
                sums[1] += w * x;
                sums[2] += w * y;
                sums[3] += w * z;
            }
        }
    }
}
