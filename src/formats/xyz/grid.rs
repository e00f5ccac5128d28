//! The first lines of a table: the dialect that suits them, and their values column by column.

use super::super::options::ReadOptions;
use super::super::text::decoded;
use super::dialect::{DIALECTS, Delimiter, Dialect, is_comma_blank};
use super::guess::Column;
use super::line::{Numbered, is_comment};
use super::value::{Value, color};

/// The dialect in which most lines are rows, with the fewest values that are no numbers and the fewest widths.
pub(super) fn dialect_of(said: &[&Numbered], options: &ReadOptions) -> Dialect {
    let asked = |dialect: &Dialect| {
        let comma = options
            .decimal
            .is_none_or(|mark| dialect.decimal_comma == (mark == ','));
        let delimiter = match options.delimiter {
            None => true,
            Some(' ') => dialect.delimiter == Delimiter::Blanks,
            Some(mark) => dialect.delimiter == Delimiter::Mark(mark as u8),
        };
        comma && delimiter
    };
    let own = options.delimiter.map(|mark| Dialect {
        delimiter: if mark == ' ' {
            Delimiter::Blanks
        } else {
            Delimiter::Mark(mark as u8)
        },
        decimal_comma: options.decimal == Some(','),
    });
    let rows = || {
        said.iter()
            .map(|line| line.bytes.as_slice())
            .filter(|line| !is_comment(line))
    };
    if options.delimiter.is_none_or(|mark| mark == ',')
        && options.decimal.is_none_or(|mark| mark == ',')
        && is_comma_blank(rows())
    {
        return Dialect {
            delimiter: Delimiter::CommaBlank,
            decimal_comma: true,
        };
    }
    let candidates = DIALECTS.into_iter().filter(asked);
    let mut best: Option<((usize, usize, usize), Dialect)> = None;
    for dialect in candidates.chain(own) {
        let score = score(said, dialect);
        if best.is_none_or(|(most, _)| score > most) {
            best = Some((score, dialect));
        }
    }
    best.map_or(DIALECTS[8], |(_, dialect)| dialect)
}

/// Rows, numbers among their values in thousandths, and rows as wide as the first.
fn score(said: &[&Numbered], dialect: Dialect) -> (usize, usize, usize) {
    let (mut rows, mut numbers, mut values, mut alike) = (0, 0, 0, 0);
    let mut first = None;
    for line in said.iter().filter(|line| !is_comment(&line.bytes)) {
        let (mut here, mut count, mut said) = (0, 0, 0);
        for token in dialect.split(&line.bytes) {
            count += 1;
            let value = dialect.value(token);
            here += usize::from(matches!(value, Value::Number(_) | Value::Hex(_)));
            said += usize::from(value != Value::Empty);
        }
        if here >= 3 {
            rows += 1;
            numbers += here;
            values += said;
            alike += usize::from(*first.get_or_insert(count) == count);
        }
    }
    (rows, 1000 * numbers / values.max(1), alike)
}

/// The first rows.
#[derive(Default)]
pub(super) struct Grid {
    pub(super) columns: Vec<Column>,
    /// Values row by row, whatever their number.
    pub(super) rows: Vec<Vec<f64>>,
    pub(super) texts: Vec<Vec<String>>,
    /// A value has a decimal comma.
    pub(super) commas: bool,
    /// Number of the first row's line.
    pub(super) first_row: u64,
}

impl Grid {
    pub(super) fn of(lines: &[&Numbered], dialect: Dialect) -> Grid {
        const SHOWN: usize = 8;
        const MOST_SHOWN: usize = 64;
        let mut grid = Grid {
            first_row: lines.first().map_or(0, |line| line.number),
            ..Grid::default()
        };
        for line in lines {
            let tokens: Vec<&[u8]> = dialect.split(&line.bytes).collect();
            if grid.columns.is_empty() {
                grid.columns.resize_with(tokens.len(), Column::default);
            }
            if grid.texts.len() < SHOWN {
                let text = |token: &&[u8]| decoded(&token[..token.len().min(40)]);
                grid.texts
                    .push(tokens.iter().take(MOST_SHOWN).map(text).collect());
            }
            let values: Vec<Value> = tokens.iter().map(|token| dialect.value(token)).collect();
            let number = |value: &Value| match value {
                Value::Number(value) | Value::Hex(value) => *value,
                Value::Empty | Value::Text => f64::NAN,
            };
            grid.commas |=
                dialect.decimal_comma && tokens.iter().any(|token| token.contains(&b','));
            grid.rows.push(values.iter().map(number).collect());
            for (column, (value, token)) in grid.columns.iter_mut().zip(values.iter().zip(&tokens))
            {
                column.values.push(number(value));
                column.texts += usize::from(*value == Value::Text);
                column.empty += usize::from(*value == Value::Empty);
                column.hexes += usize::from(matches!(value, Value::Hex(_)));
                column.colors += usize::from(color(token).is_some());
                column.fractions += usize::from(token.iter().any(|b| b".,eEdD".contains(b)));
            }
        }
        // A mark at the end of every line has nothing behind it.
        while grid
            .columns
            .last()
            .is_some_and(|column| column.empty == column.values.len())
        {
            grid.columns.pop();
        }
        // Rows that are too short are refused later; here all columns are as long as the rows are many.
        for column in &mut grid.columns {
            column.values.resize(lines.len(), f64::NAN);
        }
        grid
    }
}
