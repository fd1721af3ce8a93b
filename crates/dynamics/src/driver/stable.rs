//! Explicit steps at finite strain: elements that shorten take the critical step down as they deform.

use super::Driver;
use crate::error::Error;

/// Part of the critical step that is taken, for what elements change until they are looked at again.
const PART: f64 = 0.9;

/// Change of the lengths in an element, relative, after which its frequencies are looked at again: that costs several steps.
const CHANGE: f64 = 0.1;

impl Driver {
    /// Looks at the critical step of an explicit scheme anew, before a step of `dt` (s), where elements have changed; what was
    /// found is kept in the state.
    ///
    /// # Errors
    /// An element without tangent.
    pub(super) fn renew_stable(&mut self, dt: f64) -> Result<(), Error> {
        let system = &*self.system;
        let explicit = system
            .schemes
            .iter()
            .any(|scheme| scheme.get().is_explicit());
        if !explicit || self.is_static() || system.bodies.iter().all(|body| body.is_linear()) {
            return Ok(());
        }
        let change = self.state.control.changed + dt * self.largest_rate();
        self.state.control.changed = change;
        if self.state.step == 0 || change > CHANGE {
            let critical = self.system.critical_step_at(&self.state.motion)?;
            self.state.control.stable = PART * critical;
            self.state.control.changed = 0.0;
        }
        Ok(())
    }

    /// How many times a step of `dt` (s) is halved for its parts to be below the critical step.
    ///
    /// # Errors
    /// A critical step below the smallest part.
    pub(super) fn stable_level(&self, dt: f64) -> Result<u32, Error> {
        let stable = self.state.control.stable;
        let halvings = self.system.nonlinear.iteration.halvings;
        let mut levels = 0..=halvings;
        let level = levels.find(|&level| dt <= stable * (1u64 << level) as f64);
        level.ok_or_else(|| Error::Shortened {
            step: self.state.step + 1,
            time: self.state.time,
            dt: dt / (1u64 << halvings) as f64,
            critical: stable / PART,
        })
    }

    /// Largest rate at which the distance of two nodes of an element changes, relative to it, 1/s.
    fn largest_rate(&self) -> f64 {
        let (system, motion) = (&*self.system, &self.state.motion);
        let mut largest: f64 = 0.0;
        let mut visit = |nodes: &[u32]| {
            for (k, &a) in nodes.iter().enumerate() {
                for &b in &nodes[..k] {
                    let [u, v] = [&motion.u, &motion.v].map(|values| {
                        let [a, b] = [a, b].map(|node| system.unknowns.vector(node, values));
                        [0, 1, 2].map(|i| a[i] - b[i])
                    });
                    let [a, b] = [a, b].map(|node| system.x[node as usize]);
                    let (mut square, mut product) = (0.0, 0.0);
                    for i in 0..system.dim {
                        let x = a[i] - b[i] + u[i];
                        square += x * x;
                        product += x * v[i];
                    }
                    largest = largest.max(product.abs() / square);
                }
            }
        };
        // the bound of springs holds for all elongations
        let solids = system.bodies.iter().filter(|b| b.as_solid().is_some());
        for body in solids.filter(|body| !body.is_linear()) {
            body.each_element(&mut visit);
        }
        largest
    }
}
