//! Which triangles' boxes meet: found by an octree of their centres, eight at a time.

use crate::base::lanes::{LANES, Lanes, places_within};
use crate::cloud::octree::Octree;
use crate::mesh::surface::Mesh;
use glam::Vec3;

/// Triangles with their boxes, in the order of an octree of their centres.
pub(crate) struct Boxes {
    pub(crate) tree: Octree,
    pub(crate) boxes: Vec<(Vec3, Vec3)>,
    /// Of every node of the tree, how far its triangles' boxes reach beyond their centres.
    reach: Vec<f32>,
}

impl Boxes {
    pub(crate) fn new(mesh: &Mesh) -> Boxes {
        let bounds = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| mesh.vertices[v as usize]);
            (a.min(b).min(c), a.max(b).max(c))
        };
        let of: Vec<(Vec3, Vec3)> = mesh.triangles.iter().map(bounds).collect();
        let centers: Vec<Vec3> = of.iter().map(|&(lo, hi)| (lo + hi) / 2.0).collect();
        let tree = Octree::build(&centers);
        let boxes: Vec<(Vec3, Vec3)> = tree.order.iter().map(|&t| of[t as usize]).collect();
        let beyond = |i: usize| {
            let (lo, hi) = boxes[i];
            let center = tree.points[i];
            (hi - center).max(center - lo).max_element()
        };
        let beyond: Vec<f32> = (0..boxes.len()).map(beyond).collect();
        let reach = tree.largest(&beyond);
        Boxes { tree, boxes, reach }
    }

    /// The triangles whose boxes may meet one from `lo` to `hi`.
    pub(crate) fn near(&self, (lo, hi): (Vec3, Vec3), near: &mut Near) {
        near.clear();
        self.tree.visit(
            |id, node| {
                let reach = Vec3::splat(self.reach[id]);
                meet((node.lo - reach, node.hi + reach), (lo, hi))
            },
            |i| {
                if meet(self.boxes[i], (lo, hi)) {
                    near.push(i as u32, self.boxes[i]);
                }
            },
        );
        near.fill();
    }
}

/// Triangles near each other, by their places in the tree, with their boxes' sides one after the other; the memory of one worker.
#[derive(Default)]
pub(crate) struct Near {
    places: Vec<u32>,
    low: [Vec<f32>; 3],
    high: [Vec<f32>; 3],
    /// Which of them meet a box.
    met: Vec<u32>,
}

impl Near {
    fn clear(&mut self) {
        self.places.clear();
        self.low
            .iter_mut()
            .chain(&mut self.high)
            .for_each(Vec::clear);
    }

    fn push(&mut self, place: u32, (lo, hi): (Vec3, Vec3)) {
        self.places.push(place);
        for axis in 0..3 {
            self.low[axis].push(lo[axis]);
            self.high[axis].push(hi[axis]);
        }
    }

    /// Whole blocks of lanes.
    fn fill(&mut self) {
        let whole = self.places.len().next_multiple_of(LANES);
        for side in self.low.iter_mut().chain(&mut self.high) {
            side.resize(whole, 0.0);
        }
    }

    /// The places of those whose boxes meet this one.
    pub(crate) fn meeting(&mut self, (lo, hi): (Vec3, Vec3)) -> impl Iterator<Item = usize> {
        let (low, high) = (&self.low, &self.high);
        let apart = |start: usize| {
            let axes = [0, 1, 2].map(|axis| {
                let below = Lanes::load(&low[axis][start..]) - Lanes::splat(hi[axis]);
                let above = Lanes::splat(lo[axis]) - Lanes::load(&high[axis][start..]);
                below.max(above)
            });
            axes[0].max(axes[1]).max(axes[2])
        };
        places_within(self.places.len(), 0.0, apart, &mut self.met);
        self.met.iter().map(|&k| self.places[k as usize] as usize)
    }
}

fn meet(a: (Vec3, Vec3), b: (Vec3, Vec3)) -> bool {
    a.0.cmple(b.1).all() && b.0.cmple(a.1).all()
}
