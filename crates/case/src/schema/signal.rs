//! `[signal]`: functions of time that loads, supports and base accelerations refer to.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use carom_quantities::{Acceleration, Delay, Duration, Frequency};

use super::body::MovementPoint;
use super::load::AmplitudePoint;

/// A function of time. What uses it names it: a support that moves, a base acceleration, the amplitude of a load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend(
    "oneOf" = [
        { "required": ["acceleration"] },
        { "required": ["displacement"] },
        { "required": ["factor"] },
    ],
    "dependentRequired" = { "baseline": ["acceleration"] },
))]
pub struct Signal {
    /// Acceleration: straight between its points, zero before the first and after the last. A support that follows it moves by
    /// its exact double integral, from rest.
    pub acceleration: Option<AccelerationSource>,
    /// Displacement of supports: straight between its points, constant before the first and after the last.
    pub displacement: Option<DisplacementSource>,
    /// Factor of loads: straight between its points, constant before the first and after the last.
    pub factor: Option<FactorSource>,
    /// Factor of all values. Default: 1.
    pub scale: Option<f64>,
    /// Added to all times. Default: 0.
    pub delay: Option<Delay>,
    /// Baseline of an acceleration. Default: `as-given`.
    pub baseline: Option<Baseline>,
}

/// Where an acceleration comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AccelerationSource {
    /// Points.
    #[schemars(extend("minItems" = 2))]
    Points(Vec<AccelerationPoint>),
    /// Columns of a text file.
    Csv(Columns),
    /// A random record fitted to a response spectrum, on its baseline.
    Synthetic(Synthetic),
}

/// Where a displacement comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DisplacementSource {
    /// Points.
    #[schemars(extend("minItems" = 1))]
    Points(Vec<MovementPoint>),
    /// Columns of a text file.
    Csv(Columns),
}

/// Where a factor comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FactorSource {
    /// Points.
    #[schemars(extend("minItems" = 1))]
    Points(Vec<AmplitudePoint>),
    /// Columns of a text file.
    Csv(Columns),
}

/// A point of an acceleration as a function of time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AccelerationPoint {
    /// Time.
    pub time: Delay,
    /// Acceleration at that time.
    pub acceleration: Acceleration,
}

/// Two columns of a text file: numbers in rows, separated by semicolons, commas, tabs or blanks; lines with `#` are comments. The
/// first row has the names of the columns, each with its unit in square brackets if it is none of SI: `t [ms], a [gn]`. A file
/// without names has the columns `1`, `2`, ....
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Columns {
    /// Path of the file, from the folder of the case file.
    pub file: String,
    /// Column of the times.
    pub time: String,
    /// Column of the values.
    pub value: String,
    /// Unit of the times, if the column does not say it. Default: s.
    pub time_unit: Option<String>,
    /// Unit of the values, if the column does not say it. Default: that of SI.
    pub unit: Option<String>,
}

/// Baseline of an acceleration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Baseline {
    /// As it is: the ground may end away from where it was, and may move on.
    #[default]
    AsGiven,
    /// Corrected by a smooth acceleration such that the ground ends at rest where it began.
    Corrected,
}

/// A random record fitted to a response spectrum. Its envelope rises, stays, and decays; velocity and displacement end at zero.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Synthetic {
    /// Points of the response spectrum with ascending frequencies; between them it is straight in both logarithms.
    #[schemars(extend("minItems" = 1))]
    pub spectrum: Vec<SpectrumPoint>,
    /// Damping ratio of the spectrum.
    #[serde(default = "five_per_cent")]
    #[schemars(range(min = 0.001, max = 0.5))]
    pub damping: f64,
    /// Duration of the record; at least the longest period of the spectrum.
    pub duration: Duration,
    /// Time in which the envelope rises, as the square of the time.
    pub rise: Duration,
    /// Time for which the envelope is one; after it the envelope decays to 5 % at the end.
    pub strong: Duration,
    /// Step of the record, at most a quarter of the shortest period. Default: a tenth of the shortest period.
    pub step: Option<Duration>,
    /// Seed of the random phases: another seed gives another record.
    #[serde(default = "one")]
    pub seed: u32,
    /// Largest relative misfit at the points of the spectrum.
    #[serde(default = "five_per_cent")]
    #[schemars(range(min = 0.005, max = 0.5))]
    pub tolerance: f64,
}

fn five_per_cent() -> f64 {
    0.05
}

fn one() -> u32 {
    1
}

/// A point of a response spectrum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SpectrumPoint {
    /// Frequency of the oscillator.
    pub frequency: Frequency,
    /// Its largest absolute acceleration.
    pub acceleration: Acceleration,
}
