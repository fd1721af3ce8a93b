//! Whether mesh and step are fine enough.

use crate::results::lines::{Evidence, Finding};

/// One run cannot tell, unless there is an exact solution beside it.
pub(super) fn of_mesh_and_step(evidence: &Evidence) -> Finding {
    match evidence.exact {
        Some(_) => Finding::Absent,
        None => Finding::Unchecked(
            "whether mesh and step are fine enough: vary `mesh.refine` or `time.step` with `carom study`"
                .to_owned(),
        ),
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
