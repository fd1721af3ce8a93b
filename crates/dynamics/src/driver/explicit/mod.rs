//! Explicit steps in one pass over the lumped mass.

pub(crate) mod leapfrog;

use crate::shapes::{Rates, Shape};
use leapfrog::Direct;

/// Explicit steps in one pass over the lumped mass.
pub(crate) struct Explicit {
    /// For steps whose matrix is the lumped mass; none where there are no such steps.
    direct: Option<Direct>,
    rates: Rates,
}

impl Explicit {
    /// Those of a system with so many parts.
    pub(crate) fn new(direct: Option<Direct>, parts: usize) -> Explicit {
        Explicit {
            direct,
            rates: Rates::new(parts),
        }
    }

    /// The pass, while no step has taken it.
    pub(crate) fn direct(&self) -> Option<&Direct> {
        self.direct.as_ref()
    }

    /// Takes the pass, for a step that keeps it again.
    pub(crate) fn take(&mut self) -> Option<Direct> {
        self.direct.take()
    }

    /// Keeps the pass that a step had taken.
    pub(crate) fn keep(&mut self, direct: Direct) {
        self.direct = Some(direct);
    }

    /// Makes the attempt the state.
    pub(crate) fn accept(&mut self) {
        if let Some(direct) = &mut self.direct {
            direct.go_on();
        }
    }

    /// Bound of the rate at which lengths in elements change, relative, 1/s, where the last pass has found it.
    pub(crate) fn rate_of_pass(
        &mut self,
        parts: &[usize],
        bodies: &[Option<Shape>],
    ) -> Option<f64> {
        let direct = self.direct.as_ref().filter(|own| own.ready.is_some())?;
        let fastest = |part: usize, _: &[f64; 3]| direct.parts[part].fastest;
        Some(self.rates.largest(parts, bodies, fastest))
    }

    /// How fast lengths in elements change.
    pub(crate) fn rates(&self) -> &Rates {
        &self.rates
    }

    /// The same, to refer them to other shapes or to find the largest.
    pub(crate) fn rates_mut(&mut self) -> &mut Rates {
        &mut self.rates
    }
}
