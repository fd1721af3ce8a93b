//! Where internal forces are taken, and the energies there.

use carom_algebra::rotation::Rotation;

/// Where internal forces are taken.
#[derive(Clone, Copy, Debug)]
pub struct Placement<'a> {
    /// Displacement, system vector, m.
    pub u: &'a [f64],
    /// Velocity at the same instant, system vector, m/s.
    pub v: &'a [f64],
    /// Displacement at the start of the step, for the algorithmic stress between the two, whose work over the step is the
    /// change of the stored energy; none for the stress at `u`.
    pub from: Option<&'a [f64]>,
    /// Rotations of the nodes with finite ones at the start of the step, in the order of
    /// [`Unknowns::turning`](carom_algebra::unknowns::Unknowns::turning).
    pub frames: &'a [Rotation],
    /// Time since the history `old`, s.
    pub dt: f64,
    /// History of this body at the start of the step, [`Solid::history_len`](crate::Solid::history_len) numbers.
    pub old: &'a [f64],
}

/// Energies of a body, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stored {
    /// Stored by elastic strain, at `u`.
    pub strain: f64,
    /// Stored by hardening, at `u`.
    pub hardening: f64,
    /// Dissipated since the old history.
    pub dissipated: f64,
    /// What of `strain` resists the hourglass modes of elements with one point.
    pub hourglass: f64,
    /// Dissipated by bulk viscosity since the old history.
    pub viscous: f64,
    /// Fastest compression of a point with bulk viscosity since the old history: minus the rate of ln J, 1/s.
    pub compression: f64,
}

impl Stored {
    /// Adds the energies of a part.
    pub fn include(&mut self, part: &Stored) {
        self.strain += part.strain;
        self.hardening += part.hardening;
        self.dissipated += part.dissipated;
        self.hourglass += part.hourglass;
        self.viscous += part.viscous;
        self.compression = self.compression.max(part.compression);
    }
}
