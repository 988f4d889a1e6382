//! SIMD vector trait in which every model is written, over one lane (`f32`) or eight.
//!
//! A lane is one sample of one shading point, or one of eight shading points, as the caller decides; models never mix lanes.
//! [`Lanes`] has arithmetic and masks, and [`Choice`] selects one of four numbers. [`Schedule`] has hints for a compiler, so that a
//! model compiles to the same straight line of instructions on every backend. All three are sealed, and public so that models can be
//! written over them.
//!
//! Comparisons are false for NaN. `min` and `max` return their second operand when either is NaN,
//! as the machine does, so that one `min` at the end of a model turns a NaN into its bound.

use super::choice::{Choice, Select};
use super::schedule::Schedule;
use super::storage::{NUMBERS, Storage};
use core::fmt::Debug;
use core::ops::{Add, Mul, Neg, Sub};
use wide::{f32x8, i32x8};

pub(crate) mod sealed {
    /// Supertrait that keeps the backends in this crate.
    pub trait Sealed {}
}

/// Entry of a struct of lanes: one number, or one number per lane. Sealed.
pub trait Scalar: sealed::Sealed + Copy + Debug + Send + Sync + 'static {
    /// Storage form of a [`Table`](super::table::Table) of this type.
    #[doc(hidden)]
    type Table: Storage<Self>;
}

/// One number per lane, with the arithmetic that models are written in. A number that is the same for all lanes is a float:
/// `x * 0.5 + 1.0`.
pub trait Lanes:
    Scalar
    + Schedule
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + Add<f32, Output = Self>
    + Sub<f32, Output = Self>
    + Mul<f32, Output = Self>
{
    /// One truth value per lane.
    type Mask: Copy;
    /// An index from 0 to 3 per lane.
    type Index: Choice<Self>;
    /// Storage of the lanes between calls: `f32` for one, `wide::f32x8` for eight.
    type Stored: Broadcast<Self>;
    /// Value of [`fuses`](Self::fuses) where it is known when compiled: `None` for lanes that record.
    const FUSES: Option<bool>;

    /// Returns true if [`mul_add`](Self::mul_add) rounds once.
    #[inline(always)]
    #[must_use]
    fn fuses() -> bool {
        const { Self::FUSES.expect("lanes that record ask their recorder") }
    }
    /// Repeats a number in every lane.
    fn splat(x: f32) -> Self;
    /// Returns the lanes in their storage form.
    fn store(self) -> Self::Stored;
    /// Loads lanes from their storage form: [`Broadcast::lanes`] calls it.
    fn load(stored: &Self::Stored) -> Self;
    /// Loads lanes like [`load`](Self::load), for numbers that may just have been written: see [`Broadcast::fresh_lanes`].
    #[inline(always)]
    fn load_fresh(stored: &Self::Stored) -> Self {
        Self::load(stored)
    }
    /// Computes `self * a + b`, rounded once where the backend fuses and twice where it does not.
    #[must_use]
    fn mul_add(self, a: Self, b: Self) -> Self;
    /// Computes `self * a - b`, rounded like [`mul_add`](Self::mul_add).
    #[must_use]
    fn mul_sub(self, a: Self, b: Self) -> Self;
    /// Computes `a * b - c * d`, to within two units in the last place however much cancels.
    ///
    /// Backends that fuse recover the rounding error of a product; others split the factors. The difference of two plain products
    /// would lose every digit that cancels.
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self;
    /// Computes `a / b`. There is no operator `/`: on one lane a compiler may make one division of four lanes from two, whose unused
    /// lanes raise exceptions. A quotient is [`alone`](Schedule::alone).
    #[must_use]
    fn quotient(a: Self, b: Self) -> Self;
    /// Computes the square root, correctly rounded.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Divides four numbers of `a` by those of `b`.
    ///
    /// Provided: four times [`quotient`](Self::quotient). One lane of x86-64 has an instruction for all of them.
    #[inline(always)]
    #[must_use]
    fn four_quotients(a: [Self; 4], b: [Self; 4]) -> [Self; 4] {
        [
            Self::quotient(a[0], b[0]),
            Self::quotient(a[1], b[1]),
            Self::quotient(a[2], b[2]),
            Self::quotient(a[3], b[3]),
        ]
    }
    /// Computes the square roots of four numbers.
    ///
    /// Provided: four times [`sqrt`](Self::sqrt). One lane of x86-64 has an instruction for all of them.
    #[inline(always)]
    #[must_use]
    fn four_roots(x: [Self; 4]) -> [Self; 4] {
        [x[0].sqrt(), x[1].sqrt(), x[2].sqrt(), x[3].sqrt()]
    }
    /// Returns the magnitude of each lane.
    #[must_use]
    fn abs(self) -> Self;
    /// Returns `if self < other { self } else { other }`: NaN on either side gives `other`.
    #[must_use]
    fn min(self, other: Self) -> Self;
    /// Returns `if self > other { self } else { other }`: NaN on either side gives `other`.
    #[must_use]
    fn max(self, other: Self) -> Self;
    /// Returns `self` with its sign flipped where the sign of `sign` is set.
    #[must_use]
    fn times_sign(self, sign: Self) -> Self;
    /// Returns `-x` where the mask is set and `x` elsewhere.
    fn negate(mask: Self::Mask, x: Self) -> Self;
    /// Shifts the bits of each lane, as an integer, left by 23, which builds a power of two from a biased exponent.
    #[must_use]
    fn bits_shl_23(self) -> Self;
    /// Splits a normal number above 0 into `(m, e)` with `self = m 2^e`, `m` in `[sqrt(1/2), sqrt(2))` and `e` an integer. Any other
    /// number gives finite numbers or NaN.
    #[must_use]
    fn split_exponent(self) -> (Self, Self);
    /// Computes `2^self` where the target has an instruction for it, which only GPUs have.
    #[doc(hidden)]
    #[inline(always)]
    #[must_use]
    fn native_exp2(self) -> Option<Self> {
        None
    }
    /// Computes the logarithm to the base 2 where the target has an instruction for it.
    #[doc(hidden)]
    #[inline(always)]
    #[must_use]
    fn native_log2(self) -> Option<Self> {
        None
    }
    /// Describes, to lanes that record, what the operations that follow compute: a comment in generated source.
    #[inline(always)]
    fn stage(_sentence: &'static str) {}
    /// Returns the mask of `self < other`, false for NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// Returns the mask of lanes that are set in both masks.
    fn and(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Returns the mask of lanes that are set in either mask.
    fn or(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Returns `yes` where the mask is set and `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Selects like [`select`](Self::select), by a mask that is nearly always the same. One lane branches, so that the code that
    /// follows does not wait for the mask, and the number that is not selected is not computed.
    #[inline(always)]
    #[must_use]
    fn select_predictable(mask: Self::Mask, yes: Self, no: Self) -> Self {
        Self::select(mask, yes, no)
    }
    /// Returns `(a, b)` where the mask is set and `(b, a)` elsewhere.
    fn swap(mask: Self::Mask, a: Self, b: Self) -> (Self, Self);
    /// Returns `x` where the mask is set and 0 elsewhere.
    fn keep(mask: Self::Mask, x: Self) -> Self;
    /// Transposes the four numbers of a row per lane into four vectors, for eight lanes.
    #[doc(hidden)]
    #[inline(always)]
    #[must_use]
    fn transpose(_rows: [&[f32; 4]; 8]) -> [Self; 4] {
        unreachable!("there is a row for each of eight lanes")
    }
}

impl<L: Lanes> Select for L {
    type Mask = L::Mask;
    type Index = L::Index;
    #[inline(always)]
    fn splat(x: f32) -> L {
        <L as Lanes>::splat(x)
    }
    #[inline(always)]
    fn select(mask: L::Mask, yes: L, no: L) -> L {
        <L as Lanes>::select(mask, yes, no)
    }
}

/// Storage of lanes: one number for all lanes, or one number per lane.
///
/// A model reads its constants through this trait, so that one source serves eight directions at one shading point
/// (constants in `f32`) and eight shading points (constants in `f32x8`).
pub trait Broadcast<L: Lanes>: Scalar {
    /// Loads the number of each lane.
    fn lanes(&self) -> L;
    /// Loads lanes like [`lanes`](Self::lanes), for numbers that the caller may just have stored lane by lane. Loading them in two
    /// halves avoids a store-forwarding stall of about 15 cycles.
    #[inline(always)]
    fn fresh_lanes(&self) -> L {
        self.lanes()
    }
    /// Returns true if the number of any lane is below 0, for a branch that all lanes take together. Lanes that record take the branch.
    #[doc(hidden)]
    #[inline(always)]
    #[must_use]
    fn any_below_0(&self) -> bool {
        true
    }
    /// Returns, for each lane, the entry at the lane's index.
    #[inline(always)]
    fn look_up(table: &[Self; 4], index: L::Index) -> L {
        index.choose(lanes4(table))
    }
    /// Returns four numbers of the entry at each lane's index, which counts 4 more where `upper` is set: see
    /// [`Choice::look_up_four`].
    #[doc(hidden)]
    #[inline(always)]
    fn look_up_four(table: &Self::Table, index: L::Index, upper: L::Mask, four: usize) -> [L; 4] {
        let [a, b, c, d, e, f, g, h] = &table.entries();
        let mut found = [L::splat(0.0); 4];
        let mut i = 0;
        while i < 4 && 4 * four + i < NUMBERS {
            let n = 4 * four + i;
            let low = index.choose(lanes4(&[a[n], b[n], c[n], d[n]]));
            let high = index.choose(lanes4(&[e[n], f[n], g[n], h[n]]));
            found[i] = L::select(upper, high, low);
            i += 1;
        }
        found
    }
    /// Returns the entry at each lane's index, of a table whose last two entries are equal, in less time than
    /// [`look_up`](Self::look_up).
    #[inline(always)]
    fn look_up_three(table: &[Self; 4], index: L::Index) -> L {
        index.choose_three([table[0].lanes(), table[1].lanes(), table[2].lanes()])
    }
    /// Returns the entry at half of each lane's index: the first entry for 0 and 1, the second for 2 and 3.
    #[inline(always)]
    fn look_up_half(table: &[Self; 2], index: L::Index) -> L {
        index.choose_half([table[0].lanes(), table[1].lanes()])
    }
}

impl<L: Lanes> Broadcast<L> for f32 {
    #[inline(always)]
    fn lanes(&self) -> L {
        L::splat(*self)
    }
    #[inline(always)]
    fn any_below_0(&self) -> bool {
        *self < 0.0
    }
    #[inline(always)]
    fn look_up(table: &[Self; 4], index: L::Index) -> L {
        index.look_up(table)
    }
    #[inline(always)]
    fn look_up_four(table: &Self::Table, index: L::Index, upper: L::Mask, four: usize) -> [L; 4] {
        index.look_up_four(upper, table, four)
    }
    #[inline(always)]
    fn look_up_three(table: &[Self; 4], index: L::Index) -> L {
        index.look_up_three(table)
    }
    #[inline(always)]
    fn look_up_half(table: &[Self; 2], index: L::Index) -> L {
        index.look_up_half(table)
    }
}

impl<L: Lanes<Stored = f32x8>> Broadcast<L> for f32x8 {
    #[inline(always)]
    fn lanes(&self) -> L {
        L::load(self)
    }
    #[inline(always)]
    fn fresh_lanes(&self) -> L {
        L::load_fresh(self)
    }
    #[inline(always)]
    fn any_below_0(&self) -> bool {
        self.simd_lt(Self::ZERO).any()
    }
    #[inline(always)]
    fn look_up_four(table: &Self::Table, index: L::Index, upper: L::Mask, four: usize) -> [L; 4] {
        // Through numbers, because with masks and integers, in as many instructions, a packet of eight materials took a twentieth
        // longer: LLVM then computes the parts of the index last, and nothing is left to do meanwhile.
        let offset = L::select(upper, L::splat(4.0), L::splat(0.0));
        // The index is below 8. Masking it here, for all lanes at once, removes the bounds check of each lane.
        const SEVEN: i32x8 = i32x8::new([7; 8]);
        let number = (index.to_number() + offset).store().fast_trunc_int() & SEVEN;
        let [i, j, k, l, m, n, o, p] = number.to_array();
        let [a, b, c, d, e, f, g, h] = table;
        L::transpose([
            a.four(i, four),
            b.four(j, four),
            c.four(k, four),
            d.four(l, four),
            e.four(m, four),
            f.four(n, four),
            g.four(o, four),
            h.four(p, four),
        ])
    }
}

/// Lanes that are read from `W` consecutive numbers of any alignment, and written to them.
pub(crate) trait Packet<const W: usize>: Lanes {
    /// Reads the numbers as lanes.
    fn read(from: &[f32; W]) -> Self;
    /// Reads numbers that may just have been written: see [`Broadcast::fresh_lanes`].
    #[inline(always)]
    fn read_fresh(from: &[f32; W]) -> Self {
        Self::read(from)
    }
    /// Writes the lanes as numbers.
    fn write(self, to: &mut [f32; W]);
}

/// Loads the three numbers of `x` as lanes.
#[inline(always)]
pub fn lanes3<L: Lanes, C: Broadcast<L>>(x: &[C; 3]) -> [L; 3] {
    [x[0].lanes(), x[1].lanes(), x[2].lanes()]
}

/// Loads the three numbers of `x`, which may just have been written, as lanes.
#[inline(always)]
pub(crate) fn fresh_lanes3<L: Lanes, C: Broadcast<L>>(x: &[C; 3]) -> [L; 3] {
    [x[0].fresh_lanes(), x[1].fresh_lanes(), x[2].fresh_lanes()]
}

/// Loads the four numbers of `x` as lanes.
#[inline(always)]
pub fn lanes4<L: Lanes, C: Broadcast<L>>(x: &[C; 4]) -> [L; 4] {
    [x[0].lanes(), x[1].lanes(), x[2].lanes(), x[3].lanes()]
}

/// Returns the three lanes of `x` in their storage form.
#[inline(always)]
pub fn store3<L: Lanes>(x: [L; 3]) -> [L::Stored; 3] {
    [x[0].store(), x[1].store(), x[2].store()]
}

/// Returns the four lanes of `x` in their storage form.
#[inline(always)]
pub fn store4<L: Lanes>(x: [L; 4]) -> [L::Stored; 4] {
    [x[0].store(), x[1].store(), x[2].store(), x[3].store()]
}

/// Offset that [`Lanes::split_exponent`] adds to the bits of a float, so that the biased exponent becomes that of the power of two
/// at or below `sqrt(2)` times the float: the bits of 1 less those of `sqrt(1/2)`.
pub(crate) const ROUND_EXPONENT: u32 = 0x3f80_0000 - 0x3f35_04f3;
/// Bits of the float 1, whose biased exponent stands for 0.
pub(crate) const ONE: u32 = 0x3f80_0000;
/// Bits of `2^23`: with a smaller integer in the low bits they are the float sum of both.
pub(crate) const INTEGER: u32 = 0x4b00_0000;
/// Sum of `2^23` and the bias of an exponent.
pub(crate) const INTEGER_BIAS: f32 = 8_388_608.0 + 127.0;

/// Computes [`Lanes::difference_of_products`] with a fused `mul_add`, after Kahan.
#[inline(always)]
pub(crate) fn difference_fused<L: Lanes>(a: L, b: L, c: L, d: L) -> L {
    let product = c * d;
    let left_out = c.mul_sub(d, product);
    a.mul_sub(b, product) - left_out
}

/// Computes [`Lanes::difference_of_products`] from the factors and their halves of 12 bits, after Dekker.
#[inline(always)]
pub(crate) fn difference_split<L: Lanes>([a, b, c, d]: [L; 4], halves: [[L; 2]; 4]) -> L {
    let (left, right) = (a * b, c * d);
    (left - right)
        + (rounding_error(left, halves[0], halves[1]) - rounding_error(right, halves[2], halves[3]))
}

/// Computes the rounding error of a product of two factors, which is exact because the products of halves are.
#[inline(always)]
fn rounding_error<L: Lanes>(product: L, a: [L; 2], b: [L; 2]) -> L {
    let left_out = ((a[0] * b[0] - product) + a[0] * b[1]) + a[1] * b[0];
    left_out + a[1] * b[1]
}

/// Mask of the sign, the exponent and the upper 11 bits of the fraction.
pub(crate) const UPPER: u32 = 0xffff_f000;

/// Arithmetic of lanes with one number for all lanes.
macro_rules! by_splat {
    ($Lanes:ty, $generics:tt) => {
        by_splat! { $Lanes, $generics, Add add }
        by_splat! { $Lanes, $generics, Sub sub }
        by_splat! { $Lanes, $generics, Mul mul }
    };
    ($Lanes:ty, [$($generics:tt)*], $Op:ident $op:ident) => {
        impl<$($generics)*> $Op<f32> for $Lanes {
            type Output = Self;
            #[inline(always)]
            fn $op(self, number: f32) -> Self {
                $Op::$op(self, <Self as Lanes>::splat(number))
            }
        }
    };
}
pub(super) use by_splat;
