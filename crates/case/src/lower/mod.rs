//! Stage two: names resolved, meshes read, ranges that need the mesh checked; a system, or every problem found.
//!
//! Each section of the case file has a file with a function `lower` from the `Context` and the results of earlier sections, which reports to
//! `Problems`. `model.rs` and `system.rs` call them in their order.

mod added;
mod advice;
mod allowables;
mod arlequin;
mod beams;
mod bodies;
mod built;
mod columns;
mod constraints;
mod contact_checks;
mod contact_pairs;
mod contacts;
mod context;
mod course;
mod damped;
mod discrete;
mod explicit;
mod fluids;
mod general;
mod general_sides;
mod held;
mod hinged;
mod joints;
mod laws;
mod layers;
mod levels;
mod loads;
mod lookup;
mod materials;
mod mesh;
mod model;
mod nonlinear;
mod obstacles;
mod oscillators;
mod penetration;
mod pieces;
mod plan;
mod pretensions;
mod probes;
mod problems;
mod profiles;
mod reductions;
mod reference;
mod refused;
mod rigid;
mod shells;
mod signals;
mod stops;
mod supports;
mod surfaces;
mod system;
mod thickness;
mod thin_overlaps;
mod tied;
mod ties;
mod time;
mod transitions;
mod turning;
mod unfit;
mod zones;

use std::path::Path;

use carom_dynamics::Model;

use crate::error::Problem;
use crate::input::Input;
use crate::locate::Locator;
use crate::schema::Case;

pub use added::AddedForce;
pub use built::{Built, BuiltProbe};
use context::Context;
pub use joints::BuiltOverlap;
use problems::Problems;
pub(crate) use problems::plural;
pub use reference::ExactReference;

/// Builds the system of a case, with forces that are in no case file; what it must give is left to [`complete`](crate::complete). `saves`: whether a
/// reduction that is made anew is saved in its file.
///
/// # Errors
/// All problems that stage two can tell, with their places; those of the forces have none.
pub(crate) fn built(
    case: &Case,
    locator: &Locator,
    (input, saves): (&Input, bool),
    forces: &[AddedForce],
) -> Result<Built, Vec<Problem>> {
    lowered(case, locator, (input, saves), |context, problems| {
        system::lower(context, forces, problems)
    })
}

/// The model of a case without zones, for another rank than the first, which builds its part of it ([`Driver::beside`](carom_dynamics::Driver::beside)).
/// Its step is not known.
///
/// # Errors
/// As [`build`](crate::build), but for what the system tells.
pub fn model(case: &Case, locator: &Locator, input: &Input) -> Result<Model, Vec<Problem>> {
    lowered(case, locator, (input, true), |context, problems| {
        let modelled = model::lower(context, &[], problems)?;
        Some(model::in_one(context, modelled.model))
    })
}

/// What `lower` makes of a case, or the problems with their places. `saves`: whether a reduction that is made anew is saved in its file.
fn lowered<T>(
    case: &Case,
    locator: &Locator,
    (input, saves): (&Input, bool),
    lower: impl FnOnce(&Context, &mut Problems) -> Option<T>,
) -> Result<T, Vec<Problem>> {
    let mut problems = Problems::default();
    let plan = zones::lower(case, &mut problems);
    let signals = signals::lower(case, &input.folder, &mut problems);
    let file = input.sources.first();
    let context = Context {
        case,
        signals: &signals,
        plan: &plan,
        file: Path::new(file.map_or("", |source| &source.name)),
        folder: &input.folder,
        saves,
    };
    match lower(&context, &mut problems) {
        Some(lowered) if problems.is_empty() => Ok(lowered),
        _ => Err(locator.locate_all(problems.all)),
    }
}
