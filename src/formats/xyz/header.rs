//! What the lines before the rows of a table call its columns.

use super::super::text::decoded;
use super::dialect::{DIALECTS, Delimiter, Dialect};
use super::grid::Grid;
use super::line::{Line, NoPlan, Numbered, is_comment, line_of};
use super::names;

/// A header that numbers its columns, as pandas writes it: `,0,1,2`, or `0,1,2` above coordinates that have decimal places.
pub(super) fn is_header_of_numbers(lines: &[&Numbered], dialect: Dialect) -> bool {
    let [line, below @ ..] = lines else {
        return false;
    };
    let tokens: Vec<&[u8]> = dialect.split(&line.bytes).collect();
    let numbers = |tokens: &[&[u8]]| {
        let number = |(i, token): (usize, &&[u8])| *token == i.to_string().as_bytes();
        tokens.len() >= 3 && tokens.iter().enumerate().all(number)
    };
    let has_places = |line: &&&Numbered| {
        let mut values = dialect.split(&line.bytes);
        let mark = |b: &u8| *b == b'.' || (dialect.decimal_comma && *b == b',');
        values.by_ref().take(3).all(|value| value.iter().any(mark))
    };
    match tokens.as_slice() {
        [[], rest @ ..] => !below.is_empty() && numbers(rest),
        all => {
            below.len() >= 3 && numbers(all) && below.iter().take(100).all(|line| has_places(&line))
        }
    }
}

/// Whether the names in a line only number the columns.
pub(super) fn only_numbers(line: &Numbered, dialect: Dialect) -> bool {
    names::only_number(&names_of(&line.bytes, dialect))
}

/// What the lines before the rows say.
pub(super) enum Header {
    Names {
        roles: Vec<String>,
        names: Vec<String>,
        ragged: bool,
        weak: bool,
    },
    /// Names that only number the columns.
    Numbers,
    None,
}

/// What the lines before the rows call the columns.
pub(super) fn header(
    before: &[&Numbered],
    dialect: Dialect,
    grid: &Grid,
) -> std::result::Result<Header, NoPlan> {
    let width = grid.columns.len();
    let Some((line, mut names)) = header_names(before, dialect, width) else {
        // Without rows the first line that is none says more.
        let last = before.last().filter(|line| {
            let names = dialect.split(&line.bytes).count();
            width > 0
                && !is_comment(&line.bytes)
                && names == width
                && line_of(&line.bytes, dialect) == Line::Other
        });
        return match last {
            Some(line) if dialect.split(&line.bytes).all(|name| name.is_empty()) => {
                Ok(Header::None)
            }
            Some(line) if is_header_of_numbers(&[line, line], dialect) => Ok(Header::None),
            Some(line) if only_numbers(line, dialect) => Ok(Header::Numbers),
            Some(line) => Err(NoPlan::line(
                line,
                "numbers, or names of columns with x, y and z, or the option columns",
            )),
            None => Ok(Header::None),
        };
    };
    if names::contradict(&names) {
        return Err(NoPlan::line(
            line,
            "numbers, or different column names with x, y and z",
        ));
    }
    // COLMAP: a list whose length differs ends the row. One before x, y and z is a column like others.
    let list = names
        .iter()
        .position(|name| name.contains("[]"))
        .filter(|&list| names::roles(&names[..list]).is_some());
    if let Some(list) = list {
        names.truncate(list);
    }
    if names.len() + 1 == width && list.is_none() && is_row_name(grid) {
        names.insert(0, String::new());
    }
    let named = names::named(&names);
    let weak = named.as_ref().is_some_and(|named| named.weak);
    let roles = named.map_or(Vec::new(), |named| named.roles);
    let matches = width == 0 || roles.len() == width || list.is_some();
    if !matches && is_comment(&line.bytes) {
        return Ok(Header::None);
    }
    // Behind the columns that have names a mark may end each row.
    let wider = roles.len() > width && roles[width..].iter().all(|role| role == "-");
    if !matches && !wider {
        return Err(NoPlan::Line {
            number: grid.first_row,
            expected: format!("{} values, one for each name", roles.len()),
            found: format!("{width} values"),
        });
    }
    let mut roles = roles;
    if list.is_none() && width > 0 {
        roles.truncate(width);
    }
    Ok(Header::Names {
        roles,
        names,
        ragged: list.is_some(),
        weak,
    })
}

/// R writes names of rows without a name for their column.
fn is_row_name(grid: &Grid) -> bool {
    let first = &grid.columns[0];
    let runs = first.values.windows(2).all(|pair| pair[1] - pair[0] == 1.0);
    grid.rows.len() > 1 && (runs || !first.is_numeric())
}

/// The last line before the rows that names x, y and z, and its names.
pub(super) fn header_names<'a>(
    before: &[&'a Numbered],
    dialect: Dialect,
    width: usize,
) -> Option<(&'a Numbered, Vec<String>)> {
    /// Lines above the rows, and bytes of them.
    const MOST: usize = 64;
    const MOST_BYTES: usize = 1 << 17;
    let mut bytes = 0;
    let mut near = before.iter().rev().take(MOST).take_while(|line| {
        bytes += line.bytes.len();
        bytes <= MOST_BYTES
    });
    near.find_map(|line| {
        let bytes = &line.bytes[line.bytes.iter().take_while(|b| b" \t".contains(b)).count()..];
        let marks = bytes.iter().take_while(|b| b"#/%!".contains(b)).count();
        let text = &bytes[marks..];
        // Behind a mark: `VARIABLES = "X", "Y", "Z"`, `# columns: x y z`.
        let behind = |mark: u8| {
            text.iter()
                .position(|&b| b == mark)
                .map(|at| &text[at + 1..])
        };
        let texts = [Some(text), behind(b'='), behind(b':')];
        let mut found = texts.into_iter().flatten();
        let names = found.find_map(|text| names_within(text, dialect, width));
        names.map(|names| (*line, names))
    })
}

/// The names in a line that name x, y and z.
fn names_within(text: &[u8], dialect: Dialect, width: usize) -> Option<Vec<String>> {
    // Names have letters.
    if !text
        .iter()
        .any(|b| b.is_ascii_alphabetic() || !b.is_ascii())
    {
        return None;
    }
    let others = DIALECTS
        .into_iter()
        .filter(|other| !other.decimal_comma && *other != dialect)
        .filter(|other| match other.delimiter {
            Delimiter::Mark(mark) => text.contains(&mark),
            _ => true,
        });
    let own = names_of(text, dialect);
    // Names that are as many as the columns are no others, taken apart.
    let fits = own.len() == width;
    let splits: Vec<Vec<String>> = std::iter::once(own)
        .chain(others.map(|dialect| names_of(text, dialect)))
        .filter(|names| !fits || names.len() == width)
        .filter(|names| names::roles(names).is_some())
        .collect();
    let fitting = splits.iter().find(|names| names.len() == width);
    let found = fitting.or_else(|| {
        splits
            .iter()
            .max_by_key(|names| std::cmp::Reverse(names.len().abs_diff(width)))
    });
    found.cloned()
}

/// Names of columns; between blanks a unit in brackets belongs to the name before it.
fn names_of(text: &[u8], dialect: Dialect) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for token in dialect.split(text) {
        let name = decoded(token);
        let open =
            |name: &String| name.matches(['(', '[']).count() > name.matches([')', ']']).count();
        match names.last_mut() {
            Some(last)
                if dialect.delimiter == Delimiter::Blanks
                    && (name.starts_with(['(', '[']) || open(last)) =>
            {
                last.push(' ');
                last.push_str(&name);
            }
            _ => names.push(name),
        }
    }
    names
}
