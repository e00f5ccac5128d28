//! Neighbour queries of the octree.

use crate::cloud::octree::{Node, Octree};
use glam::Vec3;

/// A point found by a query.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neighbor {
    /// Squared distance in the unit frame.
    pub distance2: f32,
    /// Index in [`Octree::points`].
    pub index: u32,
}

impl Octree {
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

    /// Whether a point is nearer than `distance`. To find one is less than to find the nearest.
    pub fn has_nearer(&self, q: Vec3, distance: f32) -> bool {
        self.has_nearer_below(0, q, distance * distance)
    }

    fn has_nearer_below(&self, id: usize, q: Vec3, bound: f32) -> bool {
        let node = &self.nodes[id];
        if node.is_leaf() {
            let mut points = self.points[node.range()].iter();
            return points.any(|p| p.distance_squared(q) < bound);
        }
        let near = self.nearer(node, q, bound);
        let mut children = near.children().iter();
        children.any(|&(_, child)| self.has_nearer_below(child, q, bound))
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
pub(crate) fn insert(out: &mut Vec<Neighbor>, k: usize, n: Neighbor) {
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
                let distance = all[0].distance2.sqrt();
                assert!(tree.has_nearer(q, 1.001 * distance + 1e-6));
                assert!(!tree.has_nearer(q, 0.999 * distance));
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
    fn a_hundred_thousand_equal_points_are_no_trap() {
        let tree = Octree::build(&vec![Vec3::splat(0.25); 100_000]);
        let mut found = Vec::new();
        for _ in 0..1000 {
            tree.knn(Vec3::ZERO, 16, &mut found);
            assert_eq!(found.len(), 16);
        }
    }
}
