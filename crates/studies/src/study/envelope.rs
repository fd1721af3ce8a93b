//! The envelope of the runs of a study: for each contact and level the largest force, the largest energy of an impact and the work of friction over all
//! records, gaps and directions, with the run that gives it.

use carom_output::rows::Cell;
use carom_output::statistics::{Level, Statistics};
use carom_output::summary::Summary;
use carom_output::table::{Table, write_csv};
use carom_output::{Error, Folder};
use carom_pages::form;
use carom_pages::plot::{quantity, rounded};

use crate::study::Study;

/// A largest value and the run that it is from.
#[derive(Clone, Debug, PartialEq)]
pub struct Governed {
    /// The value, SI.
    pub value: f64,
    /// Name of the run.
    pub run: String,
}

/// What the runs come to in one contact or level.
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    /// `contact` or `level`.
    pub kind: &'static str,
    /// Its name.
    pub name: String,
    /// Largest force, N.
    pub force: Option<Governed>,
    /// Largest energy taken up in an impact, J.
    pub energy: Option<Governed>,
    /// Smallest margin of the force.
    pub force_margin: Option<Governed>,
    /// Smallest margin of the energy.
    pub energy_margin: Option<Governed>,
    /// Largest energy that friction took over a run, J: a measure of wear.
    pub friction: Option<Governed>,
}

impl Study {
    /// The envelope over the runs that were computed: levels, then contacts; those without an impact in any run are left out.
    pub fn envelope(&self) -> Vec<Envelope> {
        let levels = self.names(|summary| summary.levels.keys().cloned().collect());
        let contacts = self.names(|summary| summary.contacts.keys().cloned().collect());
        let of_level = |name: String| {
            let statistics = |summary: &Summary, value: fn(&Statistics) -> f64| {
                summary
                    .levels
                    .get(&name)
                    .map(|level| value(&level.statistics))
            };
            let margin = |summary: &Summary, of: fn(&Level) -> Option<f64>| {
                summary.levels.get(&name).and_then(of)
            };
            Envelope {
                kind: "level",
                force: self.largest(1.0, |s| statistics(s, |s| s.peak_force)),
                energy: self.largest(1.0, |s| statistics(s, |s| s.energy_taken)),
                force_margin: self
                    .largest(-1.0, |s| margin(s, |l| l.force_margin.as_ref()?.margin)),
                energy_margin: self
                    .largest(-1.0, |s| margin(s, |l| l.energy_margin.as_ref()?.margin)),
                friction: self.largest(1.0, |s| statistics(s, |s| s.friction_loss)),
                name: name.clone(),
            }
        };
        let of_contact = |name: String| {
            let statistics = |summary: &Summary, value: fn(&Statistics) -> f64| {
                summary.contacts.get(&name)?.statistics.as_ref().map(value)
            };
            Envelope {
                kind: "contact",
                force: self.largest(1.0, |s| statistics(s, |s| s.peak_force)),
                energy: self.largest(1.0, |s| statistics(s, |s| s.energy_taken)),
                force_margin: None,
                energy_margin: None,
                friction: self.largest(1.0, |s| statistics(s, |s| s.friction_loss)),
                name: name.clone(),
            }
        };
        let all = levels.into_iter().map(of_level);
        all.chain(contacts.into_iter().map(of_contact))
            .filter(|envelope| envelope.force.is_some())
            .collect()
    }

    /// Names that any run has, each once, sorted.
    fn names(&self, of: impl Fn(&Summary) -> Vec<String>) -> Vec<String> {
        let done = self.runs.iter().filter_map(|run| run.variant.done());
        let mut names: Vec<String> = done.flat_map(|done| of(&done.summary)).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// The run with the largest value times a sign; the first of equals. Zero of what is a size is nothing.
    fn largest(&self, sign: f64, of: impl Fn(&Summary) -> Option<f64>) -> Option<Governed> {
        let mut best: Option<Governed> = None;
        for run in &self.runs {
            let value = run.variant.done().and_then(|done| of(&done.summary));
            let Some(value) = value.filter(|value| sign < 0.0 || *value > 0.0) else {
                continue;
            };
            if best
                .as_ref()
                .is_none_or(|best| sign * value > sign * best.value)
            {
                best = Some(Governed {
                    value,
                    run: run.variant.name.clone(),
                });
            }
        }
        best
    }

    /// The envelope for people: the levels, or without levels the contacts.
    pub fn envelope_table(&self) -> Table {
        let all = self.envelope();
        let kind = all.first().map_or("", |first| first.kind);
        let show = |governed: &Option<Governed>, unit: &'static str| match governed {
            None => [form::NOTHING.to_owned(), String::new()],
            Some(governed) => {
                let value = match unit {
                    "%" => format!("{} %", rounded(100.0 * governed.value, "", 3)),
                    unit => quantity(governed.value, unit),
                };
                [value, governed.run.clone()]
            }
        };
        let row = |envelope: &Envelope| {
            let cells = [
                show(&envelope.force, "N"),
                show(&envelope.energy, "J"),
                show(&envelope.force_margin, "%"),
                show(&envelope.energy_margin, "%"),
                show(&envelope.friction, "J"),
            ];
            let name = std::iter::once(envelope.name.clone());
            name.chain(cells.into_iter().flatten()).collect()
        };
        let heads = [
            "",
            "largest force",
            "in",
            "largest energy",
            "in",
            "margin of the force",
            "in",
            "margin of the energy",
            "in",
            "lost in friction",
            "in",
        ];
        Table {
            heads: heads.map(str::to_owned).to_vec(),
            rows: all.iter().filter(|e| e.kind == kind).map(row).collect(),
        }
    }

    /// Writes `envelope.csv`, if a contact had an impact in any run.
    pub(super) fn write_envelope(&self, folder: &mut Folder) -> Result<(), Error> {
        let all = self.envelope();
        if all.is_empty() {
            return Ok(());
        }
        let names = [
            "kind",
            "name",
            "peak_force_n",
            "peak_force_run",
            "energy_taken_j",
            "energy_taken_run",
            "force_margin",
            "force_margin_run",
            "energy_margin",
            "energy_margin_run",
            "friction_loss_j",
            "friction_loss_run",
        ];
        let rows: Vec<Vec<Cell>> = all.iter().map(cells).collect();
        write_csv(&folder.file("envelope.csv")?, &names, &rows)
    }
}

fn cells(envelope: &Envelope) -> Vec<Cell<'_>> {
    let of = [
        &envelope.force,
        &envelope.energy,
        &envelope.force_margin,
        &envelope.energy_margin,
        &envelope.friction,
    ];
    let mut row = vec![Cell::Text(envelope.kind), Cell::Text(&envelope.name)];
    for governed in of {
        row.push(Cell::from(governed.as_ref().map(|governed| governed.value)));
        let run = governed.as_ref().map(|governed| governed.run.as_str());
        row.push(run.map_or(Cell::Empty, Cell::Text));
    }
    row
}
