//! Largest values of the fields of a run, each with its place and its instant.

use serde::{Deserialize, Serialize};

/// The largest value of a field.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Maximum {
    /// In SI units.
    pub value: f64,
    /// Name of the body.
    pub body: String,
    /// Place in the reference configuration, m: of the node, or of the middle of the cell.
    pub place: Vec<f64>,
    /// When, s.
    pub time: f64,
}

/// The largest values: of stresses over the steps, of others at the instants that a run keeps for its pictures, between which they may have been
/// larger.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Maxima {
    /// Number of these instants: at equal times, at the first closing, the largest force and the last release, and at the end.
    pub instants: usize,
    /// Steps from one look at the stresses to the next: 1 where each is looked at. The kept instants and static
    /// steps are looked at in any case.
    #[serde(default)]
    pub stress_every: u64,
    /// Von Mises stress, mean of a cell, Pa; of a shell the largest through its thickness, of a beam the largest in its sections. `None` where
    /// nothing is stressed.
    pub von_mises: Option<Maximum>,
    /// The same of each body that is stressed.
    #[serde(default)]
    pub von_mises_of_bodies: Vec<Maximum>,
    /// Principal strain of a cell of the largest magnitude, of solids and bars: at small strain that of the displacement, at
    /// finite strain the logarithmic one; `None` where nothing is strained.
    #[serde(default)]
    pub strain: Option<Maximum>,
    /// Equivalent plastic strain, mean of a cell; `None` where nothing yields.
    pub plastic_strain: Option<Maximum>,
    /// Magnitude of the displacement of a node, m.
    pub displacement: Option<Maximum>,
}
