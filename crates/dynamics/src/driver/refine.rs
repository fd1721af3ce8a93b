//! The problem of an iteration with bodies alone linearised.
//!
//! The matrix A of an iteration is symmetric, and its contact forces act along the rows N of where the iteration begins. What it leaves
//! out (the weights of mortar and the directions of friction, which move with the points, and the part of the tangent that is not
//! symmetric) makes iterations converge at a rate, not quadratically. With K̂ the whole derivative of inertia, internal and
//! damping forces at x, the motion d and the forces P of the iteration are therefore sought of
//!
//! `r(x) - K̂ d + N(x + d)ᵀ P = 0,   laws at x + d,`
//!
//! whose only error is that of the bodies, of second order in d. Passes solve it with A as it is,
//!
//! `A δ - N(x)ᵀ P₊ = r - K̂ d + (N(x + d) - N(x))ᵀ P,   gap(x + d) + N(x) δ,   d₊ = d + δ,`
//!
//! which needs the columns of N(x) that are at hand, and neither forces of elements nor a factor; Anderson's mixing makes of them
//! what GMRES is for linear problems. These are Newton iterations with the symmetric factor as preconditioner.

use std::sync::Arc;

use super::Driver;
use super::parts::mixing::{LARGEST, Refined};
use super::parts::solve::WITHIN;
use super::residual::Standing;
use crate::error::Error;

/// Most passes of an iteration.
const PASSES: usize = 12;

/// Imbalance over that of the pass before from which on passes are of no use.
const STALLED: f64 = 0.9;

impl Driver {
    /// Makes the motion `dx` of the iteration and the contact forces after it those of the problem with bodies alone linearised.
    ///
    /// # Errors
    /// A contact problem without solution.
    pub(super) fn refine(&mut self) -> Result<(), Error> {
        // the motion has the jump of the supports
        let jumps = std::mem::take(&mut self.attempt.vectors.jumps);
        let mut refined = self.parts.take_refined();
        refined.x.clone_from(&self.attempt.vectors.x);
        refined.residual.clone_from(&self.attempt.vectors.residual);
        refined.motion.clone_from(&self.attempt.vectors.dx);
        refined.mixing.clear();
        let outcome = self.passes(&mut refined);
        let vectors = &mut self.attempt.vectors;
        vectors.jumps = jumps;
        vectors.x.copy_from_slice(&refined.x);
        vectors.residual.copy_from_slice(&refined.residual);
        vectors.dx.copy_from_slice(&refined.motion);
        self.parts.keep_refined(refined);
        outcome
    }

    fn passes(&mut self, refined: &mut Refined) -> Result<(), Error> {
        let (mut enough, mut last) = (None, f64::INFINITY);
        for _ in 0..PASSES {
            let standing = self.stand_at(refined);
            let now = standing.imbalance;
            let enough = *enough.get_or_insert_with(|| self.parts.enough(&self.attempt, now));
            let obeys = standing.defect <= WITHIN;
            if obeys && (now <= enough.max(standing.rounding) || now > STALLED * last) {
                break;
            }
            if now > last {
                self.contacts.undo_pass(&mut self.attempt, refined);
                break;
            }
            last = now;
            refined.before.clone_from(&refined.motion);
            refined.interface.clone_from(&self.attempt.next.interface);
            refined.slips.clear();
            refined.slips.extend_from_slice(self.contacts.slips());
            self.contacts.load_pass(&mut self.parts, &mut self.attempt);
            self.solve_with_columns()?;
            let way = (
                &self.attempt.vectors.x[..],
                &mut self.attempt.vectors.dx[..],
            );
            if refined
                .mixing
                .mix(way, &mut self.attempt.next.interface, LARGEST)
            {
                self.contacts.take_weak(&self.attempt);
            }
            for (motion, dx) in refined.motion.iter_mut().zip(&self.attempt.vectors.dx) {
                *motion += dx;
            }
        }
        Ok(())
    }

    /// Goes to x + d, with the residual of linear bodies there.
    fn stand_at(&mut self, refined: &mut Refined) -> Standing {
        let system = Arc::clone(&self.attempt.system);
        self.parts
            .effective_mut()
            .whole_product(&refined.motion, &mut refined.product);
        let vectors = &mut self.attempt.vectors;
        for (i, x) in vectors.x.iter_mut().enumerate() {
            *x = refined.x[i] + refined.motion[i];
            if !system.fixed[i] {
                vectors.residual[i] = refined.residual[i] - refined.product[i];
            }
        }
        self.contacts.pair_candidates(&mut self.attempt);
        self.standing()
    }
}
