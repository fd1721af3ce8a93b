//! `[expect]`: what a run of the case must give.

use std::borrow::Cow;

use carom_quantities::Delay;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

/// A number of the results that a run of this file must give: a `value` with its tolerance, or bounds. A run that misses one is graded
/// `bad`. With a `--set` that changes the model the rows are shown and not judged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend(
    "oneOf" = [{ "required": ["summary"] }, { "required": ["column"] }],
    "anyOf" = [{ "required": ["value"] }, { "required": ["at-least"] }, { "required": ["at-most"] }],
    "dependentRequired" = {
        "value": ["tolerance"],
        "tolerance": ["value"],
        "column": ["take"],
        "take": ["column"],
    },
))]
pub struct Expect {
    /// A number of `summary.json`: its keys, joined by dots. The first number of a list has the key 0: `momentum.final.0`.
    pub summary: Option<String>,
    /// A column of `histories.csv`, by its name there.
    pub column: Option<String>,
    /// Which number of the column.
    pub take: Option<Take>,
    /// What the number must be.
    pub value: Option<Amount>,
    /// Largest difference from the value: a bare number is a part of the value, a text with a unit an absolute difference.
    pub tolerance: Option<Amount>,
    /// Smallest number allowed.
    pub at_least: Option<Amount>,
    /// Largest number allowed.
    pub at_most: Option<Amount>,
    /// What the value or the bound is.
    pub kind: ExpectKind,
    /// Where it is from: the formula; author, year and place; or the run that gave it.
    pub source: String,
    /// Why the tolerance is what it is; a regression needs it.
    pub reason: Option<String>,
}

/// Which number of a column of histories.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Take {
    /// The largest.
    Largest,
    /// The smallest.
    Smallest,
    /// That of the last row.
    Last,
    /// That at a time, between two rows on the line that joins them.
    At(Delay),
}

/// What an expected number is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ExpectKind {
    /// An exact solution, an identity, a conservation law, or a bound that theory states.
    ClosedForm,
    /// A figure printed in the literature.
    Published,
    /// A figure of an implementation that shares no code with Carom.
    AnotherCode,
    /// Another scheme, law, mesh or formulation of Carom.
    SecondFormulation,
    /// A figure that Carom itself gave: the row shows that it has not changed, not that it is right.
    Regression,
}

/// A number, or a text with a unit, of the dimension of what it is compared with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Amount {
    /// In SI units, or a part.
    Number(f64),
    /// With a unit.
    Text(String),
}

impl JsonSchema for Amount {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        "Amount".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["number", "string"], "x-any-dimension": true, "x-example": "6.6 N s" })
    }
}
