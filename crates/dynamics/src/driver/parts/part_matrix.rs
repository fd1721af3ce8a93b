//! The matrix of a linear part.

use std::ops::Range;

use carom_algebra::csr::Csr;

use crate::at_rows::AtRows;
use crate::driver::loads::damping_rate;
use crate::operator::{add_rows, assembled_at};
use crate::step_map::StepMap;
use crate::system::System;

/// Whether the matrix of a linear part is the lumped mass alone.
pub(super) fn is_diagonal(system: &System, part: &Range<usize>, map: &StepMap) -> bool {
    map.force.x == 0.0 && !system.mass.couples(part)
}

/// The matrix of a linear part; `None` of one that is the lumped mass alone.
pub(crate) fn part_matrix(
    system: &System,
    part: &Range<usize>,
    map: &StepMap,
    between: bool,
) -> Option<Csr> {
    let all = (system, &AtRows::all());
    (!is_diagonal(system, part, map)).then(|| rows_of_part(all, part, map, between))
}

/// Some rows of the matrix of a linear part.
pub(super) fn rows_of_part(
    (system, at): (&System, &AtRows),
    part: &Range<usize>,
    map: &StepMap,
    between: bool,
) -> Csr {
    let rate = damping_rate(map).x;
    let damping = |body: usize| {
        system
            .nonlinear
            .damping
            .get(body)
            .copied()
            .unwrap_or_default()
    };
    let stiffness = if between {
        0.5 * map.force.x
    } else {
        map.force.x
    };
    let of_body = |body: usize| stiffness + rate * damping(body).stiffness;
    let mut a = assembled_at((system, at), part, [map.inertia.x, rate], &of_body);
    if let Some(mass) = &system.damping_mass {
        mass.add_to(rate, part, part.start, &mut a);
    }
    if map.inertia.x == 0.0 {
        add_rows((system, &system.links.rows), part, part.start, &mut a);
    }
    a
}
