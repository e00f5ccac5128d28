//! `pkg/types.options.d.ts`: the types with their documentation.

use super::rows::{Body, Choice, Row};
use super::rules::value_type;
use super::{CALLS, HEAD, Table, camel_case, number};

/// A space at which no line ends, until the lines are made.
const TIE: char = '\u{a0}';
/// Choices that have a name in TypeScript, too.
const EXPORTED: [&str; 2] = ["Carry", "Orientation"];
/// The target that the package makes a count of: wasm never sees it.
const AUTO: &str = "As many points as suit the scan and the device: a third, at least 2,000, and at most 60,000, on a phone 20,000. \
    The same scan can thus give two devices different results.";
/// Columns of a line.
const WIDTH: usize = 125;

pub fn render(table: &Table) -> String {
    let targets: String = table
        .rows("Target")
        .iter()
        .map(|row| {
            let text = [sentences(table, row.docs), accepted(row)].concat();
            format!("\n{}  | {{ {}: number }}", doc(2, &text, &[]), row.name)
        })
        .collect();
    let mut text = format!(
        "{HEAD}import type {{ ReducedCloud, SurfaceMesh }} from './types.js';\n\n{}export type Target ={targets}\n{}  | 'auto';\n",
        doc(0, &sentences(table, table.item("Target").docs), &[]),
        doc(2, AUTO, &[]),
    );
    for name in EXPORTED {
        let words: String = choices(table, name)
            .iter()
            .map(|choice| {
                format!(
                    "\n{}  | '{}'",
                    doc(2, &sentences(table, choice.docs), &[]),
                    choice.word
                )
            })
            .collect();
        text += &format!(
            "\n{}export type {name} ={words};\n",
            doc(0, &sentences(table, table.item(name).docs), &[])
        );
    }
    for (name, interface, _) in CALLS {
        let fields: String = table
            .rows(name)
            .iter()
            .map(|row| field(table, row))
            .collect();
        text += &format!(
            "\n{}export interface {interface} {{\n{fields}}}\n",
            doc(0, &sentences(table, table.item(name).docs), &[])
        );
    }
    text
}

fn choices<'a>(table: &'a Table, name: &str) -> &'a [Choice] {
    match &table.item(name).body {
        Body::Choice(choices) => choices,
        _ => panic!("{name} is no choice"),
    }
}

fn field(table: &Table, row: &Row) -> String {
    let mut text = String::new();
    let mut list = Vec::new();
    let of_its_type = |name: &str| sentences(table, table.item(name).docs);
    match row.kind {
        "choice" if EXPORTED.contains(&row.ty) => text += &of_its_type(row.ty),
        "choice" => {
            text += &of_its_type(row.ty);
            for (i, choice) in choices(table, row.ty).iter().enumerate() {
                let default = if i == 0 { " (default)" } else { "" };
                list.push(format!(
                    "`'{}'`{default}: {}",
                    choice.word,
                    sentences(table, choice.docs)
                ));
            }
        }
        "number" => {
            if let Some(Body::Auto { auto, number }) = table
                .0
                .iter()
                .find(|item| item.name == row.ty)
                .map(|item| &item.body)
            {
                text += &of_its_type(row.ty);
                list.push(format!("`'auto'` (default): {}", sentences(table, auto)));
                list.push(format!(
                    "a number: {}{}",
                    sentences(table, number),
                    accepted(row)
                ));
            }
        }
        _ => {}
    }
    if !row.docs.is_empty() {
        text = [text, sentences(table, row.docs)]
            .into_iter()
            .filter(|part| !part.is_empty())
            .collect::<Vec<_>>()
            .join(" ");
    }
    if list.is_empty() {
        text += &accepted(row);
        text += &default(table, row);
    }
    let ty = match row.kind {
        "number" if !list.is_empty() => "number | 'auto'".into(),
        "number" | "integer" => "number".into(),
        "switch" => "boolean".into(),
        "choice" if EXPORTED.contains(&row.ty) => row.ty.to_string(),
        "choice" => table
            .words(row.ty)
            .iter()
            .map(|word| format!("'{word}'"))
            .collect::<Vec<_>>()
            .join(" | "),
        "amount" => row.ty.to_string(),
        "named" => format!("Record<string, {}>", value_type(row.ty)),
        "nested" => "ReduceOptions | false".into(),
        other => panic!("{}: there is no kind {other}", row.name),
    };
    format!(
        "{}  {}?: {ty};\n",
        doc(2, &text, &list),
        camel_case(row.name)
    )
}

/// ` In (0, 1].`
fn accepted(row: &Row) -> String {
    let Some(range) = row.range() else {
        return String::new();
    };
    match (row.kind, range.high) {
        (_, None) => format!(" At least {}.", range.low),
        ("integer", Some(high)) => format!(" {} to {high}.", range.low),
        (_, Some(high)) => {
            let (open, close) = (
                if range.low_included { '[' } else { '(' },
                if range.high_included { ']' } else { ')' },
            );
            format!(" In {open}{},{TIE}{high}{close}.", range.low)
        }
    }
}

/// ` Default 0.5.`
fn default(table: &Table, row: &Row) -> String {
    if let Some(words) = row.default_in_words() {
        return format!(" Default: {}.", sentences(table, &[words]));
    }
    if let Some(follows) = row.follows() {
        let values: Vec<String> = follows
            .iter()
            .map(|(method, value)| format!("{} (`'{}'`)", number(value), method.to_lowercase()))
            .collect();
        return format!(" Default {}.", values.join(", "));
    }
    match row.kind {
        "amount" => " Default `{ ratio: 1/3 }`.".into(),
        "named" => " Default `{}`.".into(),
        "nested" => " `false` is no reduction. Default {@link ReduceOptions}' defaults.".into(),
        "switch" => format!(" Default `{}`.", row.default),
        "choice" => format!(" Default `'{}'`.", table.words(row.ty)[0]),
        _ => format!(" Default {}.", number(row.default)),
    }
}

/// The lines of a comment as one, with what stands in backticks as JavaScript calls it.
fn sentences(table: &Table, docs: &[&str]) -> String {
    let text = docs
        .iter()
        .map(|line| line.trim())
        .collect::<Vec<_>>()
        .join(" ");
    let parts = text.split('`').enumerate();
    parts
        .map(|(i, part)| match part {
            _ if i % 2 == 0 => part.to_string(),
            _ if table.has_word(part) => format!("`'{part}'`"),
            _ if part.starts_with(char::is_uppercase) && part.contains('.') => {
                format!("{{@link {part}}}")
            }
            _ if part.contains("::") => format!("`{part}`"),
            _ => format!("`{}`", camel_case(part)),
        })
        .collect()
}

/// A comment, on one line where it fits.
fn doc(indent: usize, text: &str, list: &[String]) -> String {
    let space = " ".repeat(indent);
    let text = text.trim();
    if list.is_empty() && text.chars().count() + indent + 7 <= WIDTH {
        return format!("{space}/** {text} */\n").replace(TIE, " ");
    }
    let mut lines = wrap(text, WIDTH - indent - 3, "");
    for entry in list {
        lines.extend(wrap(
            &format!("- {}", entry.trim()),
            WIDTH - indent - 3,
            "  ",
        ));
    }
    let lines: String = lines
        .iter()
        .map(|line| format!("{space} * {line}\n"))
        .collect();
    format!("{space}/**\n{lines}{space} */\n").replace(TIE, " ")
}

fn wrap(text: &str, width: usize, later: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ').filter(|word| !word.is_empty()) {
        let line = lines.last_mut().expect("there is always one");
        let is_empty = line.trim().is_empty();
        if !is_empty && line.chars().count() + 1 + word.chars().count() > width {
            lines.push(format!("{later}{word}"));
        } else {
            if !is_empty {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_comment_is_wrapped_and_a_list_hangs() {
        assert_eq!(doc(2, " One. ", &[]), "  /** One. */\n");
        assert_eq!(wrap("- one two three", 9, "  "), ["- one two", "  three"]);
        assert_eq!(doc(0, "One.", &["a".into()]), "/**\n * One.\n * - a\n */\n");
    }

    #[test]
    fn what_stands_in_backticks_is_javascripts() {
        let table = Table(super::super::table());
        assert_eq!(
            sentences(
                &table,
                &[" Of `max_depth`, as", " in `paper`: `ReducedCloud.cells`."]
            ),
            "Of `maxDepth`, as in `'paper'`: {@link ReducedCloud.cells}."
        );
    }
}
