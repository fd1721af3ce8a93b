//! Statuses of contact points over time, as a raster of bounded size.

use carom_contact::law::Status;
use carom_dynamics::{State, StepReport, System};
use serde::{Deserialize, Serialize};

use crate::results::stills::{dynamics_begin, slips};

/// Columns: equal parts of the time.
pub(crate) const COLUMNS: usize = 480;

/// Rows of all contacts together, and most of one.
const ROWS: usize = 256;
const MOST: usize = 48;

/// Points of a contact that are looked at, at most: of more every second, third, ... one.
const POINTS: usize = 4096;

/// Bits of a cell.
const OPEN: u8 = 1;
const CLOSED: u8 = 2;
const SLIPPING: u8 = 4;

/// The raster so far.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct RasterOf {
    /// Rows of each contact.
    pub(crate) rows: Vec<usize>,
    /// Row after row.
    pub(crate) cells: Vec<u8>,
    begin: f64,
    end: f64,
    /// The last column of each contact.
    last: Vec<Option<usize>>,
}

impl RasterOf {
    /// Nothing yet, up to the time `end`, s.
    pub(crate) fn new(system: &System, end: f64) -> RasterOf {
        let most = (ROWS / system.contacts.len().max(1)).clamp(1, MOST);
        let contacts = system.contacts.iter();
        let rows: Vec<usize> = contacts.map(|c| c.points.len().min(most)).collect();
        RasterOf {
            cells: vec![0; rows.iter().sum::<usize>() * COLUMNS],
            last: vec![None; rows.len()],
            rows,
            begin: dynamics_begin(system, end),
            end,
        }
    }

    /// Whether this can be gone on with.
    pub(crate) fn takes(&self, before: &RasterOf) -> bool {
        let mut last = before.last.iter().flatten();
        before.rows == self.rows
            && before.cells.len() == self.cells.len()
            && before.last.len() == self.last.len()
            && last.all(|column| *column < COLUMNS)
    }

    /// Goes on from a raster up to another time or the same: what was in a column is in those of its time.
    pub(crate) fn go_on(&mut self, before: RasterOf) {
        if before.end == self.end {
            *self = before;
            return;
        }
        let own = [self.begin, self.end];
        let column = |old: usize| {
            let since = (old as f64 + 0.5) / COLUMNS as f64 * (before.end - before.begin);
            column_of(before.begin + since, own)
        };
        let rows = before.cells.chunks_exact(COLUMNS);
        for (row, cells) in self.cells.chunks_exact_mut(COLUMNS).zip(rows) {
            for (old, bits) in cells.iter().enumerate() {
                row[column(old)] |= bits;
            }
        }
        let last = before.last.iter();
        self.last = last.map(|last| last.map(column)).collect();
    }

    /// Time at the start of the first column, s.
    pub(crate) fn begin(&self) -> f64 {
        self.begin
    }

    /// Time at the end of the last column, s.
    pub(crate) fn end(&self) -> f64 {
        self.end
    }

    /// Whether statuses of points are looked at after a step.
    pub(crate) fn wants(&self, report: &StepReport) -> bool {
        let column = column_of(report.time, [self.begin, self.end]);
        let contacts = report.contacts.iter().zip(&self.last);
        let mut contacts = contacts.zip(&self.rows).filter(|(_, rows)| **rows > 0);
        contacts.any(|((report, last), _)| report.status_changes > 0 || *last != Some(column))
    }

    /// Adds the statuses at the end of a step; a contact without a change of status is looked at once for each column.
    pub(crate) fn push(&mut self, system: &System, state: &State, report: &StepReport) {
        let column = column_of(report.time, [self.begin, self.end]);
        let mut first = 0;
        for (contact, rows) in self.rows.iter().enumerate() {
            let own = &mut self.cells[first * COLUMNS..(first + rows) * COLUMNS];
            first += rows;
            let changed = report.contacts[contact].status_changes > 0;
            if !changed && self.last[contact] == Some(column) {
                continue;
            }
            let from = self.last[contact].map_or(column, |last| (last + 1).min(column));
            self.last[contact] = Some(column);
            let count = system.points_of(contact).len();
            for (k, point) in points(system, contact) {
                let row = k * rows / count;
                let bit = status(system, point, state);
                // a step may be longer than a column
                for cell in &mut own[row * COLUMNS + from..=row * COLUMNS + column] {
                    *cell |= bit;
                }
            }
        }
    }
}

/// The points of a contact that are looked at, by their numbers in the contact and among all.
pub(crate) fn points(system: &System, contact: usize) -> impl Iterator<Item = (usize, usize)> {
    let points = system.points_of(contact);
    let count = points.len();
    let numbers = (0..count).step_by(count.div_ceil(POINTS).max(1));
    numbers.map(move |k| (k, points.start + k))
}

/// The column of a time, s; that of a static stage before the dynamics is the first.
fn column_of(time: f64, [begin, end]: [f64; 2]) -> usize {
    let part = ((time - begin) / (end - begin)).max(0.0);
    ((part * COLUMNS as f64) as usize).min(COLUMNS - 1)
}

fn status(system: &System, point: usize, state: &State) -> u8 {
    let interface = &state.interface;
    match interface.force[point] != 0.0 || interface.status[point] != Status::Open {
        false => OPEN,
        true if slips(system, point, interface) => SLIPPING,
        true => CLOSED,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_raster_that_goes_on_to_twice_its_end_has_its_columns_in_the_first_half() {
        let of = |end| RasterOf {
            rows: vec![1],
            cells: vec![0; COLUMNS],
            begin: 0.0,
            end,
            last: vec![None],
        };
        let mut before = of(1.0);
        before.cells[COLUMNS - 1] = CLOSED;
        before.cells[0] = OPEN;
        before.last = vec![Some(COLUMNS - 1)];
        let mut longer = of(2.0);
        longer.go_on(before);
        assert_eq!(longer.last, [Some(COLUMNS / 2 - 1)]);
        let marked: Vec<usize> = (0..COLUMNS).filter(|k| longer.cells[*k] != 0).collect();
        assert_eq!(marked, [0, COLUMNS / 2 - 1]);
    }
}
