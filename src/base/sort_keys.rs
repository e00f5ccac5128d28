//! Whole numbers that sort as what they stand for does.
//!
//! What is sorted in this crate is sorted as `u32`, `u64` or `f32`, with few exceptions: the standard library's sort is
//! compiled once for each type, to some 5 kB of wasm.

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

/// Sorts by keys of 63 bits; equals stay in order. A radix sort, lowest digits first: as many passes over the values as keys have
/// digits, without those in which all are equal.
pub(crate) fn sort_pairs(pairs: &mut Vec<(u64, u32)>) {
    // Few values do not pay for many counters.
    let bits = if pairs.len() < 4096 { 8 } else { 11 };
    let mut counters = vec![0u32; 1 << bits];
    let mut sorted = vec![(0, 0); pairs.len()];
    for shift in (0..63).step_by(bits) {
        let digit = |&(key, _): &(u64, u32)| (key >> shift) as usize & ((1 << bits) - 1);
        counters.fill(0);
        for pair in &*pairs {
            counters[digit(pair)] += 1;
        }
        if counters.contains(&(pairs.len() as u32)) {
            continue;
        }
        let mut before = 0;
        for counter in &mut counters {
            before += std::mem::replace(counter, before);
        }
        for pair in &*pairs {
            let place = &mut counters[digit(pair)];
            sorted[*place as usize] = *pair;
            *place += 1;
        }
        std::mem::swap(pairs, &mut sorted);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Rng;

    #[test]
    fn pairs_are_sorted_as_the_standard_library_sorts_them() {
        let mut rng = Rng::new(1);
        for n in [0, 1, 2, 100, 4095, 4096, 20_000] {
            for shift in [1, 30, 62] {
                let mut pairs: Vec<(u64, u32)> =
                    (0..n).map(|i| (rng.next_u64() >> shift, i)).collect();
                let mut expected = pairs.clone();
                expected.sort();
                sort_pairs(&mut pairs);
                assert!(pairs == expected, "{n} keys of {} bits", 64 - shift);
            }
        }
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
