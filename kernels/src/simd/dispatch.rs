//! Run-time dispatch: the only place that picks a backend.
#![allow(
    unsafe_code,
    reason = "calls into functions of target features that a `Level` proves present"
)]

use super::columns::{Columns, Naming, Row};
use super::lanes::Lanes;
use super::portable::{FUSES, Portable};
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
use super::{avx2::Avx2, avx512::Avx512, pair::Pair};
use core::fmt;
use wide::f32x8;
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
use {
    core::{arch::asm, mem::MaybeUninit},
    wide::f32x16,
};

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
cpufeatures::new!(avx2_fma, "avx2", "fma");
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
cpufeatures::new!(
    avx512, "avx2", "fma", "avx512f", "avx512vl", "avx512dq", "avx512bw"
);
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
cpufeatures::new!(avx, "avx");

/// Zeroes the upper halves of the vector registers, before code of a plain build.
///
/// A host may call with dirty upper halves (code for AVX ought to end in `vzeroupper`, and some does not). Every legacy SSE
/// instruction then merges with the upper half of its register, or the first one saves all of them, for 120 ns.
#[inline(always)]
pub(crate) fn clean_upper_halves() {
    // A build for AVX has no legacy SSE instructions.
    #[cfg(all(
        any(target_arch = "x86", target_arch = "x86_64"),
        not(target_feature = "avx")
    ))]
    if avx::get() {
        #[target_feature(enable = "avx")]
        fn clean() {
            #[cfg(target_arch = "x86")]
            use core::arch::x86::_mm256_zeroupper;
            #[cfg(target_arch = "x86_64")]
            use core::arch::x86_64::_mm256_zeroupper;
            _mm256_zeroupper();
        }
        // SAFETY: the CPU has AVX.
        unsafe { clean() }
    }
}

/// Instruction set that this CPU has; a value is proof that the instructions exist.
///
/// ```
/// use hairis::simd::Level;
/// println!("eight lanes run on {}", Level::detect());
/// assert!(Level::available().any(|level| level == Level::portable()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level(Kind);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Portable,
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    Avx2,
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    Avx512,
}

/// True in builds of developers that compile models for the portable level alone, in half the time: see CONTRIBUTING.md.
const PORTABLE_ALONE: bool = cfg!(hairis_portable_alone);

impl Level {
    /// Returns the best level of this CPU. The level is detected once; later calls are a load and a compare.
    #[inline(always)]
    #[must_use]
    pub fn detect() -> Self {
        if PORTABLE_ALONE {
            return Self::portable();
        }
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        {
            if avx512::get() {
                return Self(Kind::Avx512);
            }
            if avx2_fma::get() {
                return Self(Kind::Avx2);
            }
        }
        Self::portable()
    }

    /// Returns the level of eight lanes through `wide`, in the instruction set that the program was compiled for.
    #[inline(always)]
    #[must_use]
    pub const fn portable() -> Self {
        Self(Kind::Portable)
    }

    /// Returns every level of this CPU, with the portable level first and the best level last.
    #[inline]
    pub fn available() -> impl Iterator<Item = Self> {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        let more = [
            avx2_fma::get().then_some(Self(Kind::Avx2)),
            avx512::get().then_some(Self(Kind::Avx512)),
        ];
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        let more: [Option<Self>; 0] = [];
        let more = more.into_iter().flatten().filter(|_| !PORTABLE_ALONE);
        core::iter::once(Self::portable()).chain(more)
    }

    /// Returns the name of the instruction set, for reports: `avx2+fma`, `avx512`, or the one that the program was compiled for.
    #[inline]
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self.0 {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Kind::Avx2 => "avx2+fma",
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Kind::Avx512 => "avx512",
            Kind::Portable => PORTABLE,
        }
    }

    /// Returns true if `mul_add` rounds once on this level. Levels for which `fuses` is equal give the same bits.
    #[inline]
    #[must_use]
    pub const fn fuses(self) -> bool {
        match self.0 {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Kind::Avx2 | Kind::Avx512 => true,
            Kind::Portable => FUSES,
        }
    }
}

/// Name of the instruction set that `wide` was compiled for.
const PORTABLE: &str = if cfg!(all(target_feature = "avx", target_feature = "fma")) {
    "wide (avx+fma)"
} else if cfg!(target_feature = "avx") {
    "wide (avx)"
} else if cfg!(target_feature = "sse2") {
    "wide (sse2)"
} else if cfg!(all(target_arch = "aarch64", target_feature = "neon")) {
    "wide (neon)"
} else if cfg!(target_feature = "simd128") {
    "wide (simd128)"
} else {
    "wide (scalar)"
};

impl fmt::Display for Level {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Computation over eight lanes of any backend, for [`Level::run`].
///
/// ```
/// use hairis::simd::f32x8;
/// use hairis::simd::{Broadcast, Kernel, Lanes, Level};
/// use hairis::model::math;
///
/// /// The arc tangent of eight numbers in `[-1, 1]`.
/// struct Atan<'a>(&'a f32x8);
///
/// impl Kernel for Atan<'_> {
///     type Output = f32x8;
///
///     #[inline(always)]
///     fn run<L: Lanes<Stored = f32x8>>(self) -> f32x8 {
///         math::atan_unit::<L>(self.0.lanes()).store()
///     }
/// }
///
/// let angles = Level::detect().run(Atan(&f32x8::splat(1.0)));
/// assert!((angles.to_array()[7] - core::f32::consts::FRAC_PI_4).abs() < 1e-6);
/// ```
pub trait Kernel {
    /// Result of the computation.
    type Output;

    /// True if the kernel is compiled for the registers of AVX-512. With twice as many registers, evaluation and sampling gain 5 %,
    /// while a kernel that mostly writes loses 25 %.
    const MANY_REGISTERS: bool = true;

    /// Computes the result on the lanes `L`. Mark this function and every function it calls `#[inline(always)]`, so that the
    /// dispatched function contains no call.
    fn run<L: Lanes<Stored = f32x8>>(self) -> Self::Output;
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
#[target_feature(enable = "avx2,fma")]
fn run_avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Avx2>()
}

// Packets of eight use AVX2 here, too, compiled for twice the registers.
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
#[target_feature(enable = "avx2,fma,avx512f,avx512vl,avx512dq,avx512bw")]
fn run_avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Avx2>()
}

// Inlined, because a call costs 4 to 20 % more instructions. Not in tests, which take longer to compile than to run: there each
// caller would hold a copy of the model in every codegen unit.
#[cfg_attr(debug_assertions, inline(never))]
#[cfg_attr(not(debug_assertions), inline(always))]
fn run_portable<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Portable<FUSES>>()
}

/// Aligns the frame of the function that this is inlined into to the size of a register.
///
/// The compiler aligns frames for variables, but not for registers that it saves there. In a frame at an odd multiple of 16 bytes
/// every second of them would lie across two cache lines. Slices of hits then took up to 15 % longer (AMD Zen 3), for a caller whose
/// stack happened to be that deep.
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
#[inline(always)]
fn align_frame<Register>() {
    let register = MaybeUninit::<Register>::uninit();
    if cfg!(not(miri)) {
        // SAFETY: there is no code.
        unsafe {
            asm!("/* {} */", in(reg) &raw const register, options(readonly, nostack, preserves_flags));
        }
    }
}

/// Functions that compute the rows of an instruction set.
macro_rules! rows {
    ($($(#[$meta:meta])* $name:ident $method:ident $Lanes:ty, $W:literal $(, frame of $Register:ty)?;)*) => { $(
        $(#[$meta])*
        unsafe fn $name<R: Row<I, N>, const I: usize, const N: usize>(row: R, columns: &Columns<'_, I, N>, at: usize) {
            $(align_frame::<$Register>();)?
            // SAFETY: the caller's.
            unsafe { columns.$method::<R, $Lanes, $W>(row, at) };
        }
    )* };
}
rows! {
    /// Inlined like [`run_portable`].
    #[cfg_attr(debug_assertions, inline(never))]
    #[cfg_attr(not(debug_assertions), inline(always))]
    eight_portable packet Portable<FUSES>, 8;
}
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
rows! {
    /// Computes one packet: the rest of a longer slice, or all of a short one. It has no loop, before which the compiler would
    /// expand all constants in memory.
    #[target_feature(enable = "avx2,fma")]
    eight_avx2 packet Avx2, 8, frame of f32x8;
    #[target_feature(enable = "avx2,fma")]
    rows_avx2 packets Avx2, 8, frame of f32x8;
    #[target_feature(enable = "avx2,fma,avx512f,avx512vl,avx512dq,avx512bw")]
    rows_avx512 packets Avx512, 16, frame of f32x16;
    #[target_feature(enable = "avx2,fma")]
    pairs_avx2 packets Pair<Avx2>, 16, frame of f32x8;
    #[target_feature(enable = "avx2,fma,avx512f,avx512vl,avx512dq,avx512bw")]
    pairs_avx512 packets Pair<Avx512>, 32, frame of f32x16;
}

impl Level {
    /// Runs `kernel` on eight lanes of this instruction set, and returns its output.
    #[inline(always)]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        self.run_into(kernel, |output| output)
    }

    /// Runs `kernel` and wraps its output, in each branch, so that the output is written to the place of the result.
    #[inline(always)]
    pub(crate) fn run_into<K: Kernel, T>(self, kernel: K, wrap: impl Fn(K::Output) -> T) -> T {
        if PORTABLE_ALONE {
            return wrap(run_portable(kernel));
        }
        match self.0 {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            // SAFETY: a `Level` of this kind is made only where these features were found.
            Kind::Avx512 if K::MANY_REGISTERS => wrap(unsafe { run_avx512(kernel) }),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            // SAFETY: as above.
            Kind::Avx2 | Kind::Avx512 => wrap(unsafe { run_avx2(kernel) }),
            Kind::Portable => {
                clean_upper_halves();
                wrap(run_portable(kernel))
            }
        }
    }

    /// Runs `row` over columns, with `I` numbers in and `N` out. Unless all columns are of one length, nothing is written. If
    /// columns are [`OPTIONAL`](Row::OPTIONAL), those that differ in length from the first input are left out instead.
    ///
    /// Rows are computed in packets as wide as the instruction set allows, two at a time, and the rest in narrower packets.
    #[inline]
    pub fn run_rows<R: Row<I, N>, const I: usize, const N: usize>(
        self,
        row: R,
        inputs: [&[f32]; I],
        outputs: &mut [&mut [f32]; N],
    ) {
        if R::OPTIONAL {
            self.run_columns(row, &Columns::some(&inputs, outputs));
            return;
        }
        let outputs = outputs.each_mut().map(|column| &mut **column);
        if let Some(columns) = Naming::new(&inputs).output(0, Some(outputs)).all() {
            self.run_columns(row, &columns);
        }
    }

    /// Runs `row` over columns of one length.
    #[inline(always)]
    pub(crate) fn run_columns<R: Row<I, N>, const I: usize, const N: usize>(
        self,
        row: R,
        columns: &Columns<'_, I, N>,
    ) {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        if !PORTABLE_ALONE && self.0 != Kind::Portable {
            let mut done = 0;
            if self.0 == Kind::Avx512 {
                // SAFETY: a `Level` of this kind is made only where these features were found; there are as many packets.
                done = if R::PAIRS {
                    columns.in_packets::<32>(done, |columns, packets| unsafe {
                        pairs_avx512(row, columns, packets)
                    })
                } else {
                    columns.in_packets::<16>(done, |columns, packets| unsafe {
                        rows_avx512(row, columns, packets)
                    })
                };
            }
            // SAFETY: as above, and a level with AVX-512 has those of AVX2.
            done = if R::PAIRS {
                columns.in_packets::<16>(done, |columns, packets| unsafe {
                    pairs_avx2(row, columns, packets)
                })
            } else {
                columns.in_packets::<8>(done, |columns, packets| unsafe {
                    rows_avx2(row, columns, packets)
                })
            };
            // SAFETY: as above; there are eight rows.
            columns.in_eights(done, |columns, at| unsafe { eight_avx2(row, columns, at) });
            return;
        }
        // SAFETY: there are eight rows.
        columns.in_eights(0, |columns, at| unsafe {
            eight_portable(row, columns, at);
        });
    }
}
