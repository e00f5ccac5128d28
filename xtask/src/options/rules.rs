//! `pkg/engine/options-table.js`: the checks and the defaults.

use super::rows::Row;
use super::{CALLS, HEAD, Table, camel_case, number, quoted};

pub fn render(table: &Table) -> String {
    let targets = object(table, "TARGETS", "Target");
    let [(reduce, ..), (surface, ..)] = CALLS;
    let tables = [
        targets,
        object(table, "REDUCE", reduce),
        object(table, "RECONSTRUCT", surface),
    ];
    format!(
        "{HEAD}import {{ choice, integer, named, nested, number, oneOf, toggle }} from './rules.js';\n\n{}",
        tables.join("\n")
    )
}

fn object(table: &Table, constant: &str, name: &str) -> String {
    let rows = table.rows(name).iter();
    let lines: String = rows
        .map(|row| format!("  {}: {},\n", camel_case(row.name), rule(table, row)))
        .collect();
    format!("export const {constant} = {{\n{lines}}};\n")
}

fn rule(table: &Table, row: &Row) -> String {
    match row.kind {
        "number" => number_rule(row),
        "integer" => integer_rule(row),
        "switch" => format!("toggle({})", row.default),
        "choice" => choice_rule(table, row.ty),
        "amount" => format!("oneOf(TARGETS, {})", amount(row.default)),
        "named" => format!("named({})", choice_rule(table, value_type(row.ty))),
        "nested" => "nested('reduce', REDUCE)".into(),
        other => panic!("{}: there is no kind {other}", row.name),
    }
}

fn choice_rule(table: &Table, name: &str) -> String {
    let words: Vec<String> = table.words(name).into_iter().map(quoted).collect();
    format!("choice({})", words.join(", "))
}

fn number_rule(row: &Row) -> String {
    let range = row.range().expect("a number has a range");
    let high = range.high.expect("a number's range has two ends");
    let open = match (range.low_included, range.high_included) {
        (true, true) => None,
        (false, true) => Some("open: '('"),
        (true, false) => Some("open: ')'"),
        (false, false) => Some("open: '()'"),
    };
    let mut more: Vec<String> = open.map(String::from).into_iter().collect();
    if range.auto {
        more.push("or: 'auto', fallback: 'auto'".into());
    } else if let Some(default) = default(row) {
        more.push(format!("fallback: {default}"));
    }
    let more = match more[..] {
        [] => String::new(),
        _ => format!(", {{ {} }}", more.join(", ")),
    };
    format!("number({}, {high}{more})", range.low)
}

fn integer_rule(row: &Row) -> String {
    let range = row.range().expect("an integer has a range");
    let high = range.high.unwrap_or_else(|| {
        let widest = if row.ty == "u64" {
            "Number.MAX_SAFE_INTEGER"
        } else {
            "0xffffffff"
        };
        widest.into()
    });
    let default = default(row).map_or(String::new(), |value| format!(", {value}"));
    format!("integer({}, {high}{default})", range.low)
}

/// None where it follows other options.
fn default(row: &Row) -> Option<String> {
    (row.default != "None").then(|| number(row.default))
}

/// `Target::Ratio(1.0 / 3.0)` as an object.
fn amount(default: &str) -> String {
    let inner = default.split_once("::").map(|(_, inner)| inner);
    let parts = inner
        .and_then(|inner| inner.strip_suffix(')'))
        .and_then(|inner| inner.split_once('('));
    let (variant, value) = parts.unwrap_or_else(|| panic!("no amount is written {default}"));
    let value: Vec<String> = value.split(' ').map(number).collect();
    format!("{{ {}: {} }}", variant.to_lowercase(), value.join(" "))
}

/// `Carry` of `BTreeMap<String, Carry>`.
pub fn value_type(map: &str) -> &str {
    let value = map.rsplit(' ').next().unwrap_or(map);
    value.trim_end_matches('>')
}
