//! Passes over an outer step: when the rows hold, and how the multipliers are corrected where they do not.

use std::ops::Range;

use crate::ending::{GAIN, TOLERANCE, largest, rounding, speed};
use crate::error::Error;
use crate::zones::{Sample, Zones};
use carom_dynamics::Driver;
use carom_system::LinkRow;

/// Most passes over an outer step.
pub(crate) const MOST_PASSES: usize = 30;

/// The same where links turn: H does not know that their forces turn with the rows, and passes gain a factor of three to ten.
const MOST_TURNING_PASSES: usize = 60;

/// Why passes do not end where links turn: what they leave out is the force of the link times what it turns its own rows in the step, of order DT².
const TURNING: &str = "; passes over a link that turns leave out how its forces turn with it, which in this step is too much: take a smaller \
                       outer step, or adaptive ones (time.step.adaptive), which are halved where passes do not end";
const TURNING_ADAPTIVE: &str = "; passes over a link that turns leave out how its forces turn with it, which in this step is too much: take a \
                                smaller smallest step in time.step.adaptive";

impl Zones {
    /// Whether the rows hold, or would after a change of the multipliers by rounding; corrects the multipliers `which`
    /// (0 pointwise, 1 of the outer step) if not.
    pub(crate) fn corrected(&mut self, which: usize) -> Result<bool, Error> {
        let speed = speed(&self.drivers);
        let rows = self.links.defect.iter().zip(&self.links.norms).enumerate();
        let (worst, row) = rows.fold((0.0, 0), |worst: (f64, usize), (row, (d, n))| {
            match d.abs() / n {
                missed if missed > worst.0 => (missed, row),
                _ => worst,
            }
        });
        let gains = self.links.moves.is_empty() || worst < GAIN * self.links.worst;
        (self.links.worst, self.links.worst_row) = (worst, row);
        if worst <= TOLERANCE * speed {
            return Ok(true);
        }
        if self.response.solver.is_none() {
            return Ok(true);
        }
        self.solve_links(0.1 * TOLERANCE * speed)?;
        let [old, new] = &self.links.multipliers;
        let target = match which {
            0 => &self.links.pointwise[1],
            _ => new,
        };
        // at rest all velocities are rounding; then the forces tell what is small
        let forces = largest(old).max(largest(target));
        let change = largest(&self.links.defect);
        if change <= TOLERANCE * forces
            || !gains && self.force_of_change() <= rounding(&self.drivers)
        {
            return Ok(true);
        }
        self.links.moves.next(&mut self.links.defect);
        let target = match which {
            0 => &mut self.links.pointwise[1],
            _ => &mut self.links.multipliers[1],
        };
        for (l, move_) in target.iter_mut().zip(&self.links.defect) {
            *l += move_;
        }
        Ok(false)
    }

    /// Most passes over an outer step with multipliers that are linear in it.
    pub(crate) fn most_passes(&self) -> usize {
        match self.links.turning {
            None => MOST_PASSES,
            Some(_) => MOST_TURNING_PASSES,
        }
    }

    /// The largest force on one side by the change of a multiplier, N.
    fn force_of_change(&self) -> f64 {
        let changes = self.links.defect.iter().zip(&self.links.norms);
        changes.fold(0.0, |most, (l, norm)| f64::max(most, 0.5 * norm * l.abs()))
    }

    pub(crate) fn parted(&self) -> Error {
        let row = self.links.worst_row;
        let link = self
            .links
            .named
            .iter()
            .find(|(_, rows)| rows.contains(&row));
        Error::Link {
            step: self.clock.step + 1,
            link: link.map_or(String::new(), |(name, _)| name.clone()),
            passes: self.response.passes,
            defect: self.links.worst,
            dt: self.clock.dt,
            cause: match (&self.links.turning, self.clock.rules) {
                (Some(_), None) => TURNING,
                (Some(_), Some(_)) => TURNING_ADAPTIVE,
                (None, _) => "",
            },
        }
    }
}

/// Adds the work of the links in the step of a zone just completed. Of links that turn, `now` and `last` are forces of terms.
pub(crate) fn record(
    driver: &Driver,
    (rows, turn): (&[(u32, LinkRow)], bool),
    [now, last, _]: &mut [Vec<f64>; 3],
    (links, works): (&[(String, Range<usize>)], &mut [f64]),
) {
    let link_of = |row: u32| links.partition_point(|(_, range)| range.end <= row as usize);
    if turn {
        driver.terms_work(rows, [last, now], |row, work| works[link_of(row)] += work);
    } else {
        for (row, terms) in rows {
            let own = *row as usize;
            works[link_of(*row)] += driver.row_work(terms, last[own], now[own]);
        }
    }
    last.copy_from_slice(now);
}

pub(crate) fn sample(zone: usize, driver: &Driver, samples: &mut Vec<Sample>) {
    let report = driver.report();
    samples.push(Sample {
        zone,
        time: report.time,
        dt: report.dt,
        contacts: report.contacts.clone(),
    });
}
