//! How the multipliers of an outer step are solved for.

use crate::iterated::IteratedLinks;
use carom_dynamics::condensed::Condensed;
use carom_dynamics::linearised::LinearZone;

/// How `H ΔL = r` is solved.
pub(crate) enum LinkSolver {
    /// With a factor.
    Factor(Condensed),
    /// By iterations.
    Iterated(Box<IteratedLinks>),
}

impl LinkSolver {
    /// Bytes held. `rows`: their number.
    pub(crate) fn bytes(&self, rows: usize) -> usize {
        match self {
            LinkSolver::Factor(factor) => factor.bytes(rows),
            LinkSolver::Iterated(iterated) => iterated.bytes(rows),
        }
    }
}

/// The part of H of zones with one step, for multipliers at every inner instant.
#[derive(Default)]
pub(crate) enum OuterResponse {
    /// There are no such multipliers.
    #[default]
    None,
    /// The matrix, row-major.
    Matrix(Vec<f64>),
    /// By a step of each zone, none for those with several.
    Steps(Vec<Option<LinearZone>>),
}
