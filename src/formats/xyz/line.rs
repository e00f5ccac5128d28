//! Tells what kind a line of a table is: blank or comment, count, row, other.

use super::super::text::quote;
use super::dialect::Dialect;
use super::value::Value;

/// A line of the file.
pub(super) struct Numbered {
    pub(super) number: u64,
    pub(super) bytes: Vec<u8>,
}

/// Why there is no plan.
pub(super) enum NoPlan {
    /// Nothing in the lines is a row or names columns.
    Nothing,
    /// A line is wrong.
    Line {
        number: u64,
        expected: String,
        found: String,
    },
}

impl NoPlan {
    pub(super) fn line(line: &Numbered, expected: impl Into<String>) -> NoPlan {
        NoPlan::Line {
            number: line.number,
            expected: expected.into(),
            found: quote(&line.bytes),
        }
    }
}

/// Whether a line says nothing: a comment, or blanks and what systems put at the end of a file (a NUL, a substitute).
pub(super) fn is_comment(line: &[u8]) -> bool {
    let line = line.trim_ascii_start();
    !is_said(line)
        || line.starts_with(b"//")
        || line.first().is_some_and(|mark| b"#%!".contains(mark))
}

/// Whether a line has more than blanks and control characters.
pub(super) fn is_said(line: &[u8]) -> bool {
    line.iter().any(|&b| b > b' ')
}

/// What a line is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Line {
    /// Blank, or a comment.
    Nothing,
    /// One whole number.
    Count(u64),
    /// Three numbers or more.
    Row,
    Other,
}

pub(super) fn line_of(line: &[u8], dialect: Dialect) -> Line {
    if is_comment(line) {
        return Line::Nothing;
    }
    let (mut numbers, mut said) = (0, 0);
    let mut first = Value::Empty;
    for token in dialect.split(line) {
        let value = dialect.value(token);
        numbers += u64::from(matches!(value, Value::Number(_) | Value::Hex(_)));
        if value != Value::Empty {
            said += 1;
            first = if said == 1 { value } else { first };
        }
    }
    match (said, first) {
        (0, _) => Line::Nothing,
        (1, Value::Number(count)) if count >= 0.0 && count.fract() == 0.0 => {
            Line::Count(count as u64)
        }
        _ if numbers >= 3 => Line::Row,
        _ => Line::Other,
    }
}
