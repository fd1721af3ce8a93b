//! Links of an attempt: their terms, and what rows that turn miss.

use super::Attempt;
use super::identity::WorkWeights;
use crate::system::Turned;

impl Attempt {
    /// Whether the system has links of its own.
    pub(crate) fn has_links(&self) -> bool {
        !self.system.links.rows.is_empty()
    }

    /// Weights of the forces of links at the start and of the step in their work in a zone: those of the ledger.
    pub(crate) fn link_work_weights(&self, zone: usize) -> WorkWeights {
        if !self.system.is_nonlinear() {
            let [old, new] = self.system.scheme.get().link_work(self.dt);
            let lag = self.work_weights().lag;
            return WorkWeights { old, new, lag };
        }
        let [old, new] = self.weights_of(zone);
        WorkWeights { old, new, lag: 0.0 }
    }

    /// What of the second derivatives of the rows by time the velocities of the state give.
    pub(crate) fn centripetal_rows(&self) -> Vec<(usize, f64)> {
        let motion = &self.state.motion;
        let at = Turned {
            frames: &motion.frames,
            u: &motion.u,
            from: None,
        };
        let rows = &self.system.links.turning;
        rows.centripetal(&self.system.unknowns, &at, &motion.v)
            .collect()
    }

    /// Number of each row that turns, and what it misses at the end of the step with the x of the iteration and the jump of the supports.
    pub(crate) fn bent_rows(&self) -> Vec<(usize, f64)> {
        let vectors = &self.vectors;
        let all = vectors.x.iter().zip(&vectors.jump);
        self.missed(&all.map(|(x, jump)| x + jump).collect::<Vec<f64>>())
    }

    /// The displacement at the end of the step.
    pub(crate) fn end(&self, x: &[f64]) -> Vec<f64> {
        let mut end = vec![0.0; x.len()];
        let xc = [x, &self.vectors.push];
        self.maps
            .whole(|map| map.displacement, &self.state.motion, xc, &mut end);
        end
    }

    pub(crate) fn missed(&self, x: &[f64]) -> Vec<(usize, f64)> {
        let system = &self.system;
        if system.links.turning.is_empty() {
            return Vec::new();
        }
        let motion = &self.state.motion;
        let end = self.end(x);
        let at = Turned {
            frames: &motion.frames,
            u: &end,
            from: None,
        };
        let values = system.links.turning.values(&system.unknowns, &at);
        values.collect()
    }
}
