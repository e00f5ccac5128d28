//! A linear octree: points in Morton order, every cell a contiguous range of them, one tree for all neighbour queries
//! ([`crate::cloud::queries`]) and for the sub-domains of section 3.
//!
//! Nodes store the tight box of their points, so a query prunes as well as in a kd-tree. Levels in which all points fall
//! into one octant make no node. Points that share all 21 bits an axis are cut in the middle of their longest side, copies by
//! index, so neither costs more than others.

use crate::base::sort_keys::{key, sort_by_key, sort_pairs};
use crate::cloud::morton::{MAX_DEPTH, morton};
use glam::Vec3;
use std::ops::Range;

/// Points of a leaf: small enough that a scan is cheaper than another level.
const LEAF: usize = 8;

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
    /// A leaf that does not know its box yet.
    fn unboxed(range: Range<usize>, level: u32) -> Node {
        Node {
            start: range.start as u32,
            end: range.end as u32,
            first_child: 0,
            children: 0,
            level: level as u8,
            lo: Vec3::ZERO,
            hi: Vec3::ZERO,
        }
    }

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
    #[inline]
    pub fn distance2(&self, q: Vec3) -> f32 {
        (self.lo - q)
            .max(q - self.hi)
            .max(Vec3::ZERO)
            .length_squared()
    }
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
    /// Builds the tree: sorts by key, cuts from the root down, then finds the boxes from the leaves up. Cost: n for the order, n
    /// log n for the cuts; about 45 bytes a point while it is built and 30 afterwards.
    pub fn build(points: &[Vec3]) -> Octree {
        let mut keyed: Vec<(u64, u32)> = points
            .iter()
            .enumerate()
            .map(|(i, &p)| (morton(p), i as u32))
            .collect();
        sort_pairs(&mut keyed);
        let order: Vec<u32> = keyed.iter().map(|&(_, i)| i).collect();
        drop(keyed);
        let all = 0..points.len();
        let mut tree = Octree {
            points: order.iter().map(|&i| points[i as usize]).collect(),
            order,
            // Two nodes for five points, on surfaces.
            nodes: Vec::with_capacity(points.len() * 9 / 20 + 1),
        };
        tree.nodes.push(Node::unboxed(all, 0));
        let mut next = 0;
        while next < tree.nodes.len() {
            tree.split(next);
            next += 1;
        }
        tree.find_boxes();
        tree.nodes.shrink_to_fit();
        tree
    }

    /// Of every node the largest of its points' values, in the tree's order; at least 0.
    pub fn largest(&self, values: &[f32]) -> Vec<f32> {
        let of = |node: &Node| values[node.range()].iter().copied().fold(0.0, f32::max);
        self.nodes.iter().map(of).collect()
    }

    /// The points in Morton order, without the tree.
    pub fn into_points(self) -> Vec<Vec3> {
        self.points
    }

    /// The boxes of all nodes, leaves of their points, others of their children's.
    fn find_boxes(&mut self) {
        // Children come behind their parents.
        for id in (0..self.nodes.len()).rev() {
            let node = &self.nodes[id];
            let (lo, hi) = if node.is_leaf() {
                box_of(self.points[node.range()].iter().map(|&p| (p, p)))
            } else {
                let children = &self.nodes[node.child_ids()];
                box_of(children.iter().map(|child| (child.lo, child.hi)))
            };
            (self.nodes[id].lo, self.nodes[id].hi) = (lo, hi);
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
            self.nodes
                .push(Node::unboxed(range.start..middle, MAX_DEPTH));
            self.nodes.push(Node::unboxed(middle..range.end, MAX_DEPTH));
        } else {
            // The deepest level whose cell holds the whole range; its children are one level below.
            let shift = (63 - differing.leading_zeros()) / 3 * 3;
            let level = MAX_DEPTH - shift / 3;
            let mut start = range.start;
            while start < range.end {
                let octant = self.key(start) >> shift;
                let rest = &self.points[start..range.end];
                let end = start + rest.partition_point(|&p| morton(p) >> shift == octant);
                self.nodes.push(Node::unboxed(start..end, level));
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
        let (lo, hi) = box_of(self.points[range.clone()].iter().map(|&p| (p, p)));
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
}

/// The box around boxes.
fn box_of(boxes: impl Iterator<Item = (Vec3, Vec3)>) -> (Vec3, Vec3) {
    let none = (Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY));
    boxes.fold(none, |all, one| (all.0.min(one.0), all.1.max(one.1)))
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
}
