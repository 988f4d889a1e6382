//! Eight portable lanes that never fuse: what is computed without a [`Level`](crate::simd::Level) has the same bits in every build.

use super::lanes::{Broadcast, Lanes, difference_split, sealed::Sealed};
use super::portable::split;
use core::ops::{Add, Div, Mul, Neg, Sub};
use wide::f32x8;

/// Eight lanes whose `mul_add` rounds twice, as that of one lane does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unfused(pub(crate) f32x8);

impl Sealed for Unfused {}

macro_rules! binary {
    ($($Trait:ident $method:ident;)*) => { $(
        impl $Trait for Unfused {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
    )* };
}
binary! { Add add; Sub sub; Mul mul; Div div; }

impl Neg for Unfused {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Lanes for Unfused {
    type Mask = f32x8;
    type Index = [f32x8; 3];
    type Stored = Self;
    const FUSES: bool = false;

    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(<f32x8 as Lanes>::splat(x))
    }
    #[inline(always)]
    fn store(self) -> Self {
        self
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    #[inline(always)]
    fn mul_sub(self, a: Self, b: Self) -> Self {
        self * a - b
    }
    #[inline(always)]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        let halves = |x: Self| split(x.0).map(Self);
        difference_split([a, b, c, d], [halves(a), halves(b), halves(c), halves(d)])
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(<f32x8 as Lanes>::sqrt(self.0))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(<f32x8 as Lanes>::abs(self.0))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(<f32x8 as Lanes>::min(self.0, other.0))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(<f32x8 as Lanes>::max(self.0, other.0))
    }
    #[inline(always)]
    fn times_sign(self, sign: Self) -> Self {
        Self(self.0.times_sign(sign.0))
    }
    #[inline(always)]
    fn negate(mask: f32x8, x: Self) -> Self {
        Self(<f32x8 as Lanes>::negate(mask, x.0))
    }
    #[inline(always)]
    fn bits_shl_23(self) -> Self {
        Self(self.0.bits_shl_23())
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        let (mantissa, exponent) = self.0.split_exponent();
        (Self(mantissa), Self(exponent))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> f32x8 {
        <f32x8 as Lanes>::lt(self.0, other.0)
    }
    #[inline(always)]
    fn and(a: f32x8, b: f32x8) -> f32x8 {
        a & b
    }
    #[inline(always)]
    fn or(a: f32x8, b: f32x8) -> f32x8 {
        a | b
    }
    #[inline(always)]
    fn select(mask: f32x8, yes: Self, no: Self) -> Self {
        Self(<f32x8 as Lanes>::select(mask, yes.0, no.0))
    }
    #[inline(always)]
    fn swap(mask: f32x8, a: Self, b: Self) -> (Self, Self) {
        let (a, b) = <f32x8 as Lanes>::swap(mask, a.0, b.0);
        (Self(a), Self(b))
    }
    #[inline(always)]
    fn keep(mask: f32x8, x: Self) -> Self {
        Self(<f32x8 as Lanes>::keep(mask, x.0))
    }
    #[inline(always)]
    fn search(x: Self, bounds: [Self; 3], count: usize) -> [f32x8; 3] {
        <f32x8 as Lanes>::search(x.0, bounds.map(|bound| bound.0), count)
    }
    #[inline(always)]
    fn is_index(index: [f32x8; 3], entry: usize) -> f32x8 {
        <f32x8 as Lanes>::is_index(index, entry)
    }
    #[inline(always)]
    fn index_number(index: [f32x8; 3]) -> Self {
        Self(<f32x8 as Lanes>::index_number(index))
    }
}

impl Broadcast<Self> for Unfused {
    #[inline(always)]
    fn lanes(&self) -> Self {
        *self
    }
    #[inline(always)]
    fn look_up(table: &[Self; 4], index: [f32x8; 3]) -> Self {
        Self(<f32x8 as Broadcast<f32x8>>::look_up(
            &table.map(|entry| entry.0),
            index,
        ))
    }
    #[inline(always)]
    fn look_up_three(table: &[Self; 4], index: [f32x8; 3]) -> Self {
        Self(<f32x8 as Broadcast<f32x8>>::look_up_three(
            &table.map(|entry| entry.0),
            index,
        ))
    }
    #[inline(always)]
    fn look_up_half(table: &[Self; 2], index: [f32x8; 3]) -> Self {
        Self(<f32x8 as Broadcast<f32x8>>::look_up_half(
            &table.map(|entry| entry.0),
            index,
        ))
    }
}
