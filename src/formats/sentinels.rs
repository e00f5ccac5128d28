//! Values that stand for "nothing was measured here", and are no points.
//!
//! - **No data**: a coordinate that writers use for a missing one (-9999, -32768, …) and that lies further beyond all other
//!   coordinates of its axis than they extend; and any of 1e30 or more (rasters have ∓3.4e38, 1.7e38 or 1e38).
//! - **No return**: points at exactly 0 0 0 or another place of equal coordinates (-1 -1 -1), or at exactly the sensor's place, where there are many of them and other
//!   places are not repeated as often. A file that has every point many times, or corners of its own for each triangle,
//!   repeats its other places, too.
//!
//! Only the whole file tells, so points are handed on as they come, and what is left out is said at the end.

/// A coordinate of this size or more is none.
pub(super) const HUGE: f64 = 1e30;

/// Coordinates that writers have for missing ones, in order; those that single precision rounds in both spellings.
const NO_DATA: [f64; 35] = [
    -1e20_f32 as f64,
    -1e20,
    -1e10,
    -2_147_483_648.0,
    -999_999.0,
    -99_999.0,
    -88_888.0,
    -32_768.0,
    -32_767.0,
    -9999.99_f32 as f64,
    -9999.99,
    -9999.9_f32 as f64,
    -9999.9,
    -9999.0,
    -8888.0,
    -7777.0,
    -6999.0,
    -999.9_f32 as f64,
    -999.9,
    -999.25,
    -999.0,
    -99.0,
    9999.0,
    9999.99,
    9999.99_f32 as f64,
    65_535.0,
    99_999.0,
    99_999.99,
    99_999.99_f32 as f64,
    999_999.0,
    2_147_483_647.0,
    2_147_483_648.0,
    1e10,
    1e20,
    1e20_f32 as f64,
];

/// Which of [`NO_DATA`] a coordinate is.
fn no_data(x: f64) -> Option<usize> {
    // Nearly all coordinates are told apart by this alone.
    let may_be = x.abs() >= 99.0 && (x == x.trunc() || (999.0..1e5).contains(&x.abs()));
    let found = || NO_DATA.binary_search_by(|value| value.total_cmp(&x)).ok();
    may_be.then(found)?
}

/// Other places whose repetitions are counted.
const PEERS: usize = 16;

/// Places of equal coordinates that are counted.
const MOST_EQUAL: usize = 4;

/// A place is repeated this many times as often as its peers before its points count as no returns.
const OFTEN: u64 = 4;

/// Bounds of points, and what single precision does to them.
#[derive(Clone, Copy)]
pub(super) struct Span {
    pub(super) low: [f64; 3],
    pub(super) high: [f64; 3],
    /// The most that rounding to single precision moves a coordinate.
    pub(super) rounding: f64,
    rows: u64,
}

impl Span {
    const EMPTY: Span = Span {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
        rounding: 0.0,
        rows: 0,
    };

    fn add(&mut self, position: [f64; 3]) {
        self.rows += 1;
        for (axis, x) in position.into_iter().enumerate() {
            self.low[axis] = self.low[axis].min(x);
            self.high[axis] = self.high[axis].max(x);
            self.rounding = self.rounding.max((f64::from(x as f32) - x).abs());
        }
    }

    fn and(self, other: Span) -> Span {
        Span {
            low: [0, 1, 2].map(|axis| self.low[axis].min(other.low[axis])),
            high: [0, 1, 2].map(|axis| self.high[axis].max(other.high[axis])),
            rounding: self.rounding.max(other.rounding),
            rows: self.rows + other.rows,
        }
    }
}

/// What may be left out of a file's points.
pub(super) struct Sentinels {
    /// Of the points that are none of these, and of those that may be.
    ordinary: Span,
    odd: Span,
    /// Rows with each value of [`NO_DATA`], by axis.
    no_data: [[u64; NO_DATA.len()]; 3],
    huge: u64,
    /// 0 0 0, then the sensors; and points at each.
    places: Vec<([f64; 3], u64)>,
    /// Which of them is the sensor of now.
    sensor: usize,
    /// The first places whose three coordinates are equal (-1 -1 -1), and points at each.
    equal: Vec<([f64; 3], u64)>,
    /// The first other places, and points at each.
    peers: Vec<([f64; 3], u64)>,
}

impl Default for Sentinels {
    fn default() -> Sentinels {
        Sentinels {
            ordinary: Span::EMPTY,
            odd: Span::EMPTY,
            no_data: [[0; NO_DATA.len()]; 3],
            huge: 0,
            places: vec![([0.0; 3], 0)],
            sensor: 0,
            equal: Vec::new(),
            peers: Vec::new(),
        }
    }
}

impl Sentinels {
    /// Points from here on were seen from this place.
    pub(super) fn seen_from(&mut self, sensor: [f64; 3]) {
        let known = self.places.iter().position(|(place, _)| *place == sensor);
        self.sensor = known.unwrap_or_else(|| {
            self.places.push((sensor, 0));
            self.places.len() - 1
        });
    }

    pub(super) fn add(&mut self, position: [f64; 3]) {
        let mut odd = false;
        for (axis, x) in position.into_iter().enumerate() {
            if x.abs() >= HUGE {
                self.huge += 1;
                odd = true;
            } else if let Some(i) = no_data(x) {
                self.no_data[axis][i] += 1;
                odd = true;
            }
        }
        for i in [0, self.sensor] {
            if !odd && self.places[i].0 == position {
                self.places[i].1 += 1;
                odd = true;
            }
        }
        let [x, y, z] = position;
        if !odd && x == y && y == z {
            odd = count_at(&mut self.equal, position, MOST_EQUAL);
        }
        if odd {
            self.odd.add(position);
            return;
        }
        self.ordinary.add(position);
        count_at(&mut self.peers, position, PEERS);
    }

    /// What is left out.
    pub(super) fn verdict(&self) -> LeftOut {
        let Span {
            low, high, rows, ..
        } = self.ordinary;
        let mut out = LeftOut::default();
        if rows == 0 {
            return out;
        }
        out.huge = self.huge > 0;
        for axis in 0..3 {
            let extent = high[axis] - low[axis];
            let beyond = |x: f64| x < low[axis] - extent || x > high[axis] + extent;
            let found = NO_DATA.iter().zip(&self.no_data[axis]);
            let values = found.filter(|(value, count)| **count > 0 && beyond(**value));
            out.no_data[axis] = values.map(|(value, _)| *value).collect();
        }
        let usual = self.peers.iter().map(|(_, count)| *count).max();
        let usual = usual.unwrap_or(0).max(1);
        let many = |count: u64| {
            let all = rows + self.odd.rows;
            rows >= 4 && count >= 3 && (count >= 20 || 100 * count >= all) && count > OFTEN * usual
        };
        let places = self.places.iter().chain(&self.equal);
        let places = places.filter(|(_, count)| many(*count));
        out.no_returns = places.map(|(place, _)| *place).collect();
        out
    }

    /// Bounds of the points that are not left out.
    pub(super) fn span(&self, left_out: &LeftOut) -> Span {
        let all = self.no_data.iter().zip(&left_out.no_data);
        let no_data = all.into_iter().all(|(counts, out)| {
            let mut found = NO_DATA.iter().zip(counts).filter(|(_, count)| **count > 0);
            found.all(|(value, _)| out.contains(value))
        });
        let places = self.places.iter().chain(&self.equal);
        let mut places = places.filter(|(_, count)| *count > 0);
        let no_return = places.all(|(place, _)| left_out.no_returns.contains(place));
        if no_data && no_return && (left_out.huge || self.huge == 0) {
            self.ordinary
        } else {
            self.ordinary.and(self.odd)
        }
    }
}

/// Counts a point at its place, where it is one of the first; whether it is.
fn count_at(places: &mut Vec<([f64; 3], u64)>, position: [f64; 3], most: usize) -> bool {
    if let Some(known) = places.iter_mut().find(|(place, _)| *place == position) {
        known.1 += 1;
        return true;
    }
    let room = places.len() < most;
    if room {
        places.push((position, 1));
    }
    room
}

/// Which points are left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LeftOut {
    /// Those with a coordinate of 1e30 or more.
    pub huge: bool,
    /// Those with one of these coordinates, by axis.
    pub no_data: [Vec<f64>; 3],
    /// Those at one of these places.
    pub no_returns: Vec<[f64; 3]>,
}

/// Why a point is left out.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Why {
    NoData,
    NoReturn,
}

impl LeftOut {
    /// Whether nothing is.
    pub fn is_empty(&self) -> bool {
        !self.huge && self.no_returns.is_empty() && self.no_data.iter().all(Vec::is_empty)
    }

    pub(super) fn why(&self, position: [f64; 3]) -> Option<Why> {
        let mut axes = position.iter().zip(&self.no_data);
        if axes.any(|(x, values)| values.contains(x) || (self.huge && x.abs() >= HUGE)) {
            return Some(Why::NoData);
        }
        self.no_returns.contains(&position).then_some(Why::NoReturn)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_in_order() {
        assert!(NO_DATA.is_sorted());
        for (i, value) in NO_DATA.iter().enumerate() {
            assert_eq!(no_data(*value), Some(i));
        }
        assert_eq!([0.5, 455_000.25, -9998.5].map(no_data), [None; 3]);
    }

    #[test]
    fn no_returns_of_a_sensor_that_scans_again_are_found() {
        let (first, second) = ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]);
        let mut sentinels = Sentinels::default();
        for (sensor, missing) in [(first, 0), (second, 0), (first, 30)] {
            sentinels.seen_from(sensor);
            (0..100).for_each(|i| sentinels.add([10.0, f64::from(i), 0.0]));
            (0..missing).for_each(|_| sentinels.add(sensor));
        }
        assert_eq!(sentinels.verdict().no_returns, [first]);
    }
}
