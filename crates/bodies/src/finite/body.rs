//! What the elements of a body at finite strain are, and what they give.

use carom_materials::{Law, Material};

use super::Formulation;
use super::cell::Shape;
use super::element::Fault;
use super::placement::Stored;

/// What the elements of a body at finite strain are, beside their geometry.
#[derive(Clone, Debug)]
pub(crate) struct Finite {
    pub(super) law: Law,
    /// Numbers that are kept of a point: those of the law, with bulk viscosity ln J, with deletion whether the element is deleted.
    pub(super) kept: usize,
    pub(super) kept_by_law: usize,
    /// Plastic strain at which elements are deleted.
    pub(super) limit: Option<f64>,
    pub(super) shape: Shape,
}

/// Result of the elements of a chunk.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outcome {
    pub(super) stored: Stored,
    /// Place in the chunk, and what went wrong.
    pub(super) fault: Option<Failed>,
}

/// A place, and what went wrong there.
pub(super) type Failed = (usize, Fault);

impl Finite {
    /// How its elements integrate the internal work.
    pub(crate) fn formulation(&self) -> Formulation {
        self.shape.formulation
    }

    pub(crate) fn new(law: Law, shape: Shape, is_viscous: bool, limit: Option<f64>) -> Finite {
        let kept_by_law = law.finite().map_or(0, Material::history_len);
        Finite {
            law,
            kept: kept_by_law + usize::from(is_viscous) + usize::from(limit.is_some()),
            kept_by_law,
            limit,
            shape,
        }
    }
}
