//! The largest equivalent stress of von Mises in a body, cheap enough to be looked for after each step.
//!
//! Stresses of elements at small strain are linear in the displacement. Their coefficients are computed once: mean gradients of the shape
//! functions of solids, forces at the ends of beams. The stresses at the places of a section, which cost more than its forces, are computed
//! only where a bound of them is beyond what was found before. All other elements have theirs as in fields.

mod beams;
mod solids;
mod state;

use crate::{Body, Resultants};

use beams::BeamForces;
use solids::MeanStrains;
pub use state::StressedState;
use state::{larger, von_mises};

/// What a body looks for its largest stress with.
#[derive(Debug)]
pub struct PeakStress(Form);

#[derive(Debug)]
enum Form {
    Solid(MeanStrains),
    Beam(BeamForces),
    /// Without stress.
    Stiff,
    General,
}

/// What it costs to look for the largest stress of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LookCost {
    /// A part of its internal forces: the stresses are linear in the displacement.
    Linear,
    /// As much as its internal forces, or more.
    General,
    /// As much as the forces of all elements, which its own steps do not compute: of a reduced body.
    Recovered,
}

impl PeakStress {
    /// Of a body.
    pub fn new(body: &Body) -> PeakStress {
        let form = match body {
            Body::Rigid(_) | Body::Discrete(_) => Some(Form::Stiff),
            Body::Solid(solid) => MeanStrains::new(solid).map(Form::Solid),
            Body::Beam(beam) => BeamForces::new(beam).map(Form::Beam),
            _ => None,
        };
        PeakStress(form.unwrap_or(Form::General))
    }

    /// What a look at a body costs.
    pub fn cost(body: &Body) -> LookCost {
        let is_linear = match body {
            Body::Rigid(_) | Body::Discrete(_) => true,
            Body::Solid(solid) => MeanStrains::serve(solid),
            Body::Beam(beam) => BeamForces::serve(beam),
            Body::LargeBeam(_) | Body::Shell(_) => false,
            Body::Reduced(_) => return LookCost::Recovered,
        };
        if is_linear {
            LookCost::Linear
        } else {
            LookCost::General
        }
    }

    /// The largest equivalent stress (Pa) of an element of the body that is not deleted, if it is larger than a `floor` (Pa), with the place of the
    /// element in [`Body::cells`]; the first of equals. Of a solid or a bar it is that of the mean stress, of a shell the largest through its
    /// thickness, of a beam the largest in its sections.
    pub fn above(&self, floor: f64, body: &Body, at: &StressedState) -> Option<(f64, u32)> {
        match (&self.0, body) {
            (Form::Stiff, _) => None,
            (Form::Solid(strains), _) => strains.above(floor, at.u),
            (Form::Beam(forces), Body::Beam(beam)) => forces.above(floor, beam, at),
            _ => general(floor, body, at),
        }
    }
}

fn general(floor: f64, body: &Body, at: &StressedState) -> Option<(f64, u32)> {
    let deleted = body.deleted(at.history);
    let is_there = |cell: usize| deleted.as_ref().is_none_or(|deleted| !deleted[cell]);
    let all = equivalent_stresses(body, at).into_iter().enumerate();
    let all = all.filter(|(cell, value)| *value > floor && value.is_finite() && is_there(*cell));
    all.map(|(cell, value)| (value, cell as u32)).reduce(larger)
}

/// Equivalent stress of each element, Pa, in the order of [`Body::cells`].
fn equivalent_stresses(body: &Body, at: &StressedState) -> Vec<f64> {
    let StressedState { u, frames, history } = *at;
    if let Some(sections) = body.section_stresses(u, frames, history) {
        return sections.iter().map(|own| own.von_mises).collect();
    }
    match body {
        Body::Shell(shell) => {
            let all = shell.resultants(frames, u, history);
            let each = all.iter().zip(shell.mean_thicknesses());
            each.map(|(own, thickness)| through(own, thickness))
                .collect()
        }
        _ => {
            let all = body.stresses(u, history);
            all.iter().map(|(_, stress)| von_mises(stress)).collect()
        }
    }
}

/// The largest equivalent stress through the thickness (m) of a shell, Pa.
fn through(own: &Resultants, thickness: f64) -> f64 {
    let middle = von_mises(&(own.membrane / thickness));
    let faces = own.faces.iter().map(von_mises);
    faces.fold(middle.max(own.between), f64::max)
}
