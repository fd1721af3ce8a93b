//! Energies of the materials of all bodies where their forces were last computed.

use carom_bodies::Stored;

/// Energies of all bodies.
#[derive(Default)]
pub(crate) struct BodyEnergies {
    /// Of all together.
    pub(crate) all: Stored,
    /// Of each.
    pub(crate) each: Vec<BodyEnergy>,
}

/// Energy of the materials of one body, J.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BodyEnergy {
    /// That strain and hardening store.
    pub(crate) stored: f64,
    /// That materials and bulk viscosity have dissipated since the start of the step.
    pub(crate) dissipated: f64,
}

impl BodyEnergies {
    /// Begins with those of so many bodies, which have none.
    pub(crate) fn begin(&mut self, bodies: usize) {
        self.all = Stored::default();
        self.each.clear();
        self.each.resize(bodies, BodyEnergy::default());
    }

    /// Adds those of a body, or of some elements of it.
    pub(crate) fn include(&mut self, body: usize, given: &Stored) {
        self.all.include(given);
        let own = &mut self.each[body];
        own.stored += given.strain + given.hardening;
        own.dissipated += given.dissipated + given.viscous;
    }

    /// Those that are summed over ranks.
    pub(crate) fn sums(&mut self) -> impl Iterator<Item = &mut f64> {
        let Stored {
            strain,
            hardening,
            dissipated,
            hourglass,
            viscous,
            compression: _,
        } = &mut self.all;
        let each = self.each.iter_mut();
        let each = each.flat_map(|own| [&mut own.stored, &mut own.dissipated]);
        [strain, hardening, dissipated, hourglass, viscous]
            .into_iter()
            .chain(each)
    }
}
