//! Accelerations of probes behind the filters of impact tests, beside the raw ones: `filtered.csv`.
//!
//! The filters run backward too, so that they begin when the run has ended. Where steps differ, samples are at their mean distance,
//! straight between the steps.

use carom_dynamics::{Order, State, StepReport, System};
use carom_signals::{ChannelFilter, Record};

use crate::results::Probe;
use crate::results::sensor::{COMPONENTS, Sensor};
use crate::results::settings::Settings;
use crate::rows::{Cell, Rows};
use crate::{Error, Folder, column};

const FILE: &str = "filtered.csv";

/// The accelerations of the probes with filters.
#[derive(Debug)]
pub(crate) struct Filtered {
    probes: Vec<(Probe, Vec<Sensor>)>,
    times: Vec<f64>,
    /// By probe, kind of acceleration and direction, m/s².
    histories: Vec<Vec<f64>>,
    every: Option<f64>,
}

/// An acceleration of a probe, raw or behind a filter.
#[derive(Debug)]
pub(crate) struct FilteredCurve {
    /// Probe, kind of acceleration and direction.
    pub(crate) title: String,
    /// `raw`, or the name of the filter.
    pub(crate) name: String,
    /// Class of the filter, Hz.
    pub(crate) filter: Option<u32>,
    /// s, m/s².
    pub(crate) points: Vec<(f64, f64)>,
}

impl FilteredCurve {
    /// Its role in a plot.
    pub(crate) fn role(&self) -> &'static str {
        match self.filter {
            None => "computed",
            Some(_) => "filtered",
        }
    }
}

/// Names of the accelerations of a probe that are written; whether each has that of the frame.
fn kinds(probe: &Probe) -> impl Iterator<Item = (&'static str, bool)> {
    let own = probe.acceleration.then_some(("acceleration", false));
    let absolute = probe.absolute_acceleration;
    let absolute = absolute.then_some(("absolute acceleration", true));
    own.into_iter().chain(absolute)
}

impl Filtered {
    /// Nothing yet; `sensors`: of each probe.
    pub(crate) fn new(settings: &Settings, sensors: &[Vec<Sensor>]) -> Filtered {
        let probes = settings.probes.iter().cloned().zip(sensors.iter().cloned());
        let probes: Vec<_> = probes
            .filter(|(probe, _)| !probe.filters.is_empty())
            .collect();
        let count = |(probe, sensors): &(Probe, Vec<Sensor>)| kinds(probe).count() * sensors.len();
        Filtered {
            times: Vec::new(),
            histories: vec![Vec::new(); probes.iter().map(count).sum()],
            probes,
            every: settings.history_every,
        }
    }

    /// Times and histories so far.
    pub(super) fn kept(&self) -> (&[f64], &[Vec<f64>]) {
        (&self.times, &self.histories)
    }

    /// Goes on from the times and histories of a checkpoint.
    pub(super) fn go_on(&mut self, (times, histories): (Vec<f64>, Vec<Vec<f64>>)) {
        (self.times, self.histories) = (times, histories);
    }

    pub(crate) fn push(&mut self, system: &System, state: &State, report: &StepReport) {
        // the time of a static stage is none
        if self.probes.is_empty() || report.step < system.static_steps() {
            return;
        }
        self.times.push(report.time);
        let frame = system.frame_acceleration(report.time, report.dt);
        let mut histories = self.histories.iter_mut();
        for (probe, sensors) in &self.probes {
            for (_, absolute) in kinds(probe) {
                for (sensor, frame) in sensors.iter().zip(frame) {
                    let own = sensor.of(system, &state.motion, Order::Acceleration);
                    let value = if absolute { own + frame } else { own };
                    if let Some(history) = histories.next() {
                        history.push(value);
                    }
                }
            }
        }
    }

    /// Writes `filtered.csv`, if a probe has a filter and there are two states; returns its columns, each raw one before those behind its
    /// filters.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(crate) fn write(&mut self, folder: &mut Folder) -> Result<Vec<FilteredCurve>, Error> {
        let (Some(first), Some(last)) = (self.times.first(), self.times.last()) else {
            return Ok(Vec::new());
        };
        let step = (last - first) / (self.times.len().max(2) - 1) as f64;
        if step <= 0.0 {
            return Ok(Vec::new());
        }
        let first = *first;
        let (mut names, mut columns) = (vec![column(&["time"], "s")], Vec::new());
        let mut curves = Vec::new();
        let curve = |title: &str, filter: Option<u32>, samples: &[f64]| FilteredCurve {
            title: title.to_owned(),
            name: filter.map_or("raw".to_owned(), |class| format!("CFC {class}")),
            filter,
            points: samples
                .iter()
                .enumerate()
                .map(|(k, a)| (first + k as f64 * step, *a))
                .collect(),
        };
        let mut histories = self.histories.drain(..);
        for (probe, sensors) in &self.probes {
            for (kind, _) in kinds(probe) {
                for component in &COMPONENTS[..sensors.len()] {
                    let what = format!("{kind} {component}");
                    let raw = histories.next().unwrap_or_default();
                    let raw = sampled(&self.times, raw, step);
                    names.push(column(&["probe", &probe.name, &what], "m/s²"));
                    let title = format!("Probe {}: {what}", probe.name);
                    curves.push(curve(&title, None, &raw));
                    columns.push(raw.clone());
                    for class in &probe.filters {
                        // cases with longer steps are refused
                        let Some(filter) = ChannelFilter::new(f64::from(*class), step) else {
                            continue;
                        };
                        let mut samples = raw.clone();
                        filter.apply(&mut samples);
                        let name = format!("cfc {class}");
                        names.push(column(&["probe", &probe.name, &what, &name], "m/s²"));
                        curves.push(curve(&title, Some(*class), &samples));
                        columns.push(samples);
                    }
                }
            }
        }
        let mut rows = Rows::create(&folder.file(FILE)?, &names)?;
        let mut next = f64::NEG_INFINITY;
        for k in 0..columns.first().map_or(0, Vec::len) {
            let time = first + k as f64 * step;
            if time < next {
                continue;
            }
            next = self
                .every
                .map_or(time, |every| (time + every) * (1.0 - 1e-12));
            let cells: Vec<Cell> = std::iter::once(time)
                .chain(columns.iter().map(|column| column[k]))
                .map(Cell::Number)
                .collect();
            rows.push(cells.iter().copied())?;
        }
        rows.finish()?;
        Ok(curves)
    }
}

/// The values of a history at equal distances (s) from its first time on.
fn sampled(times: &[f64], values: Vec<f64>, step: f64) -> Vec<f64> {
    let first = times[0];
    let off = |(k, time): (usize, &f64)| (time - first - k as f64 * step).abs();
    if times.iter().enumerate().map(off).fold(0.0, f64::max) < 1e-6 * step {
        return values;
    }
    let points = times.iter().zip(&values).map(|(t, a)| [*t, *a]).collect();
    let equal = Record::new(points).and_then(|record| record.resampled(step));
    // values that are not finite are no record
    equal.map_or(values, |record| {
        record.points().iter().map(|p| p[1]).collect()
    })
}
