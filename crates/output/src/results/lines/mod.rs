//! The lines of the verdict of a run, one function each. To add one: a function from the evidence to what it finds, in the
//! file of its topic, and its name in [`ALL`].

mod across;
mod bolts;
mod chatter;
mod convergence;
mod crossing;
mod doubts;
mod energy;
mod exact;
mod explicit;
mod finding;
mod finite;
mod happened;
mod locking;
mod momentum;
mod patches;
mod penetration;
mod rebound;
mod resolution;
mod sampling;
mod scales;
mod small;
mod tolerated;

use crate::verdict::Verdict;
use finding::worst;
pub(crate) use finding::{Evidence, Finding};

/// All lines, in the order in which they are shown.
const ALL: &[fn(&Evidence) -> Finding] = &[
    energy::residual,
    momentum::residual,
    momentum::angular,
    momentum::exchange,
    momentum::resizing,
    energy::gain,
    energy::made,
    energy::of_contact,
    energy::lost,
    energy::lost_to_scheme,
    energy::of_scheme,
    finite::states,
    sampling::of_functions,
    happened::closed,
    happened::met,
    explicit::hourglass,
    explicit::added_mass,
    explicit::deleted_cells,
    explicit::loose_nodes,
    chatter::of_contacts,
    tolerated::tension,
    bolts::compressed,
    penetration::of_contacts,
    penetration::of_passing,
    crossing::of_contacts,
    crossing::between,
    crossing::of_surfaces,
    crossing::under_force,
    crossing::left_open,
    rebound::of_rigid_bodies,
    rebound::under_the_law_in_the_gap,
    rebound::of_many_rigid_bodies,
    resolution::of_peaks,
    resolution::of_impulses,
    patches::of_contacts,
    exact::force,
    small::rotation,
    small::strain,
    small::of_reduced,
    across::axis_rotation,
    across::fluid_gap,
    locking::in_bending,
    small::slide,
    small::turn,
    small::invented,
    small::lost,
    convergence::of_mesh_and_step,
    convergence::of_modes,
    convergence::of_undamped_modes,
];

/// The verdict on a run that came to its end (`unfinished` is `None`) or did not (`unfinished` says why).
pub(crate) fn judge(evidence: &Evidence, unfinished: Option<String>) -> Verdict {
    let (mut lines, mut unchecked) = (Vec::new(), Vec::new());
    for line in ALL {
        match line(evidence) {
            Finding::Line(line) => lines.push(line),
            Finding::Unchecked(why) => unchecked.push(why),
            Finding::Absent => {}
        }
    }
    lines.extend(doubts::lines(evidence));
    Verdict::new(unfinished, lines, unchecked)
}
