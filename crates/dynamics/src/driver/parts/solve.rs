//! The pace of the iterations of a step.

use super::Parts;
use crate::driver::attempt::Attempt;
use crate::driver::attempt::critical::PART;
use crate::error::Error;

/// Imbalance of the last pass, and defects of contact laws, over the tolerances of the iterations.
pub(crate) const WITHIN: f64 = 0.01;

impl Parts {
    pub(crate) fn leaves_iterations(&mut self, attempt: &Attempt) -> bool {
        let between = attempt.between();
        let (system, maps) = (&attempt.system, &attempt.maps);
        self.effective.leave_iterations(system, maps, between)
    }

    /// Whether an iteration whose error is that of the bodies alone needs their derivative anew: with it residuals go on as r₊ = c r²
    /// with the c of the last iteration, else at its rate. A tangent with its factor was measured to cost about what the
    /// passes that it saves, with 888 unknowns and with 2304 (decision 019).
    pub(crate) fn wants_tangent(&self, attempt: &Attempt) -> bool {
        let [.., before, now] = self.residuals[..] else {
            return false;
        };
        let ratio = now / before;
        if ratio.is_nan() || ratio >= 0.5 {
            return true;
        }
        let tolerance = attempt.system.nonlinear.iteration.tolerance;
        let kept = (tolerance / now).ln() / ratio.ln();
        let (mut left, mut newer) = (now, 0.0);
        while left > tolerance {
            left *= ratio * (left / before);
            newer += 1.0;
        }
        let renewed = kept > newer;
        tracing::debug!(
            "step {}, iteration {}: residual {now:e}, {ratio} times the one before; the factor is {}: {kept:.1} iterations \
             with it against {newer} with a new one",
            attempt.state.step + 1,
            self.residuals.len() - 1,
            if renewed { "renewed" } else { "kept" },
        );
        renewed
    }

    /// Whether it may be, by what the step has beside bodies and contacts.
    pub(crate) fn may_refine(&self, attempt: &Attempt) -> bool {
        !self.floats(attempt) && !attempt.has_links() && attempt.vectors.push.is_empty()
    }

    /// Imbalance at which passes may end, the first of which leaves this one: a tenth of it, and of what the error of the bodies will be,
    /// c r² with the c of the iteration before.
    pub(crate) fn enough(&self, attempt: &Attempt, first: f64) -> f64 {
        let bodies = match self.residuals[..] {
            [.., before, now] if now < before => now * (now / before).powi(2),
            _ => first,
        };
        let tolerance = attempt.system.nonlinear.iteration.tolerance;
        f64::max(LEFT * first.min(bodies), WITHIN * tolerance)
    }

    /// Drops an attempt of `dt` (s) in which bulk viscosity was stronger than its size is stable with: the impact began in it, of which
    /// the step before did not know.
    ///
    /// # Errors
    /// [`Error::Viscous`].
    pub(crate) fn check_viscosity(&self, attempt: &Attempt, dt: f64) -> Result<(), Error> {
        let state = &attempt.state;
        let more = state.shapes.by_compression * self.stored().compression;
        let critical = 1.0 / (PART / state.control.stable + 0.5 * more);
        if more > 0.0 && dt > critical {
            return Err(Error::Viscous {
                step: state.step + 1,
                time: state.time,
                dt,
                critical,
            });
        }
        Ok(())
    }
}

/// Imbalance of the last pass over that of the first one, and over what the iteration will leave.
const LEFT: f64 = 0.1;
