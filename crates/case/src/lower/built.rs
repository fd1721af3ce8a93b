//! What a case amounts to.

use std::sync::Arc;

use carom_dynamics::System;
use carom_output::expectations::Expected;
use carom_output::{AllowableSettings, LevelSettings, Spectrum};
use carom_zones::Zoned;

use super::joints::BuiltOverlap;
use super::reference::ExactReference;
use crate::schema::Motion;

/// What a case amounts to.
#[derive(Debug)]
pub struct Built {
    /// The system, ready to be driven unless zones step apart.
    pub system: Arc<System>,
    /// The model in zones, if the case has some.
    pub zoned: Option<Zoned>,
    /// Whether the zones step apart: the system is then all of the model, for output.
    pub apart: bool,
    /// Its overlaps, in the order of their names.
    pub overlaps: Vec<BuiltOverlap>,
    /// Time at the end, s.
    pub end: f64,
    /// End (s) and steps of the static stage before the dynamics, if there is one.
    pub stage: Option<(f64, u32)>,
    /// Contacts that are judged together, in the order of their names.
    pub levels: Vec<LevelSettings>,
    /// What bodies, supports, springs and bolts may bear.
    pub allowables: Vec<AllowableSettings>,
    /// What a run must give; filled in once all else is built.
    pub expected: Expected,
    /// Probes, in the order of their names.
    pub probes: Vec<BuiltProbe>,
    /// The exact solution that the case names.
    pub reference: Option<ExactReference>,
    /// What is strange but not wrong.
    pub warnings: Vec<String>,
    /// Those of them that concern the result.
    pub doubts: Vec<String>,
    /// Bodies whose reduction has a file, and where the reduction comes from.
    pub reductions: Vec<(String, String)>,
    /// Signals, and what they have in words.
    pub signals: Vec<(String, String)>,
}

impl Built {
    /// What another rank than the first has of a case to the time `end` (s): its part of the system.
    pub(crate) fn beside(system: Arc<System>, end: f64) -> Built {
        Built {
            system,
            zoned: None,
            apart: false,
            overlaps: Vec::new(),
            end,
            stage: None,
            levels: Vec::new(),
            allowables: Vec::new(),
            expected: Expected::default(),
            probes: Vec::new(),
            reference: None,
            warnings: Vec::new(),
            doubts: Vec::new(),
            reductions: Vec::new(),
            signals: Vec::new(),
        }
    }
}

/// A probe with its nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct BuiltProbe {
    /// Name.
    pub name: String,
    /// Nodes of the mesh, each with its weight in the mean, relative to the others.
    pub nodes: Vec<(u32, f64)>,
    /// Cell whose stress is recorded.
    pub cell: Option<carom_mesh::ElementId>,
    /// Cell of a beam or a shell in whose section forces are recorded, and the end of a beam.
    pub section: Option<(carom_mesh::ElementId, usize)>,
    /// What is recorded.
    pub record: Vec<Motion>,
    /// Response spectrum of its absolute acceleration.
    pub spectrum: Option<Spectrum>,
    /// Classes (Hz) of the filters of its accelerations.
    pub filters: Vec<u32>,
}
