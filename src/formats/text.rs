//! Text in bytes: numbers, and quotes for messages.

/// The byte order mark of UTF-8.
pub(super) const MARK: &[u8] = b"\xef\xbb\xbf";

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

/// A number whose one comma has digits on both sides.
pub(super) fn decimal_comma(token: &[u8]) -> Option<f64> {
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

/// The values of a line between blanks and tabs.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    line.split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty())
}

/// Text in UTF-8, or else, as old programs write it, in Latin-1.
pub(super) fn decoded(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.into(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    }
}

/// Bytes for a message: text is quoted, not longer than 40 characters, control characters escaped; other bytes are said
/// as hexadecimal numbers.
pub(super) fn quote(bytes: &[u8]) -> String {
    const MOST: usize = 40;
    const MOST_BYTES: usize = 8;
    let head = &bytes[..bytes.len().min(4 * MOST)];
    // What is behind zeros is no text.
    let zeros = head.windows(2).position(|pair| pair == [0, 0]);
    if let Some(zeros) = zeros.filter(|&zeros| zeros > 0) {
        return quote(&head[..zeros]) + " and zeros";
    }
    // The last character may be cut.
    let whole = match std::str::from_utf8(head) {
        Ok(text) => Some(text),
        Err(error) if error.error_len().is_none() => {
            std::str::from_utf8(&head[..error.valid_up_to()]).ok()
        }
        Err(_) => None,
    };
    let is_latin = head
        .iter()
        .all(|&b| matches!(b, b'\t' | b' '..=b'~' | 0xa0..));
    let text: String = match whole {
        Some(text) => text.into(),
        None if is_latin => decoded(head),
        None => {
            let numbers: Vec<String> = head
                .iter()
                .take(MOST_BYTES)
                .map(|byte| format!("{byte:02x}"))
                .collect();
            let more = if bytes.len() > MOST_BYTES { " …" } else { "" };
            return format!("the bytes {}{more}", numbers.join(" "));
        }
    };
    let mut shown: String = text.chars().take(MOST).flat_map(shown_char).collect();
    if bytes.len() > 4 * MOST || text.chars().count() > MOST {
        shown.push('…');
    }
    format!("\"{shown}\"")
}

/// A letter as it is, a control character or a quote as Rust writes it.
fn shown_char(c: char) -> impl Iterator<Item = char> {
    let plain = !c.is_control() && !['"', '\\'].contains(&c);
    let escaped = (!plain).then(|| c.escape_default());
    plain
        .then_some(c)
        .into_iter()
        .chain(escaped.into_iter().flatten())
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
    fn a_decimal_comma_has_digits_on_both_sides() {
        assert_eq!(decimal_comma(b"-1,5e3"), Some(-1500.0));
        for token in [&b"1,"[..], b",5", b"1,2,3", b"1.0,5", b"1, 5"] {
            assert_eq!(decimal_comma(token), None);
        }
    }

    #[test]
    fn quotes_are_short_and_printable() {
        assert_eq!(quote(b"a\x00\n"), "\"a\\u{0}\\n\"");
        assert!(quote(&[b'x'; 1000]).chars().count() < 50);
        assert_eq!(
            quote(b"\x89PNG\r\n\x1a\n\xff"),
            "the bytes 89 50 4e 47 0d 0a 1a 0a …"
        );
        assert_eq!(quote(b"H\xf6he"), "\"Höhe\"");
        assert_eq!(quote(b"DSRB\0\0\0\x01"), "\"DSRB\" and zeros");
    }
}
