//! [`Parser`], the trait that every format's reader has.

use super::faces::triangles::Faces;
use super::input::Input;
use super::preview::Preview;
use super::raw_cloud::Skin;
use super::table::Table;
use crate::base::error::Result;
use crate::cloud::{Crs, Unit};

/// A format's reader. Some take what is at hand and keep what they need; those that jump about in a file take nothing
/// before all of it is there.
pub(super) trait Parser {
    /// Takes what it can from the front of the input, and puts the points into the table, which it makes.
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step>;

    /// Faces that the file has, once all was parsed.
    fn faces(&self) -> u64 {
        0
    }

    /// Whether points may come from faces: those that are there are vertices then, and no points yet.
    fn waits_for_faces(&self) -> bool {
        false
    }

    /// The faces over the rows of the table, once all was parsed and where they are wanted.
    fn take_faces(&mut self) -> Option<Faces> {
        None
    }

    /// The pictures on the faces, and where the rows of the table are in them, once all was parsed and where one set of pictures is all that
    /// there is.
    fn take_skin(&mut self) -> Option<Skin> {
        None
    }

    /// The reference system of the coordinates.
    fn crs(&self) -> Option<Crs> {
        None
    }

    /// What a coordinate is, where the file says it.
    fn unit(&self) -> Option<Unit> {
        None
    }

    /// What the columns of a table were taken for.
    fn columns(&self) -> Vec<String> {
        Vec::new()
    }

    /// The first rows of a table.
    fn preview(&self) -> Option<Preview> {
        None
    }

    /// What else is to be said of the points.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }
}

/// How far a parser is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Step {
    /// It wants more bytes; or, where there are no more, to be called again with the same.
    More,
    /// All points are in the table.
    Done,
}
