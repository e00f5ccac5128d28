//! What is written from the one table of options, `src/base/params/table.rs`: the package's types, its checks, the command
//! line's words and the page's fields. A new option is a new row there.

#[macro_use]
mod rows;
mod fields;
mod flags;
mod rules;
mod types;

use std::fs;

use crate::shell::{Result, root, say};
use rows::{Body, Item, Row};

include!("../../../src/base/params/table.rs");

/// First line of every file that is written.
const HEAD: &str =
    "// Written by `cargo xtask build` from src/base/params/table.rs: change an option there.\n";

/// The files, with what they have to hold.
fn files() -> [(&'static str, String); 4] {
    let table = Table(table());
    [
        ("pkg/types.options.d.ts", types::render(&table)),
        ("pkg/engine/options-table.js", rules::render(&table)),
        ("pkg/cli/flags-table.js", flags::render(&table)),
        ("www/src/controls/fields-table.js", fields::render(&table)),
    ]
}

/// Writes those that are not as they have to be.
pub fn write() -> Result<()> {
    for (name, text) in files() {
        let path = root().join(name);
        if fs::read_to_string(&path).is_ok_and(|there| there == text) {
            continue;
        }
        say(&format!("writing {name} from the table of options"));
        fs::write(&path, text).map_err(|error| format!("{name} cannot be written: {error}"))?;
    }
    Ok(())
}

/// The table, with what its parts are called in JavaScript.
struct Table(Vec<Item>);

/// The sets of options: the struct in Rust, the interface in TypeScript, the call that takes them.
const CALLS: [(&str, &str, &str); 2] = [
    ("ReduceParams", "ReduceOptions", "reduce"),
    ("SurfaceParams", "ReconstructOptions", "reconstruct"),
];

impl Table {
    fn item(&self, name: &str) -> &Item {
        let item = self.0.iter().find(|item| item.name == name);
        item.unwrap_or_else(|| panic!("the table of options has no {name}"))
    }

    fn rows(&self, name: &str) -> &[Row] {
        match &self.item(name).body {
            Body::Options(rows) | Body::Amount(rows) => rows,
            _ => panic!("{name} has no rows"),
        }
    }

    /// The names of a choice, its default first.
    fn words(&self, name: &str) -> Vec<&'static str> {
        match &self.item(name).body {
            Body::Choice(choices) => choices.iter().map(|choice| choice.word).collect(),
            _ => panic!("{name} is no choice"),
        }
    }

    /// Whether some choice has this name, and no option.
    fn has_word(&self, word: &str) -> bool {
        let is_option = CALLS
            .iter()
            .any(|(name, ..)| self.rows(name).iter().any(|row| row.name == word));
        !is_option
            && self.0.iter().any(|item| match &item.body {
                Body::Choice(choices) => choices.iter().any(|choice| choice.word == word),
                Body::Auto { .. } => word == "auto",
                _ => false,
            })
    }
}

/// `max_depth` is `maxDepth` in JavaScript.
fn camel_case(name: &str) -> String {
    let mut words = name.split('_');
    let first = words.next().unwrap_or_default().to_string();
    words.fold(first, |all, word| {
        all + &word[..1].to_ascii_uppercase() + &word[1..]
    })
}

/// A number as JavaScript writes it: `6e-4` and `21`, not `21.0` or `10_000`.
fn number(text: &str) -> String {
    let plain = text.replace('_', "");
    plain.strip_suffix(".0").unwrap_or(&plain).to_string()
}

/// A string as JavaScript writes it, in single quotes where it has none.
fn quoted(text: &str) -> String {
    if text.contains('\'') {
        format!("{text:?}")
    } else {
        format!("'{text}'")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_current() {
        for (name, text) in files() {
            let there = fs::read_to_string(root().join(name)).unwrap_or_default();
            assert!(
                there == text,
                "{name} is not what the table of options says: run `cargo xtask build`"
            );
        }
    }

    #[test]
    fn the_first_of_a_choice_is_its_default() {
        let table = Table(table());
        for (name, ..) in CALLS {
            for row in table.rows(name).iter().filter(|row| row.kind == "choice") {
                let Body::Choice(choices) = &table.item(row.ty).body else {
                    panic!("{} is no choice", row.ty);
                };
                assert_eq!(row.default, format!("{}::{}", row.ty, choices[0].variant));
            }
        }
    }

    #[test]
    fn names_and_numbers_are_javascripts() {
        assert_eq!(camel_case("max_hole_size"), "maxHoleSize");
        assert_eq!(
            ["21", "1.0", "6e-4", "10_000"].map(number),
            ["21", "1", "6e-4", "10000"]
        );
        assert_eq!(
            ["paper", "the paper's"].map(quoted),
            ["'paper'", "\"the paper's\""]
        );
    }
}
