//! Stresses and plastic strains of the elements of a body.

use carom_algebra::tensor::Mat3;

use crate::Body;

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
