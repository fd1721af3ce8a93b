//! What solves with the matrix of a linear part.

use std::ops::Range;
use std::slice;

use carom_algebra::csr::Csr;
use carom_ranks::Ranks;

use super::part_matrix::{is_diagonal, rows_of_part};
use crate::at_rows::AtRows;
use crate::choice::{Use, choose_on_ranks, operator_on_ranks, rows_on_ranks, solvable};
use crate::columns::HeldColumns;
use crate::driver::loads::damping_rate;
use crate::error::Error;
use crate::operator::{Operator, unsolvable};
use crate::step_map::StepMap;
use crate::system::{NumberedModal, Solver, System};

/// The factor of the matrix of a linear part; adds its diagonal, and where supports of the part move its columns of held unknowns.
pub(super) fn linear_part(
    system: &System,
    part: &Range<usize>,
    (map, between, (ranks, others)): (&StepMap, bool, (&Ranks, Option<Solver>)),
    (diagonal, held): (&mut [f64], &mut HeldColumns),
) -> Result<Operator, Error> {
    let fixed = &system.fixed[part.clone()];
    let follows = &system.nonlinear.follows;
    let moves = follows.iter().any(|f| part.contains(&(f.unknown as usize)));
    if is_diagonal(system, part, map) {
        let lumped = &system.mass.lumped[part.clone()];
        let masses: Vec<f64> = lumped.iter().map(|m| map.inertia.x * m).collect();
        diagonal[part.clone()].copy_from_slice(&masses);
        return Ok(Operator::diagonal(&masses, fixed));
    }
    let mut of = Use {
        part: Some(part),
        inertia: map.inertia.x != 0.0,
        others,
        ranks,
    };
    if let Some(operator) = linear_on_ranks((system, of), (map, between, moves), (diagonal, held))?
    {
        return Ok(operator);
    }
    if ranks.count() > 1 {
        of.others = Some(Solver::Direct);
    }
    let a = rows_of_part((system, &AtRows::all()), part, map, between);
    take_diagonal(&a, part, diagonal);
    let operator = solvable((system, of), part, &a, fixed, "effective matrix")?;
    let columns = modal_columns(system, part, damping_rate(map).x);
    let operator = operator
        .with_columns(&columns)
        .map_err(|cause| unsolvable(system, part, ("damping of modes", cause)))?;
    if moves {
        held.append(&a, fixed, part.start);
    }
    Ok(operator)
}

fn take_diagonal(a: &Csr, part: &Range<usize>, diagonal: &mut [f64]) {
    for (place, entry) in diagonal[part.clone()].iter_mut().enumerate() {
        *entry = a.get(place, place);
    }
}

/// The same over several ranks, each of which has some rows; none where a factor costs less.
fn linear_on_ranks(
    (system, of): (&System, Use),
    (map, between, moves): (&StepMap, bool, bool),
    (diagonal, held): (&mut [f64], &mut HeldColumns),
) -> Result<Option<Operator>, Error> {
    let Some(part) = of.part else { return Ok(None) };
    let (parts, fixed) = (slice::from_ref(part), &system.fixed[part.clone()]);
    let Some(rows) = rows_on_ranks((system, of), parts, &[]) else {
        return Ok(None);
    };
    let at = AtRows::new(system, &[(parts, &rows)]);
    let a = rows_of_part((system, &at), part, map, between);
    let failed = |cause| unsolvable(system, part, ("effective matrix", cause));
    let matrix = a.with_identity(fixed);
    let solver = choose_on_ranks((system, of), &matrix, rows, parts).map_err(failed)?;
    let Some(solver) = solver else {
        return Ok(None);
    };
    take_diagonal(&a, part, diagonal);
    at.complete(part, diagonal);
    if moves {
        // their columns have rows of all ranks
        let whole = rows_of_part((system, &AtRows::all()), part, map, between);
        held.append(&whole, fixed, part.start);
    }
    let operator = operator_on_ranks(system, solver, (&matrix, parts)).map_err(failed)?;
    Ok(Some(operator))
}

/// The columns of the damping of modes in the matrix of a part, times the root of this factor of the damping.
fn modal_columns(system: &System, part: &Range<usize>, factor: f64) -> Vec<Vec<f64>> {
    let fixed = &system.fixed[part.clone()];
    let inside = |modal: &&NumberedModal| &system.parts[system.part_of_body[modal.body]] == part;
    let modal = system.modal.iter().filter(|_| factor > 0.0).filter(inside);
    let columns = modal.flat_map(|modal| modal.columns_of(part));
    let scaled = |mut column: Vec<f64>| {
        for (b, fixed) in column.iter_mut().zip(fixed) {
            *b *= if *fixed { 0.0 } else { factor.sqrt() };
        }
        column
    };
    columns.map(scaled).collect()
}
