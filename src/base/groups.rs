//! Values grouped by number, one group after the other in memory.

/// Values grouped by a number from 0 to a count (compressed rows): one counting sort, two arrays.
#[derive(Debug, Clone)]
pub(crate) struct Groups<T> {
    starts: Vec<u32>,
    values: Vec<T>,
}

impl<T: Copy + Default> Groups<T> {
    /// `count` groups of the values that `pairs` gives with their numbers, in its order; it is asked twice.
    pub(crate) fn new<P: Iterator<Item = (u32, T)>>(
        count: usize,
        pairs: impl Fn() -> P,
    ) -> Groups<T> {
        // The group of i ends where that of i + 1 starts: filling moves each start to its end.
        let mut starts = vec![0u32; count + 2];
        pairs().for_each(|(i, _)| starts[i as usize + 2] += 1);
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut values = vec![T::default(); starts[count + 1] as usize];
        for (i, value) in pairs() {
            let next = &mut starts[i as usize + 1];
            values[*next as usize] = value;
            *next += 1;
        }
        starts.truncate(count + 1);
        Groups { starts, values }
    }

    /// How many groups there are.
    pub(crate) fn count(&self) -> usize {
        self.starts.len() - 1
    }

    /// The values of number `i`.
    pub(crate) fn of(&self, i: u32) -> &[T] {
        &self.values[self.starts[i as usize] as usize..self.starts[i as usize + 1] as usize]
    }

    /// The same, to be changed.
    pub(crate) fn of_mut(&mut self, i: u32) -> &mut [T] {
        &mut self.values[self.starts[i as usize] as usize..self.starts[i as usize + 1] as usize]
    }

    /// The groups in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[T]> {
        (0..self.count() as u32).map(|i| self.of(i))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_keep_the_order_of_their_values() {
        let pairs = [(2, 'a'), (0, 'b'), (2, 'c'), (3, 'd'), (2, 'e')];
        let mut groups = Groups::new(5, || pairs.into_iter());
        let all: Vec<&[char]> = groups.iter().collect();
        assert_eq!(all, [&['b'][..], &[], &['a', 'c', 'e'], &['d'], &[]]);
        groups.of_mut(2).reverse();
        assert_eq!((groups.count(), groups.of(2)), (5, &['e', 'c', 'a'][..]));
        assert_eq!(Groups::<u32>::new(0, std::iter::empty).count(), 0);
    }
}
