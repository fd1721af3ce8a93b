//! What solves with tangents: a factor or iterations.

use std::cmp::Reverse;
use std::slice;

use carom_ranks::Ranks;

use super::part_matrix::{is_diagonal, rows_of_part};
use crate::at_rows::AtRows;
use crate::choice::{Chosen, FEW, Use, choose, choose_on_ranks, rows_on_ranks};
use crate::system::{Maps, Solver, System};

/// What solves with the tangents of these parts: as asked, else what is predicted to cost less for the largest of them, undeformed, in a step of the size
/// that the model names. So a run that goes on from a checkpoint chooses the same.
pub(super) fn tangent_solver(system: &System, iterated: &[bool], ranks: &Ranks) -> Solver {
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
    if is_diagonal(system, part, map) {
        return Solver::Direct;
    }
    let of = Use {
        part: None,
        inertia: map.inertia.x != 0.0,
        others: None,
        ranks,
    };
    let fixed = &system.fixed[part.clone()];
    let parts = slice::from_ref(part);
    // what is wrong with the matrix the tangents themselves will say
    let iterative = match rows_on_ranks((system, of), parts, &[]) {
        Some(rows) => {
            let at = AtRows::new(system, &[(parts, &rows)]);
            let matrix = rows_of_part((system, &at), part, map, false);
            let matrix = matrix.with_identity(fixed);
            matches!(
                choose_on_ranks((system, of), &matrix, rows, parts),
                Ok(Some(_))
            )
        }
        None => {
            let matrix = rows_of_part((system, &AtRows::all()), part, map, false);
            let matrix = matrix.with_identity(fixed);
            let nodes = &system.unknowns.node_of_each()[part.clone()];
            matches!(
                choose((system, of), &matrix, nodes),
                Ok(Chosen::Iterative(_))
            )
        }
    };
    if iterative {
        Solver::Iterative
    } else {
        Solver::Direct
    }
}
