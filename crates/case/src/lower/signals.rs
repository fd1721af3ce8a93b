//! Signals: functions of time by name, from points and files.

use std::path::Path;

use carom_dynamics::Amplitude;
use carom_mesh::read::file;
use carom_output::plot::{digits, quantity};
use carom_quantities::units::{Dimension, parse_quantity};
use carom_signals::{Error, Record, Synthetic, Table, corrected};

use super::Builder;
use super::course::{Course, Signals};
use crate::error::Problem;
use crate::input::Input;
use crate::schema::{
    self, AccelerationSource, Baseline, Columns, DisplacementSource, FactorSource, Signal,
};

/// Most bytes of a file of a signal, 256 MiB.
const LARGEST: u64 = 256 << 20;

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.80665;

/// Velocity at the end of a record over its largest one, above which a support that follows it drifts away.
const DRIFT: f64 = 1e-6;

/// Times and values with the key path of each time, where the file says them one by one.
struct Points {
    points: Vec<[f64; 2]>,
    /// Path of the signal's source.
    path: String,
    /// Lines of the points in a file.
    lines: Vec<usize>,
}

/// A column of a text file, and the keys of the case file that say so.
pub(super) struct FileColumn<'a> {
    /// Key of its name.
    pub(super) key: &'a str,
    /// Its name.
    pub(super) name: &'a str,
    /// Key of its unit.
    pub(super) unit_key: &'a str,
    /// Unit that the case file gives.
    pub(super) unit: Option<&'a String>,
    /// What it has.
    pub(super) dimension: &'a str,
}

impl Builder<'_> {
    /// All signals of the case.
    pub(super) fn signals(&mut self, input: &Input) -> Signals {
        let signals = self.case.signal.iter();
        signals
            .map(|(name, signal)| (name.to_string(), self.signal(input, name, signal)))
            .collect()
    }

    fn signal(&mut self, input: &Input, name: &str, signal: &Signal) -> Option<Course> {
        let path = format!("signal.{name}");
        let Signal {
            acceleration,
            displacement,
            factor,
            ..
        } = signal;
        let scale = signal.scale.unwrap_or(1.0);
        let delay = signal.delay.map_or(0.0, |delay| delay.0);
        let moved = |points: &mut Points| {
            for point in &mut points.points {
                *point = [point[0] + delay, scale * point[1]];
            }
        };
        match (acceleration, displacement, factor) {
            (Some(source), ..) => {
                let mut points = match source {
                    AccelerationSource::Points(points) => {
                        let points = points.iter().map(|p| [p.time.0, p.acceleration.0]);
                        listed(points.collect(), &format!("{path}.acceleration.points"))
                    }
                    AccelerationSource::Csv(columns) => {
                        let path = format!("{path}.acceleration.csv");
                        self.columns(&input.folder, &path, (columns, "acceleration"))?
                    }
                    AccelerationSource::Synthetic(given) => {
                        let path = format!("{path}.acceleration.synthetic");
                        let record = self.synthetic(&path, given)?;
                        listed(record.points().to_vec(), &path)
                    }
                };
                moved(&mut points);
                self.note_signal(name, &points, ("acceleration", "m/s^2"));
                let record = Record::new(points.points.clone());
                let record = record.map_err(|error| self.no_function(&error, &points));
                let record = record.ok()?;
                self.on_its_baseline(&path, record, signal.baseline)
                    .map(Course::Acceleration)
            }
            (None, Some(source), _) => {
                let mut points = match source {
                    DisplacementSource::Points(points) => {
                        let points = points.iter().map(|p| [p.time.0, p.displacement.0]);
                        listed(points.collect(), &format!("{path}.displacement.points"))
                    }
                    DisplacementSource::Csv(columns) => {
                        let path = format!("{path}.displacement.csv");
                        self.columns(&input.folder, &path, (columns, "length"))?
                    }
                };
                moved(&mut points);
                self.note_signal(name, &points, ("displacement", "m"));
                self.straight(&points).map(Course::Displacement)
            }
            (None, None, source) => {
                let mut points = match source.as_ref()? {
                    FactorSource::Points(points) => {
                        let points = points.iter().map(|p| [p.time.0, p.factor]);
                        listed(points.collect(), &format!("{path}.factor.points"))
                    }
                    FactorSource::Csv(columns) => {
                        let path = format!("{path}.factor.csv");
                        self.columns(&input.folder, &path, (columns, "number"))?
                    }
                };
                moved(&mut points);
                self.note_signal(name, &points, ("factor", ""));
                self.straight(&points).map(Course::Factor)
            }
        }
    }

    /// Notes what a signal has: its largest value with its unit, and how far its points are apart.
    fn note_signal(&mut self, name: &str, points: &Points, (what, unit): (&str, &str)) {
        let points = &points.points;
        let size = |point: &[f64; 2]| point[1].abs();
        let by_size = |a: &&[f64; 2], b: &&[f64; 2]| size(a).total_cmp(&size(b));
        let (Some(largest), [first, .., last]) = (points.iter().max_by(by_size), &points[..])
        else {
            return;
        };
        let steps = points.windows(2).map(|pair| pair[1][0] - pair[0][0]);
        let least = steps.clone().fold(f64::INFINITY, f64::min);
        let most = steps.fold(0.0, f64::max);
        // rounding of the times in a file
        let apart = match most - least <= 1e-3 * most {
            true => format!("every {}", quantity(most, "s")),
            false => format!("{} to {} apart", quantity(least, "s"), quantity(most, "s")),
        };
        let gravity = match unit {
            "m/s^2" if largest[1] != 0.0 => format!(", {} gn", digits(largest[1] / GRAVITY, 3)),
            _ => String::new(),
        };
        let told = format!(
            "{what}, largest {}{gravity} at {}; {} points {apart} from {} to {}",
            quantity(largest[1], unit),
            quantity(largest[0], "s"),
            points.len(),
            quantity(first[0], "s"),
            quantity(last[0], "s"),
        );
        self.told_signals.push((name.to_owned(), told));
    }

    /// A record fitted to a spectrum.
    fn synthetic(&mut self, path: &str, given: &schema::Synthetic) -> Option<Record> {
        let spectrum = given.spectrum.iter();
        let spectrum: Vec<_> = spectrum
            .map(|point| [point.frequency.0, point.acceleration.0])
            .collect();
        let highest = spectrum.iter().fold(0.0, |m: f64, point| m.max(point[0]));
        let wanted = Synthetic {
            damping: given.damping,
            duration: given.duration.0,
            rise: given.rise.0,
            strong: given.strong.0,
            step: given.step.map_or(0.1 / highest, |step| step.0),
            seed: u64::from(given.seed),
            tolerance: given.tolerance,
            spectrum,
        };
        let refused = |error: Error| {
            let path = match &error {
                Error::NotASpectrum { at } => format!("{path}.spectrum[{at}]"),
                Error::TooBrief { .. } | Error::TooManySamples { .. } => {
                    format!("{path}.duration")
                }
                Error::TooCoarse { .. } => format!("{path}.step"),
                Error::Envelope { .. } => format!("{path}.strong"),
                _ => format!("{path}.spectrum"),
            };
            let problem = Problem::new(path, error.to_string());
            self.problems.push(match error {
                Error::NotMet { .. } => problem.accepted([
                    "a spectrum that oscillators of this damping can have",
                    "another `seed`",
                    "a longer `duration` or `strong` part",
                    "a larger `tolerance`",
                ]),
                _ => problem,
            });
        };
        wanted.record().map_err(refused).ok()
    }

    fn straight(&mut self, points: &Points) -> Option<Amplitude> {
        let amplitude = Amplitude::new(points.points.clone());
        amplitude
            .map_err(|error| self.no_function(&error, points))
            .ok()
    }

    fn on_its_baseline(
        &mut self,
        path: &str,
        record: Record,
        baseline: Option<Baseline>,
    ) -> Option<Record> {
        match baseline.unwrap_or_default() {
            Baseline::AsGiven => Some(record),
            Baseline::Corrected => corrected(&record)
                .map_err(|error| {
                    let problem = Problem::new(format!("{path}.baseline"), error.to_string());
                    self.problems
                        .push(problem.accepted(["a record with more points", "\"as-given\""]));
                })
                .ok(),
        }
    }

    /// Tells why points are no function of time, at the point where the case has it, else with the line of the file.
    fn no_function(&mut self, error: &Error, points: &Points) {
        let path = &points.path;
        let problem = match (error, points.lines.is_empty()) {
            (Error::Times { at, time, before }, true) => {
                let problem = Problem::new(format!("{path}[{at}].time"), "the times must ascend");
                problem
                    .found(format!("{time} s"))
                    .accepted([format!("more than {before} s")])
            }
            (Error::Times { at, time, before }, false) => {
                let line = points.lines.get(*at).copied().unwrap_or_default();
                let message = format!(
                    "the times must ascend: line {line} of the file has {time} s after {before} s"
                );
                Problem::new(format!("{path}.time"), message)
            }
            (error, _) => Problem::new(path, error.to_string()),
        };
        self.problems.push(problem);
    }

    /// The times and values of two columns of a file, in SI units.
    fn columns(
        &mut self,
        folder: &Path,
        path: &str,
        (given, dimension): (&Columns, &str),
    ) -> Option<Points> {
        let keys = [
            FileColumn {
                key: "time",
                name: &given.time,
                unit_key: "time-unit",
                unit: given.time_unit.as_ref(),
                dimension: "time",
            },
            FileColumn {
                key: "value",
                name: &given.value,
                unit_key: "unit",
                unit: given.unit.as_ref(),
                dimension,
            },
        ];
        let (points, lines) = self.file_columns(folder, path, &given.file, keys)?;
        Some(Points {
            points,
            path: path.to_owned(),
            lines,
        })
    }

    /// Columns of a file in SI units, and the lines of their rows.
    pub(super) fn file_columns<const N: usize>(
        &mut self,
        folder: &Path,
        path: &str,
        file: &str,
        keys: [FileColumn; N],
    ) -> Option<(Vec<[f64; N]>, Vec<usize>)> {
        let bytes = file::regular(&folder.join(file), LARGEST);
        let text = bytes.map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        let table = text
            .map_err(|error| error.to_string())
            .and_then(|text| Table::parse(&text).map_err(|error| error.to_string()));
        let table = match table {
            Ok(table) => table,
            Err(error) => {
                let message = format!("{file}: {error}");
                self.problems
                    .push(Problem::new(format!("{path}.file"), message));
                return None;
            }
        };
        let found = keys.map(|column| self.file_column(path, (file, &table), &column));
        let mut columns = Vec::with_capacity(N);
        let mut lines = Vec::new();
        for column in found {
            let (values, of_values) = column?;
            columns.push(values);
            lines = of_values;
        }
        let row = |k: usize| std::array::from_fn(|column| columns[column][k]);
        Some(((0..lines.len()).map(row).collect(), lines))
    }

    /// The values of a column in SI units, and their lines.
    fn file_column(
        &mut self,
        path: &str,
        (file, table): (&str, &Table),
        wanted: &FileColumn,
    ) -> Option<(Vec<f64>, Vec<usize>)> {
        let FileColumn {
            key,
            name,
            unit_key,
            unit,
            dimension,
        } = wanted;
        let column = match table.column(name) {
            Ok(column) => column,
            Err(Error::NoColumn { name, columns }) => {
                let message = format!("{file} has no column of this name");
                let problem = Problem::new(format!("{path}.{key}"), message);
                let columns = columns.iter().map(String::as_str);
                self.problems.push(problem.unknown(&name, columns));
                return None;
            }
            Err(error) => {
                let message = format!("{file}: {error}");
                self.problems
                    .push(Problem::new(format!("{path}.{key}"), message));
                return None;
            }
        };
        let unit_path = format!("{path}.{unit_key}");
        let written = match (&column.unit, unit) {
            (Some(of_file), Some(unit)) if of_file != *unit => {
                let message = format!("column `{name}` has the unit [{of_file}] already");
                let problem = Problem::new(unit_path, message).found(*unit);
                self.problems.push(problem);
                return None;
            }
            (Some(of_file), _) => Some((of_file, format!("{path}.{key}"))),
            (None, unit) => unit.map(|unit| (unit, unit_path)),
        };
        let factor = match written {
            None => 1.0,
            Some((unit, path)) => self.factor_of(&path, unit, dimension)?,
        };
        let values = column.values.iter().map(|value| factor * value).collect();
        Some((values, column.lines))
    }

    /// The SI value of one of a unit.
    fn factor_of(&mut self, path: &str, unit: &str, dimension: &str) -> Option<f64> {
        let wanted = Dimension::named(dimension)?;
        match parse_quantity(&format!("1 {unit}"), wanted) {
            Ok(factor) => Some(factor),
            Err(error) => {
                let mut problem = Problem::new(path, error.to_string()).found(unit);
                problem.nearest = error.meant();
                self.problems.push(
                    problem.accepted([format!("a unit of {dimension}, such as {}", wanted.unit())]),
                );
                None
            }
        }
    }

    /// The signal of this name, if it is one; a problem where there is none.
    fn find(&mut self, path: &str, name: &str) -> Option<Course> {
        match self.signals.get(name) {
            Some(course) => course.clone(),
            None => {
                let names: Vec<String> = self.signals.keys().cloned().collect();
                let problem = Problem::new(path, "no signal of this name in the case");
                let names = names.iter().map(String::as_str);
                self.problems.push(problem.unknown(name, names));
                None
            }
        }
    }

    fn of_another_quantity(&mut self, path: &str, (name, found): (&str, &Course), accepted: &str) {
        let message = format!("the signal `{name}` is {}", found.quantity());
        let problem = Problem::new(path, message).found(name);
        self.problems
            .push(problem.accepted([format!("a signal that is {accepted}")]));
    }

    /// The displacement of a support that follows a signal.
    pub(super) fn displacement_signal(&mut self, path: &str, name: &str) -> Option<Amplitude> {
        match self.find(path, name)? {
            Course::Displacement(amplitude) => Some(amplitude),
            Course::Acceleration(record) => {
                self.warn_of_drift(path, name, &record);
                Some(record.displacement())
            }
            other => {
                let accepted = "a displacement or an acceleration";
                self.of_another_quantity(path, (name, &other), accepted);
                None
            }
        }
    }

    /// A base acceleration.
    pub(super) fn acceleration_signal(&mut self, path: &str, name: &str) -> Option<Amplitude> {
        match self.find(path, name)? {
            Course::Acceleration(record) => Some(record.acceleration()),
            other => {
                self.of_another_quantity(path, (name, &other), "an acceleration");
                None
            }
        }
    }

    /// The factor of a load.
    pub(super) fn factor_signal(&mut self, path: &str, name: &str) -> Option<Amplitude> {
        match self.find(path, name)? {
            Course::Factor(amplitude) => Some(amplitude),
            other => {
                self.of_another_quantity(path, (name, &other), "a factor");
                None
            }
        }
    }

    /// Warns of a support that moves on after its record.
    fn warn_of_drift(&mut self, path: &str, name: &str, record: &Record) {
        let [v, u] = record.drift();
        let speeds = record.integrals();
        let fastest = speeds.iter().fold(0.0_f64, |m, [v, _]| m.max(v.abs()));
        if v.abs() > DRIFT * fastest {
            self.warnings.push(format!(
                "{path}: the record `{name}` ends with {v:.3e} m/s at {u:.3e} m: the support goes on with this velocity; signal.{name}.baseline = \"corrected\" brings it to rest where it began"
            ));
        }
    }

    /// Warns of files whose steps are not those of the run.
    pub(super) fn warn_of_steps(&mut self, dt: f64) {
        let mut warnings = Vec::new();
        for (name, signal) in self.case.signal.iter() {
            let from_file = matches!(signal.acceleration, Some(AccelerationSource::Csv(_)));
            let Some(Some(Course::Acceleration(record))) = self.signals.get(name) else {
                continue;
            };
            let steps = record.steps();
            // rounding of the times in the file
            if from_file && steps.longest > 1.001 * dt {
                warnings.push(format!(
                    "signal.{name}: its points are up to {:.6} s apart, the steps of the run {dt} s: the acceleration is straight between the points, so the record says nothing about the response above {:.3} Hz",
                    steps.longest,
                    0.5 / steps.longest
                ));
            }
            if from_file && steps.shortest < 0.999 * dt {
                warnings.push(format!(
                    "signal.{name}: its points are {} s apart, closer than the steps of the run, {dt} s: the run does not see all of them; take a step of at most {} s",
                    steps.shortest, steps.shortest
                ));
            }
        }
        self.warnings.extend(warnings);
    }
}

/// Points that the case lists.
fn listed(points: Vec<[f64; 2]>, path: &str) -> Points {
    Points {
        points,
        path: path.to_owned(),
        lines: Vec::new(),
    }
}
