//! Eight lanes through `wide`: the instruction set the program was compiled for, whatever the machine has.

#![allow(
    unsafe_code,
    reason = "intrinsics of target features that the program is compiled for"
)]

use super::lanes::{
    Broadcast, INTEGER, INTEGER_BIAS, Lanes, ONE, Packet, ROUND_EXPONENT, UPPER, difference_fused,
    difference_split, sealed::Sealed, select_of_four, select_of_three,
};
use wide::{f32x8, u32x8};

impl Sealed for f32x8 {}

/// Whether `wide`'s `mul_add` rounds once in this build.
pub(crate) const FUSES: bool = cfg!(any(
    target_feature = "fma",
    all(target_arch = "aarch64", target_feature = "neon")
));

/// Masks of the sign, and of everything but the sign.
const SIGN: f32x8 = f32x8::new([-0.0; 8]);
const MAGNITUDE: f32x8 = f32x8::new([f32::from_bits(0x7fff_ffff); 8]);

/// The same number in every lane.
///
/// `wide` fills an array, which the compiler leaves a loop over memory where it saves space: a packet took three to ten
/// times as long at opt-level s.
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

/// The upper half of the digits, and the rest.
#[inline(always)]
pub(super) fn split(x: f32x8) -> [f32x8; 2] {
    const MASK: u32x8 = u32x8::new([UPPER; 8]);
    let upper = f32x8::from_bits(x.to_bits() & MASK);
    [upper, x - upper]
}

impl Lanes for f32x8 {
    type Mask = f32x8;
    /// Where the chosen number is at least each of the three bounds.
    type Index = [f32x8; 3];
    type Stored = f32x8;
    const FUSES: bool = FUSES;

    #[inline(always)]
    fn splat(x: f32) -> Self {
        splat(x)
    }
    #[inline(always)]
    fn store(self) -> f32x8 {
        self
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        f32x8::mul_add(self, a, b)
    }
    // `wide` splats the sign that it negates with, at a cost (see `splat`).
    #[inline(always)]
    fn mul_sub(self, a: Self, b: Self) -> Self {
        if FUSES {
            f32x8::mul_add(self, a, b ^ SIGN)
        } else {
            self * a - b
        }
    }
    #[inline(always)]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        if FUSES {
            difference_fused(a, b, c, d)
        } else {
            difference_split([a, b, c, d], [split(a), split(b), split(c), split(d)])
        }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f32x8::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self & MAGNITUDE
    }
    // `fast_min` is the machine's own: its result for NaN is specified on x86 alone.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if cfg!(any(target_arch = "x86", target_arch = "x86_64")) {
            self.fast_min(other)
        } else {
            self.simd_lt(other).select(self, other)
        }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if cfg!(any(target_arch = "x86", target_arch = "x86_64")) {
            self.fast_max(other)
        } else {
            other.simd_lt(self).select(self, other)
        }
    }
    #[inline(always)]
    fn times_sign(self, sign: Self) -> Self {
        self ^ (sign & SIGN)
    }
    #[inline(always)]
    fn negate(mask: f32x8, x: Self) -> Self {
        x ^ (mask & SIGN)
    }
    #[inline(always)]
    fn bits_shl_23(self) -> Self {
        f32x8::from_bits(self.to_bits() << 23_u32)
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        const ROUND: u32x8 = u32x8::new([ROUND_EXPONENT; 8]);
        const ONES: u32x8 = u32x8::new([ONE; 8]);
        const INTEGERS: u32x8 = u32x8::new([INTEGER; 8]);
        let bits = self.to_bits();
        let exponent = (bits + ROUND) >> 23_u32;
        let mantissa = bits + ONES - (exponent << 23_u32);
        (
            f32x8::from_bits(mantissa),
            f32x8::from_bits(exponent | INTEGERS) - splat(INTEGER_BIAS),
        )
    }
    #[inline(always)]
    fn lt(self, other: Self) -> f32x8 {
        self.simd_lt(other)
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
        mask.select(yes, no)
    }
    #[inline(always)]
    fn swap(mask: f32x8, a: Self, b: Self) -> (Self, Self) {
        let kept = (a ^ b) & mask;
        (b ^ kept, a ^ kept)
    }
    #[inline(always)]
    fn keep(mask: f32x8, x: Self) -> Self {
        mask & x
    }
    #[inline(always)]
    fn search(x: Self, bounds: [Self; 3], count: usize) -> [f32x8; 3] {
        [
            if count > 0 {
                x.simd_ge(bounds[0])
            } else {
                f32x8::ZERO
            },
            if count > 1 {
                x.simd_ge(bounds[1])
            } else {
                f32x8::ZERO
            },
            if count > 2 {
                x.simd_ge(bounds[2])
            } else {
                f32x8::ZERO
            },
        ]
    }
    #[inline(always)]
    fn is_index(index: [f32x8; 3], entry: usize) -> f32x8 {
        match entry {
            0 => !index[0],
            1 => index[0] & !index[1],
            2 => index[1] & !index[2],
            _ => index[2],
        }
    }
    #[inline(always)]
    fn index_number(index: [f32x8; 3]) -> Self {
        let one = splat(1.0);
        (index[0] & one) + (index[1] & one) + (index[2] & one)
    }
}

/// [`Broadcast`] by selection among the entries, each read as lanes.
macro_rules! broadcast {
    ($($Stored:ty, $x:ident, $lanes:expr;)*) => { $(
        impl Broadcast<f32x8> for $Stored {
            #[inline(always)]
            fn lanes(&self) -> f32x8 {
                let $x = *self;
                $lanes
            }
            #[inline(always)]
            fn look_up(table: &[$Stored; 4], index: [f32x8; 3]) -> f32x8 {
                select_of_four([table[0].lanes(), table[1].lanes(), table[2].lanes(), table[3].lanes()], index)
            }
            #[inline(always)]
            fn look_up_three(table: &[$Stored; 4], index: [f32x8; 3]) -> f32x8 {
                select_of_three([table[0].lanes(), table[1].lanes(), table[2].lanes()], index)
            }
            #[inline(always)]
            fn look_up_half(table: &[$Stored; 2], index: [f32x8; 3]) -> f32x8 {
                index[1].select(table[1].lanes(), table[0].lanes())
            }
        }
    )* };
}
broadcast! { f32, x, splat(x); f32x8, x, x; }

impl Packet<8> for f32x8 {
    #[inline(always)]
    fn read(from: &[f32; 8]) -> Self {
        f32x8::new(*from)
    }
    #[inline(always)]
    fn write(self, to: &mut [f32; 8]) {
        *to = self.to_array();
    }
}
