//! What an iterated step asks of a solid.

use carom_algebra::csr::Csr;
use carom_mesh::ElementId;

use super::body::{Failed, Finite};
use super::element::Fault;
use super::{Deleted, Placement, Stored};
use crate::error::Error;
use crate::scratch::Scratch;
use crate::solid::Solid;
use crate::stability;

/// Bound of 2 over the stable step of an explicit scheme.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrequencyBound {
    /// The bound, rad/s.
    pub frequency: f64,
    /// What a compression of rate 1/s adds to it at most by quadratic bulk viscosity, rad: ω² ρ l² b₂²/κ.
    pub by_compression: f64,
    /// The element with this bound, where it is known.
    pub cell: Option<ElementId>,
}

impl FrequencyBound {
    /// Without quadratic bulk viscosity.
    pub(crate) fn of(frequency: f64) -> FrequencyBound {
        FrequencyBound {
            frequency,
            by_compression: 0.0,
            cell: None,
        }
    }

    /// Of two bodies together.
    pub fn most(&self, other: &FrequencyBound) -> FrequencyBound {
        let faster = other.frequency > self.frequency;
        FrequencyBound {
            frequency: self.frequency.max(other.frequency),
            cell: if faster { other.cell } else { self.cell },
            by_compression: self.by_compression.max(other.by_compression),
        }
    }
}

impl Solid {
    /// Whether forces are linear in the displacement: small strain.
    pub fn is_linear(&self) -> bool {
        self.finite.is_none()
    }

    /// Whether its kinematics goes with laws at finite strain: neither a bar nor plane stress.
    pub fn takes_finite_strain(&self) -> bool {
        self.kinematics().plane() == carom_materials::Plane::Full
    }

    /// Numbers that the integration points keep from one step to the next.
    pub fn history_len(&self) -> usize {
        let len = |finite: &Finite| finite.history_len(self.blocks());
        self.finite.as_ref().map_or(0, len)
    }

    /// Writes the history of a body that nothing has happened to, [`Solid::history_len`] numbers.
    pub fn start_history(&self, out: &mut [f64]) {
        if let Some(finite) = &self.finite {
            finite.start_history(out);
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
        match &self.finite {
            None => Ok(self.linear_force(at, scratch, f)),
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
    /// and one at finite strain the symmetric part of ∂f/∂u, which is not symmetric there.
    ///
    /// # Errors
    /// As [`Solid::force`]. The matrix is then of no use.
    pub fn add_tangent(&self, at: &Placement, factor: f64, matrix: &mut Csr) -> Result<(), Error> {
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

    /// Upper bound of the angular frequencies (rad/s) with lumped mass about a displacement: the largest magnitude of an
    /// eigenvalue of M_e⁻¹ K_e over the elements, with the tangents K_e there. [`Solid::frequency_bound`] is that of the
    /// undeformed body.
    ///
    /// An element that shortens in the direction of a wave keeps its mass, and its tangent grows. Costs about 2 n³ flops a
    /// dozen times for each element of n unknowns: not for every step.
    ///
    /// # Errors
    /// As [`Solid::force`].
    pub fn frequency_bound_at(&self, at: &Placement) -> Result<FrequencyBound, Error> {
        let Some(finite) = &self.finite else {
            return Ok(FrequencyBound::of(self.frequency_bound()));
        };
        let mut masses = Vec::new();
        self.each_matrix(false, &mut |element| masses.extend(element.lumped));
        let (mut bound, mut scaled) = (FrequencyBound::default(), Vec::new());
        let (mut first, mut element) = (0, 0);
        let modulus = self.bulk_modulus();
        let deleted = finite.deleted(self.blocks(), at.old);
        let visited = finite.each_tangent(self.blocks(), at, &mut |of_nodes, dim, k| {
            let masses = &masses[first..first + of_nodes.len()];
            first += of_nodes.len();
            if deleted.as_ref().is_some_and(|deleted| deleted[element]) {
                element += 1;
                return;
            }
            stability::scale(dim, k, masses, &mut scaled);
            let norm = scaled.iter().map(|b| b * b).sum::<f64>().sqrt();
            let viscous = self.coefficients(element);
            // no eigenvalue is beyond the norm
            if viscous.is_some() || norm > bound.frequency * bound.frequency {
                let square = stability::largest_magnitude(&mut scaled);
                let frequency = self.damped_frequency(element, square);
                if frequency > bound.frequency {
                    bound.frequency = frequency;
                    bound.cell = Some(self.cells()[element]);
                }
                let quadratic = viscous.map_or(0.0, |[_, quadratic]| quadratic);
                bound.by_compression = bound.by_compression.max(quadratic / modulus * square);
            }
            element += 1;
        });
        visited.map_err(|failed| self.failed(failed))?;
        Ok(bound)
    }

    fn failed(&self, (place, fault): Failed) -> Error {
        let body = self.name().to_owned();
        match fault {
            Fault::Law { point, failure } => Error::NoStress {
                body,
                cell: self.cells()[place],
                point,
                failure,
            },
            Fault::NoBetween => Error::NoBetween { body },
        }
    }
}
