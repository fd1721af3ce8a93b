//! Quadrature points of the mortar method and what each gives to a multiplier.

use crate::mortar::CORNERS;

/// A quadrature point of one face.
#[derive(Clone, Copy, Debug)]
pub struct Quadrature {
    pub stencil: u32,
    pub weight: f64,
    pub phi: [f64; CORNERS],
}

/// A stencil's part in a multiplier: w_q φ_A.
#[derive(Clone, Copy, Debug)]
pub struct Share {
    pub point: u32,
    pub stencil: u32,
    pub weight: f64,
}
