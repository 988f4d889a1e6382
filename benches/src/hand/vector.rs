//! The intrinsics of three instruction sets under one name each: no more than the hand-written kernels use.

#![allow(
    unsafe_code,
    reason = "intrinsics, in functions that are called below a check of the CPU alone"
)]

use core::arch::asm;
use core::arch::x86_64::*;
use core::ops::{Add, Div, Mul, Sub};

/// Four entries by lobe; `steps` are the bits in which each differs from the one before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Table {
    entries: [f32; 4],
    steps: [f32; 4],
}

impl Table {
    pub(super) fn new(entries: [f32; 4]) -> Self {
        let step = |i: usize| f32::from_bits(entries[i].to_bits() ^ entries[i - 1].to_bits());
        Self {
            entries,
            steps: [entries[0], step(1), step(2), step(3)],
        }
    }
}

/// A register, or two of them side by side.
///
/// # Safety
///
/// Every function needs the instruction set of the type; pointers have as many numbers as there are lanes.
pub(super) trait Vector:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    type Mask: Copy;
    /// A number from 0 to 3 per lane, and where it is at least 1, 2 and 3.
    type Index: Copy;
    const LANES: usize;
    fn splat(x: f32) -> Self;
    unsafe fn load(from: *const f32) -> Self;
    /// Loads numbers that the caller has just written by narrower stores.
    #[inline(always)]
    unsafe fn load_fresh(from: *const f32) -> Self {
        // SAFETY: the caller's.
        unsafe { Self::load(from) }
    }
    unsafe fn store(self, to: *mut f32);
    /// `self * a + b`.
    fn mul_add(self, a: Self, b: Self) -> Self;
    /// `self * a - b`.
    fn mul_sub(self, a: Self, b: Self) -> Self;
    /// `b - self * a`.
    fn sub_from(self, a: Self, b: Self) -> Self;
    /// `a * b - c * d` without cancellation.
    fn cross(a: Self, b: Self, c: Self, d: Self) -> Self;
    fn sqrt(self) -> Self;
    /// Quotient, to within two units in the last place.
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        self / other
    }
    /// Reciprocals. Where `few`, the last two of one division: beside Gaussians the divider has time, beside Cauchy bells not.
    #[inline(always)]
    fn reciprocals([a, b, c, d]: [Self; 4], few: bool) -> [Self; 4] {
        let one = Self::splat(1.0);
        if few {
            let inv = one / (c * d);
            [one / a, one / b, inv * d, inv * c]
        } else {
            [one / a, one / b, one / c, one / d]
        }
    }
    /// `sqrt(1 - x^2)`.
    #[inline(always)]
    fn rest_of_square(x: Self) -> Self {
        x.sub_from(x, Self::splat(1.0)).sqrt()
    }
    fn abs(self) -> Self;
    fn min(self, other: Self) -> Self;
    fn max(self, other: Self) -> Self;
    fn times_sign(self, sign: Self) -> Self;
    fn below_zero(self) -> Self::Mask;
    fn either(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    fn clear(mask: Self::Mask, x: Self) -> Self;
    fn negate(mask: Self::Mask, x: Self) -> Self;
    fn shift_23(self) -> Self;
    fn search(x: Self, bounds: [Self; 3]) -> Self::Index;
    fn is_tt(index: Self::Index) -> Self::Mask;
    fn is_glint(index: Self::Index) -> Self::Mask;
    fn look_up(table: &Table, index: Self::Index) -> Self;
    /// Looks up a table whose first two entries are equal, and whose last two.
    fn look_up_half(table: &Table, index: Self::Index) -> Self {
        Self::look_up(table, index)
    }
    /// Keeps the compiler from computing one register of two after the other.
    #[inline(always)]
    fn pair(a: Self, b: Self) -> (Self, Self) {
        (a, b)
    }
    #[inline(always)]
    fn together(self) -> Self {
        self
    }
}

macro_rules! operators {
    ($Type:ident $add:ident $sub:ident $mul:ident $div:ident) => {
        operators!(@ $Type Add add $add; Sub sub $sub; Mul mul $mul; Div div $div;);
    };
    (@ $Type:ident $($Trait:ident $method:ident $intrinsic:ident;)*) => { $(
        impl $Trait for $Type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: the trait's.
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    )* };
}

/// The functions of a vector, each of one expression of intrinsics.
macro_rules! functions {
    ($($name:ident($($arg:ident: $type:ty),*) -> $out:ty = $body:expr;)*) => { $(
        #[inline(always)]
        #[allow(unused_unsafe, reason = "some are made of the others")]
        fn $name($($arg: $type),*) -> $out {
            // SAFETY: the trait's.
            unsafe { $body }
        }
    )* };
}

/// Eight lanes of AVX2 and FMA.
#[derive(Clone, Copy)]
pub(super) struct Avx2(__m256);
operators! { Avx2 _mm256_add_ps _mm256_sub_ps _mm256_mul_ps _mm256_div_ps }

#[derive(Clone, Copy)]
pub(super) struct Index8(__m256i, [__m256; 3]);

impl Vector for Avx2 {
    type Mask = __m256;
    type Index = Index8;
    const LANES: usize = 8;
    #[inline(always)]
    unsafe fn load(from: *const f32) -> Self {
        // SAFETY: the trait's.
        Self(unsafe { _mm256_loadu_ps(from) })
    }
    #[inline(always)]
    unsafe fn load_fresh(from: *const f32) -> Self {
        // SAFETY: the trait's.
        Self(unsafe { load_halves(from) })
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        // SAFETY: the trait's.
        unsafe { _mm256_storeu_ps(to, self.0) }
    }
    functions! {
        splat(x: f32) -> Self = Self(_mm256_set1_ps(x));
        mul_add(self: Self, a: Self, b: Self) -> Self = Self(_mm256_fmadd_ps(self.0, a.0, b.0));
        mul_sub(self: Self, a: Self, b: Self) -> Self = Self(_mm256_fmsub_ps(self.0, a.0, b.0));
        sub_from(self: Self, a: Self, b: Self) -> Self = Self(_mm256_fnmadd_ps(self.0, a.0, b.0));
        cross(a: Self, b: Self, c: Self, d: Self) -> Self = cross_fused(a, b, c, d);
        sqrt(self: Self) -> Self = Self(_mm256_sqrt_ps(self.0));
        abs(self: Self) -> Self = Self(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0));
        min(self: Self, other: Self) -> Self = Self(_mm256_min_ps(self.0, other.0));
        max(self: Self, other: Self) -> Self = Self(_mm256_max_ps(self.0, other.0));
        times_sign(self: Self, sign: Self) -> Self =
            Self(_mm256_xor_ps(self.0, _mm256_and_ps(_mm256_set1_ps(-0.0), sign.0)));
        below_zero(self: Self) -> __m256 = _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, _mm256_setzero_ps());
        either(a: __m256, b: __m256) -> __m256 = _mm256_or_ps(a, b);
        select(mask: __m256, yes: Self, no: Self) -> Self = Self(_mm256_blendv_ps(no.0, yes.0, mask));
        clear(mask: __m256, x: Self) -> Self = Self(_mm256_andnot_ps(mask, x.0));
        negate(mask: __m256, x: Self) -> Self = Self(_mm256_xor_ps(x.0, _mm256_and_ps(mask, _mm256_set1_ps(-0.0))));
        shift_23(self: Self) -> Self =
            Self(_mm256_castsi256_ps(_mm256_slli_epi32::<23>(_mm256_castps_si256(self.0))));
        search(x: Self, bounds: [Self; 3]) -> Index8 = {
            let at_least = [
                _mm256_cmp_ps::<_CMP_GE_OQ>(x.0, bounds[0].0),
                _mm256_cmp_ps::<_CMP_GE_OQ>(x.0, bounds[1].0),
                _mm256_cmp_ps::<_CMP_GE_OQ>(x.0, bounds[2].0),
            ];
            let [a, b, c] = [_mm256_castps_si256(at_least[0]), _mm256_castps_si256(at_least[1]), _mm256_castps_si256(at_least[2])];
            // A set mask is -1: the number is -(a + b + c), and of its negative the tables are read in reverse.
            Index8(_mm256_add_epi32(_mm256_add_epi32(a, b), c), at_least)
        };
        is_tt(index: Index8) -> __m256 = _mm256_andnot_ps(index.1[1], index.1[0]);
        is_glint(index: Index8) -> __m256 = index.1[2];
        // -3 to 0: the low two bits are 1, 2, 3 and 0.
        look_up(table: &Table, index: Index8) -> Self = {
            let [a, b, c, d] = table.entries;
            let four = _mm_setr_ps(a, d, c, b);
            Self(_mm256_permutevar_ps(_mm256_set_m128(four, four), index.0))
        };
    }
    #[inline(always)]
    fn pair(a: Self, b: Self) -> (Self, Self) {
        // SAFETY: the trait's.
        let (a, b) = unsafe { together(a.0, b.0) };
        (Self(a), Self(b))
    }
}

/// Two loads of 16 bytes, to which stores of 16 are forwarded. Of intrinsics the compiler makes one of 32.
#[target_feature(enable = "avx")]
#[inline]
unsafe fn load_halves(from: *const f32) -> __m256 {
    // SAFETY: there are eight numbers.
    unsafe {
        let mut lanes = _mm256_castps128_ps256(_mm_loadu_ps(from));
        asm!("vinsertf128 {0}, {0}, xmmword ptr [{1} + 16], 1", inout(ymm_reg) lanes, in(reg) from,
            options(pure, readonly, nostack, preserves_flags));
        lanes
    }
}

/// No code, which a compiler takes for one instruction with two results: neither is used before both are computed.
#[target_feature(enable = "avx")]
#[inline]
fn together(mut a: __m256, mut b: __m256) -> (__m256, __m256) {
    // SAFETY: there is no code.
    unsafe {
        asm!("/* {0} {1} */", inout(ymm_reg) a, inout(ymm_reg) b, options(pure, nomem, nostack, preserves_flags));
    }
    (a, b)
}

/// Sixteen lanes of AVX-512.
#[derive(Clone, Copy)]
pub(super) struct Avx512(__m512);
operators! { Avx512 _mm512_add_ps _mm512_sub_ps _mm512_mul_ps _mm512_div_ps }

#[derive(Clone, Copy)]
pub(super) struct Index16(__m512i, [__mmask16; 3]);

impl Vector for Avx512 {
    type Mask = __mmask16;
    type Index = Index16;
    const LANES: usize = 16;
    #[inline(always)]
    unsafe fn load(from: *const f32) -> Self {
        // SAFETY: the trait's.
        Self(unsafe { _mm512_loadu_ps(from) })
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        // SAFETY: the trait's.
        unsafe { _mm512_storeu_ps(to, self.0) }
    }
    functions! {
        splat(x: f32) -> Self = Self(_mm512_set1_ps(x));
        mul_add(self: Self, a: Self, b: Self) -> Self = Self(_mm512_fmadd_ps(self.0, a.0, b.0));
        mul_sub(self: Self, a: Self, b: Self) -> Self = Self(_mm512_fmsub_ps(self.0, a.0, b.0));
        sub_from(self: Self, a: Self, b: Self) -> Self = Self(_mm512_fnmadd_ps(self.0, a.0, b.0));
        cross(a: Self, b: Self, c: Self, d: Self) -> Self = cross_fused(a, b, c, d);
        // A square root takes the divider for 18 cycles, this the ports for 3.
        sqrt(self: Self) -> Self = {
            let estimate = Self(_mm512_rsqrt14_ps(self.0));
            let root = self * estimate;
            let error = root.sub_from(estimate, Self::splat(1.0));
            (root * Self::splat(0.5)).mul_add(error, root)
        };
        // A division takes the divider for 16 cycles, this the ports for 3.
        over(self: Self, other: Self) -> Self = {
            let estimate = Self(_mm512_rcp14_ps(other.0));
            let quotient = self * estimate;
            other.sub_from(quotient, self).mul_add(estimate, quotient)
        };
        // All four from one.
        reciprocals(denominators: [Self; 4], _few: bool) -> [Self; 4] = {
            let [a, b, c, d] = denominators;
            let (first, second) = (a * b, c * d);
            let inv = Self::splat(1.0).over(first * second);
            let (of_first, of_second) = (inv * second, inv * first);
            [of_first * b, of_first * a, of_second * d, of_second * c]
        };
        // `sqrt` of 0 is NaN.
        rest_of_square(x: Self) -> Self = x.sub_from(x, Self::splat(1.0)).max(Self::splat(1e-30)).sqrt();
        abs(self: Self) -> Self = Self(_mm512_andnot_ps(_mm512_set1_ps(-0.0), self.0));
        min(self: Self, other: Self) -> Self = Self(_mm512_min_ps(self.0, other.0));
        max(self: Self, other: Self) -> Self = Self(_mm512_max_ps(self.0, other.0));
        // self ^ (sign & -0.0) in one instruction.
        times_sign(self: Self, sign: Self) -> Self = Self(_mm512_castsi512_ps(_mm512_ternarylogic_epi32::<0x78>(
            _mm512_castps_si512(self.0), _mm512_castps_si512(sign.0), _mm512_castps_si512(_mm512_set1_ps(-0.0))
        )));
        below_zero(self: Self) -> __mmask16 = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, _mm512_setzero_ps());
        either(a: __mmask16, b: __mmask16) -> __mmask16 = a | b;
        select(mask: __mmask16, yes: Self, no: Self) -> Self = Self(_mm512_mask_blend_ps(mask, no.0, yes.0));
        clear(mask: __mmask16, x: Self) -> Self = Self(_mm512_maskz_mov_ps(!mask, x.0));
        negate(mask: __mmask16, x: Self) -> Self = Self(_mm512_mask_xor_ps(x.0, mask, x.0, _mm512_set1_ps(-0.0)));
        shift_23(self: Self) -> Self =
            Self(_mm512_castsi512_ps(_mm512_slli_epi32::<23>(_mm512_castps_si512(self.0))));
        search(x: Self, bounds: [Self; 3]) -> Index16 = {
            let at_least = [
                _mm512_cmp_ps_mask::<_CMP_GE_OQ>(x.0, bounds[0].0),
                _mm512_cmp_ps_mask::<_CMP_GE_OQ>(x.0, bounds[1].0),
                _mm512_cmp_ps_mask::<_CMP_GE_OQ>(x.0, bounds[2].0),
            ];
            let number = _mm512_maskz_set1_epi32(at_least[0], 1);
            let number = _mm512_mask_mov_epi32(number, at_least[1], _mm512_set1_epi32(2));
            Index16(_mm512_mask_mov_epi32(number, at_least[2], _mm512_set1_epi32(3)), at_least)
        };
        is_tt(index: Index16) -> __mmask16 = index.1[0] & !index.1[1];
        is_glint(index: Index16) -> __mmask16 = index.1[2];
        look_up(table: &Table, index: Index16) -> Self =
            Self(_mm512_permutevar_ps(_mm512_broadcast_f32x4(_mm_loadu_ps(table.entries.as_ptr())), index.0));
    }
}

/// Four lanes of SSE2, without fused products.
#[derive(Clone, Copy)]
pub(super) struct Sse2(__m128);
operators! { Sse2 _mm_add_ps _mm_sub_ps _mm_mul_ps _mm_div_ps }

impl Vector for Sse2 {
    type Mask = __m128;
    type Index = [__m128; 3];
    const LANES: usize = 4;
    #[inline(always)]
    unsafe fn load(from: *const f32) -> Self {
        // SAFETY: the trait's.
        Self(unsafe { _mm_loadu_ps(from) })
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        // SAFETY: the trait's.
        unsafe { _mm_storeu_ps(to, self.0) }
    }
    functions! {
        splat(x: f32) -> Self = Self(_mm_set1_ps(x));
        mul_add(self: Self, a: Self, b: Self) -> Self = self * a + b;
        mul_sub(self: Self, a: Self, b: Self) -> Self = self * a - b;
        sub_from(self: Self, a: Self, b: Self) -> Self = b - self * a;
        // Factors in halves of 12 bits, whose products are exact; those of constants are split before the loop.
        cross(a: Self, b: Self, c: Self, d: Self) -> Self = {
            let upper = |x: Self| Self(_mm_and_ps(x.0, _mm_castsi128_ps(_mm_set1_epi32(-4096))));
            let rest = |x: Self, y: Self, product: Self| {
                let (x_upper, y_upper) = (upper(x), upper(y));
                let (x_lower, y_lower) = (x - x_upper, y - y_upper);
                (((x_upper * y_upper - product) + x_upper * y_lower) + x_lower * y_upper) + x_lower * y_lower
            };
            let (first, second) = (a * b, c * d);
            (first - second) + (rest(a, b, first) - rest(c, d, second))
        };
        sqrt(self: Self) -> Self = Self(_mm_sqrt_ps(self.0));
        abs(self: Self) -> Self = Self(_mm_andnot_ps(_mm_set1_ps(-0.0), self.0));
        min(self: Self, other: Self) -> Self = Self(_mm_min_ps(self.0, other.0));
        max(self: Self, other: Self) -> Self = Self(_mm_max_ps(self.0, other.0));
        times_sign(self: Self, sign: Self) -> Self = Self(_mm_xor_ps(self.0, _mm_and_ps(_mm_set1_ps(-0.0), sign.0)));
        below_zero(self: Self) -> __m128 = _mm_cmplt_ps(self.0, _mm_setzero_ps());
        either(a: __m128, b: __m128) -> __m128 = _mm_or_ps(a, b);
        select(mask: __m128, yes: Self, no: Self) -> Self =
            Self(_mm_or_ps(_mm_and_ps(mask, yes.0), _mm_andnot_ps(mask, no.0)));
        clear(mask: __m128, x: Self) -> Self = Self(_mm_andnot_ps(mask, x.0));
        negate(mask: __m128, x: Self) -> Self = Self(_mm_xor_ps(x.0, _mm_and_ps(mask, _mm_set1_ps(-0.0))));
        shift_23(self: Self) -> Self = Self(_mm_castsi128_ps(_mm_slli_epi32::<23>(_mm_castps_si128(self.0))));
        search(x: Self, bounds: [Self; 3]) -> [__m128; 3] =
            [_mm_cmpge_ps(x.0, bounds[0].0), _mm_cmpge_ps(x.0, bounds[1].0), _mm_cmpge_ps(x.0, bounds[2].0)];
        is_tt(index: [__m128; 3]) -> __m128 = _mm_andnot_ps(index[1], index[0]);
        is_glint(index: [__m128; 3]) -> __m128 = index[2];
        // The bits in which each entry differs from the one before, where the index reaches it. The last two are equal.
        look_up(table: &Table, index: [__m128; 3]) -> Self = {
            let [first, one, two, _] = table.steps.map(|step| _mm_set1_ps(step));
            Self(_mm_xor_ps(_mm_xor_ps(first, _mm_and_ps(index[0], one)), _mm_and_ps(index[1], two)))
        };
        look_up_half(table: &Table, index: [__m128; 3]) -> Self = {
            let [first, _, two, _] = table.steps.map(|step| _mm_set1_ps(step));
            Self(_mm_xor_ps(first, _mm_and_ps(index[1], two)))
        };
    }
}

#[inline(always)]
fn cross_fused<V: Vector>(a: V, b: V, c: V, d: V) -> V {
    let product = c * d;
    a.mul_sub(b, product) - c.mul_sub(d, product)
}
