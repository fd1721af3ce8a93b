//! The residual of an iteration, and how far it is from nothing.

use carom_bodies::Body;

use super::Driver;
use super::attempt::Configuration;
use super::parts::pace::Squares;
use crate::error::Error;

/// Where an iteration stands. Forces are told by assembly: the imbalance and its rounding are those of the one that is worst.
#[derive(Default)]
pub(super) struct Standing {
    /// Imbalance of the forces, relative.
    pub(super) imbalance: f64,
    /// Largest defect of a contact law, in tolerances.
    pub(super) defect: f64,
    /// What of the imbalance may be rounding, relative.
    pub(super) rounding: f64,
    /// Largest of the forces that balance, N.
    pub(super) scale: f64,
    /// Imbalance of the forces of all, N.
    pub(super) force: f64,
    /// Largest imbalance of a connected part over what its own forces tolerate.
    pub(super) excess: f64,
    /// Whether no assembly has more imbalance than its forces and momentum tolerate, or than may be rounding.
    pub(super) is_rounding: bool,
}

impl Driver {
    /// Loads, inertia, internal and damping forces at x. `first`: those that x does not change too.
    pub(super) fn evaluate(&mut self, first: bool) -> Result<(), Error> {
        match first
            && self.contacts.is_affine(&self.parts)
            && self.attempt.system.nonlinear.follows.is_empty()
        {
            // the first guess has no inertia
            true => self.attempt.vectors.inertia.fill(0.0),
            false => self.attempt.evaluate_inertia(),
        }
        if first || !self.attempt.maps.is_explicit() {
            self.attempt.evaluate_rate();
            self.parts.evaluate_damping(&mut self.attempt);
            let vectors = &mut self.attempt.vectors;
            let (xc, motion) = ([&vectors.x[..], &vectors.push], &self.attempt.state.motion);
            let place = &mut vectors.place;
            self.attempt.maps.whole(|map| map.force, motion, xc, place);
            self.links.turn_rows(&self.attempt);
            let (between, dt) = (self.attempt.between(), self.attempt.dt);
            self.parts
                .internal(
                    &mut self.attempt,
                    (Configuration::Place, between),
                    |map| match between {
                        true => dt,
                        false => map.instant(dt),
                    },
                )?;
            self.attempt.evaluate_loads_of_step();
        }
        let vectors = &mut self.attempt.vectors;
        let residual = &mut vectors.residual[..];
        let n = residual.len();
        let (fixed, load, inertia) = (
            &self.attempt.system.fixed[..n],
            &vectors.load[..n],
            &vectors.inertia[..n],
        );
        let (internal, damping) = (&vectors.internal[..n], &vectors.damping[..n]);
        for i in 0..n {
            let left = load[i] - inertia[i] - internal[i] - damping[i];
            residual[i] = if fixed[i] { 0.0 } else { left };
        }
        if !self.links.force().is_empty() {
            let vectors = &mut self.attempt.vectors;
            vectors.unlinked.clone_from(&vectors.residual);
            self.links.add_link_force(&mut self.attempt);
        }
        Ok(())
    }

    /// How far forces and contacts are from what they must be. The forces of an assembly, whose bodies may act on each other, are compared with
    /// the largest of those that balance in it, and with its momentum per step: bodies that have nothing to do with it do not make its
    /// equations less accurate. The excess is by connected part, and without momentum, so that a light body is as accurate where a heavy
    /// one strikes it.
    pub(super) fn standing(&mut self) -> Standing {
        self.stages.spread(&self.contacts, &mut self.attempt);
        let mut squares = self.parts.take_squares();
        self.links
            .square_forces(&mut self.parts, &self.attempt, &mut squares);
        let tolerance = self.attempt.system.nonlinear.iteration.tolerance;
        let mut standing = Standing {
            is_rounding: true,
            ..Standing::default()
        };
        let (mut left_over, mut force) = (0.0, 0.0);
        for assembly in &self.attempt.system.assemblies.all {
            let parts = || assembly.parts.iter().map(|&part| &squares[part]);
            standing.excess = excess(parts, tolerance).max(standing.excess);
            let own = parts().fold(Squares::default(), Squares::with);
            let scale = own.scale();
            let [imbalance, rounding] =
                [own.imbalance, own.rounding].map(|square| square.sqrt() / scale);
            standing.is_rounding &= imbalance <= tolerance.max(rounding);
            left_over += (scale * tolerance.max(rounding)).powi(2);
            force += own.imbalance;
            standing.scale = standing.scale.max(scale);
            // what is no number is the worst
            if imbalance.is_nan() || imbalance >= standing.imbalance {
                (standing.imbalance, standing.rounding) = (imbalance, rounding);
            }
        }
        self.parts.keep_squares(squares);
        self.parts.leave_over(left_over.sqrt());
        standing.force = force.sqrt();
        let of_points = self
            .contacts
            .worst_point(&self.parts, &self.attempt)
            .map_or(0.0, |(_, defect)| defect);
        standing.defect = of_points.max(self.links.worst_row(&self.attempt));
        standing
    }

    /// The same of forces alone, without gaps: those of bodies at small strain are of displacements, and places do not count.
    pub fn rounding_of_forces(&self) -> f64 {
        let finite = self
            .attempt
            .system
            .bodies
            .iter()
            .any(Body::has_finite_motion);
        self.parts
            .rounding_with(&self.attempt, if finite { 1.0 } else { 0.0 })
    }

    /// Norm of the forces that the iterations of the last step may have left unbalanced, N; zero of linear steps.
    pub fn left_over(&self) -> f64 {
        self.parts.left_over()
    }
}

/// Part of the tolerance by which the largest forces of an assembly count in each of its parts: what contacts and links exchange is known to no more digits.
const EXCHANGED: f64 = 1e-3;

/// The same, in roundings.
const ROUNDINGS: f64 = 16.0;

/// Largest imbalance of the parts of an assembly over what is tolerated there: the tolerance times the largest of the forces that balance in the part, rounding
/// of what the assembly exchanges, and of the inertia.
fn excess<'a, I: Iterator<Item = &'a Squares>>(parts: impl Fn() -> I, tolerance: f64) -> f64 {
    let exchanged = parts().fold(0.0, |most, part| part.largest().max(most));
    let floor = (EXCHANGED * tolerance).max(ROUNDINGS * f64::EPSILON) * exchanged;
    let of = |part: &Squares| {
        let rounding = ROUNDINGS * part.inertia_rounding.sqrt();
        let tolerated = (tolerance * part.largest()).max(floor).max(rounding);
        // what is no number is not in balance
        match part.imbalance.sqrt() / tolerated.max(f64::MIN_POSITIVE) {
            excess if excess.is_nan() => f64::INFINITY,
            excess => excess,
        }
    };
    parts().map(of).fold(0.0, f64::max)
}
