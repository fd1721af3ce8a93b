//! Problems that are solved as several: of laws that are not linear, one of their tangents after the other; of coefficients of sliding
//! below those of sticking, one with fewer points at the larger one after the other.

use super::{Coulomb, FrictionFailure, Posed, Slip, Tangential};
use crate::tangents::{MOST, Reached, Tangents};

impl Coulomb {
    /// Solves with relations that are renewed until they stand.
    pub(super) fn renew(
        &mut self,
        problem: &Posed,
        tangents: &mut Tangents,
    ) -> Result<(), FrictionFailure> {
        let mut friction = problem.friction.to_vec();
        let (mut passes, mut sweeps) = (0, 0);
        for _ in 0..MOST {
            self.settle(&Posed {
                candidates: &tangents.candidates,
                friction: &friction,
                ..*problem
            })?;
            (passes, sweeps) = (passes + self.passes, sweeps + self.sweeps);
            (self.passes, self.sweeps) = (passes, sweeps);
            let stand = tangents.stand(problem.tolerance, |_, i| {
                let product = self.trial.product[problem.normal(i)];
                let end = problem.end(i, self.forces[i], product, product);
                Reached {
                    at: [end.gap, end.rate],
                    force: end.force,
                    status: self.statuses[i],
                }
            });
            if stand {
                return Ok(());
            }
            self.go_on(&mut friction);
        }
        self.best.worst = tangents.worst;
        Err(self.failure())
    }

    /// Solves with the coefficients of sticking, then with those of sliding in the points that slide, until no further one does. A point
    /// that slides with the larger coefficient is not asked again: the number of problems is at most that of points.
    pub(super) fn lower(&mut self, problem: &Posed) -> Result<(), FrictionFailure> {
        let mut friction = problem.friction.to_vec();
        let (mut passes, mut sweeps) = (0, 0);
        loop {
            self.solve_at_once(&Posed {
                friction: &friction,
                ..*problem
            })?;
            (passes, sweeps) = (passes + self.passes, sweeps + self.sweeps);
            (self.passes, self.sweeps) = (passes, sweeps);
            let mut lowered = false;
            for (point, slip) in friction.iter_mut().zip(&self.slips) {
                if *slip == Slip::Slip
                    && let Some(mu) = point.sliding.take()
                {
                    lowered |= mu < point.mu;
                    point.mu = mu;
                }
            }
            if !lowered {
                return Ok(());
            }
            self.go_on(&mut friction);
        }
    }

    /// Makes the forces found those with which a problem begins.
    fn go_on(&self, friction: &mut [Tangential]) {
        for (i, point) in friction.iter_mut().enumerate() {
            point.slip = self.slips[i];
            point.force = self.tangential[i];
            point.pressed = self.forces[i];
        }
    }
}
