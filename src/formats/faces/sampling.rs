//! The account of what was made of a file's faces.

/// What was made of a file's faces.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sampling {
    /// Points that were taken from faces; 0 where the points are the file's own.
    pub points: u64,
    /// Vertices that no face uses and that were left out.
    pub unused: u64,
    /// Faces that name a vertex that there is not.
    pub broken: u64,
    /// Files that the faces name and that were not there, and pictures that are of no kind that is read.
    pub missing: Vec<String>,
}

impl Sampling {
    /// What was left out, by why.
    pub(in crate::formats) fn skipped(&self) -> Vec<(&'static str, u64)> {
        let counts = [
            ("unused-vertices", self.unused),
            ("broken-faces", self.broken),
        ];
        counts.into_iter().filter(|(_, count)| *count > 0).collect()
    }
}
