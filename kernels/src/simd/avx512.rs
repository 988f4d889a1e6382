//! Sixteen lanes in one `__m512`, for the slices of CPUs found at run time to have AVX-512.
//!
//! Packets of eight are [`Avx2`](super::avx2::Avx2) on these CPUs, too: `dispatch` compiles them for AVX-512 once more.
//! Multiplication fuses as on AVX2, and the results are the same to the bit.

#![allow(
    unsafe_code,
    reason = "intrinsics of target features that `dispatch` has checked"
)]

use super::choice::Choice;
use super::lanes::{
    Broadcast, INTEGER, INTEGER_BIAS, Lanes, ONE, Packet, ROUND_EXPONENT, Scalar, by_splat,
    difference_fused, sealed::Sealed,
};
use super::schedule::Schedule;
use super::storage::Entries;
#[cfg(target_arch = "x86")]
use core::arch::x86::*;
#[cfg(target_arch = "x86_64")]
use core::arch::x86_64::*;
use core::mem::transmute;
use core::ops::{Add, Mul, Neg, Sub};

/// Sixteen lanes. As for [`Avx2`](super::avx2::Avx2), code with this type comes only from below
/// `dispatch`'s functions of AVX-512F, VL, DQ and BW, which a `Level` enters only where the CPU has
/// them: every `unsafe` of this module rests on that.
#[derive(Clone, Copy, Debug)]
pub(super) struct Avx512(__m512);

/// Calls intrinsics of this module's target features.
macro_rules! avx512 {
    ($e:expr) => {{
        // SAFETY: code with the type `Avx512` comes from below `dispatch`'s check: the CPU has
        // these features.
        unsafe { $e }
    }};
}
macro_rules! binary {
    ($($Trait:ident $method:ident $intrinsic:ident;)*) => { $(
        impl $Trait for Avx512 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(avx512!($intrinsic(self.0, other.0)))
            }
        }
    )* };
}
binary! { Add add _mm512_add_ps; Sub sub _mm512_sub_ps; Mul mul _mm512_mul_ps; }
by_splat! { Avx512, [] }

impl Neg for Avx512 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(avx512!(_mm512_xor_ps(self.0, _mm512_set1_ps(-0.0))))
    }
}

impl Sealed for Avx512 {}
impl Scalar for Avx512 {
    type Table = Entries<Self>;
}
impl Schedule for Avx512 {}

/// Index from 0 to 3 per lane: its number, and the masks of at least 1, 2 and 3. The compiler drops the parts that are not used.
#[derive(Clone, Copy, Debug)]
pub(super) struct Indices16 {
    number: __m512i,
    at_least: [__mmask16; 3],
}

impl Lanes for Avx512 {
    type Mask = __mmask16;
    type Index = Indices16;
    // Only columns run in sixteen lanes, which are not kept between calls.
    type Stored = Self;
    const FUSES: Option<bool> = Some(true);

    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(avx512!(_mm512_set1_ps(x)))
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
        Self(avx512!(_mm512_fmadd_ps(self.0, a.0, b.0)))
    }
    #[inline(always)]
    fn mul_sub(self, a: Self, b: Self) -> Self {
        Self(avx512!(_mm512_fmsub_ps(self.0, a.0, b.0)))
    }
    #[inline(always)]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        difference_fused(a, b, c, d)
    }
    #[inline(always)]
    fn quotient(a: Self, b: Self) -> Self {
        Self(avx512!(_mm512_div_ps(a.0, b.0)))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(avx512!(_mm512_sqrt_ps(self.0)))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(avx512!(_mm512_andnot_ps(_mm512_set1_ps(-0.0), self.0)))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(avx512!(_mm512_min_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(avx512!(_mm512_max_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn times_sign(self, sign: Self) -> Self {
        Self(avx512!(_mm512_xor_ps(
            self.0,
            _mm512_and_ps(_mm512_set1_ps(-0.0), sign.0)
        )))
    }
    #[inline(always)]
    fn negate(mask: __mmask16, x: Self) -> Self {
        Self(avx512!(_mm512_mask_xor_ps(
            x.0,
            mask,
            x.0,
            _mm512_set1_ps(-0.0)
        )))
    }
    #[inline(always)]
    fn bits_shl_23(self) -> Self {
        Self(avx512!(_mm512_castsi512_ps(_mm512_slli_epi32::<23>(
            _mm512_castps_si512(self.0)
        ))))
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        avx512!({
            let bits = _mm512_castps_si512(self.0);
            let exponent = _mm512_srli_epi32::<23>(_mm512_add_epi32(
                bits,
                _mm512_set1_epi32(ROUND_EXPONENT.cast_signed()),
            ));
            let mantissa = _mm512_sub_epi32(
                _mm512_add_epi32(bits, _mm512_set1_epi32(ONE.cast_signed())),
                _mm512_slli_epi32::<23>(exponent),
            );
            let number = _mm512_castsi512_ps(_mm512_or_si512(
                exponent,
                _mm512_set1_epi32(INTEGER.cast_signed()),
            ));
            (
                Self(_mm512_castsi512_ps(mantissa)),
                Self(_mm512_sub_ps(number, _mm512_set1_ps(INTEGER_BIAS))),
            )
        })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> __mmask16 {
        avx512!(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0))
    }
    #[inline(always)]
    fn and(a: __mmask16, b: __mmask16) -> __mmask16 {
        a & b
    }
    #[inline(always)]
    fn or(a: __mmask16, b: __mmask16) -> __mmask16 {
        a | b
    }
    #[inline(always)]
    fn select(mask: __mmask16, yes: Self, no: Self) -> Self {
        Self(avx512!(_mm512_mask_blend_ps(mask, no.0, yes.0)))
    }
    #[inline(always)]
    fn swap(mask: __mmask16, a: Self, b: Self) -> (Self, Self) {
        (Self::select(mask, a, b), Self::select(mask, b, a))
    }
    #[inline(always)]
    fn keep(mask: __mmask16, x: Self) -> Self {
        Self(avx512!(_mm512_maskz_mov_ps(mask, x.0)))
    }
}

impl Choice<Avx512> for Indices16 {
    #[inline(always)]
    fn search(x: Avx512, bounds: [Avx512; 3], count: usize) -> Self {
        let at_least = avx512!([
            if count > 0 {
                _mm512_cmp_ps_mask::<_CMP_GE_OQ>(x.0, bounds[0].0)
            } else {
                0
            },
            if count > 1 {
                _mm512_cmp_ps_mask::<_CMP_GE_OQ>(x.0, bounds[1].0)
            } else {
                0
            },
            if count > 2 {
                _mm512_cmp_ps_mask::<_CMP_GE_OQ>(x.0, bounds[2].0)
            } else {
                0
            },
        ]);
        let number = avx512!({
            // Not a sum of masks, which the compiler makes one of bytes.
            let first = _mm512_maskz_set1_epi32(at_least[0], 1);
            let second = _mm512_mask_mov_epi32(first, at_least[1], _mm512_set1_epi32(2));
            _mm512_mask_mov_epi32(second, at_least[2], _mm512_set1_epi32(3))
        });
        Self { number, at_least }
    }
    #[inline(always)]
    fn masks(self) -> [__mmask16; 3] {
        self.at_least
    }
    #[inline(always)]
    fn equals(self, entry: usize) -> __mmask16 {
        let [one, two, three] = self.at_least;
        match entry {
            0 => !one,
            1 => one & !two,
            2 => two & !three,
            _ => three,
        }
    }
    #[inline(always)]
    fn to_number(self) -> Avx512 {
        Avx512(avx512!(_mm512_cvtepi32_ps(self.number)))
    }
    // One shuffle in place of three blends.
    #[inline(always)]
    fn look_up(self, table: &[f32; 4]) -> Avx512 {
        Avx512(avx512!(_mm512_permutevar_ps(
            _mm512_broadcast_f32x4(transmute::<[f32; 4], __m128>(*table)),
            self.number
        )))
    }
    #[inline(always)]
    fn look_up_eight(self, upper: __mmask16, table: &[f32; 8]) -> Avx512 {
        Avx512(avx512!({
            let four = _mm512_set1_epi32(4);
            let number = _mm512_mask_or_epi32(self.number, upper, self.number, four);
            let eight = _mm512_broadcast_f32x8(transmute::<[f32; 8], __m256>(*table));
            _mm512_permutexvar_ps(number, eight)
        }))
    }
    #[inline(always)]
    fn look_up_three(self, table: &[f32; 4]) -> Avx512 {
        self.look_up(table)
    }
    #[inline(always)]
    fn look_up_half(self, table: &[f32; 2]) -> Avx512 {
        Avx512(avx512!({
            // Either entry in every second lane: the upper of an index's two bits selects.
            let two = _mm512_castpd_ps(_mm512_set1_pd(transmute::<[f32; 2], f64>(*table)));
            _mm512_permutevar_ps(two, _mm512_srli_epi32::<1>(self.number))
        }))
    }
}

impl Broadcast<Self> for Avx512 {
    #[inline(always)]
    fn lanes(&self) -> Self {
        *self
    }
}

impl Packet<16> for Avx512 {
    #[inline(always)]
    fn read(from: &[f32; 16]) -> Self {
        Self(avx512!(transmute::<[f32; 16], __m512>(*from)))
    }
    #[inline(always)]
    fn write(self, to: &mut [f32; 16]) {
        *to = avx512!(transmute::<__m512, [f32; 16]>(self.0));
    }
}
