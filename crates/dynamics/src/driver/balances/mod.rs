//! What the balance of a step is made of, and forces of supports.

mod mean_forces;
mod obstacles;
pub(crate) mod record;
mod reported;
mod supports;
mod worked;
mod works;

use carom_algebra::rotation::Rotation;
use carom_system::Motion;

use crate::driver::attempt::Attempt;
use crate::driver::attempt::forces::Loads;
use crate::error::Error;
use crate::resultant::Resultant;
use crate::system::System;
use supports::Jump;
use works::Works;

/// What the balance of a step is made of, and forces of supports.
#[derive(Default)]
pub(crate) struct Balances {
    jump: Jump,
    /// Forces of the named supports in the last attempt.
    reactions: Vec<Resultant>,
    works: Works,
}

impl Balances {
    /// Works of the forces.
    pub(crate) fn works_mut(&mut self) -> &mut Works {
        &mut self.works
    }

    /// Writes the forces of the named supports; see [`reported::write`].
    pub(crate) fn write_reactions(
        &mut self,
        system: &System,
        at: (&[Rotation], Option<&[f64]>),
        of: impl Fn(usize) -> f64,
    ) {
        reported::write(&mut self.reactions, system, at, of);
    }

    /// Those forces, to add those of other ranks.
    pub(crate) fn reactions_mut(&mut self) -> &mut [Resultant] {
        &mut self.reactions
    }

    /// The jump of the supports at the start of the step.
    pub(crate) fn jump(&self) -> &Jump {
        &self.jump
    }

    /// Exchanges the velocities before and after that jump.
    pub(crate) fn exchange_jump(&mut self, motion: &mut Motion) {
        self.jump.exchange(motion);
    }

    /// Forces of the named supports in the last attempt.
    pub(crate) fn reactions(&self) -> &[Resultant] {
        &self.reactions
    }

    /// Computes the jump of the supports at the start of the step; tells whether there is one.
    pub(crate) fn find_jump(&mut self, attempt: &Attempt) -> Result<bool, Error> {
        if attempt.maps.is_static() || attempt.system.nonlinear.follows.is_empty() {
            self.jump.clear();
            return Ok(false);
        }
        let span = [attempt.state.time, attempt.dt];
        self.jump.find(&attempt.system, &attempt.state.motion, span)
    }

    /// Forces of the named supports at the end: what is held has no acceleration. Those on nodes that do not `count` are left out.
    pub(crate) fn report_supports(
        &mut self,
        attempt: &Attempt,
        loads: Loads,
        count: &dyn Fn(usize) -> bool,
    ) {
        let motion = &attempt.next.motion;
        let load = |i: usize| match loads {
            Loads::None => 0.0,
            Loads::Dead([_, factor]) => factor * attempt.system.load[i],
            Loads::Varying => attempt.vectors.load[i],
        };
        let displacement = attempt.system.is_nonlinear().then_some(&motion.u[..]);
        let at = (&attempt.state.motion.frames[..], displacement);
        let unknowns = &attempt.system.unknowns;
        reported::write(&mut self.reactions, &attempt.system, at, |i| {
            if !count(unknowns.node(i) as usize) {
                return 0.0;
            }
            let damping = attempt.vectors.damping.get(i).unwrap_or(&0.0);
            motion.internal_force[i] + damping - load(i) - motion.contact_force[i]
        });
    }
}
