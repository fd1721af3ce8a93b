//! Rows of links that turn with their nodes: where the forces of an iteration are, and what they miss.

use std::sync::Arc;

use super::Driver;
use crate::system::{LinkRow, Turned};

impl Driver {
    /// Makes the rows those of the configuration of the internal forces, `place`, of several schemes that of the end of the step, and the forces of the multipliers those
    /// of these rows.
    pub(super) fn turn_rows(&mut self) {
        let system = &self.system;
        if system.turning_rows.is_empty() {
            return;
        }
        let motion = &self.state.motion;
        let end = (system.schemes.len() > 1).then(|| self.end(&self.vectors.x));
        let at = Turned {
            frames: &motion.frames,
            u: end.as_ref().unwrap_or(&self.vectors.place),
            from: (!self.maps.is_static() && system.scheme.get().is_between())
                .then_some(&motion.u[..]),
        };
        let rows: &mut Vec<LinkRow> = Arc::make_mut(&mut self.rows);
        system
            .turning_rows
            .coefficients(&system.unknowns, &at, rows);
        self.set_links();
    }

    /// The rows at the start of the step, where they turn and several schemes weigh multipliers in time: the force of a scheme that balances in the step is then the mean of the
    /// forces at both ends, as that of the other, and the momentum of both sides changes alike.
    pub(super) fn rows_before(&self) -> Option<Vec<LinkRow>> {
        let system = &self.system;
        if system.turning_rows.is_empty() || system.schemes.len() < 2 || self.maps.is_static() {
            return None;
        }
        let motion = &self.state.motion;
        let at = Turned {
            frames: &motion.frames,
            u: &motion.u,
            from: None,
        };
        let mut rows = Vec::clone(&self.rows);
        system
            .turning_rows
            .coefficients(&system.unknowns, &at, &mut rows);
        Some(rows)
    }

    /// Makes the rows those of the state.
    pub(super) fn turn_rows_at_start(&mut self) {
        let at = Turned {
            frames: &self.state.motion.frames,
            u: &self.state.motion.u,
            from: None,
        };
        let system = &self.system;
        if !system.turning_rows.is_empty() {
            let rows: &mut Vec<LinkRow> = Arc::make_mut(&mut self.rows);
            system
                .turning_rows
                .coefficients(&system.unknowns, &at, rows);
        }
    }

    /// What of the second derivatives of the rows by time the velocities of the state give.
    pub(super) fn centripetal_rows(&self) -> Vec<(usize, f64)> {
        let motion = &self.state.motion;
        let at = Turned {
            frames: &motion.frames,
            u: &motion.u,
            from: None,
        };
        let rows = &self.system.turning_rows;
        rows.centripetal(&self.system.unknowns, &at, &motion.v)
            .collect()
    }

    /// Number of each row that turns, and what it misses at the end of the step with the x of the iteration and the jump of the supports.
    pub(super) fn bent_rows(&self) -> Vec<(usize, f64)> {
        let vectors = &self.vectors;
        let all = vectors.x.iter().zip(&vectors.jump);
        self.missed(&all.map(|(x, jump)| x + jump).collect::<Vec<f64>>())
    }

    /// The largest of what rows that turn miss, in tolerances of a length.
    pub(super) fn worst_row(&self) -> f64 {
        let size = |row: usize| -> f64 {
            let terms = self.rows[row].iter();
            let moved = terms.filter(|(unknown, _)| {
                let node = self.system.unknowns.node(*unknown as usize);
                let own = self.system.unknowns.translations_of(node);
                own.contains(&(*unknown as usize))
            });
            moved.map(|(_, c)| c.abs()).sum()
        };
        let missed = self.missed(&self.vectors.x).into_iter();
        let lengths = missed.map(|(row, h)| h.abs() / size(row));
        lengths.fold(0.0, f64::max) / self.system.tolerance
    }

    /// The displacement at the end of the step.
    fn end(&self, x: &[f64]) -> Vec<f64> {
        let mut end = vec![0.0; x.len()];
        let xc = [x, &self.vectors.push];
        self.maps
            .whole(|map| map.displacement, &self.state.motion, xc, &mut end);
        end
    }

    fn missed(&self, x: &[f64]) -> Vec<(usize, f64)> {
        let system = &self.system;
        if system.turning_rows.is_empty() {
            return Vec::new();
        }
        let motion = &self.state.motion;
        let end = self.end(x);
        let at = Turned {
            frames: &motion.frames,
            u: &end,
            from: None,
        };
        let values = system.turning_rows.values(&system.unknowns, &at);
        values.collect()
    }
}
