//! Supports that move: the jump of their velocity at the start of a step.
//!
//! A prescribed displacement ū(t) has one rate over a step, its mean `V = (ū₊ - ū)/dt`, with which every scheme has the uniform
//! motion `u₊ = u + dt V`, `v₊ = V`, `a₊ = 0`. Where V is not the rate before, the held unknowns h jump to it at the start
//! of the step, and with a consistent mass the free ones f with them:
//!
//! `M_ff Δv_f = -M_fh Δv_h`, with the impulse `J = M Δv` of the supports (zero on f) and its work `J · (v + ½ Δv)`, which is
//! the change of the kinetic energy. Between the stages of a step the velocity at the start of the step, which the state remembers, jumps with it: the
//! later stage then starts from a uniform motion too, and its forces alone change the momentum.

use crate::columns::HeldColumns;
use crate::error::Error;
use crate::operator::{Operators, assembled};
use crate::resultant::Resultant;
use crate::system::{Motion, System};

/// Jump over what rounding of the displacements leaves in a rate, below which there is none.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The jump of an attempt at a step.
#[derive(Default)]
pub(crate) struct Jump {
    /// Impulse of the supports.
    pub(crate) impulse: Resultant,
    /// Its work, J.
    pub(crate) work: f64,
    /// Velocity at the start: before the jump while an attempt is under way, after it otherwise.
    velocity: Vec<f64>,
    /// The memory in the same way; empty where it does not jump.
    memory: Vec<f64>,
    /// Factor of the mass, and its columns of held unknowns; none where it is diagonal, or before the first jump.
    mass: Option<(Operators, HeldColumns)>,
    change: Vec<f64>,
    momentum: Vec<f64>,
    /// Scratch of the solve.
    half: Vec<f64>,
    carried: Vec<f64>,
    jumps: bool,
}

/// The columns of the mass at held unknowns.
fn held_columns(system: &System) -> HeldColumns {
    let mut columns = HeldColumns::default();
    for part in &system.parts {
        let fixed = &system.fixed[part.clone()];
        match system.mass.couples(part) {
            true => {
                let mass = assembled(system, part, [1.0, 0.0], &|_| 0.0);
                columns.append(&mass, fixed, part.start);
            }
            false => {
                columns.append_diagonal(&system.mass.lumped[part.clone()], fixed, part.start);
            }
        }
    }
    columns
}

impl Jump {
    /// Impulse of the supports on each unknown, N s; `None` without a jump.
    pub(crate) fn impulses(&self) -> Option<&[f64]> {
        self.jumps.then_some(&self.momentum)
    }

    /// Completes the change of the velocity by that of the free unknowns, and finds the impulse.
    fn carry_along(&mut self, system: &System) -> Result<(), Error> {
        if system.mass.is_lumped() {
            system.mass.multiply(&self.change, &mut self.momentum);
            return Ok(());
        }
        let (factor, columns) = match &mut self.mass {
            Some(mass) => mass,
            empty => empty.insert((
                Operators::new(system, 1.0, 0.0, "mass matrix")?,
                held_columns(system),
            )),
        };
        self.momentum.fill(0.0);
        columns.add_product(&self.change, &mut self.momentum);
        for (p, fixed) in self.momentum.iter_mut().zip(&system.fixed) {
            *p = if *fixed { 0.0 } else { -*p };
        }
        let (half, carried) = (&mut self.half, &mut self.carried);
        half.resize(self.momentum.len(), 0.0);
        carried.resize(self.momentum.len(), 0.0);
        factor.begin(&self.momentum, half);
        factor.end(half, carried);
        for (i, change) in self.change.iter_mut().enumerate() {
            if !system.fixed[i] {
                *change = carried[i];
            }
        }
        columns.product_at_held(&self.change, &mut self.momentum);
        Ok(())
    }

    /// Impulse and work of the supports, the velocity and the memory after the jump.
    fn add_up(&mut self, system: &System, motion: &Motion) {
        if system.has_stages() {
            let memory = motion.memory.iter().zip(&self.change);
            self.memory
                .extend(memory.map(|(memory, change)| memory + change));
        }
        self.velocity.clone_from(&motion.v);
        for (i, p) in self.momentum.iter_mut().enumerate() {
            if !system.fixed[i] {
                *p = 0.0;
            }
            self.work += *p * (motion.v[i] + 0.5 * self.change[i]);
            self.velocity[i] += self.change[i];
        }
        self.impulse = Resultant::at(system, (&motion.frames, &[&motion.u]), &self.momentum);
    }

    /// Computes the jump at the start of a dynamic step of `dt` from `time` (both s); tells whether there is one.
    ///
    /// # Errors
    /// A mass that is not positive definite.
    pub(crate) fn find(
        &mut self,
        system: &System,
        motion: &Motion,
        [time, dt]: [f64; 2],
    ) -> Result<bool, Error> {
        self.clear();
        let n = system.unknowns();
        self.change.clear();
        self.change.resize(n, 0.0);
        self.momentum.resize(n, 0.0);
        let end = &mut self.momentum;
        system.nonlinear.prescribe([time, time + dt], end);
        for follows in &system.nonlinear.follows {
            let i = follows.unknown as usize;
            let change = (end[i] - motion.u[i]) / dt - motion.v[i];
            let rounding = ROUNDING * (end[i].abs() + motion.u[i].abs()) / dt;
            if change.abs() > rounding {
                self.change[i] = change;
                self.jumps = true;
            }
        }
        if self.jumps {
            self.carry_along(system)?;
            self.add_up(system, motion);
        }
        Ok(self.jumps)
    }

    /// No jump.
    pub(crate) fn clear(&mut self) {
        (self.impulse, self.work, self.jumps) = (Resultant::default(), 0.0, false);
        self.memory.clear();
    }

    /// Exchanges the velocity, and between stages the memory, before the jump and after it.
    pub(crate) fn exchange(&mut self, motion: &mut Motion) {
        std::mem::swap(&mut motion.v, &mut self.velocity);
        if !self.memory.is_empty() {
            std::mem::swap(&mut motion.memory, &mut self.memory);
        }
    }
}
