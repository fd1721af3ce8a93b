//! When the contacts of an iteration ask for new matrices, and how far they are from their laws.

use super::Contacts;
use crate::driver::attempt::Attempt;
use crate::driver::parts::Parts;
use crate::driver::parts::mixing::{LARGEST, LARGEST_OF_FLOATING};
use crate::error::Error;

impl Contacts {
    pub(crate) fn no_equilibrium(&self, parts: &Parts, attempt: &Attempt, passes: usize) -> Error {
        let (node, body, cell) = attempt.place_of(attempt.worst_unknown());
        let contact = match self.worst_point(parts, attempt) {
            Some((point, defect)) if defect > 1.0 => {
                format!("; its law is missed most by {}", attempt.name(point))
            }
            _ => String::new(),
        };
        let last = parts.residuals().len().saturating_sub(8);
        let history = parts.residuals()[last..].iter().map(|r| format!("{r:.1e}"));
        Error::Equilibrium {
            step: attempt.state.step + 1,
            time: attempt.state.time,
            dt: attempt.dt,
            passes,
            node,
            body,
            cell,
            contact: contact.into(),
            history: history.collect::<Vec<_>>().join(", ").into(),
        }
    }

    /// Whether this iteration needs a new factor.
    pub(crate) fn wants_factor(&self, parts: &mut Parts, attempt: &Attempt, pass: usize) -> bool {
        if !parts.effective().iterates() {
            return false;
        }
        if self.refines(parts, attempt) && parts.pace().age > 0 {
            return parts.wants_tangent(attempt);
        }
        let (Some(&now), Some(price)) = (parts.residuals().last(), parts.effective().price())
        else {
            return true;
        };
        let Some(ratio) = self.contraction(parts, attempt) else {
            return parts.pace().age == 0;
        };
        let least = if self.alternates(parts, attempt) {
            1.0
        } else {
            0.5
        };
        if ratio.is_nan() || ratio >= least {
            return true;
        }
        let left = (attempt.system.nonlinear.iteration.tolerance / now).ln();
        let needed = left / ratio.ln();
        if self.alternates(parts, attempt) && parts.pace().age == 2 && parts.pace().made > 0 {
            parts.pace_mut().fresh = ratio;
        }
        let fresh = match parts.pace().fresh > 0.0 {
            true => (left / parts.pace().fresh.ln()).max(FRESH),
            false => FRESH,
        };
        let keeps = needed <= fresh + TANGENT + price;
        tracing::debug!(
            "step {}, iteration {pass}: residual {now:e}, {} times the one before; the factor is {}: \
             {needed:.1} iterations with it against {fresh:.1} with a new one that costs {:.1}",
            attempt.state.step + 1,
            ratio,
            if keeps { "kept" } else { "renewed" },
            TANGENT + price,
        );
        !keeps
    }

    /// Whether residuals fall by turns fast and slowly.
    fn alternates(&self, parts: &Parts, attempt: &Attempt) -> bool {
        attempt.between() && !self.refines(parts, attempt)
    }

    /// Factor by which an iteration with the factor at hand shrinks the residual, if that is known. The matrix of forces
    /// between two states is the symmetric part of their derivative, with which residuals fall by turns fast and slowly:
    /// two iterations are looked at.
    fn contraction(&self, parts: &Parts, attempt: &Attempt) -> Option<f64> {
        match (parts.residuals(), parts.pace().age) {
            (_, 0) => None,
            ([.., before, now], 1) if !self.alternates(parts, attempt) => Some(now / before),
            (_, 1) => None,
            ([.., before, _, now], _) if self.alternates(parts, attempt) => {
                Some((now / before).sqrt())
            }
            ([.., before, now], _) => Some(now / before),
            _ => None,
        }
    }

    /// Mixes the iteration that has been computed with those before it.
    pub(crate) fn mix(&mut self, parts: &mut Parts, attempt: &mut Attempt) {
        let largest = match parts.floats(attempt) {
            true => LARGEST_OF_FLOATING,
            false => LARGEST,
        };
        if parts.mix(attempt, largest) {
            self.take_weak(attempt);
        }
    }
}

/// Iterations that a fresh factor is counted to need.
const FRESH: f64 = 2.0;

/// Cost of a new tangent beside its factorisation, in iterations with the old one.
const TANGENT: f64 = 3.0;
