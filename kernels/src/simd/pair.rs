//! Two interleaved packets: while one waits for a result, the other computes.
//!
//! A sample is a dependency chain of some two hundred cycles, while a CPU looks no more than a few hundred instructions ahead for
//! other work. With two chains interleaved it waits a quarter less.
//!
//! Models interleave equal steps of one packet in the same way, two or four of them.

use super::choice::Choice;
use super::lanes::{Broadcast, Lanes, Packet, Scalar, by_splat, sealed::Sealed};
use super::schedule::Schedule;
use super::storage::{Entries, Shared};
use core::ops::{Add, Mul, Neg, Sub};

/// Two packets, or two equal steps of one packet, as lanes: each instruction for one is followed by the same instruction for the
/// other.
///
/// Constants are read once for both, and neither chain of results waits alone. Pairs can be nested.
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
impl<L: Lanes> Scalar for Pair<L> {
    type Table = Entries<Self>;
}

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
binary! { Add add; Sub sub; Mul mul; }
by_splat! { Pair<L>, [L: Lanes] }

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
    // Only columns run in pairs, which are not kept between calls.
    type Stored = Self;
    const FUSES: Option<bool> = L::FUSES;

    #[inline(always)]
    fn fuses() -> bool {
        L::fuses()
    }
    #[inline(always)]
    fn splat(x: f32) -> Self {
        let x = L::splat(x);
        Self(x, x)
    }
    #[inline(always)]
    fn store(self) -> Self {
        self
    }
    #[inline(always)]
    fn load(stored: &Self) -> Self {
        *stored
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
    fn quotient(a: Self, b: Self) -> Self {
        Self(L::quotient(a.0, b.0), L::quotient(a.1, b.1))
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
    fn native_exp2(self) -> Option<Self> {
        Some(Self(self.0.native_exp2()?, self.1.native_exp2()?))
    }
    #[inline(always)]
    fn native_log2(self) -> Option<Self> {
        Some(Self(self.0.native_log2()?, self.1.native_log2()?))
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
}

impl<L: Lanes> Schedule for Pair<L> {
    #[inline(always)]
    fn alone(self) -> Self {
        Self(self.0.alone(), self.1.alone())
    }
    #[inline(always)]
    fn spread(self) -> Self {
        Self(self.0.spread(), self.1.spread())
    }
    #[inline(always)]
    fn together([a, b, c]: [Self; 3]) -> [Self; 3] {
        let [d, e, f] = L::together([a.0, b.0, c.0]);
        let [g, h, i] = L::together([a.1, b.1, c.1]);
        [Self(d, g), Self(e, h), Self(f, i)]
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
}

impl<L: Lanes> Choice<Pair<L>> for (L::Index, L::Index) {
    #[inline(always)]
    fn search(x: Pair<L>, [a, b, c]: [Pair<L>; 3], count: usize) -> Self {
        (
            L::Index::search(x.0, [a.0, b.0, c.0], count),
            L::Index::search(x.1, [a.1, b.1, c.1], count),
        )
    }
    #[inline(always)]
    fn masks(self) -> [(L::Mask, L::Mask); 3] {
        let ([a, b, c], [d, e, f]) = (self.0.masks(), self.1.masks());
        [(a, d), (b, e), (c, f)]
    }
    #[inline(always)]
    fn equals(self, entry: usize) -> (L::Mask, L::Mask) {
        (self.0.equals(entry), self.1.equals(entry))
    }
    #[inline(always)]
    fn to_number(self) -> Pair<L> {
        Pair(self.0.to_number(), self.1.to_number())
    }
    #[inline(always)]
    fn look_up(self, table: &[f32; 4]) -> Pair<L> {
        Pair(self.0.look_up(table), self.1.look_up(table))
    }
    #[inline(always)]
    fn look_up_four(self, upper: (L::Mask, L::Mask), table: &Shared, four: usize) -> [Pair<L>; 4] {
        let [a, b, c, d] = self.0.look_up_four(upper.0, table, four);
        let [e, f, g, h] = self.1.look_up_four(upper.1, table, four);
        [Pair(a, e), Pair(b, f), Pair(c, g), Pair(d, h)]
    }
    #[inline(always)]
    fn look_up_three(self, table: &[f32; 4]) -> Pair<L> {
        Pair(self.0.look_up_three(table), self.1.look_up_three(table))
    }
    #[inline(always)]
    fn look_up_half(self, table: &[f32; 2]) -> Pair<L> {
        Pair(self.0.look_up_half(table), self.1.look_up_half(table))
    }
}

impl<L: Lanes> Broadcast<Self> for Pair<L> {
    #[inline(always)]
    fn lanes(&self) -> Self {
        *self
    }
}

/// Reads and writes pairs as twice as many consecutive numbers.
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
