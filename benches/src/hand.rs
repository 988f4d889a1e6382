//! Kernels written by hand for one model and one task each: the bound that a port of the published model could reach.
//!
//! They call nothing of `hairis`; only the coefficients of a Gaussian are the same. They keep the stated accuracy, next to `phi = pi` as
//! well, and nothing else of what its kernels promise: no lobe masks, no rules for NaN or for the axis, no slots, no values with
//! samples. Directions have unit length.

#![allow(
    unsafe_code,
    reason = "functions of instruction sets that `Set` has checked; columns of one length, checked per call"
)]

mod kernel;
mod two;
mod vector;

pub use kernel::Constants;

use std::arch::is_x86_feature_detected as detected;
use two::Two;
use vector::{Avx2, Avx512, Sse2, Vector as _};

/// An instruction set that this CPU has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Set(Kind);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Sse2,
    Avx2,
    Avx512,
}

impl Set {
    /// The kernels for a level of `hairis`: SSE2 for the portable one.
    #[must_use]
    pub fn of(level: hairis::simd::Level) -> Option<Self> {
        match level.name() {
            "avx512" if detected!("avx512f") => Some(Self(Kind::Avx512)),
            "avx2+fma" if detected!("avx2") && detected!("fma") => Some(Self(Kind::Avx2)),
            "wide (sse2)" => Some(Self(Kind::Sse2)),
            _ => None,
        }
    }
}

/// The loops of an instruction set: `Slice` at a time over columns whose length is a multiple of its lanes.
macro_rules! kernels {
    ($($module:ident $features:literal $Slice:ty, $Eight:ty;)*) => { $(
        mod $module {
            use super::*;

            kernels! { @ $features
                eval $Slice, load, 4 kernel::eval::<$Slice, CAUCHY>;
                eval8 $Eight, load_fresh, 4 kernel::eval::<$Eight, CAUCHY>;
                sample $Slice, load, 7 kernel::sample::<$Slice>;
                sample8 $Eight, load_fresh, 7 kernel::sample::<$Eight>;
            }
        }
    )* };
    (@ $features:literal $($name:ident $V:ty, $load:ident, $n:literal $row:expr;)*) => { $(
        /// # Safety
        ///
        /// The CPU has the features, and every column `len` numbers.
        #[target_feature(enable = $features)]
        pub(super) unsafe fn $name<const CAUCHY: bool>(c: &Constants, from: [*const f32; 3], to: [*mut f32; $n], len: usize) {
            let mut at = 0;
            while at < len {
                // SAFETY: the caller's.
                unsafe {
                    let [x, y, z] = from;
                    let row = $row(c, [<$V>::$load(x.add(at)), <$V>::$load(y.add(at)), <$V>::$load(z.add(at))]);
                    let mut i = 0;
                    while i < $n {
                        row[i].store(to[i].add(at));
                        i += 1;
                    }
                }
                at += <$V>::LANES;
            }
        }
    )* };
}
kernels! {
    sse2 "sse2" Two<Sse2>, Two<Sse2>;
    avx2 "avx2,fma" Two<Avx2>, Avx2;
    avx512 "avx2,fma,avx512f,avx512vl,avx512dq,avx512bw" Two<Avx512>, Avx2;
}

macro_rules! dispatch {
    ($set:ident, $name:ident($($argument:expr),*)) => {
        match $set.0 {
            Kind::Sse2 => sse2::$name::<CAUCHY>($($argument),*),
            Kind::Avx2 => avx2::$name::<CAUCHY>($($argument),*),
            Kind::Avx512 => avx512::$name::<CAUCHY>($($argument),*),
        }
    };
}

/// The functions of all instruction sets that take columns.
macro_rules! columns {
    ($($(#[$meta:meta])* $name:ident<$n:literal> in $inner:ident;)*) => { $(
        $(#[$meta])*
        ///
        /// # Panics
        ///
        /// If the columns are not of one length, or it is no multiple of 32.
        #[inline(always)]
        pub fn $name<const CAUCHY: bool>(self, c: &Constants, from: [&[f32]; 3], to: [&mut [f32]; $n]) {
            let len = from[0].len();
            assert!(len.is_multiple_of(32), "{len} rows");
            for column in from {
                assert_eq!(column.len(), len, "columns of one length");
            }
            for column in &to {
                assert_eq!(column.len(), len, "columns of one length");
            }
            let from = from.map(|column| column.as_ptr());
            let to = to.map(|column| column.as_mut_ptr());
            // SAFETY: a `Set` is made where the CPU has the features; the lengths were checked.
            unsafe { dispatch!(self, $inner(c, from, to, len)) }
        }
    )* };
}
/// The functions of all instruction sets that take eight rows.
macro_rules! eights {
    ($($(#[$meta:meta])* $name:ident<$n:literal>;)*) => { $(
        $(#[$meta])*
        #[inline(always)]
        pub fn $name<const CAUCHY: bool>(self, c: &Constants, from: [&[f32; 8]; 3], to: [&mut [f32; 8]; $n]) {
            let from = from.map(|column| column.as_ptr());
            let to = to.map(|column| column.as_mut_ptr());
            // SAFETY: a `Set` is made where the CPU has the features; there are eight rows.
            unsafe { dispatch!(self, $name(c, from, to, 8)) }
        }
    )* };
}
impl Set {
    columns! {
        /// Value and density of unit directions.
        eval<4> in eval;
        /// Direction, density and weight of samples: Gaussian bells alone.
        sample<7> in sample;
    }
    eights! {
        /// Value and density of eight unit directions.
        eval8<4>;
        /// Direction, density and weight of eight samples: Gaussian bells alone.
        sample8<7>;
    }
}
