//! How the lines of a table are taken apart: what stands between values, and what the decimal mark is.

use super::super::text::number;

/// What stands between the values of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Delimiter {
    /// One mark; two in a row have an empty value between them.
    Mark(u8),
    /// Any number of blanks and tabs.
    Blanks,
    /// Commas and blanks, any number of them.
    Any,
}

/// How lines are taken apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Dialect {
    pub(super) delimiter: Delimiter,
    pub(super) decimal_comma: bool,
}

/// All that are tried; of those that fit as well, the first counts.
pub(super) const DIALECTS: [Dialect; 11] = {
    const fn dialect(delimiter: Delimiter, decimal_comma: bool) -> Dialect {
        Dialect {
            delimiter,
            decimal_comma,
        }
    }
    [
        dialect(Delimiter::Mark(b';'), true),
        dialect(Delimiter::Mark(b';'), false),
        dialect(Delimiter::Mark(b'\t'), false),
        dialect(Delimiter::Mark(b'\t'), true),
        dialect(Delimiter::Mark(b'|'), false),
        dialect(Delimiter::Mark(b'|'), true),
        dialect(Delimiter::Mark(b','), false),
        dialect(Delimiter::Mark(b','), true),
        dialect(Delimiter::Blanks, false),
        dialect(Delimiter::Blanks, true),
        dialect(Delimiter::Any, false),
    ]
};

/// A value's text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Value {
    /// A number; NaN in all its spellings, which are also those of databases and spreadsheets for "none".
    Number(f64),
    /// A colour as hexadecimal digits with a mark before them.
    Hex(f64),
    Empty,
    Text,
}

impl Dialect {
    /// What a caller calls the delimiter.
    pub(super) fn delimiter_name(self) -> char {
        match self.delimiter {
            Delimiter::Mark(mark) => mark.into(),
            Delimiter::Blanks | Delimiter::Any => ' ',
        }
    }

    /// The values of a line, without quotes.
    pub(super) fn split(self, line: &[u8]) -> impl Iterator<Item = &[u8]> {
        let mut rest = Some(match self.delimiter {
            // Tabs at the ends have empty values beside them.
            Delimiter::Mark(b'\t') => line,
            _ => line.trim_ascii(),
        });
        std::iter::from_fn(move || {
            let mut line = rest?;
            if !matches!(self.delimiter, Delimiter::Mark(_)) {
                let between = |b: &&u8| self.divides(**b);
                line = &line[line.iter().take_while(between).count()..];
                if line.is_empty() {
                    rest = None;
                    return None;
                }
            }
            let end = self.end_of_value(line);
            rest = line.get(end + 1..);
            Some(unquoted(line[..end].trim_ascii()))
        })
    }

    fn divides(self, byte: u8) -> bool {
        match self.delimiter {
            Delimiter::Mark(mark) => byte == mark,
            Delimiter::Blanks => byte.is_ascii_whitespace(),
            Delimiter::Any => byte.is_ascii_whitespace() || byte == b',',
        }
    }

    /// Where the first value ends; a delimiter within quotes is none.
    fn end_of_value(self, line: &[u8]) -> usize {
        let quoted = line.trim_ascii_start();
        let blanks = line.len() - quoted.len();
        let closing = match quoted.split_first() {
            Some((&quote @ (b'"' | b'\''), inside)) => inside
                .iter()
                .position(|&b| b == quote)
                .map(|at| blanks + at + 2),
            _ => None,
        };
        let from = closing.unwrap_or(0);
        let end = line[from..].iter().position(|&b| self.divides(b));
        end.map_or(line.len(), |end| from + end)
    }

    /// What a value says.
    pub(super) fn value(self, token: &[u8]) -> Value {
        if token.is_empty() {
            return Value::Empty;
        }
        let found = if self.decimal_comma && token.contains(&b',') {
            decimal_comma(token)
        } else {
            number(token)
        };
        match found {
            Some(value) => Value::Number(value),
            None if is_none(token) => Value::Number(f64::NAN),
            None => hex(token, true).map_or(Value::Text, Value::Hex),
        }
    }
}

/// A number whose one comma has digits on both sides.
fn decimal_comma(token: &[u8]) -> Option<f64> {
    let at = token.iter().position(|&b| b == b',')?;
    let (before, after) = (token[..at].last()?, token.get(at + 1)?);
    let digits = before.is_ascii_digit() && after.is_ascii_digit();
    if !digits || token.contains(&b'.') {
        return None;
    }
    let mut text = token.to_vec();
    text[at] = b'.';
    number(&text)
}

fn unquoted(value: &[u8]) -> &[u8] {
    match value {
        [b'"', inside @ .., b'"'] | [b'\'', inside @ .., b'\''] => inside.trim_ascii(),
        _ => value,
    }
}

/// Spellings of "none" that are no number's.
fn is_none(token: &[u8]) -> bool {
    const NONE: [&str; 12] = [
        "na", "n/a", "#n/a", "null", "none", "nil", "nodata", "no data", "-", "--", "*", "?",
    ];
    let is = |none: &&str| token.eq_ignore_ascii_case(none.as_bytes());
    NONE.iter().any(is) || token.iter().all(|&b| b == b'*')
}

/// A colour as six or eight hexadecimal digits, after `#` or `0x` where they are `marked`.
pub(super) fn hex(token: &[u8], marked: bool) -> Option<f64> {
    let digits = match token {
        [b'#', digits @ ..] | [b'0', b'x' | b'X', digits @ ..] => digits,
        digits if !marked => digits,
        _ => return None,
    };
    let text = std::str::from_utf8(digits).ok()?;
    let value = u32::from_str_radix(text, 16).ok()?;
    match digits.len() {
        6 => Some(f64::from(value)),
        // `#RRGGBBAA` of the web: the colour comes first.
        8 if token[0] == b'#' => Some(f64::from(value >> 8)),
        8 => Some(f64::from(value & 0xff_ffff)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(delimiter: Delimiter, line: &str) -> Vec<String> {
        let dialect = Dialect {
            delimiter,
            decimal_comma: false,
        };
        let text = |value: &[u8]| String::from_utf8_lossy(value).into_owned();
        dialect.split(line.as_bytes()).map(text).collect()
    }

    #[test]
    fn values_are_empty_between_marks_and_never_between_blanks() {
        assert_eq!(split(Delimiter::Mark(b','), "1, ,3,"), ["1", "", "3", ""]);
        assert_eq!(split(Delimiter::Mark(b'\t'), "\t1\t"), ["", "1", ""]);
        assert_eq!(split(Delimiter::Blanks, " 1 \t 3  "), ["1", "3"]);
        assert_eq!(split(Delimiter::Any, "1, 2 ,3"), ["1", "2", "3"]);
        assert_eq!(split(Delimiter::Blanks, "   "), [""; 0]);
        assert_eq!(
            split(Delimiter::Mark(b','), "\"a,b\", 'c',d\"e"),
            ["a,b", "c", "d\"e"]
        );
    }

    #[test]
    fn a_decimal_comma_has_digits_on_both_sides() {
        assert_eq!(decimal_comma(b"-1,5e3"), Some(-1500.0));
        for token in [&b"1,"[..], b",5", b"1,2,3", b"1.0,5", b"1, 5"] {
            assert_eq!(decimal_comma(token), None);
        }
    }

    #[test]
    fn hexadecimal_colours_have_six_or_eight_digits() {
        assert_eq!(hex(b"#ff8000", true), Some(16_744_448.0));
        assert_eq!(hex(b"0x80FF8000", true), Some(16_744_448.0));
        assert_eq!(hex(b"#ff800080", true), Some(16_744_448.0));
        assert_eq!(hex(b"ff8000", false), Some(16_744_448.0));
        assert_eq!(hex(b"ff8000", true), None);
        assert_eq!(hex(b"#ff80", true), None);
    }
}
