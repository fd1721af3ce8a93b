//! What can be wrong with a signal.

use thiserror::Error as ThisError;

/// What can be wrong with a signal. Lines of files count from 1.
#[derive(Clone, Debug, PartialEq, ThisError)]
pub enum Error {
    /// No point at all.
    #[error("a function of time needs a point at least")]
    Empty,
    /// A time that is not after the one before it.
    #[error("the times must ascend: point {} has {time} s after {before} s", at + 1)]
    Times {
        /// Index of the point.
        at: usize,
        /// Its time, s.
        time: f64,
        /// The time before it, s.
        before: f64,
    },
    /// A number that is not finite.
    #[error("point {} is not finite", at + 1)]
    NotFinite {
        /// Index of the point.
        at: usize,
    },
    /// A record without duration.
    #[error("a record needs two points at least: with one it has no duration")]
    NoDuration,
    /// Too few points for a baseline correction.
    #[error("a baseline correction needs {least} points at least, the record has {points}")]
    TooShort {
        /// Points of the record.
        points: usize,
        /// Least number.
        least: usize,
    },
    /// A point that makes no spectrum.
    #[error(
        "point {} of the spectrum: frequencies must ascend, frequencies and accelerations be greater than zero", at + 1
    )]
    NotASpectrum {
        /// Index of the point.
        at: usize,
    },
    /// A point that makes no spectral density.
    #[error(
        "point {} of the spectral density: frequencies must ascend from above zero, densities not be negative", at + 1
    )]
    NotADensity {
        /// Index of the point.
        at: usize,
    },
    /// A synthetic record shorter than the longest period of its spectrum.
    #[error(
        "{duration} s are too short for a spectrum at {frequency} Hz: a period is needed at least"
    )]
    TooBrief {
        /// Duration, s.
        duration: f64,
        /// Lowest frequency of the spectrum, Hz.
        frequency: f64,
    },
    /// A band of a random load between two of its harmonics, so that the load would be zero.
    #[error(
        "a random load over {duration} s has its harmonics at multiples of {} Hz, and none is from {first} to {last} Hz", 1.0 / duration
    )]
    NoHarmonic {
        /// Duration, s.
        duration: f64,
        /// Lowest frequency of the spectrum, Hz.
        first: f64,
        /// Highest frequency of the spectrum, Hz.
        last: f64,
    },
    /// A synthetic record with too long a step.
    #[error(
        "a record with a step of {step} s has nothing at {frequency} Hz: it needs four points in a period at least"
    )]
    TooCoarse {
        /// Step, s.
        step: f64,
        /// Highest frequency of the spectrum, Hz.
        frequency: f64,
    },
    /// A signal of more samples than are worth their memory.
    #[error(
        "the duration has {samples:.2e} samples, and {most} are allowed: it is too long for the highest frequency, or for the step"
    )]
    TooManySamples {
        /// Samples of all signals that are made together.
        samples: f64,
        /// Most of them.
        most: usize,
    },
    /// An envelope longer than its record.
    #[error("the rise and the strong part of the envelope last {least} s, the record {duration} s")]
    Envelope {
        /// Duration of both, s.
        least: f64,
        /// Duration of the record, s.
        duration: f64,
    },
    /// A spectrum that no iterate met.
    #[error(
        "the spectrum cannot be met: at {frequency} Hz the best record has {:.1} % {} than {target} m/s², and {:.1} % are allowed",
        100.0 * misfit.abs(),
        if *misfit > 0.0 { "more" } else { "less" },
        100.0 * tolerance
    )]
    NotMet {
        /// Frequency of the worst point, Hz.
        frequency: f64,
        /// Its acceleration, m/s².
        target: f64,
        /// Found over target less one.
        misfit: f64,
        /// Largest misfit allowed.
        tolerance: f64,
    },
    /// A file without a row of numbers.
    #[error("the file has no row of numbers")]
    NoRows,
    /// A column that the file does not have.
    #[error("the file has no column '{name}'; it has {}", listed(.columns))]
    NoColumn {
        /// Name that was asked for.
        name: String,
        /// Columns of the file.
        columns: Vec<String>,
    },
    /// A row with another number of values than there are columns.
    #[error("line {line} has {found} values, the file has {columns} columns: a gap in the record?")]
    Ragged {
        /// Line of the file.
        line: usize,
        /// Values in the line.
        found: usize,
        /// Columns of the file.
        columns: usize,
    },
    /// A cell without a value.
    #[error("line {line} has no value in column '{column}': a gap in the record")]
    Missing {
        /// Line of the file.
        line: usize,
        /// Name of the column.
        column: String,
    },
    /// A cell that is no finite number.
    #[error("line {line}: '{text}' in column '{column}' is no number (a decimal point is needed)")]
    NotANumber {
        /// Line of the file.
        line: usize,
        /// Name of the column.
        column: String,
        /// The cell.
        text: String,
    },
}

fn listed(columns: &[String]) -> String {
    let quoted: Vec<String> = columns.iter().map(|name| format!("'{name}'")).collect();
    quoted.join(", ")
}
