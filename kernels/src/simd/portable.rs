//! Eight lanes through `wide`, in the instruction set that the program was compiled for, whatever the machine has.
//!
//! [`Portable`] is the backend of [`Level::portable`](crate::simd::Level::portable). `f32x8` itself never fuses, so that results
//! computed without a level have the same bits in every build.

#![allow(
    unsafe_code,
    reason = "intrinsics of target features that the program is compiled for"
)]

use super::choice::Choice;
use super::lanes::{
    INTEGER, INTEGER_BIAS, Lanes, ONE, Packet, ROUND_EXPONENT, Scalar, UPPER, by_splat,
    difference_fused, difference_split, sealed::Sealed,
};
use super::schedule::Schedule;
use super::storage::{Entries, Rows, Shared};
use core::ops::{Add, Mul, Neg, Sub};
use wide::{f32x4, f32x8, u32x8};

/// True if `mul_add` of `wide` rounds once in this build.
pub(crate) const FUSES: bool = cfg!(any(
    target_feature = "fma",
    all(target_arch = "aarch64", target_feature = "neon")
));

/// Scheduling barrier.
///
/// - Effect: an empty `asm!` block that LLVM must assume reads and writes the numbers, so that it computes all of them before it
///   uses one. Emits no instruction. Miri runs no assembly, and goes without.
/// - Measured: slices of hits that conserve energy took 1.20 times as long as those that do not. With the barrier after transposed
///   numbers alone, where LLVM otherwise makes each number by shuffles of its own, it was 1.24 times, and without any barrier 1.29
///   times (AMD Zen 3, SSE2, at the commit that introduced it).
/// - Measure again: return `four` in its place, and compare `cargo bench -p hairis-benches --bench hits`.
#[inline(always)]
fn together(four: [f32x4; 4]) -> [f32x4; 4] {
    #[cfg(all(
        target_arch = "x86_64",
        target_feature = "sse2",
        not(target_feature = "avx"),
        not(miri)
    ))]
    // SAFETY: all these types are floats in a row; there is no code, and the program is compiled for CPUs that have the registers.
    unsafe {
        use core::arch::x86_64::__m128;
        use core::mem::transmute;
        let [mut a, mut b, mut c, mut d] = transmute::<[f32x4; 4], [__m128; 4]>(four);
        core::arch::asm!("/* {0} {1} {2} {3} */", inout(xmm_reg) a, inout(xmm_reg) b, inout(xmm_reg) c, inout(xmm_reg) d, options(pure, nomem, nostack, preserves_flags));
        transmute::<[__m128; 4], [f32x4; 4]>([a, b, c, d])
    }
    #[cfg(not(all(
        target_arch = "x86_64",
        target_feature = "sse2",
        not(target_feature = "avx"),
        not(miri)
    )))]
    four
}

/// Transposes the first four numbers of four rows: row `i` goes to lane `i`.
#[inline(always)]
fn transposed([a, b, c, d]: [&[f32; 4]; 4]) -> [f32x4; 4] {
    together(f32x4::transpose([
        f32x4::new(*a),
        f32x4::new(*b),
        f32x4::new(*c),
        f32x4::new(*d),
    ]))
}

/// Splits eight lanes into the first four and the last four.
#[cfg(all(
    target_arch = "x86_64",
    target_feature = "sse2",
    not(target_feature = "avx")
))]
#[inline(always)]
fn split_halves(lanes: f32x8) -> [f32x4; 2] {
    let [a, b, c, d, e, f, g, h] = lanes.to_array();
    [f32x4::new([a, b, c, d]), f32x4::new([e, f, g, h])]
}

/// Joins four lanes and four more.
#[inline(always)]
fn both(low: f32x4, high: f32x4) -> f32x8 {
    let ([a, b, c, d], [e, f, g, h]) = (low.to_array(), high.to_array());
    f32x8::new([a, b, c, d, e, f, g, h])
}

/// Eight lanes of this build: with `FUSE`, `mul_add` rounds once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Portable<const FUSE: bool>(pub(crate) f32x8);

/// Eight lanes whose `mul_add` rounds twice, like that of one lane.
pub(crate) type Unfused = Portable<false>;

/// Type that holds eight lanes of this build.
trait Eight: Copy {
    fn wrap(lanes: f32x8) -> Self;
    fn unwrap(self) -> f32x8;
}

impl Eight for f32x8 {
    #[inline(always)]
    fn wrap(lanes: f32x8) -> Self {
        lanes
    }
    #[inline(always)]
    fn unwrap(self) -> f32x8 {
        self
    }
}

impl<const FUSE: bool> Eight for Portable<FUSE> {
    #[inline(always)]
    fn wrap(lanes: f32x8) -> Self {
        Self(lanes)
    }
    #[inline(always)]
    fn unwrap(self) -> f32x8 {
        self.0
    }
}

/// Mask of the sign bit.
const SIGN: f32x8 = f32x8::new([-0.0; 8]);
const MAGNITUDE: f32x8 = f32x8::new([f32::from_bits(0x7fff_ffff); 8]);

/// Repeats a number in every lane. The operators of `f32x8` with a float need no such function, but those of [`Portable`] do.
///
/// `wide` fills an array in a loop over memory, which compilers that optimise for size keep: a packet took three to ten times as
/// long at opt-level s.
#[inline(always)]
fn splat(x: f32) -> f32x8 {
    #[cfg(all(
        any(target_arch = "x86", target_arch = "x86_64"),
        target_feature = "sse2"
    ))]
    {
        #[cfg(target_arch = "x86")]
        use core::arch::x86 as arch;
        #[cfg(target_arch = "x86_64")]
        use core::arch::x86_64 as arch;
        // SAFETY: the program is compiled for CPUs that have the instruction; all these types are floats in a row.
        #[cfg(target_feature = "avx")]
        return unsafe { core::mem::transmute::<arch::__m256, f32x8>(arch::_mm256_set1_ps(x)) };
        // SAFETY: as above.
        #[cfg(not(target_feature = "avx"))]
        return unsafe {
            let half = arch::_mm_set1_ps(x);
            core::mem::transmute::<[arch::__m128; 2], f32x8>([half, half])
        };
    }
    #[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
    {
        use core::arch::aarch64::{float32x4_t, vdupq_n_f32};
        // SAFETY: as above.
        unsafe {
            let half = vdupq_n_f32(x);
            core::mem::transmute::<[float32x4_t; 2], f32x8>([half, half])
        }
    }
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    {
        use core::arch::wasm32::{f32x4_splat, v128};
        let half = f32x4_splat(x);
        // SAFETY: all these types are floats in a row.
        unsafe { core::mem::transmute::<[v128; 2], f32x8>([half, half]) }
    }
    #[cfg(not(any(
        all(
            any(target_arch = "x86", target_arch = "x86_64"),
            target_feature = "sse2"
        ),
        all(target_arch = "aarch64", target_feature = "neon"),
        all(target_arch = "wasm32", target_feature = "simd128"),
    )))]
    f32x8::new([x, x, x, x, x, x, x, x])
}

/// Splits a number into the upper half of its digits and the rest.
#[inline(always)]
fn split<P: Eight>(x: P) -> [P; 2] {
    const MASK: u32x8 = u32x8::new([UPPER; 8]);
    let x = x.unwrap();
    let upper = f32x8::from_bits(x.to_bits() & MASK);
    [P::wrap(upper), P::wrap(x - upper)]
}

macro_rules! binary {
    ($($Op:ident $op:ident;)*) => { $(
        impl<const FUSE: bool> $Op for Portable<FUSE> {
            type Output = Self;
            #[inline(always)]
            fn $op(self, other: Self) -> Self {
                Self(self.0.$op(other.0))
            }
        }
    )* };
}
binary! { Add add; Sub sub; Mul mul; }
by_splat! { Portable<FUSE>, [const FUSE: bool] }

impl<const FUSE: bool> Neg for Portable<FUSE> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

/// Implements the lanes of a type that holds eight lanes of this build.
macro_rules! eight_lanes {
    ($Lanes:ty, [$($generics:tt)*], $fuses:expr, $Table:ty) => {
        impl<$($generics)*> Sealed for $Lanes {}
        impl<$($generics)*> Scalar for $Lanes {
            type Table = $Table;
        }
        impl<$($generics)*> Schedule for $Lanes {
            #[cfg(all(
                target_arch = "x86_64",
                target_feature = "sse2",
                not(target_feature = "avx")
            ))]
            #[inline(always)]
            fn together(three: [Self; 3]) -> [Self; 3] {
                let [[a, d], [b, e], [c, f]] = three.map(|lanes| split_halves(lanes.unwrap()));
                let [a, d, b, e] = together([a, d, b, e]);
                let [b, e, c, f] = together([b, e, c, f]);
                [both(a, d), both(b, e), both(c, f)].map(Self::wrap)
            }
        }

        impl<$($generics)*> Lanes for $Lanes {
            type Mask = f32x8;
            /// Masks: the chosen number is at least each of the three bounds.
            type Index = [f32x8; 3];
            type Stored = f32x8;
            const FUSES: Option<bool> = Some($fuses);

            #[inline(always)]
            fn splat(x: f32) -> Self {
                Self::wrap(splat(x))
            }
            #[inline(always)]
            fn store(self) -> f32x8 {
                self.unwrap()
            }
            #[inline(always)]
            fn load(stored: &f32x8) -> Self {
                Self::wrap(*stored)
            }
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                if $fuses {
                    Self::wrap(self.unwrap().mul_add(a.unwrap(), b.unwrap()))
                } else {
                    self * a + b
                }
            }
            // `wide` splats the sign that it negates with, at a cost (see `splat`).
            #[inline(always)]
            fn mul_sub(self, a: Self, b: Self) -> Self {
                if $fuses {
                    Self::wrap(self.unwrap().mul_add(a.unwrap(), b.unwrap() ^ SIGN))
                } else {
                    self * a - b
                }
            }
            #[inline(always)]
            fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
                if $fuses {
                    difference_fused(a, b, c, d)
                } else {
                    difference_split([a, b, c, d], [split(a), split(b), split(c), split(d)])
                }
            }
            #[inline(always)]
            fn quotient(a: Self, b: Self) -> Self {
                Self::wrap(a.unwrap() / b.unwrap())
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                Self::wrap(self.unwrap().sqrt())
            }
            #[inline(always)]
            fn abs(self) -> Self {
                Self::wrap(self.unwrap() & MAGNITUDE)
            }
            // `fast_min` is the machine's own: its result for NaN is specified on x86 alone.
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                let (a, b) = (self.unwrap(), other.unwrap());
                Self::wrap(if cfg!(any(target_arch = "x86", target_arch = "x86_64")) {
                    a.fast_min(b)
                } else {
                    a.simd_lt(b).select(a, b)
                })
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                let (a, b) = (self.unwrap(), other.unwrap());
                Self::wrap(if cfg!(any(target_arch = "x86", target_arch = "x86_64")) {
                    a.fast_max(b)
                } else {
                    b.simd_lt(a).select(a, b)
                })
            }
            #[inline(always)]
            fn times_sign(self, sign: Self) -> Self {
                Self::wrap(self.unwrap() ^ (sign.unwrap() & SIGN))
            }
            #[inline(always)]
            fn negate(mask: f32x8, x: Self) -> Self {
                Self::wrap(x.unwrap() ^ (mask & SIGN))
            }
            #[inline(always)]
            fn bits_shl_23(self) -> Self {
                Self::wrap(f32x8::from_bits(self.unwrap().to_bits() << 23_u32))
            }
            #[inline(always)]
            fn split_exponent(self) -> (Self, Self) {
                const ROUND: u32x8 = u32x8::new([ROUND_EXPONENT; 8]);
                const ONES: u32x8 = u32x8::new([ONE; 8]);
                const INTEGERS: u32x8 = u32x8::new([INTEGER; 8]);
                let bits = self.unwrap().to_bits();
                let exponent = (bits + ROUND) >> 23_u32;
                let mantissa = bits + ONES - (exponent << 23_u32);
                let number = f32x8::from_bits(exponent | INTEGERS) - splat(INTEGER_BIAS);
                (Self::wrap(f32x8::from_bits(mantissa)), Self::wrap(number))
            }
            #[inline(always)]
            fn lt(self, other: Self) -> f32x8 {
                self.unwrap().simd_lt(other.unwrap())
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
                Self::wrap(mask.select(yes.unwrap(), no.unwrap()))
            }
            #[inline(always)]
            fn swap(mask: f32x8, a: Self, b: Self) -> (Self, Self) {
                let (a, b) = (a.unwrap(), b.unwrap());
                let kept = (a ^ b) & mask;
                (Self::wrap(b ^ kept), Self::wrap(a ^ kept))
            }
            #[inline(always)]
            fn keep(mask: f32x8, x: Self) -> Self {
                Self::wrap(mask & x.unwrap())
            }
            #[inline(always)]
            fn transpose([a, b, c, d, e, f, g, h]: [&[f32; 4]; 8]) -> [Self; 4] {
                let (low, high) = (transposed([a, b, c, d]), transposed([e, f, g, h]));
                let ([a, b, c, d], [e, f, g, h]) = (low, high);
                [both(a, e), both(b, f), both(c, g), both(d, h)].map(Self::wrap)
            }
        }

        impl<$($generics)*> Choice<$Lanes> for [f32x8; 3] {
            #[inline(always)]
            fn search(x: $Lanes, bounds: [$Lanes; 3], count: usize) -> Self {
                let (x, none) = (x.unwrap(), f32x8::ZERO);
                [
                    if count > 0 { x.simd_ge(bounds[0].unwrap()) } else { none },
                    if count > 1 { x.simd_ge(bounds[1].unwrap()) } else { none },
                    if count > 2 { x.simd_ge(bounds[2].unwrap()) } else { none },
                ]
            }
            #[inline(always)]
            fn masks(self) -> Self {
                self
            }
            #[inline(always)]
            fn equals(self, entry: usize) -> f32x8 {
                let [one, two, three] = self;
                match entry {
                    0 => !one,
                    1 => one & !two,
                    2 => two & !three,
                    _ => three,
                }
            }
            // Loads of four numbers of an entry: a blend, of which seven give one number, is six instructions of SSE2.
            #[inline(always)]
            fn look_up_four(self, upper: f32x8, table: &Shared, four: usize) -> [$Lanes; 4] {
                const FOUR: u32x8 = u32x8::new([4; 8]);
                // The index is below 8. Masking it here, for all lanes at once, removes the bounds check of each lane.
                const SEVEN: u32x8 = u32x8::new([7; 8]);
                // A set mask is -1 as an integer.
                let [one, two, three] = [self[0].to_bits(), self[1].to_bits(), self[2].to_bits()];
                let number = ((upper.to_bits() & FOUR) - (one + two + three)) & SEVEN;
                let ([i, j, k, l, m, n, o, p], rows) = (number.to_array(), &table.rows);
                Lanes::transpose([
                    rows.four(i.cast_signed(), four),
                    rows.four(j.cast_signed(), four),
                    rows.four(k.cast_signed(), four),
                    rows.four(l.cast_signed(), four),
                    rows.four(m.cast_signed(), four),
                    rows.four(n.cast_signed(), four),
                    rows.four(o.cast_signed(), four),
                    rows.four(p.cast_signed(), four),
                ])
            }
            #[inline(always)]
            fn to_number(self) -> $Lanes {
                let (one, [a, b, c]) = (splat(1.0), self);
                <$Lanes>::wrap((a & one) + (b & one) + (c & one))
            }
        }
    };
}
eight_lanes! { f32x8, [], false, [Rows; 8] }
eight_lanes! { Portable<FUSE>, [const FUSE: bool], FUSE, Entries<Self> }

impl<const FUSE: bool> Packet<8> for Portable<FUSE> {
    #[inline(always)]
    fn read(from: &[f32; 8]) -> Self {
        Self(f32x8::new(*from))
    }
    #[inline(always)]
    fn write(self, to: &mut [f32; 8]) {
        *to = self.0.to_array();
    }
}
