//! What solves with tangents: a factor or iterations.

use std::cmp::Reverse;

use carom_algebra::solver::{Iterative, Ordering};
use carom_ranks::Ranks;

use super::part_matrix::part_matrix;
use crate::choice::{FEW, Use, pays};
use crate::operator::groups;
use crate::system::{Maps, Solver, System};

/// What solves with the tangents of these parts: as asked, else what is predicted to cost less for the largest of them, undeformed, in a step of the size
/// that the model names. So a run that goes on from a checkpoint chooses the same.
pub(super) fn tangent_solver(system: &System, iterated: &[bool]) -> Solver {
    let asked = system.nonlinear.iteration.solver;
    let parts = system.parts.iter().zip(iterated);
    let parts = parts.filter_map(|(part, iterated)| iterated.then_some(part));
    let largest = parts.min_by_key(|part| Reverse(part.len()));
    let (Solver::Auto, None, Some(part)) = (asked, system.needs_factor(), largest) else {
        return if asked == Solver::Auto {
            Solver::Direct
        } else {
            asked
        };
    };
    let maps = Maps::new(system, system.dt, system.dt);
    let map = maps.of(part.start);
    let matrix = match part.len() < FEW || map.inertia.x == 0.0 {
        true => None,
        false => part_matrix(system, part, map, false),
    };
    let Some(matrix) = matrix else {
        return Solver::Direct;
    };
    let matrix = matrix.with_identity(&system.fixed[part.clone()]);
    let nodes = &system.unknowns.node_of_each()[part.clone()];
    let groups = groups(nodes);
    let place = |unknown: usize| system.x[nodes[unknown] as usize];
    let of = Use {
        part: None,
        stays: false,
        inertia: true,
        others: None,
        ranks: &Ranks::alone(),
    };
    let pays = || -> Result<bool, carom_algebra::Error> {
        let order = Ordering::new(&matrix, &groups, Some(&place))?;
        let mut solver = Iterative::new(&matrix, &groups)?;
        Ok(pays(&mut solver, (system, of), order.work()))
    };
    // what is wrong with the matrix the tangents themselves will say
    match pays() {
        Ok(true) => Solver::Iterative,
        Ok(false) | Err(_) => Solver::Direct,
    }
}
