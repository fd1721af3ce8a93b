//! Rows of links that turn with their nodes: where the forces of an iteration are, and what they miss.

use std::sync::Arc;

use super::Links;
use crate::driver::attempt::Attempt;
use crate::system::{LinkRow, Turned};

impl Links {
    /// Makes the rows those of the configuration of the internal forces, `place`, of several schemes that of the end of the step, and the forces of the multipliers those
    /// of these rows.
    pub(crate) fn turn_rows(&mut self, attempt: &Attempt) {
        let system = &attempt.system;
        if system.links.turning.is_empty() {
            return;
        }
        let motion = &attempt.state.motion;
        let end = (system.schemes.len() > 1).then(|| attempt.end(&attempt.vectors.x));
        let at = Turned {
            frames: &motion.frames,
            u: end.as_ref().unwrap_or(&attempt.vectors.place),
            from: (!attempt.maps.is_static() && system.scheme.get().is_between())
                .then_some(&motion.u[..]),
        };
        let rows: &mut Vec<LinkRow> = Arc::make_mut(&mut self.rows);
        system
            .links
            .turning
            .coefficients(&system.unknowns, &at, rows);
        self.set_links(attempt);
    }

    /// The rows at the start of the step, where they turn and several schemes weigh multipliers in time: the force of a scheme that balances in the step is then the mean of the
    /// forces at both ends, as that of the other, and the momentum of both sides changes alike.
    pub(crate) fn rows_before(&self, attempt: &Attempt) -> Option<Vec<LinkRow>> {
        let system = &attempt.system;
        if system.links.turning.is_empty() || system.schemes.len() < 2 || attempt.maps.is_static() {
            return None;
        }
        let motion = &attempt.state.motion;
        let at = Turned {
            frames: &motion.frames,
            u: &motion.u,
            from: None,
        };
        let mut rows = Vec::clone(&self.rows);
        system
            .links
            .turning
            .coefficients(&system.unknowns, &at, &mut rows);
        Some(rows)
    }

    /// Makes the rows those of the state.
    pub(super) fn turn_rows_at_start(&mut self, attempt: &Attempt) {
        let at = Turned {
            frames: &attempt.state.motion.frames,
            u: &attempt.state.motion.u,
            from: None,
        };
        let system = &attempt.system;
        if !system.links.turning.is_empty() {
            let rows: &mut Vec<LinkRow> = Arc::make_mut(&mut self.rows);
            system
                .links
                .turning
                .coefficients(&system.unknowns, &at, rows);
        }
    }

    /// The largest of what rows that turn miss, in tolerances of a length.
    pub(crate) fn worst_row(&self, attempt: &Attempt) -> f64 {
        let size = |row: usize| -> f64 {
            let terms = self.rows[row].iter();
            let moved = terms.filter(|(unknown, _)| {
                let node = attempt.system.unknowns.node(*unknown as usize);
                let own = attempt.system.unknowns.translations_of(node);
                own.contains(&(*unknown as usize))
            });
            moved.map(|(_, c)| c.abs()).sum()
        };
        let missed = attempt.missed(&attempt.vectors.x).into_iter();
        let lengths = missed.map(|(row, h)| h.abs() / size(row));
        lengths.fold(0.0, f64::max) / attempt.system.tolerance
    }
}
