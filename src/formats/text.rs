//! Text in bytes: numbers, and quotes for messages.

/// A number: decimal or exponent notation, `inf` and `nan` in the spellings of C and of Microsoft's run-time, Fortran's
/// `D` for the exponent. `None` for anything else.
pub(super) fn number(token: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(token).ok()?;
    if let Ok(value) = text.parse() {
        return Some(value);
    }
    let lower = text.to_ascii_lowercase();
    let unsigned = lower.trim_start_matches(['+', '-']);
    if unsigned.starts_with("1.#inf") {
        let sign = if lower.starts_with('-') { -1.0 } else { 1.0 };
        return Some(sign * f64::INFINITY);
    }
    if unsigned.starts_with("1.#") || unsigned.starts_with("nan") {
        return Some(f64::NAN);
    }
    let digits = lower.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    if digits && lower.matches('d').count() == 1 {
        return lower.replace('d', "e").parse().ok();
    }
    None
}

/// The values of a line between blanks and tabs.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    line.split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty())
}

/// Bytes for a message: quoted, not longer than 40 characters, control characters escaped.
pub(super) fn quote(bytes: &[u8]) -> String {
    const MOST: usize = 40;
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4 * MOST)]);
    let mut shown: String = text
        .chars()
        .take(MOST)
        .flat_map(char::escape_default)
        .collect();
    if bytes.len() > 4 * MOST || text.chars().count() > MOST {
        shown.push('…');
    }
    format!("\"{shown}\"")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_many_dialects() {
        for (token, value) in [
            ("1", 1.0),
            ("+1.5", 1.5),
            (".5", 0.5),
            ("-7e-2", -0.07),
            ("1.25D+02", 125.0),
            ("2d0", 2.0),
            ("-1.#INF", f64::NEG_INFINITY),
            ("+inf", f64::INFINITY),
        ] {
            assert_eq!(number(token.as_bytes()), Some(value), "{token}");
        }
        for token in ["nan", "-nan", "NaN", "-1.#IND", "1.#QNAN", "nan(ind)"] {
            assert!(number(token.as_bytes()).is_some_and(f64::is_nan), "{token}");
        }
        for token in ["", "x", "1..2", "d", "1e", "0x10", "1,5", "\u{661}"] {
            assert_eq!(number(token.as_bytes()), None, "{token}");
        }
    }

    #[test]
    fn quotes_are_short_and_printable() {
        assert_eq!(quote(b"a\x00\n"), "\"a\\u{0}\\n\"");
        assert!(quote(&[b'x'; 1000]).chars().count() < 50);
    }
}
