//! One number of each of W elements: what the sweeps over elements compute with.
//!
//! The loops over the lanes are plain and short, and everything is inlined, so that they become vector code of the
//! instruction set for which the caller is compiled (`pulp::Simd::vectorize`). No lane sees another.
//!
//! Kernels fill arrays of lanes by loops too: with `array::from_fn` and `map` the hexahedron was measured 13 times
//! slower, its numbers passing one by one through memory. `benches/benches/bodies.rs` would show it.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::functions;
use crate::number::Number;

/// The same number of W elements. One lane alone is for instruction sets without vectors.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Lanes<const W: usize>(pub [f64; W]);

/// One Cartesian or reference vector of W elements.
pub type Vector<const W: usize, const D: usize> = [Lanes<W>; D];

impl<const W: usize> Lanes<W> {
    /// Zeros.
    pub const ZERO: Self = Lanes([0.0; W]);
    /// Ones.
    pub const ONE: Self = Lanes([1.0; W]);
}

impl<const W: usize> Number for Lanes<W> {
    #[inline(always)]
    fn like(self, value: f64) -> Self {
        Lanes([value; W])
    }

    #[inline(always)]
    fn lanes(&self) -> &[f64] {
        &self.0
    }

    #[inline(always)]
    fn lanes_mut(&mut self) -> &mut [f64] {
        &mut self.0
    }

    /// With one lane there is no fused operation, and `f64::mul_add` would be a library call.
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        let mut out = c;
        for k in 0..W {
            out.0[k] = if W == 1 {
                self.0[k] * b.0[k] + c.0[k]
            } else {
                self.0[k].mul_add(b.0[k], c.0[k])
            };
        }
        out
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let mut out = self;
        for k in 0..W {
            out.0[k] = self.0[k].sqrt();
        }
        out
    }

    #[inline(always)]
    fn ln_1p(self) -> Self {
        functions::ln_1p(self)
    }

    #[inline(always)]
    fn exp_m1(self) -> Self {
        functions::exp_m1(self)
    }

    #[inline(always)]
    fn if_below(self, bound: Self, then: Self, otherwise: Self) -> Self {
        let mut out = otherwise;
        for k in 0..W {
            out.0[k] = if self.0[k] < bound.0[k] {
                then.0[k]
            } else {
                otherwise.0[k]
            };
        }
        out
    }

    #[inline(always)]
    fn largest(self) -> f64 {
        let mut largest = self.0[0];
        for k in 1..W {
            largest = largest.max(self.0[k]);
        }
        largest
    }
}

macro_rules! operator {
    ($name:ident, $function:ident, $symbol:tt) => {
        impl<const W: usize> $name for Lanes<W> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                let mut out = self;
                for k in 0..W {
                    out.0[k] = self.0[k] $symbol other.0[k];
                }
                out
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl<const W: usize> Neg for Lanes<W> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let mut out = self;
        for k in 0..W {
            out.0[k] = -self.0[k];
        }
        out
    }
}

impl<const W: usize> AddAssign for Lanes<W> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const W: usize> SubAssign for Lanes<W> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
