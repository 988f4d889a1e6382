//! Lanes that compute nothing, but pass each operation to a recorder, which makes a graph of the model.
//!
//! A model over [`Lanes`] has no control flow that depends on its data, so that one run on these lanes turns it into a straight line
//! of the operations of [`Op`]. The results have the bits of one lane with [`Target::Exact`], and the bits of a level that
//! fuses with [`Target::Fused`].

use super::choice::Choice;
use super::lanes::{
    Broadcast, INTEGER, INTEGER_BIAS, Lanes, ONE, ROUND_EXPONENT, Scalar, UPPER, difference_fused,
    difference_split, sealed::Sealed,
};
use super::schedule::Schedule;
use super::storage::Entries;
use core::fmt;
use core::marker::PhantomData;
use core::ops::{Add, Mul, Neg, Sub};
use core::panic::Location;

/// Operation on numbers (32-bit floats) and masks (truth values), which reads up to three results `a`, `b`, `c`. Comparisons are
/// false for NaN.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Op {
    /// Number whose bits are given.
    Constant(u32),
    /// `a + b`.
    Add,
    /// `a - b`.
    Sub,
    /// `a * b`.
    Mul,
    /// `a / b`.
    Div,
    /// `a` with its sign flipped.
    Neg,
    /// `a * b + c`, rounded once. Only lanes that fuse record it.
    MulAdd,
    /// `2^a` of the target. Only [`Target::GpuNative`] records it.
    Exp2,
    /// Logarithm to the base 2 of the target. Only [`Target::GpuNative`] records it.
    Log2,
    /// Square root.
    Sqrt,
    /// `a` without its sign.
    Abs,
    /// `if a < b { a } else { b }`.
    Min,
    /// `if a > b { a } else { b }`.
    Max,
    /// `a` with its sign flipped where the sign of `b` is set.
    TimesSign,
    /// `b` with its sign flipped where the mask `a` is set.
    NegateIf,
    /// The bits of `a`, shifted left by 23.
    ShiftLeft23,
    /// The number `m` of [`Lanes::split_exponent`].
    Mantissa,
    /// The number `e` of [`Lanes::split_exponent`].
    Exponent,
    /// `a` with the lower 12 bits cleared.
    Upper,
    /// The mask `a < b`.
    Less,
    /// The mask `a >= b`.
    AtLeast,
    /// Mask of the lanes that are set in both masks.
    And,
    /// Mask of the lanes that are set in either mask.
    Or,
    /// Mask of the lanes that are not set in the mask `a`.
    Not,
    /// `b` where the mask `a` is set, `c` elsewhere.
    Select,
}

impl Op {
    /// Returns the number of results that the operation reads.
    #[inline]
    #[must_use]
    pub const fn arity(self) -> usize {
        match self {
            Self::Constant(_) => 0,
            Self::Neg
            | Self::Exp2
            | Self::Log2
            | Self::Sqrt
            | Self::Abs
            | Self::ShiftLeft23
            | Self::Mantissa
            | Self::Exponent
            | Self::Upper
            | Self::Not => 1,
            Self::MulAdd | Self::Select => 3,
            _ => 2,
        }
    }

    /// Returns true if the result of the operation is a mask.
    #[inline]
    #[must_use]
    pub const fn is_mask(self) -> bool {
        matches!(
            self,
            Self::Less | Self::AtLeast | Self::And | Self::Or | Self::Not
        )
    }

    /// Returns the biased exponent of [`Lanes::split_exponent`] from the bits of a number.
    #[inline]
    #[must_use]
    pub const fn biased_exponent(bits: u32) -> u32 {
        bits.wrapping_add(ROUND_EXPONENT) >> 23
    }

    /// Computes the operation on the bits of a number, or returns `None` for operations that do not take the bits of one number
    /// apart.
    #[inline]
    #[must_use]
    pub fn of_bits(self, bits: u32) -> Option<f32> {
        Some(match self {
            Self::ShiftLeft23 => f32::from_bits(bits << 23),
            Self::Mantissa => f32::from_bits(
                bits.wrapping_add(ONE)
                    .wrapping_sub(Self::biased_exponent(bits) << 23),
            ),
            Self::Exponent => f32::from_bits(Self::biased_exponent(bits) | INTEGER) - INTEGER_BIAS,
            Self::Upper => f32::from_bits(bits & UPPER),
            _ => return None,
        })
    }
}

/// Arithmetic of the target that a graph is for: how products with sums round, and whose exponentials are used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// Products and sums round separately, with the bits of one lane.
    Exact,
    /// Products with sums round once ([`Op::MulAdd`]), with the bits of a level that fuses.
    Fused,
    /// Products with sums may round once or twice, as WGSL allows for its `fma`.
    Gpu,
    /// Like [`Gpu`](Self::Gpu), but with the `exp2` and `log2` of the target.
    ///
    /// - Accuracy: [`math::gaussian`](crate::model::math::gaussian) and [`math::log2`](crate::model::math::log2) have the error of
    ///   the target's `exp2` and `log2`: in WGSL 3 + 2 |x| units in the last place, and 3 units or 2^-21 for the logarithm.
    GpuNative,
}

impl Target {
    /// Returns true if [`Lanes::mul_add`] is one operation.
    #[inline]
    #[must_use]
    pub const fn fuses(self) -> bool {
        !matches!(self, Self::Exact)
    }

    /// Returns true if that operation rounds once on every target, which Kahan's difference of products relies on.
    #[inline]
    #[must_use]
    pub const fn rounds_once(self) -> bool {
        matches!(self, Self::Fused)
    }

    /// Returns true if powers and logarithms to the base 2 are computed by the target.
    #[inline]
    #[must_use]
    pub const fn is_native(self) -> bool {
        matches!(self, Self::GpuNative)
    }
}

/// Receiver of operations, which names their results. It receives an operation before any operation that reads its result.
pub trait Recorder: 'static {
    /// Returns the target that the operations are recorded for. It changes only between recordings.
    fn target() -> Target;
    /// Records the operation `op` on the results named by `args`, of which it reads [`Op::arity`]. `at` is the line of the model
    /// that called the operation.
    fn record(op: Op, args: [u32; 3], at: &'static Location<'static>) -> u32;
    /// Receives the model's description of what the operations that follow compute.
    fn stage(sentence: &'static str);
}

/// Number on lanes that record, as the name that the recorder gave its result.
pub struct Traced<R> {
    name: u32,
    kind: PhantomData<fn() -> R>,
}

/// Mask on lanes that record, as the name that the recorder gave its result.
pub struct TracedMask<R> {
    name: u32,
    kind: PhantomData<fn() -> R>,
}

macro_rules! names {
    ($($Name:ident $letter:literal;)*) => { $(
        impl<R> Clone for $Name<R> {
            #[inline]
            fn clone(&self) -> Self {
                *self
            }
        }
        impl<R> Copy for $Name<R> {}
        impl<R> fmt::Debug for $Name<R> {
            #[inline]
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{}{}", $letter, self.name)
            }
        }
        impl<R> $Name<R> {
            /// Makes the number or mask that has this name.
            #[inline]
            #[must_use]
            pub const fn named(name: u32) -> Self {
                Self { name, kind: PhantomData }
            }
            /// Returns the name that the recorder gave the result.
            #[inline]
            #[must_use]
            pub const fn name(self) -> u32 {
                self.name
            }
        }
    )* };
}
names! { Traced 'x'; TracedMask 'm'; }

impl<R: Recorder> Traced<R> {
    #[track_caller]
    fn op(op: Op, args: [u32; 3]) -> Self {
        Self::named(R::record(op, args, Location::caller()))
    }
    #[track_caller]
    fn halves(self) -> [Self; 2] {
        let upper = Self::op(Op::Upper, [self.name, 0, 0]);
        [upper, self - upper]
    }
}

impl<R: Recorder> TracedMask<R> {
    #[track_caller]
    fn op(op: Op, a: u32, b: u32) -> Self {
        Self::named(R::record(op, [a, b, 0], Location::caller()))
    }
}

impl<R: Recorder> Sealed for Traced<R> {}
impl<R: Recorder> Scalar for Traced<R> {
    type Table = Entries<Self>;
}
impl<R: Recorder> Schedule for Traced<R> {}

macro_rules! binary {
    ($($Op:ident $op:ident;)*) => { $(
        impl<R: Recorder> $Op for Traced<R> {
            type Output = Self;
            #[inline]
            #[track_caller]
            fn $op(self, other: Self) -> Self {
                Self::op(Op::$Op, [self.name, other.name, 0])
            }
        }
    )* };
}
binary! { Add add; Sub sub; Mul mul; }

/// Arithmetic with one number for all lanes, like that of other lanes except for the line that is recorded.
macro_rules! by_number {
    ($($Op:ident $op:ident;)*) => { $(
        impl<R: Recorder> $Op<f32> for Traced<R> {
            type Output = Self;
            #[inline]
            #[track_caller]
            fn $op(self, number: f32) -> Self {
                $Op::$op(self, Self::splat(number))
            }
        }
    )* };
}
by_number! { Add add; Sub sub; Mul mul; }

impl<R: Recorder> Neg for Traced<R> {
    type Output = Self;
    #[inline]
    #[track_caller]
    fn neg(self) -> Self {
        Self::op(Op::Neg, [self.name, 0, 0])
    }
}

impl<R: Recorder> Lanes for Traced<R> {
    type Mask = TracedMask<R>;
    /// Masks of the lanes whose number is at least each of the three bounds.
    type Index = [TracedMask<R>; 3];
    type Stored = Self;
    const FUSES: Option<bool> = None;

    #[inline]
    fn fuses() -> bool {
        R::target().fuses()
    }
    #[inline]
    #[track_caller]
    fn splat(x: f32) -> Self {
        Self::op(Op::Constant(x.to_bits()), [0; 3])
    }
    #[inline]
    fn store(self) -> Self {
        self
    }
    #[inline]
    fn load(stored: &Self) -> Self {
        *stored
    }
    #[inline]
    #[track_caller]
    fn mul_add(self, a: Self, b: Self) -> Self {
        if Self::fuses() {
            Self::op(Op::MulAdd, [self.name, a.name, b.name])
        } else {
            self * a + b
        }
    }
    #[inline]
    #[track_caller]
    fn mul_sub(self, a: Self, b: Self) -> Self {
        if Self::fuses() {
            self.mul_add(a, -b)
        } else {
            self * a - b
        }
    }
    #[inline]
    #[track_caller]
    fn quotient(a: Self, b: Self) -> Self {
        Self::op(Op::Div, [a.name, b.name, 0])
    }
    #[inline]
    #[track_caller]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        if R::target().rounds_once() {
            difference_fused(a, b, c, d)
        } else {
            difference_split([a, b, c, d], [a, b, c, d].map(Self::halves))
        }
    }
    #[inline]
    #[track_caller]
    fn native_exp2(self) -> Option<Self> {
        let is_native = R::target().is_native();
        is_native.then(|| Self::op(Op::Exp2, [self.name, 0, 0]))
    }
    #[inline]
    #[track_caller]
    fn native_log2(self) -> Option<Self> {
        let is_native = R::target().is_native();
        is_native.then(|| Self::op(Op::Log2, [self.name, 0, 0]))
    }
    #[inline]
    fn stage(sentence: &'static str) {
        R::stage(sentence);
    }
    #[inline]
    #[track_caller]
    fn sqrt(self) -> Self {
        Self::op(Op::Sqrt, [self.name, 0, 0])
    }
    #[inline]
    #[track_caller]
    fn abs(self) -> Self {
        Self::op(Op::Abs, [self.name, 0, 0])
    }
    #[inline]
    #[track_caller]
    fn split_exponent(self) -> (Self, Self) {
        (
            Self::op(Op::Mantissa, [self.name, 0, 0]),
            Self::op(Op::Exponent, [self.name, 0, 0]),
        )
    }
    #[inline]
    #[track_caller]
    fn min(self, other: Self) -> Self {
        Self::op(Op::Min, [self.name, other.name, 0])
    }
    #[inline]
    #[track_caller]
    fn max(self, other: Self) -> Self {
        Self::op(Op::Max, [self.name, other.name, 0])
    }
    #[inline]
    #[track_caller]
    fn times_sign(self, sign: Self) -> Self {
        Self::op(Op::TimesSign, [self.name, sign.name, 0])
    }
    #[inline]
    #[track_caller]
    fn bits_shl_23(self) -> Self {
        Self::op(Op::ShiftLeft23, [self.name, 0, 0])
    }
    #[inline]
    #[track_caller]
    fn negate(mask: TracedMask<R>, x: Self) -> Self {
        Self::op(Op::NegateIf, [mask.name, x.name, 0])
    }
    #[inline]
    #[track_caller]
    fn select(mask: TracedMask<R>, yes: Self, no: Self) -> Self {
        Self::op(Op::Select, [mask.name, yes.name, no.name])
    }
    #[inline]
    #[track_caller]
    fn lt(self, other: Self) -> TracedMask<R> {
        TracedMask::op(Op::Less, self.name, other.name)
    }
    #[inline]
    #[track_caller]
    fn and(a: TracedMask<R>, b: TracedMask<R>) -> TracedMask<R> {
        TracedMask::op(Op::And, a.name, b.name)
    }
    #[inline]
    #[track_caller]
    fn or(a: TracedMask<R>, b: TracedMask<R>) -> TracedMask<R> {
        TracedMask::op(Op::Or, a.name, b.name)
    }
    #[inline]
    #[track_caller]
    fn swap(mask: TracedMask<R>, a: Self, b: Self) -> (Self, Self) {
        (Self::select(mask, a, b), Self::select(mask, b, a))
    }
    #[inline]
    #[track_caller]
    fn keep(mask: TracedMask<R>, x: Self) -> Self {
        Self::select(mask, x, Self::splat(0.0))
    }
}

impl<R: Recorder> Choice<Traced<R>> for [TracedMask<R>; 3] {
    #[inline]
    #[track_caller]
    fn search(x: Traced<R>, bounds: [Traced<R>; 3], count: usize) -> Self {
        // Never set: no number is at least NaN.
        let none = Traced::<R>::splat(f32::NAN);
        let at = |i: usize| if i < count { bounds[i] } else { none };
        [at(0), at(1), at(2)].map(|bound| TracedMask::op(Op::AtLeast, x.name, bound.name))
    }
    #[inline]
    fn masks(self) -> Self {
        self
    }
    #[inline]
    #[track_caller]
    fn equals(self, entry: usize) -> TracedMask<R> {
        let [one, two, three] = self.map(|mask| mask.name);
        let but = |mask: u32, next: u32| {
            let not = TracedMask::<R>::op(Op::Not, next, 0);
            TracedMask::op(Op::And, mask, not.name)
        };
        match entry {
            0 => TracedMask::op(Op::Not, one, 0),
            1 => but(one, two),
            2 => but(two, three),
            _ => self[2],
        }
    }
    #[inline]
    #[track_caller]
    fn to_number(self) -> Traced<R> {
        self.choose([0.0, 1.0, 2.0, 3.0].map(Traced::splat))
    }
}

impl<R: Recorder> Broadcast<Self> for Traced<R> {
    #[inline]
    fn lanes(&self) -> Self {
        *self
    }
}
