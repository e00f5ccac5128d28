//! What a value of a table of text says: a number in the spellings of many programs and languages, a colour, nothing, or text.

use super::super::text::{decimal_comma, decoded, number};

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

/// What a value says.
pub(super) fn value_of(token: &[u8], decimal_comma: bool) -> Value {
    if token.is_empty() {
        return Value::Empty;
    }
    match number_of(token, decimal_comma) {
        Some(value) => Value::Number(value),
        None if is_none(token) => Value::Number(f64::NAN),
        None => match hex(token, true) {
            Some(color) => Value::Hex(color),
            None => other_number(token, decimal_comma).map_or(Value::Text, Value::Number),
        },
    }
}

/// A number with one decimal mark and nothing else.
pub(super) fn number_of(token: &[u8], comma: bool) -> Option<f64> {
    if comma && token.contains(&b',') {
        decimal_comma(token)
    } else {
        number(token)
    }
}

/// A number with a unit behind it, with a minus as printers set it, or in groups of three digits.
fn other_number(token: &[u8], comma: bool) -> Option<f64> {
    const UNITS: [&str; 9] = ["mm", "cm", "km", "m", "ft", "in", "deg", "°", "\""];
    const MOST: usize = 40;
    if token.len() > MOST || !token.iter().any(u8::is_ascii_digit) {
        return None;
    }
    let text = decoded(token);
    let unit = UNITS.iter().find_map(|unit| text.strip_suffix(unit));
    let bare = unit.map_or(text.as_str(), str::trim_end);
    let bare = bare.replace(['\u{2212}', '\u{2013}'], "-");
    let (sign, digits) = match bare.strip_prefix('-') {
        Some(digits) => (-1.0, digits),
        None => (1.0, bare.as_str()),
    };
    if !digits.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let value = number_of(digits.as_bytes(), comma).or_else(|| grouped(digits, comma))?;
    Some(sign * value)
}

/// Digits in groups of three: `2'612'345.1`, `612,345.12`, `3.512.345,12`. A mark that could be the decimal one has to be there twice, or
/// the other one behind it.
fn grouped(text: &str, comma: bool) -> Option<f64> {
    let (decimal, other) = if comma { (',', '.') } else { ('.', ',') };
    let (whole, places) = text.split_once(decimal).unwrap_or((text, ""));
    let is_mark = |c: char| c == other || "' _\u{2019}\u{a0}\u{202f}\u{2009}".contains(c);
    let mark = whole.chars().find(|c| is_mark(*c))?;
    let groups: Vec<&str> = whole.split(mark).collect();
    let digits = |text: &&str| text.bytes().all(|b| b.is_ascii_digit());
    let right =
        (1..=3).contains(&groups[0].len()) && groups[1..].iter().all(|group| group.len() == 3);
    let sure = mark != other || groups.len() > 2 || !places.is_empty();
    if !(right && sure && groups.iter().all(digits) && digits(&places)) {
        return None;
    }
    format!("{}.{places}", groups.concat()).parse().ok()
}

/// Spellings of "none" that are no number's.
fn is_none(token: &[u8]) -> bool {
    const NONE: [&str; 26] = [
        "na",
        "n/a",
        "#n/a",
        "<na>",
        "n.a.",
        "null",
        "(null)",
        "\\n",
        "none",
        "nil",
        "nodata",
        "no data",
        "no_data",
        "no-data",
        "missing",
        "invalid",
        "undefined",
        "undef",
        "-",
        "--",
        "---",
        "*",
        "?",
        "...",
        "#div/0!",
        "#value!",
    ];
    let is = |none: &&str| token.eq_ignore_ascii_case(none.as_bytes());
    NONE.iter().any(is) || token.iter().all(|&b| b == b'*')
}

/// A colour in one value: hexadecimal digits, or `rgb(0, 40, 90)` and what is like it.
pub(super) fn color(token: &[u8]) -> Option<f64> {
    hex(token, false).or_else(|| triple(token))
}

/// Three numbers of a byte, or four with the opacity, within one value.
fn triple(token: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(token).ok()?;
    let text = text.trim_start_matches(|c: char| c.is_ascii_alphabetic());
    let inside = text.trim_matches(|c: char| "()[]{}".contains(c) || c == ' ');
    let parts = inside
        .split(|c: char| ",; ".contains(c))
        .filter(|part| !part.is_empty());
    let values: Option<Vec<u8>> = parts.take(5).map(|part| part.parse().ok()).collect();
    match values?.as_slice() {
        [r, g, b] | [r, g, b, _] => Some(f64::from(u32::from_be_bytes([0, *r, *g, *b]))),
        _ => None,
    }
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

    #[test]
    fn hexadecimal_colours_have_six_or_eight_digits() {
        assert_eq!(hex(b"#ff8000", true), Some(16_744_448.0));
        assert_eq!(hex(b"0x80FF8000", true), Some(16_744_448.0));
        assert_eq!(hex(b"#ff800080", true), Some(16_744_448.0));
        assert_eq!(hex(b"ff8000", false), Some(16_744_448.0));
        assert_eq!(hex(b"ff8000", true), None);
        assert_eq!(hex(b"#ff80", true), None);
    }

    #[test]
    fn numbers_of_printers_and_offices() {
        for (token, comma, value) in [
            ("2'612'345.10", false, 2_612_345.1),
            ("2\u{2019}612\u{2019}345", false, 2_612_345.0),
            ("612,345.12", false, 612_345.12),
            ("1,234,567", false, 1_234_567.0),
            ("3.512.345,12", true, 3_512_345.12),
            ("612\u{a0}345,5", true, 612_345.5),
            ("\u{2212}0.5", false, -0.5),
            ("12.5 m", false, 12.5),
            ("-3,5mm", true, -3.5),
        ] {
            assert_eq!(
                value_of(token.as_bytes(), comma),
                Value::Number(value),
                "{token}"
            );
        }
        for token in ["612,345", "1'23", "12,34,567.8", "a'234", "m", "-", "1 m 2"] {
            assert!(
                !matches!(value_of(token.as_bytes(), false), Value::Number(value) if !value.is_nan()),
                "{token}"
            );
        }
    }

    #[test]
    fn colours_in_one_value() {
        for token in [
            "002850",
            "#002850",
            "rgb(0, 40, 80)",
            "0,40,80",
            "[0 40 80]",
            "rgba(0,40,80,255)",
        ] {
            assert_eq!(color(token.as_bytes()), Some(10_320.0), "{token}");
        }
        for token in ["red", "0,40", "0,40,300", "1.5,2,3", "0 1 2 3 4"] {
            assert_eq!(color(token.as_bytes()), None, "{token}");
        }
    }
}
