//! One number of each of as many elements as a register has lanes.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use pulp::{Simd, bytemuck};

use crate::functions;
use crate::number::Number;

/// A register of the instruction set S.
#[derive(Clone, Copy, Debug)]
pub struct Packed<S: Simd> {
    simd: S,
    register: S::f64s,
}

impl<S: Simd> Packed<S> {
    /// The same value in all lanes.
    #[inline(always)]
    pub fn all(simd: S, value: f64) -> Self {
        Packed {
            simd,
            register: simd.splat_f64s(value),
        }
    }

    #[inline(always)]
    fn of(self, register: S::f64s) -> Self {
        Packed { register, ..self }
    }
}

impl<S: Simd> Number for Packed<S> {
    #[inline(always)]
    fn like(self, value: f64) -> Self {
        Packed::all(self.simd, value)
    }

    #[inline(always)]
    fn lanes(&self) -> &[f64] {
        bytemuck::cast_slice(std::slice::from_ref(&self.register))
    }

    #[inline(always)]
    fn lanes_mut(&mut self) -> &mut [f64] {
        bytemuck::cast_slice_mut(std::slice::from_mut(&mut self.register))
    }

    /// Without vectors in two roundings: a fused operation would be a library call.
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        if S::IS_SCALAR {
            return self * b + c;
        }
        self.of(self
            .simd
            .mul_add_f64s(self.register, b.register, c.register))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.of(self.simd.sqrt_f64s(self.register))
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
        let below = self.simd.less_than_f64s(self.register, bound.register);
        let chosen = self
            .simd
            .select_f64s(below, then.register, otherwise.register);
        self.of(chosen)
    }

    #[inline(always)]
    fn largest(self) -> f64 {
        self.simd.reduce_max_f64s(self.register)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.of(self.simd.abs_f64s(self.register))
    }
}

macro_rules! operator {
    ($name:ident, $function:ident, $operation:ident) => {
        impl<S: Simd> $name for Packed<S> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                self.of(self.simd.$operation(self.register, other.register))
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

impl<S: Simd> Neg for Packed<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.of(self.simd.neg_f64s(self.register))
    }
}

impl<S: Simd> AddAssign for Packed<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Simd> SubAssign for Packed<S> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
