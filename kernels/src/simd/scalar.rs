//! One lane: the backend of scalar calls.
//!
//! Selections are marked unpredictable, because as branches, which the compiler makes of them here and there, they would be
//! mispredicted half of the time. Selections by a mask that is nearly always the same are branches.

#![allow(
    unsafe_code,
    reason = "an intrinsic of a target feature that the program is compiled for"
)]

use core::hint::select_unpredictable;

use super::choice::Choice;
use super::lanes::{
    INTEGER, INTEGER_BIAS, Lanes, ONE, ROUND_EXPONENT, Scalar, UPPER, difference_split,
    sealed::Sealed,
};
use super::schedule::Schedule;
use super::storage::Shared;

impl Sealed for f32 {}
impl Scalar for f32 {
    type Table = Shared;
}

/// Splits a number into the upper half of its digits and the rest.
#[inline(always)]
fn split(x: f32) -> [f32; 2] {
    let upper = f32::from_bits(x.to_bits() & UPPER);
    [upper, x - upper]
}

/// Computes the square root by the instruction, because that of `libm` stays a call where the compiler optimises for size.
///
/// The result replaces the operand: written to another register, it would wait for the earlier content of that register, which may
/// be a result of the last call.
#[inline(always)]
fn sqrt(x: f32) -> f32 {
    #[cfg(all(target_arch = "x86_64", target_feature = "sse2", not(miri)))]
    {
        let mut root = x;
        // SAFETY: the program is compiled for CPUs that have the instruction, which reads and writes a register.
        unsafe {
            #[cfg(not(target_feature = "avx"))]
            core::arch::asm!("sqrtss {0}, {0}", inout(xmm_reg) root, options(pure, nomem, nostack, preserves_flags));
            #[cfg(target_feature = "avx")]
            core::arch::asm!("vsqrtss {0}, {0}, {0}", inout(xmm_reg) root, options(pure, nomem, nostack, preserves_flags));
        }
        root
    }
    #[cfg(all(target_arch = "x86", target_feature = "sse2"))]
    {
        use core::arch::x86::{_mm_cvtss_f32, _mm_set_ss, _mm_sqrt_ss};
        // SAFETY: the program is compiled for CPUs that have SSE2.
        unsafe { _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(x))) }
    }
    #[cfg(not(any(
        all(target_arch = "x86_64", target_feature = "sse2", not(miri)),
        all(target_arch = "x86", target_feature = "sse2")
    )))]
    libm::sqrtf(x)
}

/// Applies an instruction to four numbers, and to four others if it has two operands.
///
/// Inline assembly, because LLVM applies an intrinsic to the lanes in use, and to whatever the other lanes of the register hold.
#[cfg(all(target_arch = "x86_64", target_feature = "sse2", not(miri)))]
macro_rules! of_four {
    ($sse:literal, $avx:literal, $numbers:expr $(, $others:expr)?) => {{
        use core::arch::x86_64::{_mm_setr_ps, _mm_storeu_ps};
        let [a, b, c, d] = $numbers;
        let mut results = [0.0; 4];
        // SAFETY: the program is compiled for CPUs that have the instructions, and there is room for four results.
        unsafe {
            let mut packed = _mm_setr_ps(a, b, c, d);
            #[cfg(not(target_feature = "avx"))]
            core::arch::asm!($sse, inout(xmm_reg) packed, $(in(xmm_reg) { let [a, b, c, d] = $others; _mm_setr_ps(a, b, c, d) },)? options(pure, nomem, nostack, preserves_flags));
            #[cfg(target_feature = "avx")]
            core::arch::asm!($avx, inout(xmm_reg) packed, $(in(xmm_reg) { let [a, b, c, d] = $others; _mm_setr_ps(a, b, c, d) },)? options(pure, nomem, nostack, preserves_flags));
            _mm_storeu_ps(results.as_mut_ptr(), packed);
        }
        results
    }};
}

impl Lanes for f32 {
    type Mask = bool;
    type Index = usize;
    type Stored = f32;
    const FUSES: Option<bool> = Some(false);

    #[inline(always)]
    fn splat(x: f32) -> Self {
        x
    }
    #[inline(always)]
    fn store(self) -> f32 {
        self
    }
    #[inline(always)]
    fn load(stored: &f32) -> Self {
        *stored
    }
    // Not fused: without the instruction, `libm::fmaf` would cost more than the rest of the model.
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    #[inline(always)]
    fn mul_sub(self, a: Self, b: Self) -> Self {
        self * a - b
    }
    #[inline(always)]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        difference_split([a, b, c, d], [split(a), split(b), split(c), split(d)])
    }
    #[inline(always)]
    fn quotient(a: Self, b: Self) -> Self {
        (a / b).alone()
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        sqrt(self)
    }
    #[cfg(all(target_arch = "x86_64", target_feature = "sse2", not(miri)))]
    #[inline(always)]
    fn four_quotients(a: [Self; 4], b: [Self; 4]) -> [Self; 4] {
        of_four!("divps {0}, {1}", "vdivps {0}, {0}, {1}", a, b)
    }
    #[cfg(all(target_arch = "x86_64", target_feature = "sse2", not(miri)))]
    #[inline(always)]
    fn four_roots(x: [Self; 4]) -> [Self; 4] {
        of_four!("sqrtps {0}, {0}", "vsqrtps {0}, {0}", x)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f32::abs(self)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn times_sign(self, sign: Self) -> Self {
        f32::from_bits(self.to_bits() ^ (sign.to_bits() & (1 << 31)))
    }
    #[inline(always)]
    fn negate(mask: bool, x: Self) -> Self {
        f32::from_bits(x.to_bits() ^ (u32::from(mask) << 31))
    }
    #[inline(always)]
    fn bits_shl_23(self) -> Self {
        f32::from_bits(self.to_bits() << 23)
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        let bits = self.to_bits();
        let exponent = bits.wrapping_add(ROUND_EXPONENT) >> 23;
        let mantissa = bits.wrapping_add(ONE).wrapping_sub(exponent << 23);
        (
            f32::from_bits(mantissa),
            f32::from_bits(exponent | INTEGER) - INTEGER_BIAS,
        )
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn and(a: bool, b: bool) -> bool {
        a & b
    }
    #[inline(always)]
    fn or(a: bool, b: bool) -> bool {
        a | b
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        select_unpredictable(mask, yes, no)
    }
    // Effect: a branch, as LLVM must run the empty `asm!` block on one side alone. Emits no instruction. Measured on an AMD EPYC
    // (family 25, model 1): `eval_hit` of the published Gaussian takes 122 ns with it, and 136 without. Measure again: leave the
    // function out, and run the bench `hits`.
    #[cfg(all(target_arch = "x86_64", not(miri)))]
    #[inline(always)]
    fn select_predictable(mask: bool, yes: Self, no: Self) -> Self {
        if mask {
            yes
        } else {
            // SAFETY: there is no code.
            unsafe { core::arch::asm!("", options(nomem, nostack, preserves_flags)) };
            no
        }
    }
    #[inline(always)]
    fn swap(mask: bool, a: Self, b: Self) -> (Self, Self) {
        (
            select_unpredictable(mask, a, b),
            select_unpredictable(mask, b, a),
        )
    }
    #[inline(always)]
    fn keep(mask: bool, x: Self) -> Self {
        select_unpredictable(mask, x, 0.0)
    }
}

impl Schedule for f32 {
    // Effect: an empty `asm!` block that LLVM must assume reads and writes the number, so that it
    // does not compute the number as one lane of several. Emits no instruction. Miri runs no
    // assembly, and goes without. Measured: without it, 916 of 1024 samples of `Matched<Gaussian>`
    // raised an exception in an unused lane. Measure again: return `self` in its place and
    // run `.ci/exceptions.sh`.
    #[cfg(all(target_arch = "x86_64", target_feature = "sse2", not(miri)))]
    #[inline(always)]
    fn alone(mut self) -> Self {
        // SAFETY: there is no code, and the program is compiled for CPUs that have the registers.
        unsafe {
            core::arch::asm!("/* {0} */", inout(xmm_reg) self, options(pure, nomem, nostack, preserves_flags));
        }
        self
    }
    #[cfg(all(target_arch = "x86_64", target_feature = "sse2", not(miri)))]
    #[inline(always)]
    fn spread(mut self) -> Self {
        // SAFETY: the program is compiled for CPUs that have the instruction, which reads and writes a register.
        unsafe {
            #[cfg(not(target_feature = "avx"))]
            core::arch::asm!("shufps {0}, {0}, 0", inout(xmm_reg) self, options(pure, nomem, nostack, preserves_flags));
            #[cfg(target_feature = "avx")]
            core::arch::asm!("vshufps {0}, {0}, {0}, 0", inout(xmm_reg) self, options(pure, nomem, nostack, preserves_flags));
        }
        self
    }
}

impl Choice<f32> for usize {
    #[inline(always)]
    fn search(x: f32, bounds: [f32; 3], count: usize) -> Self {
        Self::from(count > 0 && x >= bounds[0])
            + Self::from(count > 1 && x >= bounds[1])
            + Self::from(count > 2 && x >= bounds[2])
    }
    #[inline(always)]
    fn masks(self) -> [bool; 3] {
        [self >= 1, self >= 2, self >= 3]
    }
    #[inline(always)]
    fn equals(self, entry: usize) -> bool {
        self == entry
    }
    #[inline(always)]
    fn to_number(self) -> f32 {
        [0.0, 1.0, 2.0, 3.0][self & 3]
    }
    // One load of the table in memory.
    #[inline(always)]
    fn look_up(self, table: &[f32; 4]) -> f32 {
        table[self & 3]
    }
    #[inline(always)]
    fn look_up_four(self, upper: bool, table: &Shared, four: usize) -> [f32; 4] {
        let entry = (self & 3) + 4 * Self::from(upper);
        table.rows.0[entry][four]
    }
    #[inline(always)]
    fn look_up_three(self, table: &[f32; 4]) -> f32 {
        table[self & 3]
    }
    #[inline(always)]
    fn look_up_half(self, table: &[f32; 2]) -> f32 {
        table[self >> 1 & 1]
    }
}
