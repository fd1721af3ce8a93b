//! Signals: functions of time by name, from points and files.

use std::path::Path;

use carom_dynamics::Amplitude;
use carom_pages::plot::{digits, quantity};
use carom_signals::{Error, Record, Synthetic, corrected};

use super::columns::{self, FileColumn};
use super::context::Context;
use super::course::{Course, Signals};
use super::problems::Problems;
use crate::error::Problem;
use crate::schema::{
    self, AccelerationSource, Baseline, Case, Columns, DisplacementSource, FactorSource, Signal,
};

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

/// All signals of the case. `folder`: that its paths start from.
pub(super) fn lower(case: &Case, folder: &Path, problems: &mut Problems) -> Signals {
    let mut signals = Signals::default();
    for (name, given) in case.signal.iter() {
        let lowered = signal(&format!("signal.{name}"), given, folder, problems);
        let course = lowered.map(|Lowered { course, words }| {
            signals
                .words
                .extend(words.map(|words| (name.to_owned(), words)));
            course
        });
        signals.courses.insert(name.to_owned(), course);
    }
    signals
}

/// A signal, and what it has in words.
struct Lowered {
    course: Course,
    words: Option<String>,
}

fn signal(path: &str, given: &Signal, folder: &Path, problems: &mut Problems) -> Option<Lowered> {
    let mut points = match (&given.acceleration, &given.displacement, &given.factor) {
        (Some(source), ..) => accelerations(path, source, folder, problems),
        (None, Some(source), _) => displacements(path, source, folder, problems),
        (None, None, source) => factors(path, source.as_ref()?, folder, problems),
    }?;
    let scale = given.scale.unwrap_or(1.0);
    let delay = given.delay.map_or(0.0, |delay| delay.0);
    for point in &mut points.points {
        *point = [point[0] + delay, scale * point[1]];
    }
    let (course, words) = if given.acceleration.is_some() {
        let record = Record::new(points.points.clone());
        let record = record.map_err(|error| no_function(&error, &points, problems));
        let record = on_its_baseline(path, record.ok()?, given.baseline, problems)?;
        (Course::Acceleration(record), ("acceleration", "m/s^2"))
    } else if given.displacement.is_some() {
        let course = Course::Displacement(straight(&points, problems)?);
        (course, ("displacement", "m"))
    } else {
        (Course::Factor(straight(&points, problems)?), ("factor", ""))
    };
    Some(Lowered {
        course,
        words: words_of(&points, words),
    })
}

fn accelerations(
    path: &str,
    source: &AccelerationSource,
    folder: &Path,
    problems: &mut Problems,
) -> Option<Points> {
    match source {
        AccelerationSource::Points(points) => {
            let points = points.iter().map(|p| [p.time.0, p.acceleration.0]);
            let path = format!("{path}.acceleration.points");
            Some(listed(points.collect(), &path))
        }
        AccelerationSource::Csv(csv) => {
            let path = format!("{path}.acceleration.csv");
            columns(folder, &path, (csv, "acceleration"), problems)
        }
        AccelerationSource::Synthetic(given) => {
            let path = format!("{path}.acceleration.synthetic");
            let record = synthetic(&path, given, problems)?;
            Some(listed(record.points().to_vec(), &path))
        }
    }
}

fn displacements(
    path: &str,
    source: &DisplacementSource,
    folder: &Path,
    problems: &mut Problems,
) -> Option<Points> {
    match source {
        DisplacementSource::Points(points) => {
            let points = points.iter().map(|p| [p.time.0, p.displacement.0]);
            let path = format!("{path}.displacement.points");
            Some(listed(points.collect(), &path))
        }
        DisplacementSource::Csv(csv) => {
            let path = format!("{path}.displacement.csv");
            columns(folder, &path, (csv, "length"), problems)
        }
    }
}

fn factors(
    path: &str,
    source: &FactorSource,
    folder: &Path,
    problems: &mut Problems,
) -> Option<Points> {
    match source {
        FactorSource::Points(points) => {
            let points = points.iter().map(|p| [p.time.0, p.factor]);
            let path = format!("{path}.factor.points");
            Some(listed(points.collect(), &path))
        }
        FactorSource::Csv(csv) => {
            let path = format!("{path}.factor.csv");
            columns(folder, &path, (csv, "number"), problems)
        }
    }
}

/// What a signal has: its largest value with its unit, and how far its points are apart.
fn words_of(points: &Points, (what, unit): (&str, &str)) -> Option<String> {
    let points = &points.points;
    let size = |point: &[f64; 2]| point[1].abs();
    let by_size = |a: &&[f64; 2], b: &&[f64; 2]| size(a).total_cmp(&size(b));
    let (Some(largest), [first, .., last]) = (points.iter().max_by(by_size), &points[..]) else {
        return None;
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
    Some(format!(
        "{what}, largest {}{gravity} at {}; {} points {apart} from {} to {}",
        quantity(largest[1], unit),
        quantity(largest[0], "s"),
        points.len(),
        quantity(first[0], "s"),
        quantity(last[0], "s"),
    ))
}

/// A record fitted to a spectrum.
fn synthetic(path: &str, given: &schema::Synthetic, problems: &mut Problems) -> Option<Record> {
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
        problems.push(match error {
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

fn straight(points: &Points, problems: &mut Problems) -> Option<Amplitude> {
    let amplitude = Amplitude::new(points.points.clone());
    amplitude
        .map_err(|error| no_function(&error, points, problems))
        .ok()
}

fn on_its_baseline(
    path: &str,
    record: Record,
    baseline: Option<Baseline>,
    problems: &mut Problems,
) -> Option<Record> {
    match baseline.unwrap_or_default() {
        Baseline::AsGiven => Some(record),
        Baseline::Corrected => corrected(&record)
            .map_err(|error| {
                let problem = Problem::new(format!("{path}.baseline"), error.to_string());
                problems.push(problem.accepted(["a record with more points", "\"as-given\""]));
            })
            .ok(),
    }
}

/// Tells why points are no function of time, at the point where the case has it, else with the line of the file.
fn no_function(error: &Error, points: &Points, problems: &mut Problems) {
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
    problems.push(problem);
}

/// The times and values of two columns of a file, in SI units.
fn columns(
    folder: &Path,
    path: &str,
    (given, dimension): (&Columns, &str),
    problems: &mut Problems,
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
    let (points, lines) = columns::file_columns(folder, path, &given.file, keys, problems)?;
    Some(Points {
        points,
        path: path.to_owned(),
        lines,
    })
}

/// What follows a signal.
#[derive(Clone, Copy)]
pub(super) enum Follower {
    /// The displacement of a support.
    Displacement,
    /// A base acceleration.
    Acceleration,
    /// The factor of a load.
    Factor,
}

impl Follower {
    /// Its function of time, if the signal is one of its quantities.
    fn amplitude(self, course: &Course) -> Option<Amplitude> {
        match (self, course) {
            (Follower::Displacement, Course::Acceleration(record)) => Some(record.displacement()),
            (Follower::Acceleration, Course::Acceleration(record)) => Some(record.acceleration()),
            (Follower::Displacement, Course::Displacement(amplitude))
            | (Follower::Factor, Course::Factor(amplitude)) => Some(amplitude.clone()),
            _ => None,
        }
    }

    /// Its quantities.
    fn quantities(self) -> &'static str {
        match self {
            Follower::Displacement => "a displacement or an acceleration",
            Follower::Acceleration => "an acceleration",
            Follower::Factor => "a factor",
        }
    }
}

/// The function of time of what follows the signal `name`.
pub(super) fn followed(
    context: &Context,
    path: &str,
    name: &str,
    follower: Follower,
    problems: &mut Problems,
) -> Option<Amplitude> {
    let courses = &context.signals.courses;
    let Some(course) = courses.get(name) else {
        let problem = Problem::new(path, "no signal of this name in the case");
        return problems.refuse(problem.unknown(name, courses.keys().map(String::as_str)));
    };
    let course = course.as_ref()?;
    if let (Follower::Displacement, Course::Acceleration(record)) = (follower, course) {
        warn_of_drift(path, name, record, problems);
    }
    follower.amplitude(course).or_else(|| {
        let message = format!("the signal `{name}` is {}", course.quantity());
        let problem = Problem::new(path, message).found(name);
        problems.refuse(problem.accepted([format!("a signal that is {}", follower.quantities())]))
    })
}

/// Warns of a support that moves on after its record.
fn warn_of_drift(path: &str, name: &str, record: &Record, problems: &mut Problems) {
    let [v, u] = record.drift();
    let speeds = record.integrals();
    let fastest = speeds.iter().fold(0.0_f64, |m, [v, _]| m.max(v.abs()));
    if v.abs() > DRIFT * fastest {
        problems.warn(format!(
            "{path}: the record `{name}` ends with {v:.3e} m/s at {u:.3e} m: the support goes on with this velocity; signal.{name}.baseline = \"corrected\" brings it to rest where it began"
        ));
    }
}

/// Warns of files whose steps are not those of the run.
pub(super) fn warn_of_steps(context: &Context, dt: f64, problems: &mut Problems) {
    for (name, signal) in context.case.signal.iter() {
        let from_file = matches!(signal.acceleration, Some(AccelerationSource::Csv(_)));
        let Some(Some(Course::Acceleration(record))) = context.signals.courses.get(name) else {
            continue;
        };
        let steps = record.steps();
        // rounding of the times in the file
        if from_file && steps.longest > 1.001 * dt {
            problems.warn(format!(
                "signal.{name}: its points are up to {:.6} s apart, the steps of the run {dt} s: the acceleration is straight between the points, so the record says nothing about the response above {:.3} Hz",
                steps.longest,
                0.5 / steps.longest
            ));
        }
        if from_file && steps.shortest < 0.999 * dt {
            problems.warn(format!(
                "signal.{name}: its points are {} s apart, closer than the steps of the run, {dt} s: the run does not see all of them; take a step of at most {} s",
                steps.shortest, steps.shortest
            ));
        }
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
