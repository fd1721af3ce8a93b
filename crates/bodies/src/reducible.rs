//! A body that a reduced one stands for.

use carom_algebra::tensor::Mat3;
use carom_algebra::unknowns::Unknowns;
use carom_mesh::{ElementId, Mesh};

use crate::beam::{Beam, SectionForces, SectionStress};
use crate::solid::Solid;
use crate::spec::BodySpec;
use crate::{Error, Kinematics};

/// A body that can be reduced: small strain and small rotations, and nothing flows.
#[derive(Debug)]
// A system has few bodies.
#[allow(clippy::large_enum_variant)]
pub enum Reducible {
    /// A solid or a bar.
    Solid(Solid),
    /// Beams.
    Beam(Beam),
}

impl Reducible {
    /// Builds a body on a mesh. `number`: system number of each mesh node; `unknowns`: of the nodes of the system.
    ///
    /// # Errors
    /// As [`Body::new`](crate::Body::new).
    pub fn new(
        mesh: &Mesh,
        spec: BodySpec,
        number: &[u32],
        unknowns: &Unknowns,
    ) -> Result<Reducible, Error> {
        match spec.kinematics {
            Kinematics::Beam(section) => {
                Beam::new(mesh, spec, section, number, unknowns).map(Reducible::Beam)
            }
            _ => Solid::new(mesh, spec, number, unknowns).map(Reducible::Solid),
        }
    }

    pub(crate) fn name(&self) -> &str {
        match self {
            Reducible::Solid(solid) => solid.name(),
            Reducible::Beam(beam) => beam.name(),
        }
    }

    pub(crate) fn cells(&self) -> &[ElementId] {
        match self {
            Reducible::Solid(solid) => solid.cells(),
            Reducible::Beam(beam) => beam.cells(),
        }
    }

    pub(crate) fn wave_speed(&self) -> f64 {
        match self {
            Reducible::Solid(solid) => solid.wave_speed(),
            Reducible::Beam(beam) => beam.wave_speed(),
        }
    }

    pub(crate) fn smallest_size(&self) -> f64 {
        match self {
            Reducible::Solid(solid) => solid.smallest_size(),
            Reducible::Beam(beam) => beam.smallest_size(),
        }
    }

    pub(crate) fn stresses(&self, u: &[f64]) -> Vec<(f64, Mat3)> {
        match self {
            Reducible::Solid(solid) => solid.stresses(u, &[]),
            Reducible::Beam(beam) => beam.stresses(u, &[]),
        }
    }

    pub(crate) fn has_sections(&self) -> bool {
        matches!(self, Reducible::Beam(_))
    }

    pub(crate) fn section_forces(&self, u: &[f64]) -> Option<Vec<SectionForces>> {
        match self {
            Reducible::Solid(_) => None,
            Reducible::Beam(beam) => Some(beam.section_forces(u, &[])),
        }
    }

    pub(crate) fn section_stresses(&self, u: &[f64]) -> Option<Vec<SectionStress>> {
        match self {
            Reducible::Solid(_) => None,
            Reducible::Beam(beam) => Some(beam.section_stresses(u, &[])),
        }
    }
}
