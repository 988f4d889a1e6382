//! Which instruction set runs: the only place that picks a backend at run time.
#![allow(unsafe_code, reason = "calls into functions of target features that a `Level` proves present")]

use crate::batch::rows::{self, Row};
use crate::model::{Eval8, Hit8, LobeEval8, Sample8};
use crate::{Broadcast, Gather8, Hit, Model, PerLobe, Vec3x, Vec3x8};
use core::fmt;
use wide::f32x8;

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
use crate::lanes::avx2::Avx2;
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
use crate::lanes::{avx512::Avx512, pair::Pair};

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
cpufeatures::new!(avx2_fma, "avx2", "fma");
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
cpufeatures::new!(avx512, "avx2", "fma", "avx512f", "avx512vl", "avx512dq", "avx512bw");
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
cpufeatures::new!(avx, "avx");

/// Zeroes the upper halves of the vector registers, before code of a plain build.
///
/// A host may call with them dirty (code for AVX ought to end in `vzeroupper`, and some does not). Every legacy SSE
/// instruction then merges with the upper half of its register, or the first one saves all of them, for 120 ns.
#[inline(always)]
pub(crate) fn clean_upper_halves() {
    // A build for AVX has no legacy SSE instructions.
    #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), not(target_feature = "avx")))]
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

/// An instruction set that this CPU has: a value is the proof.
///
/// ```
/// use hairis::Level;
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

impl Level {
    /// The best level of this CPU. The CPU is asked once; after that it is a load and a compare.
    #[inline(always)]
    #[must_use]
    pub fn detect() -> Self {
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

    /// Eight lanes through `wide`: what the program was compiled for, on every CPU that runs it.
    #[inline(always)]
    #[must_use]
    pub const fn portable() -> Self {
        Self(Kind::Portable)
    }

    /// Every level of this CPU, the portable one first and the best one last.
    #[inline]
    pub fn available() -> impl Iterator<Item = Self> {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        let more = [avx2_fma::get().then_some(Self(Kind::Avx2)), avx512::get().then_some(Self(Kind::Avx512))];
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        let more: [Option<Self>; 0] = [];
        core::iter::once(Self::portable()).chain(more.into_iter().flatten())
    }

    /// Name of the instruction set, for reports: `avx2+fma`, `avx512`, or what the program was compiled for.
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

    /// Whether `mul_add` rounds once on this level. Levels that agree in this give the same bits.
    #[inline]
    #[must_use]
    pub const fn fuses(self) -> bool {
        match self.0 {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Kind::Avx2 | Kind::Avx512 => true,
            Kind::Portable => crate::lanes::portable::FUSES,
        }
    }
}

/// What `wide` was compiled for.
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

/// Declares an entry point: `body` over `L`, which is the portable lanes or the backend of `level`.
///
/// The constants `C` are read as `L` in `body`, so that one entry point serves one gather point and eight. Packets of
/// eight are of AVX2 on AVX-512, too, compiled for the set given: twice the registers, and constants that are read
/// by the instructions that use them, gain evaluation and sampling 5 %; preparation, which mostly writes, loses 25 %.
macro_rules! entry {
    (
        $(#[$meta:meta])*
        $name:ident$(<$H:ident>)?($($arg:ident: $type:ty),*) -> $out:ty, $body:ident,
        on AVX-512 $set:ident
    ) => {
        $(#[$meta])*
        #[inline]
        pub(crate) fn $name<M: Model, C: Constant $(, $H: Into<Hit8>)?>(level: Level, $($arg: $type),*) -> $out {
            match level.0 {
                #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
                Kind::Avx2 => entry!(@$body $(<$H>)?($($arg: $type),*) -> $out, avx2),
                #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
                Kind::Avx512 => entry!(@$body $(<$H>)?($($arg: $type),*) -> $out, $set),
                Kind::Portable => {
                    clean_upper_halves();
                    $body!(M, f32x8, C, $($arg),*)
                }
            }
        }
    };
    (@$body:ident $(<$H:ident>)?($($arg:ident: $type:ty),*) -> $out:ty, avx2) => {
        entry!(@$body $(<$H>)?($($arg: $type),*) -> $out, avx2 "avx2,fma")
    };
    (@$body:ident $(<$H:ident>)?($($arg:ident: $type:ty),*) -> $out:ty, avx512) => {
        entry!(@$body $(<$H>)?($($arg: $type),*) -> $out, avx512 "avx2,fma,avx512f,avx512vl,avx512dq,avx512bw")
    };
    (@$body:ident $(<$H:ident>)?($($arg:ident: $type:ty),*) -> $out:ty, $set:ident $features:literal) => {{
        #[target_feature(enable = $features)]
        fn $set<M: Model, C: Constant $(, $H: Into<Hit8>)?>($($arg: $type),*) -> $out {
            $body!(M, Avx2, C, $($arg),*)
        }
        // SAFETY: a `Level` of this kind is made only where these features were found.
        unsafe { $set::<M, C $(, $H)?>($($arg),*) }
    }};
}

/// Storage that every backend reads: `f32` or `f32x8`.
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
pub(crate) trait Constant: Broadcast<f32x8> + Broadcast<Avx2> + fmt::Debug {}
#[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
pub(crate) trait Constant: Broadcast<f32x8> + fmt::Debug {}
impl Constant for f32 {}
impl Constant for f32x8 {}

macro_rules! prepare {
    ($M:ty, $L:ty, $C:ty, $material:ident, $hits:ident) => {{
        let hits: Hit8 = $hits.into();
        let hit = Hit { wo: Vec3x::load(&hits.wo), h: Broadcast::<$L>::lanes(&hits.h) };
        Gather8 { inner: <$M>::prepare::<$L, $C>($material, hit) }
    }};
}
macro_rules! eval {
    ($M:ty, $L:ty, $C:ty, $gather:ident, $wi:ident) => {
        <$M>::eval::<$L, $C>($gather, Vec3x::load($wi)).store()
    };
}
macro_rules! lobes {
    ($M:ty, $L:ty, $C:ty, $gather:ident, $wi:ident) => {{
        let [r, tt, trt, glint] = <$M>::lobes::<$L, $C>($gather, Vec3x::load($wi)).0;
        PerLobe([r.store(), tt.store(), trt.store(), glint.store()])
    }};
}
macro_rules! sample {
    ($M:ty, $L:ty, $C:ty, $gather:ident, $xi:ident) => {
        <$M>::sample::<$L, $C>($gather, crate::lanes::lanes3($xi)).store()
    };
}

entry! {
    /// Eight gather points. The hits are made from what the caller has on the far side: what copies them is vector code.
    prepare8<H>(material: &M::Material<C>, hits: H) -> Gather8<M>, prepare, on AVX-512 avx2
}
entry! {
    /// Value and density of eight directions.
    eval8(gather: &M::Gather<C>, wi: &Vec3x8) -> Eval8, eval, on AVX-512 avx512
}
entry! {
    /// Each lobe's value, colour and density at eight directions.
    lobes8(gather: &M::Gather<C>, wi: &Vec3x8) -> PerLobe<LobeEval8>, lobes, on AVX-512 avx512
}
entry! {
    /// Eight sampled directions.
    sample8(gather: &M::Gather<C>, xi: &[f32x8; 3]) -> Sample8, sample, on AVX-512 avx512
}

/// The loop of a batch on the backend `$L` of `$W` lanes: whole packets, and then packets of eight.
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
macro_rules! batch_on {
    ($level:ident, $M:ty, $R:ty, $L:ty, $N:ident, $W:literal, $gather:ident, $inputs:ident, $outputs:ident, $name:ident, $features:literal) => {{
        #[target_feature(enable = $features)]
        fn $name<M: Model, R: Row<N>, const N: usize>(
            gather: &M::Gather<f32>,
            inputs: [&[[f32; $W]]; 3],
            outputs: &mut [&mut [[f32; $W]]; N],
        ) {
            rows::packets::<M, R, $L, f32, N, $W>(gather, inputs, outputs);
        }
        let done = rows::in_packets($inputs, $outputs, |inputs, outputs| {
            // SAFETY: a `Level` of this kind is made only where these features were found.
            unsafe { $name::<$M, $R, $N>($gather, inputs, outputs) }
        });
        rows::in_eights::<$M, $R, $N>($level, $gather, $inputs, $outputs, done);
    }};
}

/// `N` numbers for each three of a batch.
#[inline]
pub(crate) fn batch<M: Model, R: Row<N>, const N: usize>(
    level: Level,
    gather: &M::Gather<f32>,
    inputs: [&[f32]; 3],
    outputs: &mut [&mut [f32]; N],
) {
    match level.0 {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Kind::Avx2 => batch_on!(level, M, R, Pair<Avx2>, N, 16, gather, inputs, outputs, avx2, "avx2,fma"),
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Kind::Avx512 => {
            batch_on!(
                level,
                M,
                R,
                Pair<Avx512>,
                N,
                32,
                gather,
                inputs,
                outputs,
                avx512,
                "avx2,fma,avx512f,avx512vl,avx512dq,avx512bw"
            );
        }
        Kind::Portable => {
            rows::in_packets(inputs, outputs, |inputs, outputs| {
                rows::packets::<M, R, f32x8, f32, N, 8>(gather, inputs, outputs);
            });
        }
    }
}
