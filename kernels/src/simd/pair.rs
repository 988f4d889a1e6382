//! Two interleaved packets: while one waits for a result, the other computes.
//!
//! A sample is a dependency chain of some two hundred cycles; a CPU looks no more than a few hundred instructions ahead
//! for other work. With two chains interleaved it waits a quarter less.
//!
//! Models interleave equal steps of one packet in the same way, two or four of them.

use super::lanes::{Broadcast, Lanes, Packet, sealed::Sealed};
use core::ops::{Add, Div, Mul, Neg, Sub};

/// Two packets, or two equal steps of one, as lanes: each instruction for one is followed by that for the other.
///
/// Constants are read once for both, and neither chain of results waits alone. Pairs nest.
///
/// ```
/// use hairis::simd::{Lanes, Pair};
/// use hairis::model::math;
/// let Pair(sine, other) = math::sin_half_turn(Pair(0.5_f32, 1.0));
/// assert!((sine - 0.5_f32.sin()).abs() < 1e-6 && (other - 1.0_f32.sin()).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Pair<L>(pub L, pub L);

impl<L: Lanes> Sealed for Pair<L> {}

macro_rules! binary {
    ($($Trait:ident $method:ident;)*) => { $(
        impl<L: Lanes> $Trait for Pair<L> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0), self.1.$method(other.1))
            }
        }
    )* };
}
binary! { Add add; Sub sub; Mul mul; Div div; }

impl<L: Lanes> Neg for Pair<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl<L: Lanes> Lanes for Pair<L> {
    type Mask = (L::Mask, L::Mask);
    type Index = (L::Index, L::Index);
    // Only columns run in pairs: nothing is kept in them between calls.
    type Stored = Self;
    const FUSES: bool = L::FUSES;

    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(L::splat(x), L::splat(x))
    }
    #[inline(always)]
    fn store(self) -> Self {
        self
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Self(self.0.mul_add(a.0, b.0), self.1.mul_add(a.1, b.1))
    }
    #[inline(always)]
    fn mul_sub(self, a: Self, b: Self) -> Self {
        Self(self.0.mul_sub(a.0, b.0), self.1.mul_sub(a.1, b.1))
    }
    #[inline(always)]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        Self(
            L::difference_of_products(a.0, b.0, c.0, d.0),
            L::difference_of_products(a.1, b.1, c.1, d.1),
        )
    }
    #[inline(always)]
    fn alone(self) -> Self {
        Self(self.0.alone(), self.1.alone())
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs(), self.1.abs())
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0), self.1.min(other.1))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0), self.1.max(other.1))
    }
    #[inline(always)]
    fn times_sign(self, sign: Self) -> Self {
        Self(self.0.times_sign(sign.0), self.1.times_sign(sign.1))
    }
    #[inline(always)]
    fn negate(mask: Self::Mask, x: Self) -> Self {
        Self(L::negate(mask.0, x.0), L::negate(mask.1, x.1))
    }
    #[inline(always)]
    fn bits_shl_23(self) -> Self {
        Self(self.0.bits_shl_23(), self.1.bits_shl_23())
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        let ((m, e), (n, f)) = (self.0.split_exponent(), self.1.split_exponent());
        (Self(m, n), Self(e, f))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Self::Mask {
        (self.0.lt(other.0), self.1.lt(other.1))
    }
    #[inline(always)]
    fn and(a: Self::Mask, b: Self::Mask) -> Self::Mask {
        (L::and(a.0, b.0), L::and(a.1, b.1))
    }
    #[inline(always)]
    fn or(a: Self::Mask, b: Self::Mask) -> Self::Mask {
        (L::or(a.0, b.0), L::or(a.1, b.1))
    }
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        Self(
            L::select(mask.0, yes.0, no.0),
            L::select(mask.1, yes.1, no.1),
        )
    }
    #[inline(always)]
    fn swap(mask: Self::Mask, a: Self, b: Self) -> (Self, Self) {
        let (first, second) = (L::swap(mask.0, a.0, b.0), L::swap(mask.1, a.1, b.1));
        (Self(first.0, second.0), Self(first.1, second.1))
    }
    #[inline(always)]
    fn keep(mask: Self::Mask, x: Self) -> Self {
        Self(L::keep(mask.0, x.0), L::keep(mask.1, x.1))
    }
    #[inline(always)]
    fn interleave(a: Self, b: Self) -> (Self, Self) {
        let (a0, b0) = L::interleave(a.0, b.0);
        let (a1, b1) = L::interleave(a.1, b.1);
        (Self(a0, a1), Self(b0, b1))
    }
    #[inline(always)]
    fn interleaved(self) -> Self {
        let (a, b) = L::interleave(self.0, self.1);
        Self(a, b)
    }
    #[inline(always)]
    fn search(x: Self, [a, b, c]: [Self; 3], count: usize) -> Self::Index {
        (
            L::search(x.0, [a.0, b.0, c.0], count),
            L::search(x.1, [a.1, b.1, c.1], count),
        )
    }
    #[inline(always)]
    fn is_index(index: Self::Index, entry: usize) -> Self::Mask {
        (L::is_index(index.0, entry), L::is_index(index.1, entry))
    }
    #[inline(always)]
    fn index_number(index: Self::Index) -> Self {
        Self(L::index_number(index.0), L::index_number(index.1))
    }
}

impl<L: Lanes> Broadcast<Pair<L>> for f32
where
    f32: Broadcast<L>,
{
    #[inline(always)]
    fn lanes(&self) -> Pair<L> {
        let lanes = Broadcast::<L>::lanes(self);
        Pair(lanes, lanes)
    }
    #[inline(always)]
    fn look_up(table: &[f32; 4], index: (L::Index, L::Index)) -> Pair<L> {
        Pair(
            <f32 as Broadcast<L>>::look_up(table, index.0),
            <f32 as Broadcast<L>>::look_up(table, index.1),
        )
    }
    #[inline(always)]
    fn look_up_three(table: &[f32; 4], index: (L::Index, L::Index)) -> Pair<L> {
        Pair(
            <f32 as Broadcast<L>>::look_up_three(table, index.0),
            <f32 as Broadcast<L>>::look_up_three(table, index.1),
        )
    }
    #[inline(always)]
    fn look_up_half(table: &[f32; 2], index: (L::Index, L::Index)) -> Pair<L> {
        Pair(
            <f32 as Broadcast<L>>::look_up_half(table, index.0),
            <f32 as Broadcast<L>>::look_up_half(table, index.1),
        )
    }
}

impl<L: Lanes> Broadcast<Self> for Pair<L>
where
    L::Stored: Broadcast<L>,
{
    #[inline(always)]
    fn lanes(&self) -> Self {
        *self
    }
    #[inline(always)]
    fn look_up(table: &[Self; 4], index: (L::Index, L::Index)) -> Self {
        let [a, b, c, d] = table;
        let first = [a.0.store(), b.0.store(), c.0.store(), d.0.store()];
        let second = [a.1.store(), b.1.store(), c.1.store(), d.1.store()];
        Self(
            L::Stored::look_up(&first, index.0),
            L::Stored::look_up(&second, index.1),
        )
    }
    #[inline(always)]
    fn look_up_three(table: &[Self; 4], index: (L::Index, L::Index)) -> Self {
        Self::look_up(table, index)
    }
    #[inline(always)]
    fn look_up_half(table: &[Self; 2], index: (L::Index, L::Index)) -> Self {
        let [a, b] = table;
        let (first, second) = ([a.0.store(), b.0.store()], [a.1.store(), b.1.store()]);
        Self(
            L::Stored::look_up_half(&first, index.0),
            L::Stored::look_up_half(&second, index.1),
        )
    }
}

/// Reads and writes pairs as twice as many numbers in a row.
macro_rules! packet {
    ($($half:literal $whole:literal;)*) => { $(
        impl<L: Packet<$half>> Packet<$whole> for Pair<L> {
            #[inline(always)]
            fn read(from: &[f32; $whole]) -> Self {
                let (halves, _) = from.as_chunks::<$half>();
                Self(L::read(&halves[0]), L::read(&halves[1]))
            }
            #[inline(always)]
            fn write(self, to: &mut [f32; $whole]) {
                let (halves, _) = to.as_chunks_mut::<$half>();
                self.0.write(&mut halves[0]);
                self.1.write(&mut halves[1]);
            }
        }
    )* };
}
packet! { 8 16; 16 32; }
