//! What steps went on after, and that their result may show.

use carom_pages::form::Form;
use carom_pages::plot::quantity;

use crate::results::lines::{Evidence, Finding};
use crate::verdict::{Bounds, Line};

/// Contact problems whose tension, which the law cuts off, did not settle: some points were left with a force that the law does not give.
pub(super) fn tension(evidence: &Evidence) -> Finding {
    let [_, _, clipped] = &evidence.totals.noticed;
    if clipped.count == 0 {
        return Finding::Absent;
    }
    let told = format!(
        "contact problems in which the tension that the law cuts off did not settle, the first in step {} at {} ({})",
        clipped.step,
        quantity(clipped.time, "s"),
        clipped.place
    );
    Finding::Line(Line::new(
        "clipped-tension",
        (&told, clipped.count as f64, Form::Count),
        Bounds::Look(0.0),
        "use a smaller step, or less damping in the law",
    ))
}
