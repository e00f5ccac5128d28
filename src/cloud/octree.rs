//! A linear octree: points in Morton order, every cell a contiguous range of them, one tree for all neighbour queries
//! and for the sub-domains of section 3.
//!
//! Nodes store the tight box of their points, so a query prunes as well as in a kd-tree. Levels in which all points fall
//! into one octant make no node. Points that share all 21 bits an axis are cut in the middle of their longest side, copies by
//! index, so neither costs more than others.

use crate::base::lists::{key, sort_by_key};
use crate::base::par;
use glam::Vec3;
use std::ops::Range;

/// Points of a leaf: small enough that a scan is cheaper than another level.
const LEAF: usize = 8;

/// Bits an axis of a Morton key; three axes fit in 63 bits.
pub const MAX_DEPTH: u32 = 21;

/// A cell.
#[derive(Debug, Clone, Copy)]
pub struct Node {
    /// Its points: `start..end` of [`Octree::points`].
    pub start: u32,
    /// See `start`.
    pub end: u32,
    /// First child in [`Octree::nodes`]; children are contiguous.
    first_child: u32,
    /// 0 for a leaf, else 2-8.
    children: u8,
    /// Octree level of the cell, 0 for the root.
    pub level: u8,
    /// Tight lower corner of its points.
    pub lo: Vec3,
    /// Tight upper corner of its points.
    pub hi: Vec3,
}

impl Node {
    /// Its points.
    pub fn range(&self) -> Range<usize> {
        self.start as usize..self.end as usize
    }

    /// Whether its points are not divided further.
    pub fn is_leaf(&self) -> bool {
        self.children == 0
    }

    /// Its children in [`Octree::nodes`].
    pub fn child_ids(&self) -> Range<usize> {
        self.first_child as usize..self.first_child as usize + self.children as usize
    }

    /// Squared distance to its tight box.
    pub fn distance2(&self, q: Vec3) -> f32 {
        (self.lo - q)
            .max(q - self.hi)
            .max(Vec3::ZERO)
            .length_squared()
    }
}

/// A point found by a query.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neighbor {
    /// Squared distance in the unit frame.
    pub distance2: f32,
    /// Index in [`Octree::points`].
    pub index: u32,
}

/// The tree. Positions are in the unit frame.
#[derive(Debug, Clone)]
pub struct Octree {
    /// `order[i]` is the input's index of `points[i]`.
    pub order: Vec<u32>,
    /// The points in Morton order.
    pub points: Vec<Vec3>,
    /// Parents before children, the root first.
    pub nodes: Vec<Node>,
}

impl Octree {
    /// Builds the tree. Cost: n log n, about 45 bytes a point while it is built and 30 afterwards.
    pub fn build(points: &[Vec3]) -> Octree {
        let mut keyed: Vec<(u64, u32)> = points
            .iter()
            .enumerate()
            .map(|(i, &p)| (morton(p), i as u32))
            .collect();
        par::sort(&mut keyed);
        let order: Vec<u32> = keyed.iter().map(|&(_, i)| i).collect();
        drop(keyed);
        let all = 0..points.len();
        let mut tree = Octree {
            points: order.iter().map(|&i| points[i as usize]).collect(),
            order,
            // Two nodes for five points, on surfaces.
            nodes: Vec::with_capacity(points.len() * 9 / 20 + 1),
        };
        tree.nodes.push(tree.node(all, 0));
        let mut next = 0;
        while next < tree.nodes.len() {
            tree.split(next);
            next += 1;
        }
        tree.nodes.shrink_to_fit();
        tree
    }

    /// The points in Morton order, without the tree.
    pub fn into_points(self) -> Vec<Vec3> {
        self.points
    }

    fn node(&self, range: Range<usize>, level: u32) -> Node {
        let (mut lo, mut hi) = (Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY));
        for &p in &self.points[range.clone()] {
            lo = lo.min(p);
            hi = hi.max(p);
        }
        let (start, end) = (range.start as u32, range.end as u32);
        Node {
            start,
            end,
            first_child: 0,
            children: 0,
            level: level as u8,
            lo,
            hi,
        }
    }

    fn key(&self, i: usize) -> u64 {
        morton(self.points[i])
    }

    fn split(&mut self, id: usize) {
        let range = self.nodes[id].range();
        if range.len() <= LEAF {
            return;
        }
        let differing = self.key(range.start) ^ self.key(range.end - 1);
        let first_child = self.nodes.len() as u32;
        if differing == 0 {
            let middle = self.halve(range.clone());
            self.nodes.push(self.node(range.start..middle, MAX_DEPTH));
            self.nodes.push(self.node(middle..range.end, MAX_DEPTH));
        } else {
            // The deepest level whose cell holds the whole range; its children are one level below.
            let shift = (63 - differing.leading_zeros()) / 3 * 3;
            let level = MAX_DEPTH - shift / 3;
            let mut start = range.start;
            while start < range.end {
                let octant = self.key(start) >> shift;
                let rest = &self.points[start..range.end];
                let end = start + rest.partition_point(|&p| morton(p) >> shift == octant);
                self.nodes.push(self.node(start..end, level));
                start = end;
            }
        }
        self.nodes[id].first_child = first_child;
        self.nodes[id].children = (self.nodes.len() as u32 - first_child) as u8;
    }

    /// Sorts points of one deepest cell along its longest side, and says where the second half starts. Copies stay together
    /// unless there is nothing else.
    fn halve(&mut self, range: Range<usize>) -> usize {
        let middle = (range.start + range.end) / 2;
        let Node { lo, hi, .. } = self.node(range.clone(), MAX_DEPTH);
        if lo == hi {
            return middle;
        }
        let size = hi - lo;
        let longest = (0..3).fold(0, |a, b| if size[b] > size[a] { b } else { a });
        let points = self.points[range.clone()].iter();
        let mut sorted: Vec<(Vec3, u32)> = points
            .copied()
            .zip(self.order[range.clone()].iter().copied())
            .collect();
        // By what counts least first: each sort keeps the order of equals.
        sort_by_key(&mut sorted, |&(_, i)| i);
        for turn in [2, 1, 0] {
            sort_by_key(&mut sorted, |&(p, _)| key(p[(longest + turn) % 3]));
        }
        for (k, (p, i)) in range.clone().zip(sorted) {
            (self.points[k], self.order[k]) = (p, i);
        }
        let copies = |k: &usize| self.points[*k] == self.points[k - 1];
        let mut cut = (middle..range.end).chain((range.start + 1..middle).rev());
        cut.find(|k| !copies(k)).unwrap_or(middle)
    }

    /// The coarsest cells for which `stop` is true, or leaves, in Morton order: together they hold every point once.
    pub fn cut(&self, mut stop: impl FnMut(&Node) -> bool) -> Vec<Range<usize>> {
        let mut out = Vec::new();
        let mut stack = vec![0];
        while let Some(id) = stack.pop() {
            let node = &self.nodes[id];
            if node.is_leaf() || stop(node) {
                out.push(node.range());
            } else {
                stack.extend(node.child_ids().rev());
            }
        }
        out
    }

    /// The `k` nearest points, nearest first, equal distances by index; `out` is cleared. About log n + k steps.
    pub fn knn(&self, q: Vec3, k: usize, out: &mut Vec<Neighbor>) {
        out.clear();
        if k > 0 {
            self.knn_below(0, q, k, out);
        }
    }

    fn knn_below(&self, id: usize, q: Vec3, k: usize, out: &mut Vec<Neighbor>) {
        let node = &self.nodes[id];
        if node.is_leaf() {
            for i in node.range() {
                insert(
                    out,
                    k,
                    Neighbor {
                        distance2: self.points[i].distance_squared(q),
                        index: i as u32,
                    },
                );
            }
            return;
        }
        let bound = |out: &[Neighbor]| {
            if out.len() == k {
                out[k - 1].distance2
            } else {
                f32::INFINITY
            }
        };
        for &(d2, child) in self.nearer(node, q, bound(out)).children() {
            if d2 >= bound(out) {
                break;
            }
            self.knn_below(child, q, k, out);
        }
    }

    /// The children of a node whose boxes are nearer to `q` than `bound` (squared), nearest first, equal ones by index.
    fn nearer(&self, node: &Node, q: Vec3, bound: f32) -> Nearer {
        let mut near = Nearer {
            children: [(0.0, 0); 8],
            len: 0,
        };
        for child in node.child_ids() {
            let d2 = self.nodes[child].distance2(q);
            if d2 < bound {
                let mut at = near.len;
                while at > 0 && near.children[at - 1].0 > d2 {
                    near.children[at] = near.children[at - 1];
                    at -= 1;
                }
                near.children[at] = (d2, child);
                near.len += 1;
            }
        }
        near
    }

    /// The nearest point.
    pub fn nearest(&self, q: Vec3) -> Neighbor {
        let mut best = Neighbor {
            distance2: f32::INFINITY,
            index: 0,
        };
        self.nearest_below(0, q, &mut best);
        best
    }

    /// The nearest point, where it is nearer than `found`; else `found`. With a near guess little is looked at.
    pub fn nearer_than(&self, found: Neighbor, q: Vec3) -> Neighbor {
        let mut best = found;
        self.improve_below(0, q, &mut best);
        best
    }

    fn improve_below(&self, id: usize, q: Vec3, best: &mut Neighbor) {
        let node = &self.nodes[id];
        if node.is_leaf() {
            self.nearest_of(node, q, best);
            return;
        }
        for child in node.child_ids() {
            if self.nodes[child].distance2(q) < best.distance2 {
                self.improve_below(child, q, best);
            }
        }
    }

    fn nearest_of(&self, leaf: &Node, q: Vec3, best: &mut Neighbor) {
        for i in leaf.range() {
            let distance2 = self.points[i].distance_squared(q);
            if distance2 < best.distance2 {
                *best = Neighbor {
                    distance2,
                    index: i as u32,
                };
            }
        }
    }

    fn nearest_below(&self, id: usize, q: Vec3, best: &mut Neighbor) {
        let node = &self.nodes[id];
        if node.is_leaf() {
            self.nearest_of(node, q, best);
            return;
        }
        for &(d2, child) in self.nearer(node, q, best.distance2).children() {
            if d2 >= best.distance2 {
                break;
            }
            self.nearest_below(child, q, best);
        }
    }

    /// Appends the points of a box, ascending, until there are more than `most` in `out`; whether all of them are there.
    pub fn gather(&self, lo: Vec3, hi: Vec3, most: usize, out: &mut Vec<u32>) -> bool {
        let within = |i: &u32| {
            let p = self.points[*i as usize];
            p.cmpge(lo).all() && p.cmple(hi).all()
        };
        let mut stack = Vec::with_capacity(64);
        stack.push(0);
        while let Some(id) = stack.pop() {
            let node = &self.nodes[id];
            if node.lo.cmpgt(hi).any() || node.hi.cmplt(lo).any() {
                continue;
            }
            let inside = node.lo.cmpge(lo).all() && node.hi.cmple(hi).all();
            if inside {
                out.extend(node.start..node.end);
            } else if node.is_leaf() {
                out.extend((node.start..node.end).filter(within));
            } else {
                stack.extend(node.child_ids().rev());
            }
            if out.len() > most {
                return false;
            }
        }
        true
    }

    /// Calls `visit` with every point of every leaf that `enter` lets pass with all its ancestors, by index; `enter` gets
    /// a node and its place in [`Octree::nodes`].
    pub fn visit(&self, enter: impl Fn(usize, &Node) -> bool, mut visit: impl FnMut(usize)) {
        // At most 7 siblings wait on each of the 21 levels and of the at most 32 halvings of equal keys.
        let mut stack = Vec::with_capacity(64);
        stack.push(0);
        while let Some(id) = stack.pop() {
            let node = &self.nodes[id];
            if !enter(id, node) {
                continue;
            }
            if node.is_leaf() {
                node.range().for_each(&mut visit);
            } else {
                stack.extend(node.child_ids().rev());
            }
        }
    }
}

/// Children that a query goes down to, with the squared distances to their boxes.
struct Nearer {
    children: [(f32, usize); 8],
    len: usize,
}

impl Nearer {
    fn children(&self) -> &[(f32, usize)] {
        &self.children[..self.len]
    }
}

/// Keeps the `k` smallest by (distance, index), ascending.
fn insert(out: &mut Vec<Neighbor>, k: usize, n: Neighbor) {
    if out.len() == k {
        let last = out[k - 1];
        if (n.distance2, n.index) >= (last.distance2, last.index) {
            return;
        }
        out.pop();
    }
    let mut at = out.len();
    while at > 0 && (out[at - 1].distance2, out[at - 1].index) > (n.distance2, n.index) {
        at -= 1;
    }
    out.insert(at, n);
}

/// Interleaved bits of a position of the unit frame (every coordinate within ±0.5).
fn morton(p: Vec3) -> u64 {
    let cell =
        |x: f32| (((x as f64 + 0.5) * (1u64 << MAX_DEPTH) as f64) as u64).min((1 << MAX_DEPTH) - 1);
    interleave([cell(p.x), cell(p.y), cell(p.z)])
}

/// The Morton code of a cell: the 21 low bits of its coordinates, interleaved.
pub(crate) fn interleave([x, y, z]: [u64; 3]) -> u64 {
    spread(x) << 2 | spread(y) << 1 | spread(z)
}

/// Two zero bits behind each of the 21 low bits.
fn spread(x: u64) -> u64 {
    let x = (x | x << 32) & 0x001F_0000_0000_FFFF;
    let x = (x | x << 16) & 0x001F_0000_FF00_00FF;
    let x = (x | x << 8) & 0x100F_00F0_0F00_F00F;
    let x = (x | x << 4) & 0x10C3_0C30_C30C_30C3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Rng;

    fn cloud(n: usize, duplicates: bool) -> Vec<Vec3> {
        let mut rng = Rng::new(n as u64);
        let mut at = || (rng.uniform() * 0.57 - 0.285) as f32;
        let mut points: Vec<Vec3> = (0..n).map(|_| Vec3::new(at(), at(), at())).collect();
        if duplicates {
            points[n / 4..].fill(Vec3::splat(0.1));
        }
        points
    }

    #[test]
    fn points_of_one_cell_are_told_apart() {
        // All but one within a millionth of the frame: no Morton key tells them apart, and some are copies.
        let mut points = cloud(4000, true);
        points.iter_mut().for_each(|p| *p *= 1e-7);
        points.push(Vec3::splat(0.5));
        let tree = Octree::build(&points);
        let mut order = tree.order.clone();
        order.sort_unstable();
        assert!(order.into_iter().eq(0..4001));
        assert!(
            tree.order
                .iter()
                .zip(&tree.points)
                .all(|(&i, &p)| points[i as usize] == p)
        );
        // Leaves hold what is close together, and copies lie side by side.
        let mean = |nodes: Vec<Range<usize>>| {
            let size = |r: &Range<usize>| tree.points[r.start].distance(tree.points[r.end - 1]);
            nodes.iter().map(size).sum::<f32>() / nodes.len() as f32
        };
        let whole = 1e-7 * 0.57;
        assert!(mean(tree.cut(|node| node.range().len() <= 8)) < 0.2 * whole);
        let first = tree
            .points
            .iter()
            .position(|&p| p == Vec3::splat(0.1) * 1e-7)
            .unwrap();
        assert!(
            tree.points[first..first + 3000]
                .iter()
                .all(|&p| p == tree.points[first])
        );
    }

    #[test]
    fn queries_agree_with_a_scan_of_all_points() {
        for (n, duplicates) in [
            (1, false),
            (7, false),
            (500, false),
            (500, true),
            (3000, true),
        ] {
            let tree = Octree::build(&cloud(n, duplicates));
            let mut found = Vec::new();
            for q in cloud(40, false)
                .into_iter()
                .chain([Vec3::splat(0.1), Vec3::splat(3.0)])
            {
                let mut all: Vec<Neighbor> = (0..n)
                    .map(|i| Neighbor {
                        distance2: tree.points[i].distance_squared(q),
                        index: i as u32,
                    })
                    .collect();
                all.sort_by(|a, b| {
                    a.distance2
                        .total_cmp(&b.distance2)
                        .then(a.index.cmp(&b.index))
                });
                for k in [1, 5, 20] {
                    tree.knn(q, k, &mut found);
                    let d = |v: &[Neighbor]| v.iter().map(|n| n.distance2).collect::<Vec<_>>();
                    assert_eq!(d(&found), d(&all[..k.min(n)]));
                }
                assert_eq!(tree.nearest(q).distance2, all[0].distance2);
                for guess in [all[0], all[n / 2], all[n - 1]] {
                    assert_eq!(tree.nearer_than(guess, q).distance2, all[0].distance2);
                }
                let mut seen = Vec::new();
                let within = |p: Vec3| p.distance_squared(q) <= 0.2 * 0.2;
                tree.visit(
                    |_, node| node.distance2(q) <= 0.2 * 0.2,
                    |i| seen.extend(within(tree.points[i]).then_some(i as u32)),
                );
                let mut inside: Vec<u32> = all
                    .iter()
                    .filter(|n| n.distance2 <= 0.2 * 0.2)
                    .map(|n| n.index)
                    .collect();
                inside.sort_unstable();
                assert_eq!(seen, inside);
            }
        }
    }

    #[test]
    fn cuts_hold_every_point_once_and_cells_are_tight() {
        let input = cloud(5000, true);
        let tree = Octree::build(&input);
        for capacity in [1, 10, 100, 10_000] {
            let mut next = 0;
            for range in tree.cut(|node| node.range().len() <= capacity) {
                assert_eq!(range.start, next);
                next = range.end;
            }
            assert_eq!(next, 5000);
        }
        for node in &tree.nodes {
            assert!(
                tree.points[node.range()]
                    .iter()
                    .all(|&p| p.cmpge(node.lo).all() && p.cmple(node.hi).all())
            );
        }
        assert!(
            tree.order
                .iter()
                .zip(&tree.points)
                .all(|(&i, &p)| input[i as usize] == p)
        );
    }

    #[test]
    fn a_hundred_thousand_equal_points_are_no_trap() {
        let tree = Octree::build(&vec![Vec3::splat(0.25); 100_000]);
        let mut found = Vec::new();
        for _ in 0..1000 {
            tree.knn(Vec3::ZERO, 16, &mut found);
            assert_eq!(found.len(), 16);
        }
    }
}
