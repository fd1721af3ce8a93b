//! Numbers that kernels and laws compute with: one, or the same number of each of several elements, its lanes.
//!
//! A law that is written once for any [`Number`] serves the iterations of an implicit step, point by point, and the sweeps
//! of an explicit one, several elements at a time. There are two kinds of lanes. [`Packed`] are a register of the instruction set,
//! whatever surrounds them: for long functions. [`Lanes`] are arrays that the compiler turns into registers: for the short kernels
//! at small strain, where two registers for each number fill each other's waiting time.
//!
//! [`Lanes`]: crate::lanes::Lanes
//! [`Packed`]: crate::packed::Packed

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// One number, or one of each of several elements. Operations are those of `f64`, lane by lane.
pub trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// The same value in all lanes, of the kind of self.
    fn like(self, value: f64) -> Self;

    /// One number for each element.
    fn lanes(&self) -> &[f64];

    /// One number for each element.
    fn lanes_mut(&mut self) -> &mut [f64];

    /// self · b + c, rounded once where the instruction set can.
    fn mul_add(self, b: Self, c: Self) -> Self;

    /// Square root.
    fn sqrt(self) -> Self;

    /// ln(1 + x), to its last digits for small x; of use for x > -1 only.
    fn ln_1p(self) -> Self;

    /// exp(x) - 1, to its last digits for small x. For |x| < 700.
    fn exp_m1(self) -> Self;

    /// `then` where self is below `bound`, elsewhere `otherwise`.
    fn if_below(self, bound: Self, then: Self, otherwise: Self) -> Self;

    /// The largest lane.
    fn largest(self) -> f64;

    /// Its size.
    #[inline(always)]
    fn abs(self) -> Self {
        self.if_below(self.like(0.0), -self, self)
    }

    /// self · b + c with the same factor b in all lanes.
    #[inline(always)]
    fn scale_add(self, b: f64, c: Self) -> Self {
        self.mul_add(self.like(b), c)
    }

    /// self · factor.
    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        self * self.like(factor)
    }

    /// The smaller one; self where one of the two is no number.
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        other.if_below(self, other, self)
    }

    /// The larger one; self where one of the two is no number.
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        self.if_below(other, other, self)
    }
}

impl Number for f64 {
    #[inline(always)]
    fn like(self, value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn lanes(&self) -> &[f64] {
        std::slice::from_ref(self)
    }

    #[inline(always)]
    fn lanes_mut(&mut self) -> &mut [f64] {
        std::slice::from_mut(self)
    }

    /// In two roundings: where the instruction set of the build has no fused operation, `f64::mul_add` is a library call.
    #[inline(always)]
    fn mul_add(self, b: f64, c: f64) -> f64 {
        self * b + c
    }

    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn ln_1p(self) -> f64 {
        f64::ln_1p(self)
    }

    #[inline(always)]
    fn exp_m1(self) -> f64 {
        f64::exp_m1(self)
    }

    #[inline(always)]
    fn if_below(self, bound: f64, then: f64, otherwise: f64) -> f64 {
        if self < bound { then } else { otherwise }
    }

    #[inline(always)]
    fn largest(self) -> f64 {
        self
    }

    #[inline(always)]
    fn abs(self) -> f64 {
        f64::abs(self)
    }
}
