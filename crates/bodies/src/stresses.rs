//! Stresses, forces in sections and plastic strains of the elements of a body.

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::Mat3;

use crate::{Body, SectionForces, SectionStress};

impl Body {
    /// Volume (m³) and mean stress (Pa) of each element, in the order of [`Body::cells`]; see [`Solid::stresses`](crate::Solid::stresses).
    pub fn stresses(&self, u: &[f64], history: &[f64]) -> Vec<(f64, Mat3)> {
        match self {
            Body::Solid(solid) => solid.stresses(u, history),
            Body::Beam(beam) => beam.stresses(u, history),
            Body::LargeBeam(beam) => beam.stresses(u, history),
            Body::Shell(shell) => shell.stresses(u, history),
            // neither volume nor stress
            Body::Discrete(discrete) => vec![(0.0, Mat3::zeros()); discrete.cells().len()],
            Body::Rigid(rigid) => vec![(0.0, Mat3::zeros()); rigid.cells().len()],
            Body::Reduced(reduced) => reduced.stresses(u),
        }
    }

    /// The same of one element, by its place in [`Body::cells`]: of a solid at the cost of one element.
    pub fn stress(&self, element: usize, u: &[f64], history: &[f64]) -> Option<(f64, Mat3)> {
        match self {
            Body::Solid(solid) => solid.stresses_of(element..element + 1, (u, history)).pop(),
            _ => self.stresses(u, history).get(element).copied(),
        }
    }

    /// Forces and moments in the sections of each element of beams, in the order of [`Body::cells`]; none of other bodies. `frames`, as in
    /// [`Placement`](crate::Placement), and `history`: of this body at `u`.
    pub fn section_forces(
        &self,
        u: &[f64],
        frames: &[Rotation],
        history: &[f64],
    ) -> Option<Vec<SectionForces>> {
        match self {
            Body::Beam(beam) => Some(beam.section_forces(u, history)),
            Body::LargeBeam(beam) => Some(beam.section_forces(frames, u, history)),
            Body::Reduced(reduced) => reduced.section_forces(u),
            _ => None,
        }
    }

    /// The largest stresses in the sections of each element of beams, as [`Body::section_forces`]; none of other bodies. They are no
    /// numbers where neither the shape nor the extreme fibres of the section are known.
    pub fn section_stresses(
        &self,
        u: &[f64],
        frames: &[Rotation],
        history: &[f64],
    ) -> Option<Vec<SectionStress>> {
        match self {
            Body::Beam(beam) => Some(beam.section_stresses(u, history)),
            Body::LargeBeam(beam) => Some(beam.section_stresses(frames, u, history)),
            Body::Reduced(reduced) => reduced.section_stresses(u),
            _ => None,
        }
    }

    /// Mean equivalent plastic strain of each element in the `history` of this body, of bars and beams the largest of their fibres, in the
    /// order of [`Body::cells`]; none of a body without plasticity.
    pub fn plastic_strains(&self, history: &[f64]) -> Option<Vec<f64>> {
        match self {
            Body::Solid(solid) => solid.plastic_strains(history),
            Body::Beam(beam) => beam.plastic_strains(history),
            Body::LargeBeam(beam) => beam.plastic_strains(history),
            Body::Shell(shell) => shell.plastic_strains(history),
            _ => None,
        }
    }
}
