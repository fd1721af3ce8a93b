//! Tables of numbers in text files.

use crate::error::Error;

/// A table of numbers with named columns.
///
/// The first line that is neither empty nor a comment (`#`) has the names of the columns, unless all its cells are numbers:
/// the columns are then called `1`, `2`, .... Cells are separated by commas, semicolons, tabs or blanks, whichever of these the
/// line of the names contains first in this order of precedence: semicolon, comma, tab, blank. A unit may follow a name in square
/// brackets, `a [m/s^2]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    names: Vec<String>,
    units: Vec<Option<String>>,
    /// Rows with the number of their line.
    rows: Vec<(usize, Vec<String>)>,
}

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Unit as the file says it.
    pub unit: Option<String>,
    /// Lines of the values in the file, from 1.
    pub lines: Vec<usize>,
    /// Values.
    pub values: Vec<f64>,
}

impl Table {
    /// Reads a text.
    ///
    /// # Errors
    /// No rows, or rows with another number of cells than the first.
    pub fn parse(text: &str) -> Result<Table, Error> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let lines = text.lines().enumerate();
        let mut lines = lines
            .map(|(k, line)| (k + 1, line.trim()))
            .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
            .peekable();
        let Some(&(_, first)) = lines.peek() else {
            return Err(Error::NoRows);
        };
        let separator = [';', ',', '\t'].into_iter().find(|c| first.contains(*c));
        let cells = |line: &str| -> Vec<String> {
            match separator {
                Some(c) => line.split(c).map(|cell| cell.trim().to_owned()).collect(),
                None => line.split_whitespace().map(str::to_owned).collect(),
            }
        };
        let head = match separator {
            // a blank may stand between a name and its unit
            None => cells(&first.replace(" [", "[")),
            Some(_) => cells(first),
        };
        let plain = head.iter().all(|cell| cell.parse::<f64>().is_ok());
        let named = match plain {
            true => (1..=head.len()).map(|k| (k.to_string(), None)).collect(),
            false => {
                lines.next();
                head.iter()
                    .map(|cell| name_and_unit(cell))
                    .collect::<Vec<_>>()
            }
        };
        let (names, units): (Vec<_>, Vec<_>) = named.into_iter().unzip();
        let rows: Vec<_> = lines.map(|(line, text)| (line, cells(text))).collect();
        if rows.is_empty() {
            return Err(Error::NoRows);
        }
        match rows.iter().find(|(_, row)| row.len() != names.len()) {
            None => Ok(Table { names, units, rows }),
            Some((line, row)) => Err(Error::Ragged {
                line: *line,
                found: row.len(),
                columns: names.len(),
            }),
        }
    }

    /// Names of the columns.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// A column by its name.
    ///
    /// # Errors
    /// No such column; a cell that is empty or no finite number.
    pub fn column(&self, name: &str) -> Result<Column, Error> {
        let Some(place) = self.names.iter().position(|other| other == name) else {
            return Err(Error::NoColumn {
                name: name.to_owned(),
                columns: self.names.clone(),
            });
        };
        let mut column = Column {
            unit: self.units[place].clone(),
            lines: Vec::with_capacity(self.rows.len()),
            values: Vec::with_capacity(self.rows.len()),
        };
        for (line, row) in &self.rows {
            let (line, cell, column_name) = (*line, &row[place], name.to_owned());
            let missing = ["", "-", "nan", "NaN", "NA", "n/a"];
            if missing.contains(&cell.as_str()) {
                let column = column_name;
                return Err(Error::Missing { line, column });
            }
            match cell.parse::<f64>() {
                Ok(value) if value.is_finite() => {
                    column.lines.push(line);
                    column.values.push(value);
                }
                _ => {
                    return Err(Error::NotANumber {
                        line,
                        column: column_name,
                        text: cell.clone(),
                    });
                }
            }
        }
        Ok(column)
    }
}

/// Name and unit of `name [unit]`.
fn name_and_unit(cell: &str) -> (String, Option<String>) {
    let cell = cell.trim_matches('"');
    match cell.strip_suffix(']').and_then(|cell| cell.split_once('[')) {
        Some((name, unit)) => (name.trim().to_owned(), Some(unit.trim().to_owned())),
        None => (cell.to_owned(), None),
    }
}

#[cfg(test)]
mod tests {
    use carom_testing::damage::damaged;

    use super::*;

    #[test]
    fn columns_have_names_units_and_lines() {
        let text = "# a record\nt [ms]; a [m/s^2]\n0; 1.5\n\n10; -2e-1\n";
        let table = Table::parse(text).unwrap();
        let a = table.column("a").unwrap();
        assert_eq!(a.values, [1.5, -0.2]);
        assert_eq!((a.unit.as_deref(), a.lines), (Some("m/s^2"), vec![3, 5]));
        assert_eq!(table.column("t").unwrap().unit.as_deref(), Some("ms"));
        assert!(matches!(table.column("b"), Err(Error::NoColumn { .. })));
    }

    #[test]
    fn every_separator_is_understood() {
        for text in [
            "t,a\n0,1\n1,2",
            "t;a\n0;1\n1;2",
            "t\ta\n0\t1\n1\t2",
            "t a\n 0  1\n1 2\n",
        ] {
            let table = Table::parse(text).unwrap();
            assert_eq!(table.column("a").unwrap().values, [1.0, 2.0], "{text}");
        }
        let plain = Table::parse("0 1\n1 2").unwrap();
        assert_eq!(plain.names(), ["1", "2"]);
        assert_eq!(plain.column("2").unwrap().values, [1.0, 2.0]);
    }

    #[test]
    fn gaps_are_named_by_their_lines() {
        let gap = Table::parse("t,a\n0,1\n1,\n2,3").unwrap();
        assert!(matches!(
            gap.column("a"),
            Err(Error::Missing { line: 3, .. })
        ));
        assert_eq!(gap.column("t").unwrap().values, [0.0, 1.0, 2.0]);
        let ragged = Table::parse("t,a\n0,1\n1\n2,3");
        assert_eq!(
            ragged,
            Err(Error::Ragged {
                line: 3,
                found: 1,
                columns: 2
            })
        );
        let comma = Table::parse("t;a\n0;1,5\n1;2").unwrap();
        assert!(matches!(
            comma.column("a"),
            Err(Error::NotANumber { line: 2, .. })
        ));
        assert_eq!(Table::parse("# nothing\n"), Err(Error::NoRows));
        assert_eq!(Table::parse("t,a\n"), Err(Error::NoRows));
    }

    #[test]
    fn damaged_tables_are_refused_or_have_columns_of_finite_numbers() {
        let text = b"# ground\nt [ms]; a [m/s^2]; b\n0; 1.5; 1\n10; -2e-1; 2\n\n20; 3; 4\n";
        let (mut state, mut refused) = (5, 0);
        for _ in 0..20_000 {
            let content = damaged(text, &mut state);
            let Ok(table) = Table::parse(&String::from_utf8_lossy(&content)) else {
                refused += 1;
                continue;
            };
            for name in table.names() {
                match table.column(name) {
                    Ok(column) => {
                        assert_eq!(column.lines.len(), column.values.len());
                        assert!(column.values.iter().all(|value| value.is_finite()));
                    }
                    Err(_) => refused += 1,
                }
            }
        }
        assert!((1000..60_000).contains(&refused), "{refused}");
    }
}
