//! One number of each of W elements: what the force kernels compute with.
//!
//! The loops over the lanes are plain and short, and everything is inlined, so that they become vector code of the
//! instruction set for which the caller is compiled (`pulp::Simd::vectorize`). No lane sees another.
//!
//! Kernels fill arrays of lanes by loops too: with `array::from_fn` and `map` the hexahedron was measured 13 times
//! slower, its numbers passing one by one through memory. `benches/benches/bodies.rs` would show it.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use pulp::Simd;

/// The same number of W elements.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Lanes<const W: usize>(pub(crate) [f64; W]);

/// One Cartesian or reference vector of W elements.
pub(crate) type Vector<const W: usize, const D: usize> = [Lanes<W>; D];

impl<const W: usize> Lanes<W> {
    pub(crate) const ZERO: Self = Lanes([0.0; W]);

    /// self · b + c, rounded once where the instruction set can: without it `mul_add` is a library call.
    #[inline(always)]
    pub(crate) fn mul_add<S: Simd>(self, b: Self, c: Self) -> Self {
        let mut out = c;
        for k in 0..W {
            out.0[k] = if S::IS_SCALAR {
                self.0[k] * b.0[k] + c.0[k]
            } else {
                self.0[k].mul_add(b.0[k], c.0[k])
            };
        }
        out
    }

    /// self · b + c with the same factor b in all lanes.
    #[inline(always)]
    pub(crate) fn scale_add<S: Simd>(self, b: f64, c: Self) -> Self {
        self.mul_add::<S>(Lanes([b; W]), c)
    }

    /// Square root.
    #[inline(always)]
    pub(crate) fn sqrt(self) -> Self {
        let mut out = self;
        for k in 0..W {
            out.0[k] = self.0[k].sqrt();
        }
        out
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

impl<const W: usize> Mul<f64> for Lanes<W> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self * Lanes([factor; W])
    }
}

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
