//! Tables of a few rows: aligned text for a terminal, and CSV files written whole.

use std::path::Path;

use crate::rows::{Cell, unique};
use crate::{Error, atomic};

/// Space between two columns of a text.
const GAP: usize = 2;

/// A table of texts; every row has as many cells as there are heads.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Names of the columns. The first column names the rows.
    pub heads: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// The table as aligned lines, the first column to the left, the others to the right. Where it is wider than
    /// `width` letters it goes on below, with the first column again.
    pub fn text(&self, width: usize) -> String {
        let lines = || std::iter::once(&self.heads).chain(&self.rows);
        let letters = |column: usize| {
            let cells = lines().filter_map(|row| row.get(column));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.heads.len()).map(letters).collect();
        let Some(&first) = widths.first() else {
            return String::new();
        };
        let mut text = String::new();
        let mut next = 1;
        loop {
            let begin = next;
            let mut total = first;
            while next < widths.len() && (next == begin || total + GAP + widths[next] <= width) {
                total += GAP + widths[next];
                next += 1;
            }
            for row in lines() {
                let name = row.first().map_or("", String::as_str);
                let mut line = format!("{name:<first$}");
                for (cell, width) in row.iter().zip(&widths).take(next).skip(begin) {
                    line += &format!("{:GAP$}{cell:>width$}", "");
                }
                text += line.trim_end();
                text.push('\n');
            }
            if next >= widths.len() {
                return text;
            }
            text.push('\n');
        }
    }
}

/// Writes a CSV file, whole or not at all.
///
/// # Errors
/// [`Error::TwinColumns`]; [`Error::RowLength`]; [`Error::File`].
pub fn write_csv<S: AsRef<str>>(
    path: &Path,
    columns: &[S],
    rows: &[Vec<Cell>],
) -> Result<(), Error> {
    unique(path, columns)?;
    let names: Vec<Cell> = columns
        .iter()
        .map(|name| Cell::Text(name.as_ref()))
        .collect();
    let mut bytes = Vec::new();
    for row in std::iter::once(&names).chain(rows) {
        if row.len() != columns.len() {
            return Err(Error::RowLength {
                path: path.to_owned(),
                expected: columns.len(),
                found: row.len(),
            });
        }
        for (column, cell) in row.iter().enumerate() {
            if column > 0 {
                bytes.push(b',');
            }
            cell.put(&mut bytes);
        }
        bytes.push(b'\n');
    }
    atomic::write(path, |to| to.write_all(&bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_wider_than_the_page_goes_on_below_with_its_first_column() {
        let row = |cells: [&str; 4]| cells.map(str::to_owned).to_vec();
        let table = Table {
            heads: row(["", "one", "two", "three"]),
            rows: vec![row(["a", "1", "22", "3"]), row(["bb", "", "5", "666666"])],
        };
        let whole = "    one  two   three\na     1   22       3\nbb         5  666666\n";
        assert_eq!(table.text(80), whole);
        let split =
            "    one  two\na     1   22\nbb         5\n\n     three\na        3\nbb  666666\n";
        assert_eq!(table.text(12), split);
        // a column is never left out, however narrow the page
        assert_eq!(table.text(0).matches("bb").count(), 3);
    }
}
