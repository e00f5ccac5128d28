//! Options from a language without types: what its value is turned into, row by row of the table.
//!
//! A value is asked through one `dyn` trait, so that the code exists once for all options: a reader of their own for every
//! struct, enum and field, as serde derives them, was a tenth of the engine.

use crate::base::error::{Error, Result};
use std::collections::BTreeMap;

/// A value of another language: a number, a word, yes or no, or an object of such.
pub trait Value {
    /// What it is, if it is a number.
    fn number(&self) -> Option<f64>;
    /// What it is, if it is yes or no.
    fn switch(&self) -> Option<bool>;
    /// What it is, if it is text.
    fn word(&self) -> Option<String>;
    /// Its properties, if it is an object; those that are undefined are left out.
    fn entries(&self) -> Option<Vec<(String, Box<dyn Value>)>>;
}

/// A type that an option can have.
pub(super) trait Given: Sized {
    /// `None` where the value is of another kind.
    fn given(value: &dyn Value) -> Option<Self>;
}

/// Puts what is given of an option into its place.
pub(super) fn take<T: Given>(option: &str, value: &dyn Value, place: &mut T) -> Result<()> {
    *place = T::given(value).ok_or_else(|| unknown(option))?;
    Ok(())
}

/// Ranges have errors of their own; what is of the wrong kind altogether has this.
#[cold]
pub(super) fn unknown(option: &str) -> Error {
    Error::BadOption {
        option: option.into(),
        expected: "a value as the reference has it".into(),
        found: "another".into(),
    }
}

impl Given for f64 {
    fn given(value: &dyn Value) -> Option<Self> {
        value.number()
    }
}

/// A number without a fraction, from 0 to 2⁵³.
fn integer(value: &dyn Value) -> Option<u64> {
    const MOST: f64 = 9_007_199_254_740_992.0;
    let number = value.number()?;
    let is_integer = (0.0..=MOST).contains(&number) && number == libm::trunc(number);
    is_integer.then_some(number as u64)
}

macro_rules! integers {
    ($($ty:ty),*) => { $(
        impl Given for $ty {
            fn given(value: &dyn Value) -> Option<Self> {
                integer(value)?.try_into().ok()
            }
        }
    )* };
}
integers!(u32, u64, usize);

impl Given for bool {
    fn given(value: &dyn Value) -> Option<Self> {
        value.switch()
    }
}

impl<T: Given> Given for Option<T> {
    fn given(value: &dyn Value) -> Option<Self> {
        T::given(value).map(Some)
    }
}

impl<T: Given> Given for BTreeMap<String, T> {
    fn given(value: &dyn Value) -> Option<Self> {
        let entries = value.entries()?.into_iter();
        entries
            .map(|(name, value)| Some((name, T::given(&*value)?)))
            .collect()
    }
}
