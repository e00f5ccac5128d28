//! Which pieces of surface a lattice cell holds: the case table of dual marching cubes, made from its rule.
//!
//! Corner `c` of a cell lies at `(c & 1, c >> 1 & 1, c >> 2)`. Edge `4 a + s` runs along axis `a` from the corner whose
//! coordinates along the two axes that follow `a` cyclically are the two bits of `s`. Face `2 a + s` has coordinate `s`
//! along axis `a`. A corner is inside where its bit in `signs` is set; an edge is crossed where its ends differ.
//!
//! On each face the crossed edges are joined in pairs: two of them by one segment; four, where opposite corners agree
//! (an *ambiguous* face), by two segments, which join the inside corners across the face if its bit in `joined` is set
//! and cut each of them off otherwise. Segments close to loops around the cell, 1 to 4 of them, and every loop is the
//! rim of one disk of the surface: the dual mesh has one vertex for it (G. M. Nielson, "Dual marching cubes", 2004).

/// The two corners of an edge, the lower one first.
pub(crate) fn edge_corners(edge: usize) -> [usize; 2] {
    let (a, s) = (edge / 4, edge % 4);
    let low = (s & 1) << ((a + 1) % 3) | (s >> 1) << ((a + 2) % 3);
    [low, low | 1 << a]
}

/// The corners of a face, in order around it.
pub(crate) fn face_corners(face: usize) -> [usize; 4] {
    let (a, s) = (face / 2, face % 2);
    let (b, c) = (1 << ((a + 1) % 3), 1 << ((a + 2) % 3));
    [0, b, b | c, c].map(|corner| s << a | corner)
}

/// The edges of a face: the `i`-th joins the corners `i` and `i + 1` of [`face_corners`].
fn face_edges(face: usize) -> [usize; 4] {
    let corners = face_corners(face);
    [0, 1, 2, 3].map(|i| edge_between(corners[i], corners[(i + 1) % 4]))
}

fn edge_between(p: usize, q: usize) -> usize {
    let (a, low) = ((p ^ q).trailing_zeros() as usize, p & q);
    4 * a + (low >> ((a + 1) % 3) & 1) + 2 * (low >> ((a + 2) % 3) & 1)
}

/// The faces whose corners alternate between inside and outside.
pub(crate) fn ambiguous_faces(signs: u8) -> u8 {
    let alternates = |face: usize| {
        let [p, q, r, s] = face_corners(face).map(|c| signs >> c & 1);
        p == r && q == s && p != q
    };
    (0..6)
        .filter(|&f| alternates(f))
        .fold(0, |mask, f| mask | 1 << f)
}

/// The loops of one cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Loops {
    /// Two bits an edge: the loop that passes through it.
    of_edge: u32,
    /// Bit `e` is set where edge `e` is crossed.
    crossed: u16,
    count: u8,
}

impl Loops {
    /// How many loops there are, 0 to 4.
    pub(crate) fn count(self) -> usize {
        self.count as usize
    }

    /// The loop through a crossed edge.
    pub(crate) fn through(self, edge: usize) -> usize {
        (self.of_edge >> (2 * edge) & 3) as usize
    }

    /// The edges of one loop.
    pub(crate) fn edges(self, index: usize) -> impl Iterator<Item = usize> {
        (0..12).filter(move |&e| self.crossed >> e & 1 == 1 && self.through(e) == index)
    }

    /// Whether both segments on an ambiguous face belong to one loop.
    pub(crate) fn meets_twice(self, face: usize) -> bool {
        let [p, q, r, s] = face_edges(face).map(|e| self.through(e));
        p == q && q == r && r == s
    }

    /// Joins the segments on the six faces to loops.
    fn trace(signs: u8, joined: u8) -> Loops {
        let inside = |corner: usize| signs >> corner & 1 == 1;
        let mut partners = [[usize::MAX; 2]; 12];
        let mut join = |p: usize, q: usize| {
            for (from, to) in [(p, q), (q, p)] {
                let slot = usize::from(partners[from][0] != usize::MAX);
                partners[from][slot] = to;
            }
        };
        let is_crossed = |e: usize| {
            edge_corners(e).map(inside) == [true, false]
                || edge_corners(e).map(inside) == [false, true]
        };
        for face in 0..6 {
            let (corners, edges) = (face_corners(face), face_edges(face));
            if ambiguous_faces(signs) >> face & 1 == 1 {
                let cut_off_inside = joined >> face & 1 == 0;
                for i in (0..4).filter(|&i| inside(corners[i]) == cut_off_inside) {
                    join(edges[(i + 3) % 4], edges[i]);
                }
            } else {
                let mut crossed = edges.into_iter().filter(|&e| is_crossed(e));
                if let (Some(p), Some(q)) = (crossed.next(), crossed.next()) {
                    join(p, q);
                }
            }
        }
        let mut loops = Loops::default();
        for start in (0..12).filter(|&e| is_crossed(e)) {
            if loops.crossed >> start & 1 == 1 {
                continue;
            }
            let (mut previous, mut edge) = (usize::MAX, start);
            while loops.crossed >> edge & 1 == 0 {
                loops.crossed |= 1 << edge;
                loops.of_edge |= (loops.count as u32) << (2 * edge);
                let [p, q] = partners[edge];
                (previous, edge) = (edge, if p == previous { q } else { p });
            }
            loops.count += 1;
        }
        loops
    }
}

/// [`Loops`] for every combination of signs and ambiguous faces.
pub(crate) struct LoopTable(Vec<Loops>);

impl LoopTable {
    /// About a millisecond of work.
    pub(crate) fn new() -> LoopTable {
        let entry = |i: usize| {
            let (signs, joined) = (i as u8, (i >> 8) as u8);
            let possible = joined & !ambiguous_faces(signs) == 0;
            if possible {
                Loops::trace(signs, joined)
            } else {
                Loops::default()
            }
        };
        LoopTable((0..1 << 14).map(entry).collect())
    }

    /// `joined` holds bits of ambiguous faces only.
    pub(crate) fn get(&self, signs: u8, joined: u8) -> Loops {
        self.0[signs as usize | (joined as usize) << 8]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every valid (signs, joined) with its entry.
    fn entries() -> Vec<(u8, u8, Loops)> {
        let table = LoopTable::new();
        let all = (0..=255u8).flat_map(|s| (0..64u8).map(move |j| (s, j)));
        all.filter(|&(s, j)| j & !ambiguous_faces(s) == 0)
            .map(|(s, j)| (s, j, table.get(s, j)))
            .collect()
    }

    #[test]
    fn every_crossed_edge_has_one_loop_of_at_least_three_edges() {
        for (signs, joined, loops) in entries() {
            let crossed = (0..12)
                .filter(|&e| edge_corners(e).map(|c| signs >> c & 1).iter().sum::<u8>() == 1)
                .count();
            let lengths: Vec<_> = (0..loops.count()).map(|l| loops.edges(l).count()).collect();
            assert_eq!(
                lengths.iter().sum::<usize>(),
                crossed,
                "{signs:08b} {joined:06b}"
            );
            assert!(
                lengths.iter().all(|&n| n >= 3),
                "{signs:08b} {joined:06b} {lengths:?}"
            );
        }
    }

    #[test]
    fn known_cases() {
        let table = LoopTable::new();
        assert_eq!(table.get(0, 0).count(), 0);
        assert_eq!(table.get(0b0000_0001, 0).count(), 1);
        assert_eq!(table.get(0b0000_1111, 0).edges(0).count(), 4);
        // Opposite corners of the cell: two caps. A checkerboard: four caps, whichever side is cut off.
        assert_eq!(table.get(0b1000_0001, 0).count(), 2);
        assert_eq!(table.get(0b0110_1001, 0).count(), 4);
        assert_eq!(table.get(0b0110_1001, 0b11_1111).count(), 4);
        // Two corners across one face: two caps, or one tunnel.
        assert_eq!(ambiguous_faces(0b0000_1001), 0b01_0000);
        assert_eq!(table.get(0b0000_1001, 0).count(), 2);
        assert_eq!(table.get(0b0000_1001, 0b01_0000).count(), 1);
        assert!(table.get(0b0000_1001, 0b01_0000).meets_twice(4));
    }

    /// What Wenger's fix rests on: turning a face that a loop meets twice splits that loop, and merges none.
    #[test]
    fn turning_a_face_that_one_loop_meets_twice_splits_it() {
        let table = LoopTable::new();
        for (signs, joined, loops) in entries() {
            for face in
                (0..6).filter(|&f| ambiguous_faces(signs) >> f & 1 == 1 && loops.meets_twice(f))
            {
                let turned = table.get(signs, joined ^ 1 << face);
                assert_eq!(turned.count(), loops.count() + 1);
                assert!(!turned.meets_twice(face));
                for f in 0..6 {
                    assert!(
                        ambiguous_faces(signs) >> f & 1 == 0
                            || loops.meets_twice(f)
                            || !turned.meets_twice(f)
                    );
                }
            }
        }
    }

    /// Exchanging inside and outside (and cut off with joined) leaves the loops as they are.
    #[test]
    fn complement_has_the_same_loops() {
        let table = LoopTable::new();
        for (signs, joined, loops) in entries() {
            assert_eq!(table.get(!signs, ambiguous_faces(signs) & !joined), loops);
        }
    }
}
