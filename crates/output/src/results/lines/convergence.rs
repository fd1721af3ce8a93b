//! Whether mesh and step are fine enough.

use crate::results::lines::{Evidence, Finding};

/// One run cannot tell, unless there is an exact solution beside it.
pub(super) fn of_mesh_and_step(evidence: &Evidence) -> Finding {
    match evidence.exact {
        Some(_) => Finding::Absent,
        None => Finding::Unchecked(
            "whether mesh and step are fine enough: `carom study` over `mesh.refine` or `time.step` shows it"
                .to_owned(),
        ),
    }
}
