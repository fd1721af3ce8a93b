//! Works of the forces of a step that are not all linear.

use crate::assembly_energy::{AssemblyEnergies, PartMotion, Taken, balance_taken};
use crate::body_energies::BodyEnergy;
use crate::driver::attempt::vectors::Vectors;
use crate::system::System;

/// Forces in the balance of a step by works, N.
#[derive(Default)]
pub(crate) struct Works {
    /// Of contacts as the ledger counts them.
    pub(crate) contact: Vec<f64>,
    /// What the balance leaves to supports, with what contact forces give by themselves in the inertia where they push.
    pub(crate) own: Vec<f64>,
    /// What supports hold of contact forces.
    pub(crate) held: Vec<f64>,
    /// Of supports.
    pub(crate) reaction: Vec<f64>,
    /// Of springs; empty without any.
    pub(crate) springs: Vec<f64>,
    /// Mean of one force over the step.
    pub(crate) mean: Vec<f64>,
    /// Work of loads and supports in the step on each connected part, J.
    pub(crate) given: Vec<f64>,
    /// Work in the step of the obstacle of each contact, J.
    pub(crate) obstacles: Vec<f64>,
    /// Connected parts at the end of the step.
    pub(crate) motions: Vec<PartMotion>,
    /// What the materials of assemblies that are balanced together took in the step.
    taken: Vec<Taken>,
}

impl Works {
    /// Makes the works of the internal forces on the connected parts add up to what their materials took. `start`: of the step; `end`: of each body at
    /// its end.
    pub(crate) fn balance_materials(
        &mut self,
        system: &System,
        motions: &mut [PartMotion],
        (start, end): (&AssemblyEnergies, &[BodyEnergy]),
    ) {
        let assemblies = &system.assemblies;
        let of_part = |part: usize| assemblies.all[assemblies.of_part[part]].balanced_with;
        let taken = &mut self.taken;
        taken.clear();
        taken.resize(assemblies.all.len(), Taken::default());
        for (part, own) in system.part_of_body.iter().zip(start.taken(end)) {
            taken[of_part(*part)].exact += own;
        }
        balance_taken(motions, taken, of_part);
    }

    /// Sets all but springs and mean. `link`: forces of links, N, empty without any; `factor`: of the contact forces; `push`: the factor of
    /// contact forces that push by themselves.
    pub(crate) fn hold(
        &mut self,
        system: &System,
        vectors: &Vectors,
        (link, factor, push): (&[f64], f64, Option<f64>),
    ) {
        let n = system.unknowns();
        for force in [
            &mut self.contact,
            &mut self.own,
            &mut self.held,
            &mut self.reaction,
        ] {
            force.resize(n, 0.0);
        }
        for i in 0..n {
            self.contact[i] = factor * vectors.contact[i];
            if !system.fixed[i] {
                // what a static stage held and let go has no reaction any more
                (self.own[i], self.held[i], self.reaction[i]) = (0.0, 0.0, 0.0);
                continue;
            }
            let inside = vectors.inertia[i] + vectors.balanced[i] + vectors.damping[i];
            // held nodes have no push
            let pushed = push.map_or(0.0, |factor| factor * vectors.contact[i]);
            self.own[i] = inside + pushed - vectors.load[i] - link.get(i).unwrap_or(&0.0);
            self.held[i] = -self.contact[i];
            self.reaction[i] = match push {
                Some(_) => self.own[i],
                None => self.own[i] + self.held[i],
            };
        }
    }
}
