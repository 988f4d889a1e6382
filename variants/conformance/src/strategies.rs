//! Strategies that draw parameters, for [`Subject::any_material`](crate::Subject::any_material).
//!
//! ```
//! use hairis_conformance::proptest::prelude::*;
//! use hairis_conformance::{AnyMaterial, strategies};
//!
//! #[derive(Clone, Copy, Debug)]
//! struct Fiber {
//!     kd: [f32; 3],
//!     width: f32,
//! }
//!
//! fn any_fiber() -> BoxedStrategy<AnyMaterial<Fiber>> {
//!     let fields = (strategies::intensities(1e30), strategies::range([1e-3, 1.0]));
//!     fields.prop_map(|(kd, width)| Fiber { kd, width }.into()).boxed()
//! }
//! # let _ = any_fiber();
//! ```

use crate::probe::{narrow, run_seed};
use crate::size;
use crate::subject::AnyMaterial;
use glam::Vec3;
use hairis::HairParams;
use hairis::params::{HairDesc, MAX_WIDTH, MIN_WIDTH, Rule};
use proptest::array::uniform3;
use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::RngSeed;

/// Returns a configuration of `proptest` for the tests of a file. It runs [`cases`](crate::cases()) of them, which are the same in every run, and keeps
/// regressions beside the file, in `proptest-regressions`.
///
/// The environment variables `HAIRIS_SEED` and `HAIRIS_CASES` apply.
#[must_use]
pub fn config(file: &'static str, cases: usize) -> ProptestConfig {
    ProptestConfig {
        cases: u32::try_from(size::cases(cases)).unwrap_or(u32::MAX),
        rng_seed: RngSeed::Fixed(run_seed()),
        source_file: Some(file),
        ..ProptestConfig::default()
    }
}

/// Draws numbers of a closed range, its ends and 0 more often than chance. They are uniform in their logarithm if both ends are above 0.
///
/// - Domain: finite ends, the smaller first.
pub fn range([least, most]: [f32; 2]) -> impl Strategy<Value = f32> + Clone {
    let [lo, hi] = [least, most].map(f64::from);
    let is_log = lo > 0.0;
    let [from, to] = if is_log { [lo.ln(), hi.ln()] } else { [lo, hi] };
    let inside =
        (from..=to).prop_map(move |x| narrow(if is_log { x.exp() } else { x }).clamp(least, most));
    prop_oneof![6 => inside, 2 => select(vec![0.0_f32.clamp(least, most), least, most])]
}

/// Draws any finite numbers, with components of directions and numbers at which arithmetic tends to fail more often than chance.
pub fn finite() -> impl Strategy<Value = f32> + Clone {
    const SPECIAL: [f32; 14] = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        1e-5,
        0.999_999_94,
        2.0,
        f32::MAX,
        f32::MIN,
        f32::MIN_POSITIVE,
        1e-45,
        -1e-45,
        1e19,
        -1e-19,
    ];
    use proptest::num::f32::{NORMAL, SUBNORMAL, ZERO};
    prop_oneof![
        3 => -1.0..1.0_f32,
        2 => select(SPECIAL.to_vec()),
        2 => NORMAL | SUBNORMAL | ZERO,
    ]
}

/// Draws vectors whose components are [`finite`] numbers.
pub fn vectors() -> impl Strategy<Value = Vec3> + Clone {
    uniform3(finite()).prop_map(Vec3::from_array)
}

/// Draws finite numbers from 0 to `most`, of any size, with 0 and the largest more often than chance.
///
/// - Domain: `most` is at least 1.
pub fn intensity(most: f32) -> impl Strategy<Value = f32> + Clone {
    let awkward = vec![0.0, 1.0, f32::MIN_POSITIVE, 1e-40, most];
    prop_oneof![
        3 => 0.0..1.0_f32,
        2 => range([1e-38, most]),
        2 => select(awkward),
    ]
}

/// Draws three numbers of [`intensity`], as a linear RGB colour.
pub fn intensities(most: f32) -> impl Strategy<Value = [f32; 3]> + Clone {
    uniform3(intensity(most))
}

/// Draws any legal parameters of hair, a quarter of them with the same width everywhere.
///
/// # Panics
///
/// Panics if a rule rejects a number of its own range, when a case is drawn.
pub fn hair() -> impl Strategy<Value = AnyMaterial<HairParams>> {
    let width = || range([MIN_WIDTH, MAX_WIDTH]);
    let each = (uniform3(width()), width(), width());
    let equal = width().prop_map(|width| ([width; 3], width, width));
    let widths = prop_oneof![1 => equal, 3 => each];
    let (shift, azimuth) = (range(Rule::Shift.range()), range(Rule::Azimuth.range()));
    let centres = (uniform3(shift), azimuth);
    let rgb = || intensities(f32::MAX);
    let colors = (rgb(), rgb(), rgb(), intensity(f32::MAX));
    (widths, centres, colors).prop_map(|(widths, (alpha, phi_g), colors)| {
        let (beta, gamma_tt, gamma_g) = widths;
        let (i_r, i_tt, i_trt, i_g) = colors;
        let desc = HairDesc {
            alpha,
            beta,
            gamma_tt,
            gamma_g,
            phi_g,
            i_r,
            i_tt,
            i_trt,
            i_g,
        };
        let params = HairParams::new(&desc);
        let params =
            params.unwrap_or_else(|error| panic!("the ranges are those of the rules: {error}"));
        let code = format!("hairis::HairParams::new(&hairis::params::{desc:?}).unwrap()");
        AnyMaterial::new(params, code)
    })
}
