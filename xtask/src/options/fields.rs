//! `www/src/controls/fields-table.js`: the page's controls.

use super::rows::{Body, Field, Row};
use super::{CALLS, HEAD, Table, camel_case, number, quoted};

pub fn render(table: &Table) -> String {
    let controls: String = CALLS
        .iter()
        .flat_map(|(name, _, call)| table.rows(name).iter().map(move |row| (row, call)))
        .filter_map(|(row, call)| {
            let entries = control(table, row, row.field()?, call);
            Some(format!(
                "  {}: {{ {} }},\n",
                camel_case(row.name),
                entries.join(", ")
            ))
        })
        .collect();
    let targets: String = table
        .rows("Target")
        .iter()
        .filter_map(|row| {
            let field = row.field()?;
            let mut entries = vec![format!("label: {}", quoted(field.label))];
            entries.extend(range(row, field));
            let start: Vec<String> = row.start()?.split(' ').map(number).collect();
            entries.push(format!("start: {}", start.join(" ")));
            Some(format!("  {}: {{ {} }},\n", row.name, entries.join(", ")))
        })
        .collect();
    format!(
        "{HEAD}/** Options that have a control, by name. */\nexport const FIELDS = {{\n{controls}}};\n\n\
         /** The ways to say how much is kept; `start` is where a change to it begins. */\nexport const TARGETS = {{\n{targets}}};\n"
    )
}

fn control(table: &Table, row: &Row, field: &Field, call: &str) -> Vec<String> {
    let kind = match row.kind {
        "choice" => "choice",
        "switch" => "flag",
        _ => "number",
    };
    let mut entries = vec![
        format!("in: '{call}'"),
        format!("kind: '{kind}'"),
        format!("label: {}", quoted(field.label)),
        format!("hint: {}", quoted(field.hint)),
    ];
    match kind {
        "choice" => entries.push(choices(table, row)),
        "number" => entries.extend(range(row, field)),
        _ => {}
    }
    if let Some(follows) = row.follows() {
        let values = follows
            .iter()
            .map(|(method, value)| format!("{}: {}", method.to_lowercase(), number(value)));
        entries.push(format!(
            "follows: {{ {} }}",
            values.collect::<Vec<_>>().join(", ")
        ));
    }
    entries
}

fn choices(table: &Table, row: &Row) -> String {
    let Body::Choice(choices) = &table.item(row.ty).body else {
        panic!("{} is no choice", row.ty);
    };
    let default = &choices[0];
    assert!(
        default.label.is_some(),
        "{} has no label for the page",
        default.variant
    );
    // What has no label asks for something that not every scan has.
    let words = choices
        .iter()
        .filter_map(|choice| Some(format!("{}: {}", choice.word, quoted(choice.label?))));
    format!("choices: {{ {} }}", words.collect::<Vec<_>>().join(", "))
}

/// The slider's ends, and what the field accepts.
fn range(row: &Row, field: &Field) -> Vec<String> {
    let range = row
        .range()
        .unwrap_or_else(|| panic!("{} has no range", row.name));
    let (low, high) = field
        .slider
        .unwrap_or_else(|| panic!("{} has no slider", row.name));
    let mut entries = vec![
        format!("low: {}", number(low)),
        format!("high: {}", number(high)),
        format!("least: {}", range.low),
        format!("most: {}", range.high.as_deref().unwrap_or("0xffffffff")),
    ];
    let open = match (range.low_included, range.high_included) {
        (true, true) => "",
        (false, true) => "(",
        (true, false) => ")",
        (false, false) => "()",
    };
    entries.push(format!("open: '{open}'"));
    if field.percent {
        entries.push("times: 100, unit: '%'".into());
    } else {
        entries.push("unit: ''".into());
    }
    if row.kind == "integer" {
        entries.push("whole: true".into());
    }
    if range.auto {
        entries.push("auto: true".into());
    }
    entries
}
