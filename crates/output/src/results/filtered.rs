//! Accelerations of probes and forces of contacts behind the filters of impact tests, beside the raw ones: `filtered.csv`.
//!
//! The filters run backward too, so that they begin when the run has ended. Where steps differ, samples are at their mean distance,
//! straight between the steps.

use carom_dynamics::{Order, State, StepReport, System};
use carom_signals::{ChannelFilter, Record};

use crate::results::sensor::{COMPONENTS, Sensor};
use crate::results::settings::Settings;
use crate::rows::{Cell, Rows};
use crate::{Error, Folder, column};

const FILE: &str = "filtered.csv";

/// What a signal is taken from.
#[derive(Debug)]
enum Source {
    /// A component of an acceleration, and the axis of the frame whose acceleration is added.
    Acceleration(Sensor, Option<usize>),
    /// The sum of the normal forces of a contact.
    Force(usize),
}

/// A signal with filters.
#[derive(Debug)]
struct Signal {
    source: Source,
    /// Path of its column.
    path: [String; 3],
    title: String,
    /// Classes of its filters, Hz.
    filters: Vec<u32>,
}

impl Signal {
    fn unit(&self) -> &'static str {
        match self.source {
            Source::Acceleration(..) => "m/s²",
            Source::Force(_) => "N",
        }
    }

    fn of(&self, system: &System, state: &State, report: &StepReport) -> f64 {
        match &self.source {
            Source::Acceleration(sensor, frame) => {
                let own = sensor.of(system, &state.motion, Order::Acceleration);
                let frame =
                    frame.map(|axis| system.frame_acceleration(report.time, report.dt)[axis]);
                frame.unwrap_or(0.0) + own
            }
            Source::Force(contact) => report.contacts[*contact].force,
        }
    }
}

/// The signals with filters.
#[derive(Debug)]
pub(crate) struct Filtered {
    signals: Vec<Signal>,
    times: Vec<f64>,
    /// By signal.
    histories: Vec<Vec<f64>>,
    every: Option<f64>,
}

/// A signal, raw or behind a filter.
#[derive(Debug)]
pub(crate) struct FilteredCurve {
    /// What it is.
    pub(crate) title: String,
    /// `raw`, or the name of the filter.
    pub(crate) name: String,
    /// Class of the filter, Hz.
    pub(crate) filter: Option<u32>,
    /// The contact whose force it is.
    pub(crate) contact: Option<usize>,
    /// s, and m/s² or N.
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

/// The signals of the probes with filters, `sensors` of each probe, and those of the contacts.
fn signals(system: &System, settings: &Settings, sensors: &[Vec<Sensor>]) -> Vec<Signal> {
    let mut signals = Vec::new();
    let probes = settings.probes.iter().zip(sensors);
    for (probe, sensors) in probes.filter(|(probe, _)| !probe.filters.is_empty()) {
        let own = probe.acceleration.then_some(("acceleration", false));
        let absolute = probe.absolute_acceleration;
        let absolute = absolute.then_some(("absolute acceleration", true));
        for (kind, absolute) in own.into_iter().chain(absolute) {
            for (axis, (sensor, component)) in sensors.iter().zip(COMPONENTS).enumerate() {
                let what = format!("{kind} {component}");
                signals.push(Signal {
                    source: Source::Acceleration(sensor.clone(), absolute.then_some(axis)),
                    title: format!("Probe {}: {what}", probe.name),
                    path: ["probe".to_owned(), probe.name.clone(), what],
                    filters: probe.filters.clone(),
                });
            }
        }
    }
    for (k, contact) in system.contacts.iter().enumerate() {
        if let Some(filters) = settings.contact_filters.get(&contact.name) {
            signals.push(Signal {
                source: Source::Force(k),
                title: format!("Force of contact {}", contact.name),
                path: ["contact", &contact.name, "force"].map(str::to_owned),
                filters: filters.clone(),
            });
        }
    }
    signals
}

impl Filtered {
    /// Nothing yet; `sensors`: of each probe.
    pub(crate) fn new(system: &System, settings: &Settings, sensors: &[Vec<Sensor>]) -> Filtered {
        let signals = signals(system, settings, sensors);
        Filtered {
            times: Vec::new(),
            histories: vec![Vec::new(); signals.len()],
            signals,
            every: settings.history_every,
        }
    }

    /// Times and histories so far.
    pub(super) fn kept(&self) -> (&[f64], &[Vec<f64>]) {
        (&self.times, &self.histories)
    }

    /// Whether this can be gone on with.
    pub(super) fn takes(&self, (times, histories): &(Vec<f64>, Vec<Vec<f64>>)) -> bool {
        histories.len() == self.histories.len()
            && histories.iter().all(|history| history.len() == times.len())
            && times.windows(2).all(|pair| pair[0] < pair[1])
    }

    /// Goes on from the times and histories of a checkpoint.
    pub(super) fn go_on(&mut self, (times, histories): (Vec<f64>, Vec<Vec<f64>>)) {
        (self.times, self.histories) = (times, histories);
    }

    pub(crate) fn push(&mut self, system: &System, state: &State, report: &StepReport) {
        // the time of a static stage is none
        if self.signals.is_empty() || report.step < system.static_steps() {
            return;
        }
        self.times.push(report.time);
        for (signal, history) in self.signals.iter().zip(&mut self.histories) {
            history.push(signal.of(system, state, report));
        }
    }

    /// Writes `filtered.csv`, if something has a filter and there are two states; returns its columns, each raw one before those behind its
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
        let mut names = vec![column(&["time"], "s")];
        let mut curves = Vec::new();
        let mut histories = self.histories.drain(..);
        for signal in &self.signals {
            let raw = histories.next().unwrap_or_default();
            let raw = sampled(&self.times, raw, step);
            let path: Vec<&str> = signal.path.iter().map(String::as_str).collect();
            names.push(column(&path, signal.unit()));
            curves.push(curve(signal, None, (*first, step), &raw));
            for class in &signal.filters {
                // cases with longer steps are refused
                let Some(filter) = ChannelFilter::new(f64::from(*class), step) else {
                    continue;
                };
                let mut samples = raw.clone();
                filter.apply(&mut samples);
                let name = format!("cfc {class}");
                let path: Vec<&str> = path.iter().copied().chain([&name[..]]).collect();
                names.push(column(&path, signal.unit()));
                curves.push(curve(signal, Some(*class), (*first, step), &samples));
            }
        }
        let mut rows = Rows::create(&folder.file(FILE)?, &names)?;
        let mut next = f64::NEG_INFINITY;
        for k in 0..curves.first().map_or(0, |curve| curve.points.len()) {
            let time = curves[0].points[k].0;
            if time < next {
                continue;
            }
            next = self
                .every
                .map_or(time, |every| (time + every) * (1.0 - 1e-12));
            let values = curves.iter().map(|curve| curve.points[k].1);
            let cells: Vec<Cell> = std::iter::once(time)
                .chain(values)
                .map(Cell::Number)
                .collect();
            rows.push(cells.iter().copied())?;
        }
        rows.finish()?;
        Ok(curves)
    }
}

/// Samples of a signal from the time `first` (s) on, `step` (s) apart.
fn curve(
    signal: &Signal,
    filter: Option<u32>,
    (first, step): (f64, f64),
    samples: &[f64],
) -> FilteredCurve {
    let samples = samples.iter().enumerate();
    FilteredCurve {
        title: signal.title.clone(),
        name: filter.map_or("raw".to_owned(), |class| format!("CFC {class}")),
        filter,
        contact: match signal.source {
            Source::Force(contact) => Some(contact),
            Source::Acceleration(..) => None,
        },
        points: samples
            .map(|(k, value)| (first + k as f64 * step, *value))
            .collect(),
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
