//! `[pretension]`: bolts that the static stage tightens.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use carom_quantities::{Force, Stiffness};

use super::discrete::Ends;
use super::obstacle::NormalVector;

/// A bolt: over the static stage its force grows to `force`, whatever gives way, and the shank is shortened as the nut turns. In the
/// dynamics it keeps that length: its force is then `force` and its stiffness times the elongation since the end of the stage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend(
    "oneOf" = [{ "required": ["ends"] }, { "required": ["beam"] }, { "required": ["on"] }],
    "dependentRequired" = { "ends": ["axis", "stiffness"], "axis": ["ends"], "stiffness": ["ends"] },
))]
pub struct Pretension {
    /// Force at the end of the static stage, positive: tension in the bolt.
    pub force: Force,
    /// A bolt between two groups of one node each, or of a group and `"ground"`: between a group of several nodes and the ground there is a
    /// bolt at each node.
    pub ends: Option<Ends>,
    /// Direction from the first end to the second one, fixed in space: the bolt has no force across it.
    pub axis: Option<NormalVector>,
    /// Force over elongation of the shank.
    pub stiffness: Option<Stiffness>,
    /// A body of beams with small rotations: the cell in the middle of each of its lines is tightened.
    pub beam: Option<String>,
    /// A group of cells of such beams: the cell in the middle of each line of them is tightened. Or a section of solids at small strain: a group of all cells that
    /// the bolt has between two planes across it, or of faces of cells in one plane inside it.
    pub on: Option<String>,
}
