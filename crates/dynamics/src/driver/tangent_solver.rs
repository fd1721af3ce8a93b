//! What solves with tangents: a factor or iterations.

use std::cmp::Reverse;

use carom_ranks::Ranks;

use super::part_matrix::part_matrix;
use crate::choice::{Chosen, FEW, Use, choose};
use crate::system::{Maps, Solver, System};

/// What solves with the tangents of these parts: as asked, else what is predicted to cost less for the largest of them, undeformed, in a step of the size
/// that the model names. So a run that goes on from a checkpoint chooses the same.
pub(super) fn tangent_solver(system: &System, iterated: &[bool]) -> Solver {
    let asked = system.nonlinear.iteration.solver;
    if asked != Solver::Auto {
        return asked;
    }
    let parts = system.parts.iter().zip(iterated);
    let parts = parts.filter_map(|(part, iterated)| iterated.then_some(part));
    let largest = parts.min_by_key(|part| Reverse(part.len()));
    let large = largest.filter(|part| part.len() >= FEW && system.needs_factor().is_none());
    let Some(part) = large else {
        return Solver::Direct;
    };
    let maps = Maps::new(system, system.dt, system.dt);
    let map = maps.of(part.start);
    let Some(matrix) = part_matrix(system, part, map, false) else {
        return Solver::Direct;
    };
    let matrix = matrix.with_identity(&system.fixed[part.clone()]);
    let nodes = &system.unknowns.node_of_each()[part.clone()];
    let of = Use {
        part: None,
        inertia: map.inertia.x != 0.0,
        others: None,
        ranks: &Ranks::alone(),
    };
    // what is wrong with the matrix the tangents themselves will say
    match choose((system, of), &matrix, nodes) {
        Ok(Chosen::Iterative(_)) => Solver::Iterative,
        Ok(Chosen::Direct(_)) | Err(_) => Solver::Direct,
    }
}
