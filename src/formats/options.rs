//! Options of a reader: what the file does not say itself, such as the columns of a table.

use super::faces::FaceMode;
use crate::base::error::{Error, Result};

/// How a file is read; what is not given is told from its content.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadOptions {
    /// Of rows of text: what each column holds: `x y z`, `nx ny nz`, `red green blue`, `rgb` for a packed colour, `-` for a
    /// column that is passed over, and any other name for an attribute. Columns beyond are passed over.
    pub columns: Option<Vec<String>>,
    /// Of rows of text: the character between values; a blank stands for any number of blanks and tabs.
    pub delimiter: Option<char>,
    /// Of rows of text: the decimal mark, `.` or `,`.
    pub decimal: Option<char>,
    /// Of rows of text: lines that are passed over before anything else.
    pub skip: u64,
    /// Points that stand for a missing measurement stay; see [`super::LeftOut`].
    pub keep_sentinels: bool,
    /// What becomes of a file's faces.
    pub faces: FaceMode,
}

impl ReadOptions {
    /// Whether they say how a table is taken apart.
    pub(super) fn is_of_a_table(&self) -> bool {
        self.columns.is_some() || self.delimiter.is_some() || self.decimal.is_some()
    }

    /// # Errors
    /// [`Error::BadOption`].
    pub(super) fn check(&self) -> Result<()> {
        let bad = |option: &'static str, expected: &str, found: String| Error::BadOption {
            option: option.into(),
            expected: expected.into(),
            found,
        };
        if let Some(columns) = &self.columns {
            let has = |axis: &str| columns.iter().any(|name| name.eq_ignore_ascii_case(axis));
            if !["x", "y", "z"].into_iter().all(has) {
                let found = columns.join(",");
                return Err(bad("columns", "names with x, y and z among them", found));
            }
        }
        if let Some(mark) = self.delimiter
            && !(mark.is_ascii_punctuation() || [' ', '\t'].contains(&mark))
        {
            let expected = "a punctuation mark, a tab, or a blank";
            return Err(bad("delimiter", expected, mark.into()));
        }
        match self.decimal {
            None | Some('.' | ',') if self.decimal.is_none() || self.decimal != self.delimiter => {
                Ok(())
            }
            mark => Err(bad(
                "decimal",
                "'.' or ',', and not the delimiter",
                mark.unwrap_or(' ').into(),
            )),
        }
    }
}
