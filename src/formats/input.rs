//! A file's bytes as they come, in slices, and the errors that say where in them something is wrong.

use super::Format;
use super::text::quote;
use crate::base::error::{Error, Result};

/// A line of text is not longer than this: a file without ends of lines is no text.
const LONGEST_LINE: usize = 1 << 20;

/// How a line ended.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Ending {
    LineFeed,
    CarriageReturn,
    Both,
    EndOfFile,
}

/// Where in the file the bytes at hand start.
#[derive(Clone, Copy, Default, Debug, PartialEq)]
pub(super) struct Place {
    /// Bytes before them.
    pub(super) byte: u64,
    /// Lines before them.
    pub(super) line: u64,
}

/// The bytes at hand, and what a parser has taken of them. What it leaves it gets again with the next slice.
pub(super) struct Input<'a> {
    bytes: &'a [u8],
    format: Format,
    /// Bytes of the whole file.
    pub(super) size: u64,
    /// Nothing follows the bytes at hand.
    pub(super) last: bool,
    pub(super) place: Place,
    /// Of the line taken last.
    pub(super) ending: Ending,
}

impl<'a> Input<'a> {
    pub(super) fn new(
        bytes: &'a [u8],
        format: Format,
        size: u64,
        last: bool,
        place: Place,
    ) -> Self {
        let ending = Ending::EndOfFile;
        Input {
            bytes,
            format,
            size,
            last,
            place,
            ending,
        }
    }

    /// All bytes at hand.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.bytes
    }

    /// Bytes of the file that are still to come, those at hand included.
    pub(super) fn left(&self) -> u64 {
        self.size
            .saturating_sub(self.place.byte)
            .max(self.bytes.len() as u64)
    }

    /// The next `length` bytes, once they are at hand.
    pub(super) fn take(&mut self, length: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.bytes.split_at_checked(length)?;
        self.bytes = rest;
        self.place.byte += length as u64;
        Some(taken)
    }

    /// As many of the next `length` bytes as are at hand; how many they were.
    pub(super) fn skip(&mut self, length: u64) -> u64 {
        let here = length.min(self.bytes.len() as u64);
        self.bytes = &self.bytes[here as usize..];
        self.place.byte += here;
        here
    }

    /// The next line without its end, once all of it is at hand; at the end of the file what is left.
    pub(super) fn line(&mut self) -> Result<Option<&'a [u8]>> {
        let found = self.bytes.iter().position(|&b| b == b'\n' || b == b'\r');
        let length = found.unwrap_or(self.bytes.len());
        if length > LONGEST_LINE {
            return Err(self.bad(
                "byte",
                self.place.byte,
                "the end of a line within 1 MiB",
                "none".into(),
            ));
        }
        let (end, ending) = match &self.bytes[length..] {
            [b'\r', b'\n', ..] => (2, Ending::Both),
            // The other half may come with the next slice.
            [b'\r'] if !self.last => return Ok(None),
            [b'\r', ..] => (1, Ending::CarriageReturn),
            [b'\n', ..] => (1, Ending::LineFeed),
            _ if self.last && length > 0 => (0, Ending::EndOfFile),
            _ => return Ok(None),
        };
        let line = &self.bytes[..length];
        self.bytes = &self.bytes[length + end..];
        self.place.byte += (length + end) as u64;
        self.place.line += 1;
        self.ending = ending;
        Ok(Some(line))
    }

    /// Where the input is, for [`Input::go_back`].
    pub(super) fn mark(&self) -> (&'a [u8], Place) {
        (self.bytes, self.place)
    }

    /// Gives back all that was taken since.
    pub(super) fn go_back(&mut self, (bytes, place): (&'a [u8], Place)) {
        (self.bytes, self.place) = (bytes, place);
    }

    /// Gives back the last byte of a line's end that was two: it was not the line's.
    pub(super) fn put_back_line_feed(&mut self, whole: &'a [u8]) {
        self.bytes = &whole[whole.len() - self.bytes.len() - 1..];
        self.place.byte -= 1;
    }

    /// The line taken last is wrong.
    pub(super) fn bad_line(&self, expected: &str, found: &[u8]) -> Error {
        self.bad_value(self.place.line, expected, found)
    }

    /// A value of an earlier line is wrong.
    pub(super) fn bad_value(&self, line: u64, expected: &str, found: &[u8]) -> Error {
        let found = if found.is_empty() {
            "nothing".into()
        } else {
            quote(found)
        };
        self.bad("line", line, expected, found)
    }

    /// An earlier line is wrong.
    pub(super) fn bad_at_line(&self, line: u64, expected: &str, found: String) -> Error {
        self.bad("line", line, expected, found)
    }

    /// The file ends where a line should follow.
    pub(super) fn no_line(&self, expected: &str) -> Error {
        self.bad(
            "line",
            self.place.line + 1,
            expected,
            "the end of the file".into(),
        )
    }

    /// The file ends where `length` bytes should follow.
    pub(super) fn no_bytes(&self, length: u64, of: &str) -> Error {
        let expected = format!("{length} more bytes of {of}");
        let found = format!("{} bytes, then the end of the file", self.left());
        self.bad("byte", self.place.byte, &expected, found)
    }

    /// The byte at `at` is wrong.
    pub(super) fn bad_byte(&self, at: u64, expected: &str, found: impl Into<String>) -> Error {
        self.bad("byte", at, expected, found.into())
    }

    /// The file is of a kind that is not read.
    pub(super) fn unsupported(&self, expected: &str, found: impl Into<String>) -> Error {
        Error::UnsupportedFile {
            format: self.format.title(),
            expected: expected.into(),
            found: found.into(),
        }
    }

    fn bad(&self, place: &'static str, at: u64, expected: &str, found: String) -> Error {
        Error::BadFile {
            format: self.format.title(),
            place,
            at,
            expected: expected.into(),
            found,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input(bytes: &[u8], last: bool) -> Input<'_> {
        Input::new(
            bytes,
            Format::Xyz,
            bytes.len() as u64,
            last,
            Place::default(),
        )
    }

    #[test]
    fn lines_end_in_any_way() {
        let mut text = input(b"a\nb\r\nc\rd\n\ne", true);
        let mut all = Vec::new();
        while let Some(line) = text.line().unwrap() {
            all.push((line, text.ending));
        }
        let ends = [
            Ending::LineFeed,
            Ending::Both,
            Ending::CarriageReturn,
            Ending::LineFeed,
            Ending::LineFeed,
            Ending::EndOfFile,
        ];
        let lines = [&b"a"[..], b"b", b"c", b"d", b"", b"e"];
        assert_eq!(all, lines.into_iter().zip(ends).collect::<Vec<_>>());
        assert_eq!(text.place, Place { byte: 11, line: 6 });
    }

    #[test]
    fn a_line_is_taken_once_its_end_is_there() {
        for (bytes, whole) in [
            (&b"ab"[..], false),
            (b"ab\r", false),
            (b"ab\n", true),
            (b"ab\rc", true),
            (b"", false),
        ] {
            let mut text = input(bytes, false);
            assert_eq!(text.line().unwrap().is_some(), whole, "{bytes:?}");
            assert_eq!(text.place.line, u64::from(whole));
        }
        assert!(input(&vec![b'a'; LONGEST_LINE + 1], false).line().is_err());
    }
}
