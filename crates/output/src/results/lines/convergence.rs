//! Whether mesh and step are fine enough.

use crate::results::lines::{Evidence, Finding};

/// One run cannot tell, unless there is an exact solution beside it.
pub(super) fn of_mesh_and_step(evidence: &Evidence) -> Finding {
    match evidence.exact {
        Some(_) => Finding::Absent,
        None => Finding::Unchecked(match evidence.study {
            Some(study) => format!("whether mesh and step are fine enough: run `{study}`"),
            None => "whether mesh and step are fine enough".to_owned(),
        }),
    }
}

/// A basis does not know what it leaves out.
pub(super) fn of_modes(evidence: &Evidence) -> Finding {
    match evidence.reduced() {
        None => Finding::Absent,
        Some((names, first)) => Finding::Unchecked(format!(
            "whether the modes of {names} are enough: double `body.{first}.reduction.modes` and compare"
        )),
    }
}

/// Damping by modes leaves the others without any.
pub(super) fn of_undamped_modes(evidence: &Evidence) -> Finding {
    let system = evidence.system;
    let unknowns = |body: usize| system.parts[system.part_of_body[body]].len();
    let modal = system.modal.iter();
    let told: Vec<String> = modal
        .filter(|modal| modal.modes.len() < unknowns(modal.body))
        .map(|modal| {
            let highest = modal.modes.iter().map(|[f, _]| *f).fold(0.0, f64::max);
            let name = system.bodies[modal.body].name();
            format!("`{name}` above {highest:.4} Hz")
        })
        .collect();
    if told.is_empty() {
        return Finding::Absent;
    }
    Finding::Unchecked(format!(
        "whether the modes without damping ring, those of {}: look at spectra of probes, or give `damping.modal` more modes",
        told.join(", ")
    ))
}
