//! Damping of modes.

use carom_dynamics::Model;
use carom_reduction::{Ratios, damp};

use super::context::Context;
use super::problems::Problems;
use crate::error::Problem;
use crate::schema;

/// Damps the modes of the bodies for which the case says so.
pub(super) fn lower(context: &Context, model: &mut Model, problems: &mut Problems) {
    let case = context.case;
    for (number, (name, body)) in case.body.iter().enumerate() {
        let modal = body
            .damping
            .as_ref()
            .and_then(|damping| damping.modal.as_ref());
        let Some(given) = modal else { continue };
        let path = format!("body.{name}.damping.modal");
        let problem = if body.reduction.is_some() {
            let problem = Problem::new(
                &path,
                "a reduced body has dense matrices, in which its own modes are damped",
            );
            problem.accepted(["reduction.damping-ratio"])
        } else {
            let ratios = ratios(given);
            let Err(error) = damp(model, number, &ratios) else {
                continue;
            };
            let path = match (&error, &ratios) {
                (carom_reduction::Error::Damped { .. }, Ratios::Each(_)) => {
                    format!("{path}.ratios")
                }
                (carom_reduction::Error::Damped { .. }, _) => format!("{path}.below"),
                _ => path,
            };
            Problem::new(path, error.to_string())
        };
        problems.push(problem);
    }
}

fn ratios(given: &schema::ModalDamping) -> Ratios {
    match (&given.ratios, given.ratio, given.below) {
        (Some(each), ..) => Ratios::Each(each.clone()),
        (None, ratio, below) => Ratios::Below {
            ratio: ratio.unwrap_or(0.0),
            frequency: below.map_or(0.0, |below| below.0),
        },
    }
}
