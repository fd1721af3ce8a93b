//! Energies of bodies that may act on each other, each assembly in its own frame ([`carom_system::Assembly`]): the sizes with which
//! losses and gains are compared, and the balance of each by itself. They do not depend on the frame of the model, nor on bodies
//! that have nothing to do with these.
//!
//! The energy of an assembly is E = K + A, with K the kinetic energy in its frame and A the work that its materials took. Outside forces
//! give W, contacts C (negative where closing takes energy, friction counted), damping takes D, and the scheme what is left:
//! `E = E₀ + W + C - D - scheme`.

use serde::{Deserialize, Serialize};

use crate::body_energies::BodyEnergy;
use crate::records::ContactRecord;
use crate::sum::Sum;
use crate::system::System;
use carom_bodies::Deleted;
use carom_system::Assembly;

/// Part of the kinetic energy in the frame of the model of which another frame leaves rounding: some 1e-15 in a step, times the
/// thousand of which a gain would be told.
const ROUNDING: f64 = 1e-11;

/// Energies of all assemblies.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AssemblyEnergies {
    /// By assembly; empty before the dynamics.
    pub all: Vec<AssemblyEnergy>,
    /// Largest so far, of all together, J.
    pub largest: f64,
    /// Whether the scheme of a zone balances an energy with a lag or a memory, which is known of the whole alone.
    pub of_whole_alone: bool,
    /// What strain and hardening store in each body, J; empty before the dynamics, of a linear system, and of zones that step apart together.
    stored: Vec<f64>,
}

/// Energy of one assembly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AssemblyEnergy {
    /// At the start, J.
    pub start: f64,
    /// Largest so far, J.
    pub largest: f64,
    /// Now, J.
    pub now: f64,
    /// Energy of springs so far that pull at elongation zero, J: what they release beyond that, positive.
    pub released: f64,
    /// Largest work from outside so far, of loads, supports and obstacles, J.
    pub largest_given: f64,
    /// Largest energy so far beyond that at the start and the work from outside, J.
    pub largest_gain: f64,
    /// Largest energy that the scheme has made so far, J.
    pub largest_made: f64,
    /// What the scheme has taken so far, J.
    pub dissipated: f64,
    /// Largest kinetic energy so far in the frame of the model, J.
    pub in_frame_of_model: f64,
    /// Its motion now, in the frame of the model.
    motion: AssemblyMotion,
    taken: Sum,
    damped: Sum,
    given: Sum,
    /// Momentum at the start, N s.
    momentum: [f64; 3],
}

/// What moves in an assembly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct AssemblyMotion {
    /// Kinetic energy, J.
    kinetic: f64,
    /// The term in |a|²_M of the energy that the scheme balances, J.
    of_scheme: f64,
    /// Momentum, N s.
    momentum: [f64; 3],
}

/// What materials took in a step, of all assemblies that are balanced together ([`Assembly::balanced_with`]).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Taken {
    /// By the energies of the bodies, J.
    pub(crate) exact: f64,
    /// Work of the internal forces, J.
    work: f64,
    /// Sum of the absolute works on the connected parts, J.
    size: f64,
}

/// A connected part at the end of a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PartMotion {
    /// ½ v · M v, J.
    pub(crate) kinetic: f64,
    /// The term in |a|²_M of the energy that the scheme balances, J.
    pub(crate) of_scheme: f64,
    /// Momentum, N s.
    pub(crate) momentum: [f64; 3],
    /// Work that the internal forces took in the step, J.
    pub(crate) taken: f64,
    /// Work that damping took in the step, J.
    pub(crate) damped: f64,
    /// Work of loads and supports in the step, J.
    pub(crate) given: f64,
}

impl AssemblyEnergy {
    /// Energy put in so far: that at the start, the largest work from outside, and what springs released, J; not less than what rounding
    /// leaves of the kinetic energy in the frame of the model.
    pub fn put_in(&self) -> f64 {
        let put_in = self.start + self.largest_given + self.released;
        put_in.max(ROUNDING * self.in_frame_of_model)
    }

    /// Work that its materials took so far, with the strain energy at the start, J.
    pub(crate) fn taken(&self) -> f64 {
        self.taken.get()
    }

    /// Begins with the motion as it is.
    fn begin(&mut self, assembly: &Assembly) {
        let motion = self.motion;
        let kinetic = assembly.kinetic(motion.kinetic, &motion.momentum);
        self.in_frame_of_model = motion.kinetic;
        self.momentum = motion.momentum;
        self.start = kinetic + self.taken.get();
        self.close(kinetic, [0.0; 3]);
        // the scheme's own term belongs to the start
        self.start += motion.of_scheme;
    }

    /// The end of a step with the motion as it is, and `contacts`, the work of its contacts so far, less what friction took, J; returns its energy without
    /// what materials gave, J.
    fn end(&mut self, assembly: &Assembly, contacts: f64) -> f64 {
        let motion = self.motion;
        // the impulse from outside is the change of the momentum
        let carried =
            (0..3).map(|i| assembly.velocity[i] * (motion.momentum[i] - self.momentum[i]));
        let given = self.given.get() - carried.sum::<f64>();
        let kinetic = assembly.kinetic(motion.kinetic, &motion.momentum);
        self.in_frame_of_model = self.in_frame_of_model.max(motion.kinetic);
        self.close(kinetic, [motion.of_scheme, given, contacts]);
        kinetic + self.taken.get().max(0.0)
    }

    /// Adds the motion and the works so far of one that belongs to it.
    fn include(&mut self, own: &AssemblyEnergy) {
        let (all, part) = (&mut self.motion, &own.motion);
        all.kinetic += part.kinetic;
        all.of_scheme += part.of_scheme;
        for i in 0..3 {
            all.momentum[i] += part.momentum[i];
        }
        self.taken.add(own.taken.get());
        self.damped.add(own.damped.get());
        self.given.add(own.given.get());
    }

    /// Adds the motion of its parts.
    fn take(&mut self, motion: &PartMotion) {
        self.taken.add(motion.taken);
        self.damped.add(motion.damped);
        self.given.add(motion.given);
    }

    /// The energies at the end of a step. `kinetic` and `given`: in the frame of the assembly; `contacts`: work of its contacts so far, less what
    /// friction took; J.
    fn close(&mut self, kinetic: f64, [of_scheme, given, contacts]: [f64; 3]) {
        let taken = self.taken.get();
        self.now = kinetic + taken;
        self.released = self.released.max(-taken);
        self.largest = self.largest.max(kinetic + taken.max(0.0));
        self.largest_given = self.largest_given.max(given);
        let gained = self.now + of_scheme - self.start - given;
        self.largest_gain = self.largest_gain.max(gained);
        self.dissipated = contacts - self.damped.get() - gained;
        self.largest_made = self.largest_made.max(-self.dissipated);
    }
}

impl AssemblyEnergies {
    /// At the start. `part`: each connected part, with ½ u · f as its work.
    pub(crate) fn start(system: &System, part: impl Fn(usize) -> PartMotion) -> AssemblyEnergies {
        let mut energies = AssemblyEnergies {
            all: vec![AssemblyEnergy::default(); system.assemblies.all.len()],
            ..AssemblyEnergies::default()
        };
        for (assembly, energy) in system.assemblies.all.iter().zip(&mut energies.all) {
            let mut sum = PartMotion::default();
            for motion in assembly.parts.iter().map(|&number| part(number)) {
                energy.take(&motion);
                sum.include(&motion);
            }
            energy.motion = sum.motion();
            energy.begin(assembly);
            energies.largest += energy.largest;
        }
        energies
    }

    /// Makes this that of the state before the step.
    pub(crate) fn follow(&mut self, before: &AssemblyEnergies) {
        self.all.clone_from(&before.all);
        self.stored.clone_from(&before.stored);
        (self.largest, self.of_whole_alone) = (before.largest, before.of_whole_alone);
    }

    /// What the materials of each body took from the state on to energies at the end of a step, J.
    pub(crate) fn taken<'a>(&'a self, bodies: &'a [BodyEnergy]) -> impl Iterator<Item = f64> + 'a {
        let ends = self.stored.iter().zip(bodies);
        ends.map(|(before, now)| now.stored - before + now.dissipated)
    }

    /// Keeps the energies of the bodies for the next step.
    pub(crate) fn store(&mut self, bodies: &[BodyEnergy]) {
        self.stored.clear();
        self.stored.extend(bodies.iter().map(|body| body.stored));
    }

    /// Takes from a body what its deleted elements had stored: its materials took that before.
    pub(crate) fn delete(&mut self, body: usize, deleted: &Deleted) {
        if let Some(stored) = self.stored.get_mut(body) {
            *stored -= deleted.stored.strain + deleted.stored.hardening;
        }
    }

    /// Adds the end of a step. `parts`: each connected part; `obstacles`: work in the step of the obstacle of each contact, J.
    pub(crate) fn add(
        &mut self,
        system: &System,
        parts: &[PartMotion],
        (records, obstacles): (&[ContactRecord], &[f64]),
    ) {
        let mut sum = 0.0;
        let assemblies = &system.assemblies;
        for (number, energy) in self.all.iter_mut().enumerate() {
            let assembly = &assemblies.all[number];
            let mut all = PartMotion::default();
            for motion in assembly.parts.iter().map(|&number| &parts[number]) {
                energy.take(motion);
                all.include(motion);
            }
            let mut contacts = 0.0;
            for &contact in &assembly.contacts {
                energy.given.add(obstacles[contact]);
                contacts += records[contact].work_with_friction();
            }
            energy.motion = all.motion();
            sum += energy.end(assembly, contacts);
        }
        self.largest = self.largest.max(sum);
    }

    /// Those of a model whose zones step apart, from theirs. `zones`: the assemblies of the zones, each with the one of the model that it belongs to; `works`: of contacts and
    /// links so far by assembly of the model, less what friction took, J.
    pub fn gather<'a>(
        &mut self,
        system: &System,
        zones: impl Iterator<Item = (usize, &'a AssemblyEnergy)>,
        works: &[f64],
    ) {
        let begins = self.all.is_empty();
        self.all
            .resize(system.assemblies.all.len(), AssemblyEnergy::default());
        for energy in &mut self.all {
            energy.motion = AssemblyMotion::default();
            (energy.taken, energy.damped, energy.given) = Default::default();
        }
        for (number, own) in zones {
            self.all[number].include(own);
        }
        let mut sum = 0.0;
        let assemblies = system.assemblies.all.iter();
        for ((energy, assembly), works) in self.all.iter_mut().zip(assemblies).zip(works) {
            if begins {
                energy.begin(assembly);
            }
            sum += energy.end(assembly, *works);
        }
        self.largest = self.largest.max(sum);
    }

    /// That of the assembly of a contact; none in a static stage.
    pub fn of_contact(&self, system: &System, contact: usize) -> Option<&AssemblyEnergy> {
        self.all.get(system.assemblies.of_contact(system, contact))
    }

    /// Whether they are of this system; none before the dynamics.
    pub(crate) fn are_of(&self, system: &System) -> bool {
        [0, system.assemblies.all.len()].contains(&self.all.len())
            && [0, system.bodies.len()].contains(&self.stored.len())
    }
}

impl PartMotion {
    fn motion(&self) -> AssemblyMotion {
        AssemblyMotion {
            kinetic: self.kinetic,
            of_scheme: self.of_scheme,
            momentum: self.momentum,
        }
    }

    /// Adds what is told of another part.
    fn include(&mut self, other: &PartMotion) {
        self.kinetic += other.kinetic;
        self.of_scheme += other.of_scheme;
        for i in 0..3 {
            self.momentum[i] += other.momentum[i];
        }
    }
}

/// Makes the works that the internal forces took add up to what the materials took, in each group of assemblies that are balanced together. The mean of the forces at the start
/// and the end of a step times the way is that energy where forces are linear in the way; at finite strain and rotation it differs by the third power of the step. Each part has
/// as much of the difference as it has of the works of its group. `groups`: with their exact energies alone; `of_part`: the group of a part.
pub(crate) fn balance_taken(
    parts: &mut [PartMotion],
    groups: &mut [Taken],
    of_part: impl Fn(usize) -> usize,
) {
    for (number, part) in parts.iter().enumerate() {
        let group = &mut groups[of_part(number)];
        group.work += part.taken;
        group.size += part.taken.abs();
    }
    for (number, part) in parts.iter_mut().enumerate() {
        let group = &groups[of_part(number)];
        if group.size != 0.0 {
            part.taken += (group.exact - group.work) / group.size * part.taken.abs();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn works_add_up_to_what_the_materials_of_those_balanced_together_took() {
        let part = |taken: f64| PartMotion {
            taken,
            ..PartMotion::default()
        };
        let mut parts = [2.0, 5.0, -1.0, 0.0].map(part);
        let mut groups = [1.3, 4.0, 7.0].map(|exact| Taken {
            exact,
            ..Taken::default()
        });
        balance_taken(&mut parts, &mut groups, |part| [0, 1, 0, 2][part]);
        // of the first and the third 0.3 J is missing, of 3 J; the second has all of its own; the last has no work that could be wrong
        let expected = [2.2, 4.0, -0.9, 0.0];
        for (part, expected) in parts.iter().zip(&expected) {
            assert!((part.taken - expected).abs() < 1e-15, "{} J", part.taken);
        }
    }
}
