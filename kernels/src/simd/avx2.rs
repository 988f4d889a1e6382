//! Eight lanes in one `__m256`, for CPUs found at run time to have AVX2 and FMA.
//!
//! `wide` chooses its instructions at compile time, so that a plain build has SSE2 alone. This newtype is private to the crate, and
//! `dispatch` is the only place that names it as a type.

#![allow(
    unsafe_code,
    reason = "intrinsics of target features that `dispatch` has checked"
)]

use super::choice::Choice;
use super::lanes::{
    INTEGER, INTEGER_BIAS, Lanes, ONE, Packet, ROUND_EXPONENT, Scalar, by_splat, difference_fused,
    sealed::Sealed,
};
use super::schedule::Schedule;
use super::storage::Entries;
use core::arch::asm;
#[cfg(target_arch = "x86")]
use core::arch::x86::*;
#[cfg(target_arch = "x86_64")]
use core::arch::x86_64::*;
use core::mem::transmute;
use core::ops::{Add, Mul, Neg, Sub};
use wide::f32x8;

/// Eight lanes. No code outside of `simd` can name the type. Code inside runs with it below
/// `dispatch`'s `#[target_feature(enable = "avx2,fma")]` functions alone, which a `Level` enters
/// only where the CPU has both; what such code keeps and calls later finds the same CPU. Every
/// `unsafe` of this module rests on that.
#[derive(Clone, Copy, Debug)]
pub(super) struct Avx2(__m256);

/// Calls intrinsics of this module's target features.
macro_rules! avx2 {
    ($e:expr) => {{
        // SAFETY: code with the type `Avx2` comes from below `dispatch`'s check: the CPU has AVX2
        // and FMA.
        unsafe { $e }
    }};
}
macro_rules! binary {
    ($($Trait:ident $method:ident $intrinsic:ident;)*) => { $(
        impl $Trait for Avx2 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(avx2!($intrinsic(self.0, other.0)))
            }
        }
    )* };
}
binary! { Add add _mm256_add_ps; Sub sub _mm256_sub_ps; Mul mul _mm256_mul_ps; }
by_splat! { Avx2, [] }

impl Neg for Avx2 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(avx2!(_mm256_xor_ps(self.0, _mm256_set1_ps(-0.0))))
    }
}

impl Sealed for Avx2 {}
impl Scalar for Avx2 {
    type Table = Entries<Self>;
}

/// Index from 0 to 3 per lane: its number, and the masks of at least 1, 2 and 3. The compiler drops the parts that are not used.
#[derive(Clone, Copy, Debug)]
pub(super) struct Indices {
    number: __m256i,
    at_least: [__m256; 3],
}

impl Lanes for Avx2 {
    type Mask = __m256;
    type Index = Indices;
    type Stored = f32x8;
    const FUSES: Option<bool> = Some(true);

    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(avx2!(_mm256_set1_ps(x)))
    }
    #[inline(always)]
    fn store(self) -> f32x8 {
        f32x8::new(avx2!(transmute::<__m256, [f32; 8]>(self.0)))
    }
    #[inline(always)]
    fn load(stored: &f32x8) -> Self {
        Self::read(stored.as_array())
    }
    #[inline(always)]
    fn load_fresh(stored: &f32x8) -> Self {
        Self::read_fresh(stored.as_array())
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Self(avx2!(_mm256_fmadd_ps(self.0, a.0, b.0)))
    }
    #[inline(always)]
    fn mul_sub(self, a: Self, b: Self) -> Self {
        Self(avx2!(_mm256_fmsub_ps(self.0, a.0, b.0)))
    }
    #[inline(always)]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        difference_fused(a, b, c, d)
    }
    #[inline(always)]
    fn quotient(a: Self, b: Self) -> Self {
        Self(avx2!(_mm256_div_ps(a.0, b.0)))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(avx2!(_mm256_sqrt_ps(self.0)))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(avx2!(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0)))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(avx2!(_mm256_min_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(avx2!(_mm256_max_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn times_sign(self, sign: Self) -> Self {
        Self(avx2!(_mm256_xor_ps(
            self.0,
            _mm256_and_ps(_mm256_set1_ps(-0.0), sign.0)
        )))
    }
    #[inline(always)]
    fn negate(mask: __m256, x: Self) -> Self {
        Self(avx2!(_mm256_xor_ps(
            x.0,
            _mm256_and_ps(mask, _mm256_set1_ps(-0.0))
        )))
    }
    #[inline(always)]
    fn bits_shl_23(self) -> Self {
        Self(avx2!(_mm256_castsi256_ps(_mm256_slli_epi32::<23>(
            _mm256_castps_si256(self.0)
        ))))
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        avx2!({
            let bits = _mm256_castps_si256(self.0);
            let exponent = _mm256_srli_epi32::<23>(_mm256_add_epi32(
                bits,
                _mm256_set1_epi32(ROUND_EXPONENT.cast_signed()),
            ));
            let mantissa = _mm256_sub_epi32(
                _mm256_add_epi32(bits, _mm256_set1_epi32(ONE.cast_signed())),
                _mm256_slli_epi32::<23>(exponent),
            );
            let number = _mm256_castsi256_ps(_mm256_or_si256(
                exponent,
                _mm256_set1_epi32(INTEGER.cast_signed()),
            ));
            (
                Self(_mm256_castsi256_ps(mantissa)),
                Self(_mm256_sub_ps(number, _mm256_set1_ps(INTEGER_BIAS))),
            )
        })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> __m256 {
        avx2!(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0))
    }
    #[inline(always)]
    fn and(a: __m256, b: __m256) -> __m256 {
        avx2!(_mm256_and_ps(a, b))
    }
    #[inline(always)]
    fn or(a: __m256, b: __m256) -> __m256 {
        avx2!(_mm256_or_ps(a, b))
    }
    #[inline(always)]
    fn select(mask: __m256, yes: Self, no: Self) -> Self {
        Self(avx2!(_mm256_blendv_ps(no.0, yes.0, mask)))
    }
    // Four operations on bits, where two blends are up to six.
    #[inline(always)]
    fn swap(mask: __m256, a: Self, b: Self) -> (Self, Self) {
        let kept = avx2!(_mm256_and_ps(_mm256_xor_ps(a.0, b.0), mask));
        (
            Self(avx2!(_mm256_xor_ps(b.0, kept))),
            Self(avx2!(_mm256_xor_ps(a.0, kept))),
        )
    }
    #[inline(always)]
    fn keep(mask: __m256, x: Self) -> Self {
        Self(avx2!(_mm256_and_ps(mask, x.0)))
    }
    #[inline(always)]
    fn transpose([a, b, c, d, e, f, g, h]: [&[f32; 4]; 8]) -> [Self; 4] {
        avx2!({
            let [a, b, c, d] = [
                two_rows(a, e),
                two_rows(b, f),
                two_rows(c, g),
                two_rows(d, h),
            ];
            // Pairs of numbers of the first two rows, and of the last.
            let (low, next) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
            let (third, last) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
            [
                Self(_mm256_shuffle_ps::<0b01_00_01_00>(low, next)),
                Self(_mm256_shuffle_ps::<0b11_10_11_10>(low, next)),
                Self(_mm256_shuffle_ps::<0b01_00_01_00>(third, last)),
                Self(_mm256_shuffle_ps::<0b11_10_11_10>(third, last)),
            ]
        })
    }
}

impl Schedule for Avx2 {
    #[inline(always)]
    fn interleave(a: Self, b: Self) -> (Self, Self) {
        let (a, b) = avx2!(interleave(a.0, b.0));
        (Self(a), Self(b))
    }
}

impl Choice<Avx2> for Indices {
    #[inline(always)]
    fn search(x: Avx2, bounds: [Avx2; 3], count: usize) -> Self {
        avx2!({
            let none = _mm256_setzero_ps();
            let at_least = [
                if count > 0 {
                    _mm256_cmp_ps::<_CMP_GE_OQ>(x.0, bounds[0].0)
                } else {
                    none
                },
                if count > 1 {
                    _mm256_cmp_ps::<_CMP_GE_OQ>(x.0, bounds[1].0)
                } else {
                    none
                },
                if count > 2 {
                    _mm256_cmp_ps::<_CMP_GE_OQ>(x.0, bounds[2].0)
                } else {
                    none
                },
            ];
            // A set mask is -1 as an integer.
            let [a, b, c] = [at_least[0], at_least[1], at_least[2]];
            let sum = _mm256_add_epi32(_mm256_castps_si256(a), _mm256_castps_si256(b));
            let number = _mm256_sub_epi32(
                _mm256_setzero_si256(),
                _mm256_add_epi32(sum, _mm256_castps_si256(c)),
            );
            Self { number, at_least }
        })
    }
    #[inline(always)]
    fn masks(self) -> [__m256; 3] {
        self.at_least
    }
    #[inline(always)]
    fn equals(self, entry: usize) -> __m256 {
        let [one, two, three] = self.at_least;
        avx2!(match entry {
            0 => _mm256_xor_ps(one, _mm256_castsi256_ps(_mm256_set1_epi32(-1))),
            1 => _mm256_andnot_ps(two, one),
            2 => _mm256_andnot_ps(three, two),
            _ => three,
        })
    }
    #[inline(always)]
    fn to_number(self) -> Avx2 {
        Avx2(avx2!(_mm256_cvtepi32_ps(self.number)))
    }
    // One shuffle in place of three blends.
    #[inline(always)]
    fn look_up(self, table: &[f32; 4]) -> Avx2 {
        Avx2(avx2!({
            let four = transmute::<[f32; 4], __m128>(*table);
            _mm256_permutevar_ps(_mm256_set_m128(four, four), self.number)
        }))
    }
    #[inline(always)]
    fn look_up_eight(self, upper: __m256, table: &[f32; 8]) -> Avx2 {
        Avx2(avx2!({
            let offset = _mm256_and_si256(_mm256_castps_si256(upper), _mm256_set1_epi32(4));
            let number = _mm256_or_si256(self.number, offset);
            _mm256_permutevar8x32_ps(transmute::<[f32; 8], __m256>(*table), number)
        }))
    }
    #[inline(always)]
    fn look_up_three(self, table: &[f32; 4]) -> Avx2 {
        self.look_up(table)
    }
    #[inline(always)]
    fn look_up_half(self, table: &[f32; 2]) -> Avx2 {
        Avx2(avx2!({
            // Either entry in every second lane: the upper of an index's two bits selects.
            let two = _mm256_castpd_ps(_mm256_set1_pd(transmute::<[f32; 2], f64>(*table)));
            _mm256_permutevar_ps(two, _mm256_srli_epi32::<1>(self.number))
        }))
    }
}

/// Scheduling barrier.
///
/// - Effect: an empty `asm!` block that LLVM must assume reads and writes both values, so that it
///   computes both before it uses either. Emits no instruction. Miri runs no assembly, and goes
///   without.
/// - Measured: a sampled packet of eight took 65 ns for 69 with the published Gaussian, 112 for 135
///   with `Matched<Gaussian>` and 84 for 98 with `Matched<Cauchy>` (AMD Zen 3, at the commit that
///   brought it).
/// - Measure again: return `(a, b)` in its place, and compare `cargo bench -p hairis-benches
///   --bench sample -- sample8`.
#[target_feature(enable = "avx")]
#[inline]
fn interleave(mut a: __m256, mut b: __m256) -> (__m256, __m256) {
    #[cfg(not(miri))]
    // SAFETY: there is no code, and AVX, which the registers belong to, is there.
    unsafe {
        asm!("/* {0} {1} */", inout(ymm_reg) a, inout(ymm_reg) b, options(pure, nomem, nostack, preserves_flags));
    }
    (a, b)
}

/// Joins two rows of four lanes to eight.
#[target_feature(enable = "avx")]
#[inline]
fn two_rows(low: &[f32; 4], high: &[f32; 4]) -> __m256 {
    // SAFETY: any bits are four numbers.
    let (low, high) = unsafe {
        (
            transmute::<[f32; 4], __m128>(*low),
            transmute::<[f32; 4], __m128>(*high),
        )
    };
    _mm256_set_m128(high, low)
}

/// Loads eight lanes in two loads of 16 bytes, each of which a store of 16 bytes is forwarded to. From intrinsics the compiler makes
/// one load of 32 bytes.
#[target_feature(enable = "avx")]
#[inline]
fn load_halves(from: &[f32; 8]) -> __m256 {
    #[cfg(miri)]
    // SAFETY: any bits are eight numbers.
    return unsafe { transmute::<[f32; 8], __m256>(*from) };
    #[cfg(not(miri))]
    // SAFETY: there are eight numbers, and AVX, which the register belongs to, is there.
    unsafe {
        let [low, _] = transmute::<[f32; 8], [__m128; 2]>(*from);
        let mut lanes = _mm256_castps128_ps256(low);
        asm!(
            "vinsertf128 {0}, {0}, xmmword ptr [{1} + 16], 1",
            inout(ymm_reg) lanes,
            in(reg) from.as_ptr(),
            options(pure, readonly, nostack, preserves_flags)
        );
        lanes
    }
}

impl Packet<8> for Avx2 {
    #[inline(always)]
    fn read(from: &[f32; 8]) -> Self {
        Self(avx2!(transmute::<[f32; 8], __m256>(*from)))
    }
    #[inline(always)]
    fn read_fresh(from: &[f32; 8]) -> Self {
        Self(avx2!(load_halves(from)))
    }
    #[inline(always)]
    fn write(self, to: &mut [f32; 8]) {
        *to = avx2!(transmute::<__m256, [f32; 8]>(self.0));
    }
}
