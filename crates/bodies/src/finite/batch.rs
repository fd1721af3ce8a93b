//! What the functions of a batch of elements hand to each other.

use carom_algebra::number::Number;
use carom_materials::tensor::{
    cofactor, determinant_less_1, green_lagrange, plus, plus_unit, scaled, transposed_product,
};
use carom_materials::{Answer, Failure, Tensor};

use super::element::Fault;

/// Points of the largest of these kinds.
pub(super) const POINTS: usize = 8;
/// How the points of an element act together.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Together {
    /// Each alone.
    Full,
    /// Mean dilatation.
    Dilated,
    /// One in place of all, with hourglass control of the factor 2 κ μ, Pa.
    OnePoint(f64),
}

/// Energies per element: strain, hardening, dissipated, hourglass, viscous.
pub(super) type Energies<T> = [T; 5];

/// What the law sees and answers at the points of several elements.
pub(super) struct AtLaw<T> {
    /// H; with mean dilatation between two displacements the strain of F̄ at the end.
    pub(super) h: [Tensor<T>; POINTS],
    /// Between two displacements: H at the start; with mean dilatation the change of that strain.
    pub(super) from: [Tensor<T>; POINTS],
    pub(super) answers: [Answer<T>; POINTS],
    /// Of the bulk viscosity.
    pub(super) viscous: Viscous<T>,
    /// δ.
    pub(super) weights: [T; POINTS],
}

impl<T: Number> AtLaw<T> {
    #[inline(always)]
    pub(super) fn new(zero: T) -> Self {
        let answer = Answer {
            stress: [[zero; 3]; 3],
            stored: zero,
            hardening: zero,
            dissipated: zero,
            positive: zero,
        };
        AtLaw {
            h: [[[zero; 3]; 3]; POINTS],
            from: [[[zero; 3]; 3]; POINTS],
            answers: [answer; POINTS],
            viscous: Viscous::new(zero),
            weights: [zero.like(1.0); POINTS],
        }
    }
}

/// Elements of which some gave no stress.
pub(super) struct Bad<T>(Watch<T>);

impl<T: Number> Bad<T> {
    /// The first element without stress.
    pub(super) fn fault(&self, first: usize, count: usize) -> Option<(usize, Fault)> {
        let lane = self.0.failed.lanes()[..count]
            .iter()
            .position(|&x| x > 0.0)?;
        let failure = Failure::Inverted {
            determinant: self.0.value.lanes()[lane],
        };
        let point = self.0.first.lanes()[lane] as usize;
        Some((first + lane, Fault::Law { point, failure }))
    }
}

/// What must be positive at the points of several elements.
pub(super) struct Watch<T> {
    /// At how many points it was not.
    failed: T,
    /// The first of them, and the value there.
    first: T,
    value: T,
}

impl<T: Number> Watch<T> {
    /// Nothing was seen yet.
    #[inline(always)]
    pub(super) fn new(zero: T) -> Self {
        Watch {
            failed: zero,
            first: zero,
            value: zero,
        }
    }

    /// Looks at a point. What is no number is not positive.
    #[inline(always)]
    pub(super) fn see(&mut self, point: usize, positive: T) {
        let zero = positive.like(0.0);
        let failed = zero.if_below(positive, zero, positive.like(1.0));
        // where none has failed before
        let first = self.failed.if_below(positive.like(0.5), failed, zero);
        self.first = zero.if_below(first, positive.like(point as f64), self.first);
        self.value = zero.if_below(first, positive, self.value);
        self.failed += failed;
    }

    /// # Errors
    /// An element with a point that was not positive.
    #[inline(always)]
    pub(super) fn end(self) -> Result<(), Bad<T>> {
        if self.failed.largest() > 0.0 {
            return Err(Bad(self));
        }
        Ok(())
    }
}

/// How one point moves between two displacements; letters of `between.rs`.
#[derive(Clone, Copy)]
pub(super) struct Path<T> {
    pub(super) f_m: Tensor<T>,
    pub(super) c_m: Tensor<T>,
    /// N.
    pub(super) slope: Tensor<T>,
    /// J - 1 at both ends.
    pub(super) grown: [T; 2],
    /// ⟨J⟩.
    pub(super) jacobian: T,
    /// ⟨s²⟩.
    pub(super) square: T,
    /// R.
    pub(super) rate: T,
}

impl<T: Number> Path<T> {
    /// Zeros like this one.
    #[inline(always)]
    pub(super) fn new(zero: T) -> Self {
        let none = [[zero; 3]; 3];
        Path {
            f_m: none,
            c_m: none,
            slope: none,
            grown: [zero; 2],
            jacobian: zero,
            square: zero,
            rate: zero,
        }
    }

    /// From F_0 = I + H_0 to F_1 = I + H_1, without what the other points decide; and D.
    #[inline(always)]
    pub(super) fn between(h_0: &Tensor<T>, h_1: &Tensor<T>) -> (Self, Tensor<T>) {
        let one = h_0[0][0].like(1.0);
        let half = one.scale(0.5);
        let f_m = plus_unit(&scaled(&plus(h_1, one, h_0), half), one);
        let square = transposed_product(&f_m, &plus(h_1, -one, h_0));
        let mut d = square;
        for i in 0..3 {
            for j in 0..3 {
                d[i][j] = (square[i][j] + square[j][i]).scale(0.5);
            }
        }
        // C = I + 2E
        let c_m = plus_unit(&plus(&green_lagrange(h_0), one, &green_lagrange(h_1)), one);
        let grown = [determinant_less_1(h_0), determinant_less_1(h_1)];
        let jacobian = (grown[0] + grown[1]).scale(0.5) + one;
        let cofactors = plus(&cofactor(&c_m), one.scale(1.0 / 3.0), &cofactor(&d));
        let path = Path {
            f_m,
            c_m,
            slope: scaled(&cofactors, one / jacobian),
            grown,
            jacobian,
            ..Path::new(one.like(0.0))
        };
        (path, d)
    }
}

/// What bulk viscosity does at the points of several elements.
pub(super) struct Viscous<T> {
    /// Works, J/m³.
    pub(super) works: [T; POINTS],
    /// Fastest compression, 1/s.
    pub(super) compression: T,
}

impl<T: Number> Viscous<T> {
    /// Nothing yet.
    #[inline(always)]
    pub(super) fn new(zero: T) -> Self {
        Viscous {
            works: [zero; POINTS],
            compression: zero,
        }
    }
}
