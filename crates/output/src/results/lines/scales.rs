//! The energies with which losses and gains are compared.
//!
//! They are told in the frames of the assemblies ([`carom_dynamics::AssemblyEnergies`]), so that they depend neither on the frame
//! of the model nor on bodies that have nothing to do with each other. Static stages and zones that step by themselves have the
//! energies of the ledger alone.

use carom_dynamics::AssemblyEnergy;

use crate::results::lines::Evidence;

/// Part of the largest energy below which an assembly is at rest: what solves leave of forces that balance.
const NOTHING: f64 = 1e-18;

/// Energies of a contact's assembly, J.
pub(super) struct OfContact {
    /// At the start, with what was put in later.
    pub(super) supplied: f64,
    /// The largest.
    pub(super) largest: f64,
}

impl Evidence<'_> {
    /// The energies of the bodies that a contact may have to do with.
    pub(super) fn around(&self, contact: usize) -> OfContact {
        match self.last.assemblies.of_contact(self.system, contact) {
            Some(energy) => OfContact {
                supplied: energy.put_in(),
                largest: energy.largest,
            },
            None => OfContact {
                supplied: self.last.put_in(),
                largest: self.last.largest_energy(),
            },
        }
    }

    /// The largest force of the contacts that may have to do with one, N. `of`: the force of each.
    pub(super) fn largest_beside(&self, contact: usize, of: impl Fn(usize) -> f64) -> f64 {
        let assemblies = &self.system.assemblies;
        let own = &assemblies.all[assemblies.of_contact(self.system, contact)];
        own.contacts.iter().map(|&k| of(k)).fold(0.0, f64::max)
    }

    /// The largest, over the assemblies, of a part of an energy, with what follows the name of the quantity; that of the whole run
    /// where there is one assembly or none.
    pub(super) fn worst_assembly(
        &self,
        whole: f64,
        of: impl Fn(&AssemblyEnergy) -> f64,
    ) -> (f64, String) {
        let (assemblies, energies) = (&self.system.assemblies, &self.last.assemblies.all);
        // the energy that a scheme with a lag or a memory balances is known of the whole alone
        let scheme = self.system.scheme.get().energy_identity(self.system.dt);
        let plain = scheme.is_some_and(|identity| identity.lag == 0.0 && identity.memory == 0.0);
        let plain = plain && !self.last.assemblies.of_whole_alone;
        if energies.len() < 2 || self.system.schemes.len() > 1 || !plain {
            return (whole, String::new());
        }
        let largest = energies.iter().map(|own| own.largest);
        let none = NOTHING * largest.fold(0.0, f64::max);
        let moved = |own: &&AssemblyEnergy| own.largest > none;
        let parts = energies.iter().enumerate();
        let parts = parts.filter(|(_, own)| moved(own));
        let parts = parts.map(|(number, own)| (number, of(own)));
        let worst = parts.reduce(|one, other| match one.1.is_nan() || one.1 >= other.1 {
            true => one,
            false => other,
        });
        let Some((number, value)) = worst else {
            return (whole, String::new());
        };
        let own = |body: &usize| {
            let part = self.system.part_of_body[*body];
            assemblies.of_part[part] == number
        };
        let mut bodies = 0..self.system.bodies.len();
        let body = bodies
            .find(own)
            .map_or("", |body| self.system.bodies[body].name());
        (value, format!(" around body `{body}`"))
    }
}
