//! `pkg/cli/flags-table.js`: what the help says of each flag.

use super::{CALLS, HEAD, Table, camel_case, quoted};

pub fn render(table: &Table) -> String {
    let names = ["Target"].into_iter().chain(CALLS.map(|(name, ..)| name));
    let rows = names.flat_map(|name| table.rows(name));
    let lines: String = rows
        .filter_map(|row| {
            Some(format!(
                "  {}: {},\n",
                camel_case(row.name),
                quoted(row.flag()?)
            ))
        })
        .collect();
    format!(
        "{HEAD}/** What each flag does, by its option's name. */\nexport const FLAGS = {{\n{lines}}};\n"
    )
}
