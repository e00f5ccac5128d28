//! Every option with its unit, range, default and the paper's symbol. JS sees the same fields in camel case.
//!
//! They stand in one table, `table.rs`. Their types, defaults and checks here are made of it, and all that JavaScript, the
//! command line and the page say of them.

#[macro_use]
mod rows;
mod given;

use crate::base::error::Result;
use std::collections::BTreeMap;

pub use given::Value;

include!("table.rs");

/// The name that stands for a cloud's colours in [`ReduceParams::attributes`].
pub const COLORS: &str = "colors";

impl Boundary {
    /// Whether every rim is closed.
    pub(crate) fn closes(self) -> bool {
        matches!(self, Boundary::Closed | Boundary::Base)
    }
}

impl Target {
    /// How many of `n` points it keeps, where that does not hang on the surface.
    pub fn count(self, n: usize) -> Option<usize> {
        match self {
            Target::Ratio(ratio) => Some(((n as f64 * ratio).round() as usize).clamp(1, n)),
            Target::Count(count) => Some(count.min(n)),
            Target::Tolerance(_) | Target::Flatness(_) => None,
        }
    }
}

/// `false` is `None` here.
impl given::Given for Option<ReduceParams> {
    fn given(value: &dyn Value) -> Option<Self> {
        match value.switch() {
            Some(reduce) => (!reduce).then_some(None),
            None => ReduceParams::given(value).ok().map(Some),
        }
    }
}
