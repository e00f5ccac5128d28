//! The first rows of a table, from which a person tells what its columns are.

/// The first rows of a table as a person reads them, and how they were taken apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Preview {
    /// Values of the first rows, as text.
    pub rows: Vec<Vec<String>>,
    /// What the file calls its columns, where it does.
    pub names: Vec<String>,
    /// Between values; a blank stands for any number of blanks and tabs.
    pub delimiter: char,
    /// `.` or `,`.
    pub decimal: char,
    /// The columns were guessed, and could be something else.
    pub weak: bool,
}
