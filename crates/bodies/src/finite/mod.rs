//! Bodies as a nonlinear solver sees them: forces and tangents at a displacement, history, energies.
//!
//! A body whose law is one of finite strain is total Lagrangian: F = I + ∂u/∂X at the integration points of the reference
//! configuration, f = ∫ P(F) ∂N/∂X dV. A body at small strain answers through the same functions with f = K u.

use carom_algebra::csr::Csr;

use crate::block::Scratch;
use crate::body::Body;
use crate::error::Error;

mod linear;

/// How the elements of a body integrate the internal work.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Formulation {
    /// All points of the stiffness rule.
    #[default]
    Full,
    /// Mean dilatation, against volumetric locking: the volume ratio of an element is that of the whole element.
    BBar,
    /// One point, and a stiffness against the hourglass modes that it does not see: 4-node quadrilaterals and 8-node
    /// hexahedra.
    Reduced {
        /// Factor of the hourglass stiffness, without unit; 0.05 to 0.1 as a rule.
        hourglass: f64,
    },
}

/// Where internal forces are taken.
#[derive(Clone, Copy, Debug)]
pub struct Placement<'a> {
    /// Displacement, system vector, m.
    pub u: &'a [f64],
    /// Displacement at the start of the step, for the algorithmic stress between the two, whose work over the step is the
    /// change of the stored energy; none for the stress at `u`.
    pub from: Option<&'a [f64]>,
    /// Time since the history `old`, s.
    pub dt: f64,
    /// History of this body at the start of the step, [`Body::history_len`] numbers.
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
}

impl Body {
    /// Whether forces are linear in the displacement: small strain.
    pub fn is_linear(&self) -> bool {
        self.material().finite().is_none()
    }

    /// Numbers that the integration points keep from one step to the next.
    pub fn history_len(&self) -> usize {
        0
    }

    /// Writes the history of a body that nothing has happened to.
    pub fn start_history(&self, _out: &mut [f64]) {}

    /// Adds the internal forces (N) to the system vector `f`, writes the history at the end of the step into `new` and
    /// returns the energies.
    ///
    /// At small strain f = K u, or K (u_0 + u)/2 between two displacements. `scratch`: this body's own, empty before the
    /// first call; later calls allocate nothing. Sums run in a fixed order whatever the number of threads.
    ///
    /// # Errors
    /// An element whose law gives no stress; a law or a formulation without stress between two displacements.
    pub fn finite_force(
        &self,
        at: &Placement,
        _new: &mut [f64],
        scratch: &mut Scratch,
        f: &mut [f64],
    ) -> Result<Stored, Error> {
        Ok(self.linear_force(at, scratch, f))
    }

    /// Adds `factor` ∂f/∂u (N/m) to a matrix over all unknowns of the system.
    ///
    /// The derivative is by `at.u`, with `at.from` held: between two displacements a body at small strain adds `factor` K/2.
    ///
    /// # Errors
    /// As [`Body::finite_force`].
    pub fn add_tangent(&self, at: &Placement, factor: f64, matrix: &mut Csr) -> Result<(), Error> {
        self.add_linear_tangent(at, factor, matrix);
        Ok(())
    }
}
