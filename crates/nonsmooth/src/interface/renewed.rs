//! The problem of laws that are not linear, as one of their tangents after the other.

use super::{Failure, Interface, end};
use crate::Compliance;
use crate::tangents::{MOST, Reached, Tangents};

impl Interface {
    /// Solves with relations that are renewed until they stand.
    pub(super) fn renew(
        &mut self,
        tangents: &mut Tangents,
        compliance: (Compliance, u64),
        s: [f64; 2],
    ) -> Result<(), Failure> {
        let mut passes = 0;
        for _ in 0..MOST {
            self.settle(&tangents.candidates, compliance, s)?;
            passes += self.passes;
            self.passes = passes;
            let (forces, product, statuses) = (&self.forces, &self.product, &self.statuses);
            let stand = tangents.stand(0.0, |candidate, i| {
                let end = end(candidate, i, compliance.0, s, forces, product);
                Reached {
                    at: [end.gap, end.rate],
                    force: end.force,
                    status: statuses[i],
                }
            });
            if stand {
                return Ok(());
            }
        }
        Err(Failure::Cycling {
            passes,
            candidate: tangents.worst.1,
        })
    }
}
