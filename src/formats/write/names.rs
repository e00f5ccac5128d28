//! Names of the columns of a table.

use crate::formats::raw_cloud::RawCloud;

/// What a written column holds.
#[derive(Clone, Copy)]
pub(super) enum Column {
    Position,
    Float,
    Byte,
}

/// The columns that a cloud is written in, in order: one word each, no name twice.
pub(super) fn names(cloud: &RawCloud) -> Vec<(String, Column)> {
    let mut columns: Vec<(String, Column)> = Vec::new();
    let mut add = |name: &str, column: Column| {
        let mut word = name.split_whitespace().collect::<Vec<_>>().join("_");
        while word.is_empty()
            || columns
                .iter()
                .any(|(taken, _)| taken.eq_ignore_ascii_case(&word))
        {
            word.push('_');
        }
        columns.push((word, column));
    };
    for name in ["x", "y", "z"] {
        add(name, Column::Position);
    }
    if cloud.normals.is_some() {
        for name in ["nx", "ny", "nz"] {
            add(name, Column::Float);
        }
    }
    if cloud.colors.is_some() {
        for name in ["red", "green", "blue"] {
            add(name, Column::Byte);
        }
    }
    for attribute in &cloud.attributes {
        add(&attribute.name, Column::Float);
    }
    columns
}
