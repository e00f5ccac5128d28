//! Lists by number, one after the other in memory, and keys that sort as what they stand for does.
//!
//! What is sorted in this crate is sorted as `u32`, `u64` or `f32`, with few exceptions: the standard library's sort is
//! compiled once for each type, to some 5 kB of wasm.

/// Some values for each number from 0 to a count: made by a counting sort.
#[derive(Debug, Clone)]
pub(crate) struct Lists<T> {
    starts: Vec<u32>,
    values: Vec<T>,
}

impl<T: Copy + Default> Lists<T> {
    /// `count` lists of the values that `pairs` gives with their numbers, in its order; it is asked twice.
    pub(crate) fn new<P: Iterator<Item = (u32, T)>>(
        count: usize,
        pairs: impl Fn() -> P,
    ) -> Lists<T> {
        // The list of i ends where that of i + 1 starts: filling moves each start to its end.
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
        Lists { starts, values }
    }

    /// How many lists there are.
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

    /// The lists in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[T]> {
        (0..self.count() as u32).map(|i| self.of(i))
    }
}

/// A whole number that is ordered as [`f32::total_cmp`] orders.
pub(crate) fn key(x: f32) -> u32 {
    let bits = x.to_bits();
    bits ^ (((bits as i32) >> 31) as u32 | 1 << 31)
}

/// The number that has this [`key`].
pub(crate) fn of_key(key: u32) -> f32 {
    f32::from_bits(key ^ (((!key as i32) >> 31) as u32 | 1 << 31))
}

/// Two whole numbers as one that is ordered by the first, then by the second.
pub(crate) fn pack(first: u32, second: u32) -> u64 {
    u64::from(first) << 32 | u64::from(second)
}

/// What [`pack`] put together.
pub(crate) fn unpack(packed: u64) -> (u32, u32) {
    ((packed >> 32) as u32, packed as u32)
}

/// Keys in ascending order, each with the place where it was; equals stay in order.
pub(crate) fn ranked(keys: impl Iterator<Item = u32>) -> Vec<u64> {
    let mut ranked: Vec<u64> = keys.zip(0..).map(|(key, i)| pack(key, i)).collect();
    ranked.sort_unstable();
    ranked
}

/// Sorts values by whole numbers; equals stay in order.
pub(crate) fn sort_by_key<T: Copy>(values: &mut [T], key: impl Fn(&T) -> u32) {
    let before = values.to_vec();
    let order = ranked(before.iter().map(key));
    for (value, packed) in values.iter_mut().zip(order) {
        *value = before[unpack(packed).1 as usize];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_keep_the_order_of_their_values() {
        let pairs = [(2, 'a'), (0, 'b'), (2, 'c'), (3, 'd'), (2, 'e')];
        let mut lists = Lists::new(5, || pairs.into_iter());
        let all: Vec<&[char]> = lists.iter().collect();
        assert_eq!(all, [&['b'][..], &[], &['a', 'c', 'e'], &['d'], &[]]);
        lists.of_mut(2).reverse();
        assert_eq!((lists.count(), lists.of(2)), (5, &['e', 'c', 'a'][..]));
        assert_eq!(Lists::<u32>::new(0, std::iter::empty).count(), 0);
    }

    #[test]
    fn keys_are_ordered_as_what_they_stand_for() {
        let numbers = [
            f32::NEG_INFINITY,
            -2.5,
            -f32::MIN_POSITIVE,
            -0.0,
            0.0,
            1e-30,
            7.0,
            f32::INFINITY,
            f32::NAN,
        ];
        assert!(numbers.windows(2).all(|w| key(w[0]) < key(w[1])));
        assert!(
            numbers
                .iter()
                .all(|x| of_key(key(*x)).to_bits() == x.to_bits())
        );
        assert!(pack(1, u32::MAX) < pack(2, 0));
        assert_eq!(unpack(pack(7, 9)), (7, 9));
    }
}
