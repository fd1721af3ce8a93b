//! Every scheme with every law and every feature.
//!
//! Problem: the models of `features`, meshes as coarse as they can be: each combination of a registered scheme, a law
//! of each kind and a feature is built, and runs until the bodies have met, or is refused with a reason. Closed solution: the
//! balances of energy and momentum. Tolerance: 1e-11 of the largest energy and momentum, round-off as for linear steps, and what the
//! iterations may leave over at their tolerance, which the ledger states and which must itself stay below 1e-7 of them. The table of the
//! manual is the one that is made here. Sizes: quick runs one law with each scheme and feature, full all.

use carom_dynamics::State;

use crate::Error;
use crate::check::{Check, Row, Size};
use crate::features::{Built, Feature, label, schemes};
use crate::reasons::reason;

/// Round-off in balances, relative.
const ROUNDING: f64 = 1e-11;
/// What iterations may leave over at most, relative.
const TOLERATED: f64 = 1e-7;

/// One in how many combinations the quick size runs; the number of laws is no multiple of it, so that all of them have their turn.
const SAMPLE: usize = 7;

/// A combination, or why there is none.
enum Cell {
    Runs(Box<Built>),
    Refused(String),
}

/// Laws of each kind with one scheme: names and cells, feature by feature.
struct Line {
    scheme: String,
    law: &'static str,
    cells: Vec<Cell>,
}

fn lines() -> Result<Vec<Line>, Error> {
    let mut lines = Vec::new();
    for scheme in schemes() {
        let names: Vec<&str> = Feature::Friction.laws()?.iter().map(|law| law.0).collect();
        for (k, name) in names.into_iter().enumerate() {
            let cell = |feature: Feature| -> Result<Cell, Error> {
                match feature.built(scheme, feature.laws()?[k].1, 1) {
                    Ok(built) => Ok(Cell::Runs(Box::new(built))),
                    Err(error) => reason(&error).map(Cell::Refused).ok_or(error),
                }
            };
            lines.push(Line {
                scheme: label(scheme),
                law: name,
                cells: Feature::ALL
                    .into_iter()
                    .map(cell)
                    .collect::<Result<_, _>>()?,
            });
        }
    }
    Ok(lines)
}

/// What is left over in a run, relative to what may be: above one, it is too much.
pub(crate) struct Balances {
    energy: f64,
    momentum: f64,
    /// What the iterations may leave over, relative.
    tolerated: f64,
}

impl Balances {
    pub(crate) fn of(state: &State) -> Balances {
        let ledger = &state.ledger;
        let (energy, momentum) = (ledger.largest_energy, ledger.largest_momentum);
        let tolerated = &ledger.tolerated;
        let part =
            |residual: f64, size: f64, tolerated: f64| residual / (ROUNDING * size + tolerated);
        Balances {
            energy: part(ledger.largest_energy_residual, energy, tolerated.energy),
            momentum: part(
                ledger.largest_momentum_residual,
                momentum,
                tolerated.momentum,
            ),
            tolerated: (tolerated.energy / energy).max(tolerated.momentum / momentum),
        }
    }

    /// The largest of the residuals over what they may be, and what iterations may leave over what that may be.
    pub(crate) fn worst(&self) -> f64 {
        let parts = [self.energy, self.momentum, self.tolerated / TOLERATED];
        parts
            .into_iter()
            .fold(0.0, |worst, part| match part.is_nan() {
                true => f64::INFINITY,
                false => worst.max(part),
            })
    }

    /// The row of a run.
    pub(crate) fn row(&self, name: &str) -> Row {
        Row::at_most(
            format!("{name}: residuals of the balances / bound"),
            self.worst(),
            1.0,
        )
    }
}

fn run(feature: Feature, built: &Built) -> Result<(Balances, bool), Error> {
    let mut run = built.start()?;
    while run.state().step < feature.steps() {
        run.step()?;
    }
    let closing = run.state().records.contacts[0].first_closing;
    Ok((Balances::of(run.state()), closing.is_some()))
}

/// Figures of the runs with a feature.
#[derive(Default)]
struct Runs {
    taken: usize,
    refused: usize,
    untouched: usize,
    failed: usize,
    /// The first that failed, and why.
    first: String,
    worst: f64,
}

impl Runs {
    fn add(&mut self, line: &Line, outcome: Result<(Balances, bool), Error>) {
        self.taken += 1;
        match outcome {
            Ok((balances, touched)) => {
                self.worst = self.worst.max(balances.worst());
                self.untouched += usize::from(!touched);
            }
            Err(error) => {
                self.failed += 1;
                if self.first.is_empty() {
                    self.first = format!(" ({}, {}: {error})", line.scheme, line.law);
                }
            }
        }
    }

    fn rows(&self, feature: Feature) -> Vec<Row> {
        let name = |what: &str| format!("{}: {what}", feature.name());
        vec![
            Row::at_least(name("runs"), self.taken as f64, 1.0),
            Row::count(name("runs that failed") + &self.first, self.failed, 0),
            Row::count(name("runs that never touched"), self.untouched, 0),
            Row::at_most(name("residuals of the balances / bound"), self.worst, 1.0),
            Row::shown(name("combinations that are refused"), self.refused as f64),
        ]
    }
}

pub(crate) const CHECK: Check = Check {
    name: "combinations",
    fact: "every scheme with every law and feature keeps its balances or is refused with a reason",
    run: |size| {
        let lines = lines()?;
        let mut rows = Vec::new();
        for (k, feature) in Feature::ALL.into_iter().enumerate() {
            let mut runs = Runs::default();
            for (number, line) in lines.iter().enumerate() {
                let built = match &line.cells[k] {
                    Cell::Runs(built) => built,
                    Cell::Refused(_) => {
                        runs.refused += 1;
                        continue;
                    }
                };
                if size == Size::Quick && number % SAMPLE != k % SAMPLE {
                    continue;
                }
                runs.add(line, run(feature, built));
            }
            rows.extend(runs.rows(feature));
        }
        Ok(rows)
    },
};

/// The table of the manual.
///
/// # Errors
/// A model that cannot be built and is not refused.
pub fn table() -> Result<String, Error> {
    let lines = lines()?;
    let mut reasons: Vec<(&str, usize)> = Vec::new();
    let titles = Feature::ALL.map(Feature::name);
    let mut text = format!(
        "| scheme | law | {} |\n|---|---|{}\n",
        titles.join(" | "),
        "---|".repeat(titles.len())
    );
    for line in &lines {
        let mut cells = Vec::new();
        for cell in &line.cells {
            cells.push(match cell {
                Cell::Runs(_) => "runs".to_string(),
                Cell::Refused(reason) => {
                    let place = match reasons.iter().position(|(other, _)| other == reason) {
                        Some(place) => place,
                        None => {
                            reasons.push((reason, 0));
                            reasons.len() - 1
                        }
                    };
                    reasons[place].1 += 1;
                    (place + 1).to_string()
                }
            });
        }
        text += &format!(
            "| {} | {} | {} |\n",
            line.scheme,
            line.law,
            cells.join(" | ")
        );
    }
    let refused: usize = reasons.iter().map(|(_, count)| count).sum();
    let all = lines.len() * titles.len();
    text += &format!(
        "\n{} of {all} combinations run; {refused} are refused:\n\n",
        all - refused
    );
    for (k, (reason, count)) in reasons.iter().enumerate() {
        text += &format!("{}. {reason} ({count} combinations)\n", k + 1);
    }
    Ok(text)
}
