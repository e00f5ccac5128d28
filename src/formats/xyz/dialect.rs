//! How the lines of a table are taken apart: what stands between values, and what the decimal mark is.

use super::value::{Value, number_of, value_of};

/// What stands between the values of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Delimiter {
    /// One mark; two in a row have an empty value between them.
    Mark(u8),
    /// Any number of blanks and tabs.
    Blanks,
    /// Commas and blanks, any number of them.
    Any,
    /// Commas that have a blank behind them: others are decimal marks.
    CommaBlank,
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

impl Dialect {
    /// What a caller calls the delimiter.
    pub(super) fn delimiter_name(self) -> char {
        match self.delimiter {
            Delimiter::Mark(mark) => mark.into(),
            Delimiter::CommaBlank => ',',
            Delimiter::Blanks | Delimiter::Any => ' ',
        }
    }

    /// The values of a line, without quotes.
    pub(super) fn split(self, line: &[u8]) -> impl Iterator<Item = &[u8]> {
        let mut rest = Some(match self.delimiter {
            // Tabs at the ends have empty values beside them.
            Delimiter::Mark(b'\t') => line,
            _ => unwrapped(line.trim_ascii()),
        });
        std::iter::from_fn(move || {
            let mut line = rest?;
            if matches!(self.delimiter, Delimiter::Blanks | Delimiter::Any) {
                let blanks = (0..line.len()).take_while(|&at| self.divides(line, at));
                line = &line[blanks.count()..];
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

    fn divides(self, line: &[u8], at: usize) -> bool {
        let byte = line[at];
        match self.delimiter {
            Delimiter::CommaBlank => {
                byte == b',' && line.get(at + 1).is_none_or(|b| b.is_ascii_whitespace())
            }
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
            Some((&quote @ (b'"' | b'\''), inside)) => {
                closing_quote(inside, quote).map(|at| blanks + at + 2)
            }
            _ => None,
        };
        let from = closing.unwrap_or(0);
        let end = (from..line.len()).find(|&at| self.divides(line, at));
        end.unwrap_or(line.len())
    }

    /// What a value says.
    pub(super) fn value(self, token: &[u8]) -> Value {
        value_of(token, self.decimal_comma)
    }
}

/// Whether most lines have at least three values with commas and blanks between them, two of them with decimal commas.
pub(super) fn is_comma_blank<'a>(lines: impl Iterator<Item = &'a [u8]>) -> bool {
    let dialect = Dialect {
        delimiter: Delimiter::CommaBlank,
        decimal_comma: true,
    };
    let (mut all, mut marked) = (0, 0);
    for line in lines {
        let tokens: Vec<&[u8]> = dialect.split(line).collect();
        let mut decimal = tokens.iter().filter(|token| token.contains(&b','));
        let two = decimal.clone().count() >= 2;
        let right = decimal.all(|token| number_of(token, true).is_some());
        all += 1;
        marked += usize::from(tokens.len() >= 3 && two && right);
    }
    2 * marked > all
}

/// Where a quote ends; a doubled one is a character of the text.
fn closing_quote(inside: &[u8], quote: u8) -> Option<usize> {
    let mut at = 0;
    loop {
        at += inside.get(at..)?.iter().position(|&b| b == quote)?;
        if inside.get(at + 1) != Some(&quote) {
            return Some(at);
        }
        at += 2;
    }
}

/// A row without the brackets around it.
fn unwrapped(line: &[u8]) -> &[u8] {
    let Some(inside) = line.strip_prefix(b"(").or(line.strip_prefix(b"[")) else {
        return line;
    };
    let inside = inside
        .strip_suffix(b",")
        .or(inside.strip_suffix(b";"))
        .unwrap_or(inside);
    let Some(inside) = inside.strip_suffix(b")").or(inside.strip_suffix(b"]")) else {
        return line;
    };
    if inside.iter().any(|b| b"()[]".contains(b)) {
        line
    } else {
        inside.trim_ascii()
    }
}

fn unquoted(value: &[u8]) -> &[u8] {
    match value {
        [b'"', inside @ .., b'"'] | [b'\'', inside @ .., b'\''] => inside.trim_ascii(),
        _ => value,
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
    fn quotes_are_doubled_and_rows_stand_in_brackets() {
        assert_eq!(
            split(Delimiter::Mark(b','), "1,\"a \"\"b\"\", c\",2"),
            ["1", "a \"\"b\"\", c", "2"]
        );
        assert_eq!(split(Delimiter::Mark(b','), "(1, 2, 3),"), ["1", "2", "3"]);
        assert_eq!(split(Delimiter::Blanks, "[1 2 3]"), ["1", "2", "3"]);
        assert_eq!(split(Delimiter::Mark(b','), "[m],[m]"), ["[m]", "[m]"]);
        assert_eq!(
            split(Delimiter::CommaBlank, "1,5, -2, 3,25"),
            ["1,5", "-2", "3,25"]
        );
    }
}
