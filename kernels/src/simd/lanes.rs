//! SIMD vector trait in which every model is written: one lane (`f32`), or eight.
//!
//! A lane is one sample of one shading point, or one of eight shading points, as the caller has it: models never mix
//! lanes. [`Lanes`] holds the arithmetic and nothing else, so that a model compiles to the same straight line of
//! instructions on every backend. It is public for models to be written over it, and sealed: the backends are ours.
//!
//! Comparisons are false for NaN. `min` and `max` give their second operand when either is NaN, which is what the
//! machine does and what lets one `min` at the end of a model turn a NaN into its bound.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

pub(crate) mod sealed {
    /// Keeps the backends in this crate.
    pub trait Sealed {}
}

/// Entry of a struct of lanes: one number, or one per lane. Sealed.
pub trait Scalar: sealed::Sealed + Copy + Debug + Send + Sync + 'static {}
impl<T: sealed::Sealed + Copy + Debug + Send + Sync + 'static> Scalar for T {}

/// A struct of lanes, as [`lane_struct!`](crate::simd::lane_struct) declares it: eight of one lane are one of eight.
pub trait LaneStruct: Copy + Debug + Send + Sync + 'static {
    /// The struct of one lane.
    type One;
    /// The struct of eight.
    type Eight;
    /// Eight structs as one: lane `i` holds the numbers of `items[i]`.
    fn pack(items: [&Self::One; 8]) -> Self::Eight;
    /// The numbers of one lane, 0 to 7.
    fn lane(eight: &Self::Eight, lane: usize) -> Self::One;
}

/// One number per lane, with the arithmetic that models are written in.
pub trait Lanes:
    Scalar
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// One truth value per lane.
    type Mask: Copy;
    /// An index from 0 to 3 per lane, see [`search`](Self::search).
    type Index: Copy;
    /// Storage of the lanes between calls: `f32` for one, `wide::f32x8` for eight.
    type Stored: Broadcast<Self>;
    /// Whether [`mul_add`](Self::mul_add) rounds once.
    const FUSES: bool;

    /// The same number in every lane.
    fn splat(x: f32) -> Self;
    /// The lanes in their storage form.
    fn store(self) -> Self::Stored;
    /// `self * a + b`, rounded once where the backend fuses and twice where it does not.
    #[must_use]
    fn mul_add(self, a: Self, b: Self) -> Self;
    /// `self * a - b`, rounded as [`mul_add`](Self::mul_add).
    #[must_use]
    fn mul_sub(self, a: Self, b: Self) -> Self;
    /// `a * b - c * d`, to within two units in the last place however much it cancels.
    ///
    /// Backends that fuse recover the rounding error of a product; others split the factors. The difference of two plain
    /// products loses every digit that cancels.
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self;
    /// `a / b`. Of two `/` on one lane a compiler may make one division of four lanes, and the unused ones raise exceptions.
    #[inline(always)]
    #[must_use]
    fn quotient(a: Self, b: Self) -> Self {
        (a / b).alone()
    }
    /// The same number. On one lane of x86-64 a barrier for the compiler, without an instruction: the number is computed by itself,
    /// not as one lane of several.
    #[inline(always)]
    #[must_use]
    fn alone(self) -> Self {
        self
    }
    /// Square root, correctly rounded.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Magnitude.
    #[must_use]
    fn abs(self) -> Self;
    /// `if self < other { self } else { other }`: NaN on either side gives `other`.
    #[must_use]
    fn min(self, other: Self) -> Self;
    /// `if self > other { self } else { other }`: NaN on either side gives `other`.
    #[must_use]
    fn max(self, other: Self) -> Self;
    /// `self` with its sign turned where that of `sign` is set.
    #[must_use]
    fn times_sign(self, sign: Self) -> Self;
    /// `-x` where the mask is set, `x` elsewhere.
    fn negate(mask: Self::Mask, x: Self) -> Self;
    /// The bits of each lane, as an integer, shifted left by 23: builds a power of two from a biased exponent.
    #[must_use]
    fn bits_shl_23(self) -> Self;
    /// `(m, e)` with `self = m 2^e`, `m` in `[sqrt(1/2), sqrt(2))` and `e` an integer: for normal numbers above 0. Any
    /// other gives finite numbers or NaN.
    #[must_use]
    fn split_exponent(self) -> (Self, Self);
    /// `self < other`, false for NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// Both masks.
    fn and(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Either mask.
    fn or(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// `yes` where the mask is set, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// `(a, b)` where the mask is set, `(b, a)` elsewhere.
    fn swap(mask: Self::Mask, a: Self, b: Self) -> (Self, Self);
    /// `x` where the mask is set, 0 elsewhere.
    fn keep(mask: Self::Mask, x: Self) -> Self;

    /// Returns both. With AVX2 a barrier for the compiler, without an instruction: neither is used before both are computed.
    /// Elsewhere no operation.
    ///
    /// Compilers tend to emit two dependency chains one after the other, which takes fewer registers. A CPU that looks a
    /// hundred instructions ahead then waits for each in turn.
    #[inline(always)]
    fn interleave(a: Self, b: Self) -> (Self, Self) {
        (a, b)
    }
    /// [`interleave`](Self::interleave) of the two halves of a pair; others are returned unchanged.
    #[inline(always)]
    #[must_use]
    fn interleaved(self) -> Self {
        self
    }

    /// How many of the first `count` ascending `bounds` are at most `x`.
    fn search(x: Self, bounds: [Self; 3], count: usize) -> Self::Index;
    /// Where the index is `entry`, 0 to 3.
    fn is_index(index: Self::Index, entry: usize) -> Self::Mask;
    /// The index as a number: 0, 1, 2 or 3.
    fn index_number(index: Self::Index) -> Self;
}

/// Storage of lanes: one number for all of them, or one per lane.
///
/// A model reads its constants through this trait, so that one source serves eight directions at one shading point
/// (constants in `f32`) and eight shading points (constants in `f32x8`).
pub trait Broadcast<L: Lanes>: Scalar {
    /// The number of each lane.
    fn lanes(&self) -> L;
    /// The same of numbers that the caller may just have written, by narrower stores: a CPU does not forward two stores to one
    /// load, but waits some fifteen cycles for both to reach the cache.
    #[inline(always)]
    fn fresh_lanes(&self) -> L {
        self.lanes()
    }
    /// The entry of each lane's index.
    fn look_up(table: &[Self; 4], index: L::Index) -> L;
    /// The entry of each lane's index, of a table whose last two entries are equal: for less.
    fn look_up_three(table: &[Self; 4], index: L::Index) -> L;
    /// The entry of half of each lane's index: the first for 0 and 1, the second for 2 and 3.
    fn look_up_half(table: &[Self; 2], index: L::Index) -> L;
}

/// `W` lanes that are read from as many numbers in a row, of any alignment, and written to them.
pub(crate) trait Packet<const W: usize>: Lanes {
    /// Reads the numbers.
    fn read(from: &[f32; W]) -> Self;
    /// Reads numbers that may just have been written: see [`Broadcast::fresh_lanes`].
    #[inline(always)]
    fn read_fresh(from: &[f32; W]) -> Self {
        Self::read(from)
    }
    /// Writes the numbers.
    fn write(self, to: &mut [f32; W]);
}

/// The three numbers of `x`, read as lanes.
#[inline(always)]
pub fn lanes3<L: Lanes, C: Broadcast<L>>(x: &[C; 3]) -> [L; 3] {
    [x[0].lanes(), x[1].lanes(), x[2].lanes()]
}

/// The three numbers of `x`, which may just have been written, read as lanes.
#[inline(always)]
pub(crate) fn fresh_lanes3<L: Lanes, C: Broadcast<L>>(x: &[C; 3]) -> [L; 3] {
    [x[0].fresh_lanes(), x[1].fresh_lanes(), x[2].fresh_lanes()]
}

/// The four numbers of `x`, read as lanes.
#[inline(always)]
pub fn lanes4<L: Lanes, C: Broadcast<L>>(x: &[C; 4]) -> [L; 4] {
    [x[0].lanes(), x[1].lanes(), x[2].lanes(), x[3].lanes()]
}

/// The three lanes of `x` in their storage form.
#[inline(always)]
pub fn store3<L: Lanes>(x: [L; 3]) -> [L::Stored; 3] {
    [x[0].store(), x[1].store(), x[2].store()]
}

/// The four lanes of `x` in their storage form.
#[inline(always)]
pub fn store4<L: Lanes>(x: [L; 4]) -> [L::Stored; 4] {
    [x[0].store(), x[1].store(), x[2].store(), x[3].store()]
}

/// Offset that [`Lanes::split_exponent`] adds to the bits of a float, so that their biased exponent is that of the power of two
/// at or below `sqrt(2)` times it: the bits of 1 less those of `sqrt(1/2)`.
pub(crate) const ROUND_EXPONENT: u32 = 0x3f80_0000 - 0x3f35_04f3;
/// The bits of 1: an exponent of 0, biased.
pub(crate) const ONE: u32 = 0x3f80_0000;
/// The bits of `2^23`: with an integer below it in the low bits they are the sum of both.
pub(crate) const INTEGER: u32 = 0x4b00_0000;
/// `2^23`, and the bias of an exponent.
pub(crate) const INTEGER_BIAS: f32 = 8_388_608.0 + 127.0;

/// [`Lanes::difference_of_products`] with a fused `mul_add`, after Kahan.
#[inline(always)]
pub(crate) fn difference_fused<L: Lanes>(a: L, b: L, c: L, d: L) -> L {
    let product = c * d;
    let left_out = c.mul_sub(d, product);
    a.mul_sub(b, product) - left_out
}

/// [`Lanes::difference_of_products`] from the factors and their halves of 12 bits, after Dekker.
#[inline(always)]
pub(crate) fn difference_split<L: Lanes>([a, b, c, d]: [L; 4], halves: [[L; 2]; 4]) -> L {
    let (left, right) = (a * b, c * d);
    (left - right)
        + (rounding_error(left, halves[0], halves[1]) - rounding_error(right, halves[2], halves[3]))
}

/// Rounding error of a product of two factors: exact, as the products of halves are.
#[inline(always)]
fn rounding_error<L: Lanes>(product: L, a: [L; 2], b: [L; 2]) -> L {
    let left_out = ((a[0] * b[0] - product) + a[0] * b[1]) + a[1] * b[0];
    left_out + a[1] * b[1]
}

/// Bits of the sign, the exponent and the upper 11 of the fraction.
pub(crate) const UPPER: u32 = 0xffff_f000;

/// The entry of `table` for an index given by where it is at least 1, 2 and 3.
#[inline(always)]
pub(crate) fn select_of_four<L: Lanes>(table: [L; 4], [one, two, three]: [L::Mask; 3]) -> L {
    L::select(
        two,
        L::select(three, table[3], table[2]),
        L::select(one, table[1], table[0]),
    )
}

/// The same of a table whose last two entries are equal.
#[inline(always)]
pub(crate) fn select_of_three<L: Lanes>(table: [L; 3], [one, two, _]: [L::Mask; 3]) -> L {
    L::select(two, table[2], L::select(one, table[1], table[0]))
}

/// Declares a struct of lanes, `Name<C>`, and its `pack` (eight scalars into lanes), `lane` (one lane out) and `spread`
/// (the same numbers in the storage of lanes).
///
/// Every field is a `C`, an array `[C; N]`, or another such struct in parentheses, `(Other<C>)`.
///
/// ```
/// hairis::simd::lane_struct! {
///     /// Constants of one shading point.
///     pub struct Constants {
///         /// Exponent of the highlight.
///         pub exponent: C,
///         /// Colour, linear RGB.
///         pub color: [C; 3],
///     }
/// }
/// let one = Constants { exponent: 8.0_f32, color: [0.1, 0.2, 0.3] };
/// let two = Constants { exponent: 2.0_f32, color: [0.4, 0.5, 0.6] };
/// let eight = Constants::pack([&one, &two, &one, &one, &one, &one, &one, &one]);
/// assert_eq!(eight.lane(1), two);
/// ```
#[macro_export]
macro_rules! lane_struct {
    (
        $(#[$meta:meta])*
        $vis:vis struct $name:ident { $($(#[$field_meta:meta])* $field_vis:vis $field:ident: $kind:tt,)* }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[allow(unused_parens, reason = "parentheses tell a nested struct from a number")]
        $vis struct $name<C> { $($(#[$field_meta])* $field_vis $field: $kind,)* }

        impl<C: Copy> $name<C> {
            /// The same numbers in the storage of `L`: one number for all lanes becomes one per lane.
            #[inline(always)]
            #[must_use]
            pub fn spread<L: $crate::simd::Lanes>(&self) -> $name<L::Stored>
            where
                C: $crate::simd::Broadcast<L>,
            {
                $name { $($field: $crate::simd::lane_struct!(@spread self, L, $field, $kind),)* }
            }
        }

        impl<C: $crate::simd::Scalar> $crate::simd::LaneStruct for $name<C> {
            type One = $name<f32>;
            type Eight = $name<$crate::simd::f32x8>;
            #[inline]
            fn pack(items: [&$name<f32>; 8]) -> $name<$crate::simd::f32x8> {
                $name::<f32>::pack(items)
            }
            #[inline]
            fn lane(eight: &$name<$crate::simd::f32x8>, lane: usize) -> $name<f32> {
                eight.lane(lane)
            }
        }

        impl $name<f32> {
            /// Eight structs as one: lane `i` holds the numbers of `items[i]`.
            #[inline]
            #[must_use]
            pub fn pack(items: [&Self; 8]) -> $name<$crate::simd::f32x8> {
                $name { $($field: $crate::simd::lane_struct!(@pack items, $field, $kind),)* }
            }
        }

        impl $name<$crate::simd::f32x8> {
            /// The numbers of one lane.
            ///
            /// # Panics
            ///
            /// If `lane` is above 7.
            #[inline]
            #[must_use]
            pub fn lane(&self, lane: usize) -> $name<f32> {
                $name { $($field: $crate::simd::lane_struct!(@lane self, lane, $field, $kind),)* }
            }
        }
    };
    (@pack $items:ident, $field:ident, C) => { $crate::simd::f32x8::new($items.map(|item| item.$field)) };
    (@pack $items:ident, $field:ident, [C; $n:literal]) => {
        core::array::from_fn::<_, $n, _>(|i| $crate::simd::f32x8::new($items.map(|item| item.$field[i])))
    };
    (@pack $items:ident, $field:ident, ($inner:ident<C>)) => { $inner::pack($items.map(|item| &item.$field)) };
    (@spread $this:ident, $L:ident, $field:ident, C) => {
        $crate::simd::Lanes::store($crate::simd::Broadcast::<$L>::lanes(&$this.$field))
    };
    // Without a loop where arrays are short: compilers that save space leave it one.
    (@spread $this:ident, $L:ident, $field:ident, [C; 2]) => { $crate::simd::lane_struct!(@each $this, $L, $field, 0 1) };
    (@spread $this:ident, $L:ident, $field:ident, [C; 3]) => { $crate::simd::lane_struct!(@each $this, $L, $field, 0 1 2) };
    (@spread $this:ident, $L:ident, $field:ident, [C; 4]) => { $crate::simd::lane_struct!(@each $this, $L, $field, 0 1 2 3) };
    (@each $this:ident, $L:ident, $field:ident, $($i:literal)*) => {
        [$($crate::simd::Lanes::store($crate::simd::Broadcast::<$L>::lanes(&$this.$field[$i]))),*]
    };
    (@spread $this:ident, $L:ident, $field:ident, [C; $n:literal]) => {{
        // A loop, not `map`: closures over lanes are not inlined into functions of target features.
        let mut out = [$crate::simd::Lanes::store($crate::simd::Broadcast::<$L>::lanes(&$this.$field[0])); $n];
        let mut i = 1;
        while i < $n {
            out[i] = $crate::simd::Lanes::store($crate::simd::Broadcast::<$L>::lanes(&$this.$field[i]));
            i += 1;
        }
        out
    }};
    (@spread $this:ident, $L:ident, $field:ident, ($inner:ident<C>)) => { $this.$field.spread::<$L>() };
    (@lane $this:ident, $lane:ident, $field:ident, ($inner:ident<C>)) => { $this.$field.lane($lane) };
    (@lane $this:ident, $lane:ident, $field:ident, C) => { $this.$field.as_array()[$lane] };
    (@lane $this:ident, $lane:ident, $field:ident, [C; $n:literal]) => {
        core::array::from_fn::<_, $n, _>(|i| $this.$field[i].as_array()[$lane])
    };
}
