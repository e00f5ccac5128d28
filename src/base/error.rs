//! What can go wrong, each case with a stable code, where it happened, what was expected and what was found.

/// A result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// An error. [`Error::code`] is stable across versions; the message is not.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// The cloud has no points.
    #[error("the cloud is empty: at least one point is needed")]
    EmptyCloud,
    /// Too few points for what was asked.
    #[error("too few points: {found} found, at least {needed} needed")]
    TooFewPoints {
        /// How many are needed.
        needed: usize,
        /// How many there are.
        found: usize,
    },
    /// An array has the wrong number of values.
    #[error("{array} has {found} values: expected {expected}")]
    BadLength {
        /// Which array.
        array: String,
        /// What its length should be, in words (`"a multiple of 3"`, `"36000"`).
        expected: String,
        /// Its length.
        found: usize,
    },
    /// A triangle's corner is no point.
    #[error("indices[{index}] is {found}: there are {points} points")]
    BadIndex {
        /// Where in the array.
        index: usize,
        /// How many points there are.
        points: usize,
        /// The value.
        found: u32,
    },
    /// A coordinate or another value is NaN or infinite.
    #[error("{array} of point {index} is {found}: expected a finite number")]
    NonFinite {
        /// Which array.
        array: String,
        /// Which point.
        index: usize,
        /// The value.
        found: f64,
    },
    /// An option is out of its range.
    #[error("option {option} is {found}: expected {expected}")]
    BadOption {
        /// The option's name, as in the JS interface.
        option: String,
        /// Its range in words.
        expected: String,
        /// The value.
        found: String,
    },
    /// No surface can pass through these points.
    #[error("no surface can be fitted: {found}; expected points that span a surface")]
    Degenerate {
        /// Why, in words.
        found: String,
    },
    /// No reader knows this content.
    #[error("the file's format is not known: expected {expected}, found {found}")]
    UnknownFormat {
        /// The formats that can be read.
        expected: String,
        /// How the content starts.
        found: String,
    },
    /// A format that holds triangles alone was asked for points.
    #[error(
        "STL and 3MF files hold triangles, and there are none: write points as PLY, XYZ, GLB, OBJ, PCD or LAS"
    )]
    NeedsTriangles,
    /// The file's content breaks its format's rules.
    #[error("bad {format} file at {place} {at}: expected {expected}, found {found}")]
    BadFile {
        /// The format's name.
        format: &'static str,
        /// What `at` counts: `"line"` (from 1) or `"byte"` (from 0).
        place: &'static str,
        /// Where.
        at: u64,
        /// What should have been there.
        expected: String,
        /// What was there.
        found: String,
    },
    /// The file is of a kind of its format that is not read.
    #[error("this {format} file cannot be read: {found}; expected {expected}")]
    UnsupportedFile {
        /// The format's name.
        format: &'static str,
        /// What is supported.
        expected: String,
        /// What the file holds.
        found: String,
    },
    /// The caller's [`crate::Progress`] asked to stop.
    #[error("cancelled")]
    Cancelled,
    /// A defect of this crate, caught.
    #[error("internal error: {0}")]
    Internal(String),
}

impl Error {
    /// [`Error::BadOption`] of these words.
    pub(crate) fn bad_option(option: &str, expected: &str, found: &str) -> Error {
        Error::BadOption {
            option: option.into(),
            expected: expected.into(),
            found: found.into(),
        }
    }

    /// The stable code, the same in Rust and in JS.
    pub fn code(&self) -> &'static str {
        match self {
            Error::EmptyCloud => "empty-cloud",
            Error::TooFewPoints { .. } => "too-few-points",
            Error::BadLength { .. } => "bad-length",
            Error::BadIndex { .. } => "bad-index",
            Error::NonFinite { .. } => "non-finite",
            Error::BadOption { .. } => "bad-option",
            Error::Degenerate { .. } => "degenerate",
            Error::UnknownFormat { .. } => "unknown-format",
            Error::NeedsTriangles => "needs-triangles",
            Error::BadFile { .. } => "bad-file",
            Error::UnsupportedFile { .. } => "unsupported-file",
            Error::Cancelled => "cancelled",
            Error::Internal(_) => "internal",
        }
    }

    /// The point, line or byte where it happened, where there is one.
    pub fn index(&self) -> Option<u64> {
        match self {
            Error::NonFinite { index, .. } | Error::BadIndex { index, .. } => Some(*index as u64),
            Error::BadFile { at, .. } => Some(*at),
            _ => None,
        }
    }

    /// What was expected, in words.
    pub fn expected(&self) -> Option<String> {
        match self {
            Error::EmptyCloud => Some("at least one point".into()),
            Error::TooFewPoints { needed, .. } => Some(format!("at least {needed} points")),
            Error::BadIndex { points, .. } => Some(format!("a number under {points}")),
            Error::NeedsTriangles => Some("a mesh".into()),
            Error::NonFinite { .. } => Some("a finite number".into()),
            Error::Degenerate { .. } => Some("points that span a surface".into()),
            Error::BadLength { expected, .. }
            | Error::BadOption { expected, .. }
            | Error::UnknownFormat { expected, .. }
            | Error::BadFile { expected, .. }
            | Error::UnsupportedFile { expected, .. } => Some(expected.clone()),
            Error::Cancelled | Error::Internal(_) => None,
        }
    }

    /// What was found instead, in words.
    pub fn found(&self) -> Option<String> {
        match self {
            Error::EmptyCloud => Some("0 points".into()),
            Error::TooFewPoints { found, .. } => Some(format!("{found} points")),
            Error::BadLength { found, .. } => Some(found.to_string()),
            Error::BadIndex { found, .. } => Some(found.to_string()),
            Error::NeedsTriangles => Some("points alone".into()),
            Error::NonFinite { found, .. } => Some(found.to_string()),
            Error::BadOption { found, .. }
            | Error::Degenerate { found }
            | Error::UnknownFormat { found, .. }
            | Error::BadFile { found, .. }
            | Error::UnsupportedFile { found, .. } => Some(found.clone()),
            Error::Cancelled | Error::Internal(_) => None,
        }
    }
}
