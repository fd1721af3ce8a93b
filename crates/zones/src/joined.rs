//! Zones as parts of the matrix that rows join, and rows that supports hold.

use carom_dynamics::condensed::{Answer, Matrix};
use carom_dynamics::operator::assembled;
use carom_system::{LinkRow, System};

/// Gives rows that act on nothing that moves a multiplier of nothing: supports hold them already.
pub(crate) fn hold_empty_rows(count: usize, h: &mut [f64]) {
    for row in 0..count {
        let diagonal = &mut h[row * count + row];
        if *diagonal == 0.0 {
            *diagonal = 1.0;
        }
    }
}

/// A zone in H, with A = `mass` M + `stiffness` K.
pub(crate) fn answer<'a>(
    (system, rows): (&'a System, &[(u32, LinkRow)]),
    [mass, stiffness]: [f64; 2],
    scale: f64,
) -> Answer<'a> {
    let span = 0..system.unknowns();
    let matrix = match stiffness == 0.0 && system.mass.is_lumped() {
        true => Matrix::Diagonal(system.mass.lumped.iter().map(|m| mass * m).collect()),
        false => Matrix::Sparse(assembled(system, &span, [mass, 0.0], &|_| stiffness)),
    };
    Answer {
        system,
        span,
        rows: rows.to_vec(),
        matrix,
        scale,
    }
}
