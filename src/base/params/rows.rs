//! From the rows of `table.rs` to types: an enum for each choice, a struct for each set of options, with its defaults and its
//! checks. `xtask/src/options/rows.rs` reads the same rows for JavaScript.

use crate::base::error::{Error, Result};

/// The numbers that an option takes.
pub(super) struct Range {
    pub low: Bound,
    pub high: Bound,
    /// In words, for the error.
    pub expected: &'static str,
}

/// One end of a [`Range`].
pub(super) struct Bound {
    pub at: f64,
    /// Whether the end itself is accepted.
    pub included: bool,
}

impl Range {
    fn contains(&self, value: f64) -> bool {
        let above = value > self.low.at || self.low.included && value == self.low.at;
        let below = value < self.high.at || self.high.included && value == self.high.at;
        above && below
    }
}

/// What has a number to check; `None` where it stands for a default.
pub(super) trait Amount {
    fn amount(&self) -> Option<f64>;
}

macro_rules! amount {
    ($($ty:ty),*) => { $(
        impl Amount for $ty {
            fn amount(&self) -> Option<f64> {
                Some(*self as f64)
            }
        }
    )* };
}
amount!(f64, usize, u32, u64);

impl<T: Amount> Amount for Option<T> {
    fn amount(&self) -> Option<f64> {
        self.as_ref().and_then(Amount::amount)
    }
}

/// `option` is the name in Rust; the error has JavaScript's.
#[inline(never)]
pub(super) fn check(option: &str, value: Option<f64>, range: &Range) -> Result<()> {
    match value {
        Some(found) if !range.contains(found) => Err(Error::BadOption {
            option: camel_case(option),
            expected: range.expected.into(),
            found: found.to_string(),
        }),
        _ => Ok(()),
    }
}

/// `max_depth` is `maxDepth` in JavaScript.
fn camel_case(name: &str) -> String {
    let mut camel = String::with_capacity(name.len());
    let mut is_first = false;
    for letter in name.chars() {
        if letter != '_' {
            camel.push(match is_first {
                true => letter.to_ascii_uppercase(),
                false => letter,
            });
        }
        is_first = letter == '_';
    }
    camel
}

/// Whether `camel` is what JavaScript calls `name`.
#[inline(never)]
pub(super) fn is_camel_case(name: &str, camel: &str) -> bool {
    camel_case(name) == camel
}

macro_rules! table {
    ($( $(#[$attr:meta])* $sort:ident $name:ident { $($rows:tt)* } )*) => {
        $( item! { $sort [$(#[$attr])*] $name { $($rows)* } } )*
    };
}

macro_rules! item {
    (choice [$(#[$attr:meta])*] $name:ident { $( $(#[$doc:meta])* $variant:ident $word:literal $($label:literal)?, )* }) => {
        $(#[$attr])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $name {
            $( $(#[$doc])* $variant, )*
        }

        impl given::Given for $name {
            fn given(value: &dyn Value) -> Option<Self> {
                match &*value.word()? {
                    $( $word => Some($name::$variant), )*
                    _ => None,
                }
            }
        }
    };
    (auto [$(#[$attr:meta])*] $name:ident {
        $(#[$auto_doc:meta])* Auto $word:literal,
        $(#[$doc:meta])* $number:ident,
    }) => {
        $(#[$attr])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub enum $name {
            $(#[$auto_doc])*
            Auto,
            $(#[$doc])*
            $number(f64),
        }

        impl rows::Amount for $name {
            fn amount(&self) -> Option<f64> {
                match *self {
                    $name::Auto => None,
                    $name::$number(value) => Some(value),
                }
            }
        }

        impl given::Given for $name {
            fn given(value: &dyn Value) -> Option<Self> {
                match value.number() {
                    None => (value.word()? == $word).then_some($name::Auto),
                    Some(number) => Some($name::$number(number)),
                }
            }
        }
    };
    (amount [$(#[$attr:meta])*] $name:ident { $(
        $(#[$doc:meta])*
        $kind:ident $variant:ident: $ty:ty, $word:literal $(, $facet:ident($($fact:tt)*))*;
    )* }) => {
        $(#[$attr])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub enum $name {
            $(
                $(#[$doc])*
                $( #[doc = fact!($facet $kind $($fact)*)] )*
                    $variant($ty),
            )*
        }

        impl $name {
            fn validate(&self) -> Result<()> {
                match self {
                    $( $name::$variant(value) => {
                        $( check!($facet $kind value, concat!("target.", $word), $($fact)*); )*
                    } )*
                }
                Ok(())
            }
        }

        impl given::Given for $name {
            fn given(value: &dyn Value) -> Option<Self> {
                let entries = value.entries()?;
                let [(name, amount)] = &*entries else {
                    return None;
                };
                match &**name {
                    $( $word => given::Given::given(&**amount).map($name::$variant), )*
                    _ => None,
                }
            }
        }
    };
    (options [$(#[$attr:meta])*] $name:ident { $(
        $(#[$field_attr:meta])*
        $kind:ident $field:ident: $ty:ty = $default:expr $(, $facet:ident($($fact:tt)*))*;
    )* }) => {
        $(#[$attr])*
        #[derive(Debug, Clone, PartialEq)]
        pub struct $name {
            $(
                $(#[$field_attr])*
                $( #[doc = fact!($facet $kind $($fact)*)] )*
                #[doc = concat!(" Default: `", stringify!($default), "`.")]
                pub $field: $ty,
            )*
        }

        impl Default for $name {
            fn default() -> Self {
                $name { $( $field: $default, )* }
            }
        }

        impl $name {
            /// The options that an object of another language has, in camel case, over the defaults. Ranges are left to
            /// [`Self::validate`].
            ///
            /// # Errors
            /// [`Error::BadOption`](crate::Error::BadOption) for a value of another kind.
            pub fn given(object: &dyn Value) -> Result<Self> {
                let mut options = Self::default();
                let entries = object.entries().ok_or_else(|| given::unknown("options"))?;
                for (name, value) in entries {
                    $( if rows::is_camel_case(stringify!($field), &name) {
                        given::take(&name, &*value, &mut options.$field)?;
                    } )*
                }
                Ok(options)
            }

            /// Checks every range.
            pub fn validate(&self) -> Result<()> {
                $(
                    check!($kind self.$field, stringify!($field));
                    $( check!($facet $kind &self.$field, stringify!($field), $($fact)*); )*
                )*
                Ok(())
            }

            $( $( in_force!($facet $kind $field $($fact)*); )* )*
        }
    };
}

/// The check that a row's kind or one of its facets asks for.
macro_rules! check {
    (amount $value:expr, $option:expr) => { $value.validate()? };
    (nested $value:expr, $option:expr) => {
        if let Some(options) = &$value {
            options.validate()?;
        }
    };
    (range $kind:ident $value:expr, $option:expr, $($range:tt)*) => {
        rows::check($option, rows::Amount::amount($value), &range!($kind $($range)*))?
    };
    ($($other:tt)*) => {};
}

/// What a facet says, as a line of documentation.
macro_rules! fact {
    (range $kind:ident $($range:tt)*) => { concat!("\n\nAccepted: ", expected!($kind $($range)*), ".") };
    (follows $kind:ident $($method:ident $value:literal),*) => { concat!("\n\n`None` stands for", $(" ", $value, " (`", stringify!($method), "`)",)* ".") };
    (default $kind:ident $words:literal) => { concat!("\n\n`None`: ", $words, ".") };
    ($($other:tt)*) => { "" };
}

macro_rules! range {
    ($kind:ident auto or $($range:tt)*) => { range!(@ ($kind auto or $($range)*) $($range)*) };
    ($kind:ident $($range:tt)*) => { range!(@ ($kind $($range)*) $($range)*) };
    (@ ($($all:tt)*) $low:ident $from:literal) => {
        rows::Range { low: bound!($low $from), high: rows::Bound { at: f64::INFINITY, included: true }, expected: expected!($($all)*) }
    };
    (@ ($($all:tt)*) $low:ident $from:literal $high:ident $to:literal) => {
        rows::Range { low: bound!($low $from), high: bound!($high $to), expected: expected!($($all)*) }
    };
}

macro_rules! bound {
    (from $at:literal) => {
        rows::Bound {
            at: $at as f64,
            included: true,
        }
    };
    (above $at:literal) => {
        rows::Bound {
            at: $at as f64,
            included: false,
        }
    };
    (to $at:literal) => {
        rows::Bound {
            at: $at as f64,
            included: true,
        }
    };
    (below $at:literal) => {
        rows::Bound {
            at: $at as f64,
            included: false,
        }
    };
}

/// A range in words, as JavaScript's errors say it.
macro_rules! expected {
    ($kind:ident auto or $($range:tt)*) => { concat!("'auto' or ", expected!($kind $($range)*)) };
    (integer from $from:literal) => { concat!("an integer of at least ", $from) };
    (integer from $from:literal to $to:literal) => { concat!("an integer from ", $from, " to ", $to) };
    (number from $from:literal to $to:literal) => { concat!("a number in [", $from, ", ", $to, "]") };
    (number above $from:literal to $to:literal) => { concat!("a number in (", $from, ", ", $to, "]") };
    (number above $from:literal below $to:literal) => { concat!("a number in (", $from, ", ", $to, ")") };
}

/// The function that gives an option whose default follows the method of the reduction.
macro_rules! in_force {
    (follows number $field:ident $($method:ident $value:literal),*) => {
        in_force!(@ f64 $field $($method $value),*);
    };
    (follows integer $field:ident $($method:ident $value:literal),*) => {
        in_force!(@ usize $field $($method $value),*);
    };
    (@ $ty:ident $field:ident $($method:ident $value:literal),+) => {
        #[doc = concat!("[`", stringify!($field), "`](#structfield.", stringify!($field), "), or the method's default.")]
        pub fn $field(&self, method: Method) -> $ty {
            self.$field.unwrap_or(match method {
                $( Method::$method => $value, )*
            })
        }
    };
    ($($other:tt)*) => {};
}

#[cfg(test)]
mod tests {
    use super::*;

    const HALF_OPEN: Range = Range {
        low: Bound {
            at: 0.0,
            included: false,
        },
        high: Bound {
            at: 1.0,
            included: true,
        },
        expected: "a number in (0, 1]",
    };

    #[test]
    fn an_end_counts_where_it_is_included() {
        for (value, accepted) in [
            (0.0, false),
            (1e-300, true),
            (1.0, true),
            (1.0 + 1e-15, false),
        ] {
            assert_eq!(HALF_OPEN.contains(value), accepted, "{value}");
        }
        assert!(!HALF_OPEN.contains(f64::NAN));
    }

    #[test]
    fn what_is_not_given_is_not_checked_and_errors_have_the_name_in_javascript() {
        assert!(check("max_share", None::<f64>.amount(), &HALF_OPEN).is_ok());
        let error = check("max_share", Some(2.0).amount(), &HALF_OPEN).unwrap_err();
        assert_eq!(
            error.to_string(),
            "option maxShare is 2: expected a number in (0, 1]"
        );
    }
}
