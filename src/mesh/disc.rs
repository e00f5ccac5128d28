//! A disc of triangles inside of a closed outline.
//!
//! 1. The outline is cut into triangles by its ears (G. H. Meisters, "Polygons have ears", 1975).
//! 2. Vertices are put into large triangles, wider apart the farther in, and edges are flipped until the triangles are as
//!    equal-angled as they get (P. Liepa, "Filling holes in meshes", 2003).

use glam::{DVec2, DVec3};
use std::collections::BTreeMap;

/// New vertices are this many times as far apart as those around them.
const GROWTH: f64 = 1.5;
/// Rounds of new vertices, each of which leaves the triangles about a third as large, and of flips in each.
const ROUNDS: usize = 24;

/// A disc of triangles; the first vertices are the outline's, in the order in which the disc runs through them.
pub(crate) struct Disc<F> {
    /// Two coordinates in a plane, in which the outline runs counter-clockwise, and the height over it.
    pub(crate) at: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// The triangles beside each inner edge, lesser vertex first.
    beside: BTreeMap<(u32, u32), [u32; 2]>,
    /// Wanted distance of a vertex from its neighbours.
    size: Vec<f64>,
    /// Vertices of the outline.
    outline: usize,
    /// Whether no edge may join two vertices of the outline.
    taken: F,
}

impl<F: Fn(u32, u32) -> bool> Disc<F> {
    /// A disc inside of an outline of at least three vertices, without the edges that are `taken`.
    pub(crate) fn new(outline: Vec<DVec3>, taken: F) -> Disc<F> {
        let (n, at) = (outline.len(), outline);
        let near = |i: usize| at[i].distance(at[(i + 1) % n]) + at[i].distance(at[(i + n - 1) % n]);
        let mut disc = Disc {
            triangles: ears(&at),
            beside: BTreeMap::new(),
            size: (0..n).map(|i| near(i) / 2.0).collect(),
            outline: n,
            at,
            taken,
        };
        for t in 0..disc.triangles.len() as u32 {
            disc.enter(t);
        }
        disc.beside.retain(|_, sides| sides[1] != u32::MAX);
        disc.refine();
        disc
    }

    /// Enters a triangle beside its edges, while they are gathered.
    fn enter(&mut self, t: u32) {
        for (a, b) in sides(self.triangles[t as usize]) {
            let entry = self.beside.entry((a.min(b), a.max(b)));
            let sides = entry.or_insert([u32::MAX; 2]);
            sides[usize::from(sides[0] != u32::MAX)] = t;
        }
    }

    /// Puts `new` where `old` was beside an edge, if that is an inner one.
    fn replace(&mut self, a: u32, b: u32, old: u32, new: u32) {
        if let Some(sides) = self.beside.get_mut(&(a.min(b), a.max(b))) {
            let place = usize::from(sides[1] == old);
            sides[place] = new;
        }
    }

    fn add(&mut self, p: DVec3, size: f64) -> u32 {
        self.at.push(p);
        self.size.push(size);
        self.at.len() as u32 - 1
    }

    /// Step 2.
    fn refine(&mut self) {
        self.flip();
        if self.outline == 3 {
            // The very triangle may be beside the outline.
            self.cut(0);
        }
        for _ in 0..ROUNDS {
            let before = self.triangles.len();
            for t in 0..before {
                let corners = self.triangles[t];
                let [a, b, c] = corners.map(|v| self.at[v as usize]);
                let middle = (a + b + c) / 3.0;
                let size = corners.iter().map(|&v| self.size[v as usize]).sum::<f64>() / 3.0;
                let far = |p: DVec3| (p - middle).truncate().length() > GROWTH * size;
                if far(a) && far(b) && far(c) {
                    self.cut(t);
                }
            }
            if self.triangles.len() == before {
                break;
            }
            self.flip();
        }
        // What is taken gets a vertex in its middle.
        let twice: Vec<(u32, u32)> = self.beside.keys().copied().collect();
        for (a, b) in twice {
            if self.is_taken(a, b) {
                self.split(a, b);
            }
        }
    }

    fn is_taken(&self, a: u32, b: u32) -> bool {
        (a.max(b) as usize) < self.outline && (self.taken)(a, b)
    }

    /// Puts a vertex into the middle of a triangle.
    fn cut(&mut self, t: usize) {
        let [a, b, c] = self.triangles[t];
        let corners = [a, b, c];
        let middle = corners.iter().map(|&v| self.at[v as usize]).sum::<DVec3>() / 3.0;
        let size = corners.iter().map(|&v| self.size[v as usize]).sum::<f64>() / 3.0;
        let v = self.add(middle, GROWTH * size);
        let (first, second, third) = (
            t as u32,
            self.triangles.len() as u32,
            self.triangles.len() as u32 + 1,
        );
        self.triangles[t] = [a, b, v];
        self.triangles.extend([[b, c, v], [c, a, v]]);
        self.replace(b, c, first, second);
        self.replace(c, a, first, third);
        self.beside.insert((b, v), [first, second]);
        self.beside.insert((c, v), [second, third]);
        self.beside.insert((a, v), [third, first]);
    }

    /// Puts a vertex into the middle of an inner edge.
    fn split(&mut self, a: u32, b: u32) {
        let Some([s, t]) = self.beside.remove(&(a, b)) else {
            return;
        };
        let (c, d) = (self.opposite(s, a, b), self.opposite(t, a, b));
        let middle = (self.at[a as usize] + self.at[b as usize]) / 2.0;
        let v = self.add(middle, self.size[a as usize]);
        let count = self.triangles.len() as u32;
        for (old, new, apex) in [(s, count, c), (t, count + 1, d)] {
            let corners = self.triangles[old as usize];
            let with = |from: u32| corners.map(|w| if w == from { v } else { w });
            self.triangles.push(with(a));
            self.triangles[old as usize] = with(b);
            self.replace(b, apex, old, new);
            self.beside.insert((apex.min(v), apex.max(v)), [old, new]);
        }
        self.beside.insert((a, v), [s, t]);
        self.beside.insert((b, v), [count, count + 1]);
    }

    fn opposite(&self, t: u32, a: u32, b: u32) -> u32 {
        let corners = self.triangles[t as usize];
        corners.into_iter().find(|&v| v != a && v != b).unwrap_or(a)
    }

    /// Turns edges whose opposite angles are together more than half a turn, in the plane.
    fn flip(&mut self) {
        for _ in 0..ROUNDS {
            let edges: Vec<(u32, u32)> = self.beside.keys().copied().collect();
            let turned = edges.into_iter().filter(|&(a, b)| self.turn(a, b)).count();
            if turned == 0 {
                break;
            }
        }
    }

    fn turn(&mut self, a: u32, b: u32) -> bool {
        let Some(&[s, t]) = self.beside.get(&(a, b)) else {
            return false;
        };
        // s runs from `from` to `to`, t back.
        let runs = sides(self.triangles[s as usize]).contains(&(a, b));
        let (from, to) = if runs { (a, b) } else { (b, a) };
        let (c, d) = (self.opposite(s, a, b), self.opposite(t, a, b));
        let at = |v: u32| self.at[v as usize].truncate();
        let (p, q, r, w) = (at(from), at(to), at(c), at(d));
        // The sine of the sum of the opposite angles.
        let angle = |apex: DVec2| {
            let (u, v) = (p - apex, q - apex);
            let length = (u.length() * v.length()).max(f64::MIN_POSITIVE);
            (u.perp_dot(v).abs() / length, u.dot(v) / length)
        };
        let (r_angle, w_angle) = (angle(r), angle(w));
        let wide = r_angle.0 * w_angle.1 + r_angle.1 * w_angle.0 < -1e-6;
        let area = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
        let convex = area(w, q, r) > 0.0 && area(r, p, w) > 0.0;
        let new = (c.min(d), c.max(d));
        let exists = c == d || self.beside.contains_key(&new) || self.is_side(c, d);
        if !(wide && convex) || exists || self.is_taken(c, d) {
            return false;
        }
        self.beside.remove(&(a, b));
        self.triangles[s as usize] = [d, to, c];
        self.triangles[t as usize] = [c, from, d];
        self.replace(to, d, t, s);
        self.replace(from, c, s, t);
        self.beside.insert(new, [s, t]);
        true
    }

    /// Whether two vertices are neighbours on the outline.
    fn is_side(&self, a: u32, b: u32) -> bool {
        let (n, apart) = (self.outline as u32, a.abs_diff(b));
        a < n && b < n && (apart == 1 || apart == n - 1)
    }
}

fn sides([a, b, c]: [u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)]
}

/// Step 1: the triangles of a polygon that runs counter-clockwise in the plane of the first two coordinates. Where it has no
/// ear, as it crosses itself, its corners go as they come.
fn ears(at: &[DVec3]) -> Vec<[u32; 3]> {
    let n = at.len();
    let p = |v: u32| at[v as usize].truncate();
    let turn = |a: u32, b: u32, c: u32| (p(b) - p(a)).perp_dot(p(c) - p(b));
    let mut left: Vec<u32> = (0..n as u32).collect();
    let mut triangles = Vec::with_capacity(n - 2);
    let (mut k, mut crossed) = (0, false);
    while left.len() > 3 {
        let count = left.len();
        let around = |k: usize| {
            let before = left[(k + count - 1) % count];
            (before, left[k % count], left[(k + 1) % count])
        };
        // A corner that lies in another's ear is a reflex one.
        let all = if crossed { 0 } else { count };
        let reflex: Vec<u32> = (0..all)
            .map(around)
            .filter(|&(a, b, c)| turn(a, b, c) <= 0.0)
            .map(|(_, b, _)| b)
            .collect();
        let is_ear = |&(a, b, c): &(u32, u32, u32)| {
            let inside = |&v: &u32| {
                let inner = |a: u32, b: u32| (p(b) - p(a)).perp_dot(p(v) - p(a)) >= 0.0;
                v != a && v != b && v != c && inner(a, b) && inner(b, c) && inner(c, a)
            };
            turn(a, b, c) > 0.0 && (crossed || !reflex.iter().any(inside))
        };
        let found = (0..count)
            .map(|step| (k + step) % count)
            .find(|&k| is_ear(&around(k)));
        // It has none where it crosses itself: any corner does then.
        crossed |= found.is_none();
        let ear = found.unwrap_or(0);
        let (a, b, c) = around(ear);
        triangles.push([a, b, c]);
        left.remove(ear);
        // The next ear is looked for two corners on, so that they do not make a fan.
        k = (ear + 1) % left.len();
    }
    triangles.push([left[0], left[1], left[2]]);
    triangles
}
