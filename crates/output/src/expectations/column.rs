//! Numbers of columns of a table of histories.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use flate2::read::MultiGzDecoder;

use crate::Error;
use crate::expectations::row::Take;

/// Part of a time by which the end of a run may miss it.
const ROUNDING: f64 = 1e-9;

/// A column, and what is taken of it so far.
struct Column {
    place: Option<usize>,
    take: Take,
    /// Time and value of the row before that has a value.
    before: Option<[f64; 2]>,
    found: Option<f64>,
}

/// The number of each column that is wanted; `None` where it has none. A table of which nothing is wanted is not read.
pub(super) fn take(path: &Path, wanted: &[(&str, Take)]) -> Result<Vec<Option<f64>>, Error> {
    if wanted.is_empty() {
        return Ok(Vec::new());
    }
    let unread = || Error::file("read", path);
    let file = File::open(path).map_err(unread())?;
    let zipped = path.extension().is_some_and(|ending| ending == "gz");
    let text: Box<dyn Read> = match zipped {
        true => Box::new(MultiGzDecoder::new(file)),
        false => Box::new(file),
    };
    let mut lines = BufReader::new(text).lines();
    let names = lines.next().transpose().map_err(unread())?;
    let names: Vec<String> = names
        .iter()
        .flat_map(|line| line.split(','))
        .map(str::to_owned)
        .collect();
    let column = |&(name, take): &(&str, Take)| Column {
        place: names.iter().position(|own| own == name),
        take,
        before: None,
        found: None,
    };
    let mut columns: Vec<Column> = wanted.iter().map(column).collect();
    for line in lines {
        let line = line.map_err(unread())?;
        let cells: Vec<&str> = line.split(',').collect();
        let number = |place: usize| cells.get(place)?.parse::<f64>().ok();
        let Some(time) = number(0) else { continue };
        for column in &mut columns {
            if let Some(value) = column.place.and_then(number) {
                column.push(time, value);
            }
        }
    }
    Ok(columns.into_iter().map(Column::end).collect())
}

impl Column {
    fn push(&mut self, time: f64, value: f64) {
        let before = self.before.replace([time, value]);
        let kept = self.found.unwrap_or(value);
        self.found = match self.take {
            Take::Largest => Some(kept.max(value)),
            Take::Smallest => Some(kept.min(value)),
            Take::Last => Some(value),
            // the first pair of rows around the time counts
            Take::At(_) if self.found.is_some() => self.found,
            Take::At(at) => match before {
                _ if time == at => Some(value),
                Some([earlier, first]) if earlier < at && at < time => {
                    let part = (at - earlier) / (time - earlier);
                    Some(first + part * (value - first))
                }
                _ => None,
            },
        };
    }

    fn end(self) -> Option<f64> {
        match (self.take, self.found, self.before) {
            (Take::At(at), None, Some([time, value])) => {
                ((time - at).abs() <= ROUNDING * at.abs()).then_some(value)
            }
            (_, found, _) => found,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_has_extremes_a_last_value_and_values_between_its_rows() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("histories.csv");
        std::fs::write(&path, "time_s,a,b\n0,1,\n1,3,-2\n2,-1,4\n").unwrap();
        let wanted = [
            ("a", Take::Largest),
            ("a", Take::Smallest),
            ("a", Take::Last),
            ("a", Take::At(0.5)),
            ("a", Take::At(1.0)),
            ("a", Take::At(1.75)),
            ("a", Take::At(2.0 + 1e-12)),
            ("a", Take::At(2.1)),
            ("b", Take::At(0.5)),
            ("b", Take::Smallest),
            ("c", Take::Last),
        ];
        let found = take(&path, &wanted).unwrap();
        let expected = [3.0, -1.0, -1.0, 2.0, 3.0, 0.0, -1.0].map(Some);
        assert_eq!(found[..7], expected);
        assert_eq!(found[7..], [None, None, Some(-2.0), None]);
        assert!(take(&folder.path().join("nothing.csv"), &[]).is_ok());
        assert!(take(&folder.path().join("nothing.csv"), &wanted).is_err());
    }
}
