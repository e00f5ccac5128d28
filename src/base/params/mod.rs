//! Every option with its unit, range, default and the paper's symbol. JS sees the same fields in camel case.
//!
//! They stand in one table, `table.rs`. Their types, defaults and checks here are made of it, and all that JavaScript, the
//! command line and the page say of them.

#[macro_use]
mod rows;

use crate::base::error::Result;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

include!("table.rs");

/// The name that stands for a cloud's colours in [`ReduceParams::attributes`].
pub const COLORS: &str = "colors";

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

/// `reduce: false` in JS is `None` here.
mod reduce_or_false {
    use super::ReduceParams;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    #[derive(Serialize, Deserialize)]
    #[serde(untagged)]
    enum OrFalse {
        False(bool),
        Params(Box<ReduceParams>),
    }

    pub fn serialize<S: Serializer>(value: &Option<ReduceParams>, s: S) -> Result<S::Ok, S::Error> {
        match value {
            None => s.serialize_bool(false),
            Some(p) => p.serialize(s),
        }
    }

    pub fn deserialize<'a, D: Deserializer<'a>>(d: D) -> Result<Option<ReduceParams>, D::Error> {
        match OrFalse::deserialize(d)? {
            OrFalse::False(false) => Ok(None),
            OrFalse::False(true) => Err(D::Error::custom(
                "reduce is true: expected false or an object",
            )),
            OrFalse::Params(p) => Ok(Some(*p)),
        }
    }
}
