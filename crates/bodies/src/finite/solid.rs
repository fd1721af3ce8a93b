//! What an iterated step asks of a solid.

use carom_algebra::csr::Csr;

use super::body::{Failed, Finite};
use super::element::Fault;
use super::{Deleted, Placement, Stored};
use crate::error::Error;
use crate::flowing::Flowing;
use crate::scratch::Scratch;
use crate::solid::Solid;

impl Solid {
    /// Whether forces are linear in the displacement: small strain, and nothing flows.
    pub fn is_linear(&self) -> bool {
        self.finite.is_none() && self.flowing.is_none()
    }

    /// Whether its law is one at finite strain.
    pub fn has_finite_strain(&self) -> bool {
        self.finite.is_some()
    }

    /// Whether its kinematics goes with laws at finite strain: neither a bar nor plane stress.
    pub fn takes_finite_strain(&self) -> bool {
        self.kinematics().plane() == carom_materials::Plane::Full
    }

    /// Numbers that the integration points keep from one step to the next.
    pub fn history_len(&self) -> usize {
        let bars = self.flowing.as_ref().map_or(0, Flowing::history_len);
        let len = |finite: &Finite| finite.history_len(self.blocks());
        let bolts = self.layers.bolts().len();
        self.finite.as_ref().map_or(bars + bolts, len)
    }

    /// Writes the history of a body that nothing has happened to, [`Solid::history_len`] numbers.
    pub fn start_history(&self, out: &mut [f64]) {
        match &self.finite {
            Some(finite) => finite.start_history(out),
            None => out.fill(0.0),
        }
    }

    /// Adds the internal forces (N) to the system vector `f`, writes the history at the end of the step into `new` and
    /// returns the energies.
    ///
    /// At small strain f = K u, or K (u_0 + u)/2 between two displacements. `scratch`: this body's own, empty before the
    /// first call; later calls allocate nothing. Sums run in a fixed order whatever the number of threads. After an error
    /// `f` and `new` are of no use.
    ///
    /// # Errors
    /// An element whose law gives no stress; a law without stress between two displacements.
    pub fn force(
        &self,
        at: &Placement,
        new: &mut [f64],
        scratch: &mut Scratch,
        f: &mut [f64],
    ) -> Result<Stored, Error> {
        if let Some(flowing) = &self.flowing {
            return match at.from {
                None => Ok(flowing.force(at, new, f)),
                Some(_) => Err(self.failed((0, Fault::NoBetween))),
            };
        }
        match &self.finite {
            None => {
                // what bolts keep
                new.copy_from_slice(at.old);
                Ok(self.linear_force(at, scratch, f))
            }
            Some(finite) => {
                let stored = finite.force(self.blocks(), at, new, scratch);
                let stored = stored.map_err(|failed| self.failed(failed))?;
                self.gather.add(&scratch.forces, f);
                Ok(stored)
            }
        }
    }

    /// Whether its elements are deleted where their material has flowed too far ([`BodySpec::deletion`](crate::BodySpec)).
    pub fn has_deletion(&self) -> bool {
        self.finite
            .as_ref()
            .is_some_and(|finite| finite.limit.is_some())
    }

    /// Whether each element is deleted in this history of the body; none of a body without deletion.
    pub fn deleted(&self, history: &[f64]) -> Option<Vec<bool>> {
        self.finite.as_ref()?.deleted(self.blocks(), history)
    }

    /// Deletes elements at the end of a step, which ends at `at` with the history `new`: those whose mean plastic strain over the points
    /// has reached the limit. They have no forces and energies from then on.
    ///
    /// # Errors
    /// As [`Solid::force`].
    pub fn delete(&self, at: &Placement, new: &mut [f64]) -> Result<Deleted, Error> {
        match &self.finite {
            None => Ok(Deleted::default()),
            Some(finite) => {
                let deleted = finite.delete(self.blocks(), at, new);
                deleted.map_err(|failed| self.failed(failed))
            }
        }
    }

    /// Adds `factor` ∂f/∂u (N/m) to a matrix over all unknowns of the system.
    ///
    /// The derivative is by `at.u`, with `at.from` held: between two displacements a body at small strain adds `factor` K/2,
    /// and one at finite strain ∂f/∂u, which is not symmetric there.
    ///
    /// # Errors
    /// As [`Solid::force`]. The matrix is then of no use.
    pub fn add_tangent(&self, at: &Placement, factor: f64, matrix: &mut Csr) -> Result<(), Error> {
        if let Some(flowing) = &self.flowing {
            flowing.add_tangent(at, factor, matrix);
            return Ok(());
        }
        match &self.finite {
            None => {
                self.add_linear_tangent(at, factor, matrix);
                Ok(())
            }
            Some(finite) => {
                let added = finite.add_tangent(self.blocks(), at, factor, matrix);
                added.map_err(|failed| self.failed(failed))
            }
        }
    }

    /// Middle of an element in the mesh, m.
    fn middle(&self, place: usize) -> [f64; 3] {
        let mut first = place;
        for block in self.blocks() {
            match first.checked_sub(block.len()) {
                Some(rest) => first = rest,
                None => return block.middle(first),
            }
        }
        [f64::NAN; 3]
    }

    pub(super) fn failed(&self, (place, fault): Failed) -> Error {
        let body = self.name().to_owned();
        match fault {
            Fault::Law { point, failure } => Error::NoStress {
                body,
                cell: self.cells()[place],
                middle: self.middle(place),
                point,
                failure,
            },
            Fault::NoBetween => Error::NoBetween { body },
        }
    }
}
