//! Disjoint sets.

/// Disjoint sets of `0..n`; the smallest member names its set.
#[derive(Debug, Clone)]
pub(crate) struct Sets(Vec<u32>);

impl Sets {
    pub(crate) fn new(n: usize) -> Sets {
        Sets((0..n as u32).collect())
    }

    pub(crate) fn find(&mut self, i: u32) -> u32 {
        let mut i = i;
        while self.0[i as usize] != i {
            let up = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = up;
            i = up;
        }
        i
    }

    pub(crate) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b) as usize] = a.min(b);
    }

    /// The number of each member's set, in the order of their least members, and how many sets there are.
    pub(crate) fn numbered(self) -> (Vec<u32>, usize) {
        let (mut of, mut count) = (self.0, 0);
        for i in 0..of.len() {
            // A link leads to a lesser member, which has its number already.
            let up = of[i] as usize;
            of[i] = if up == i {
                count += 1;
                count - 1
            } else {
                of[up]
            };
        }
        (of, count as usize)
    }
}
