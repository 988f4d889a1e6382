//! Conformance tests for scattering models written on [`hairis`]: one line instantiates them all.
//!
//! A model in a crate of its own takes this package as a dev-dependency and writes, in its tests:
//!
//! ```
//! use hairis::{Gaussian, HairParams, Published};
//! use hairis_conformance::{Claims, Materials, Subject};
//!
//! struct GaussianHair;
//!
//! impl Subject for GaussianHair {
//!     type Model = Published<Gaussian>;
//!
//!     fn model(&self) -> Self::Model {
//!         Published(Gaussian)
//!     }
//!
//!     fn materials(&self) -> Materials<Self> {
//!         vec![("brown", HairParams::brown()), ("white", HairParams::white())]
//!     }
//!
//!     fn claims(&self) -> Claims {
//!         Claims { reciprocal: Some(1e-4), ..Claims::default() }
//!     }
//! }
//!
//! hairis_conformance::conformance!(gaussian, GaussianHair);
//! # hairis_conformance::bounds::eval_is_reciprocal(&GaussianHair).unwrap();
//! ```
//!
//! The macro declares the module `gaussian` with a `#[test]` for each property:
//!
//! | test | property |
//! |---|---|
//! | `results_are_finite` | every finite input gives finite results that are not negative |
//! | `any_rounding_is_finite` | results are finite and not negative in every rounding mode, with denormals and without |
//! | `everyday_input_raises_no_exception` | unit directions raise neither invalid nor division by zero nor overflow in eight lanes and slices |
//! | `inputs_that_are_no_numbers_are_black` | NaN and infinite directions and numbers give 0, and discarded samples |
//! | `density_integrates_to_one` | each lobe's density, and that of all, integrates to the share of samples kept |
//! | `samples_follow_density` | chi-square test of random samples |
//! | `even_points_invert_density` | the cdf of samples of Sobol points is the integral of the density |
//! | `samples_agree_with_eval` | a sample's value, density and weight are those of its direction |
//! | `lanes_equal_scalar` | eight directions, hits and materials in lanes give the results of one lane |
//! | `lanes_permute` | permuted lanes permute the results |
//! | `levels_agree` | levels that fuse alike, packed and shared materials, give the same bits |
//! | `lobes_and_albedo_equal_scalar` | lobes and albedo in lanes are those of one lane; `h` matters only if the model claims to read it |
//! | `slices_equal_packets` | slices of every length and alignment give the bits of packets |
//! | `hits_equal_packets` | slices of hits give the bits of packets: evaluated, sampled or both at once, on one material and on tables, with columns left out |
//! | `resampling_is_unbiased` | resampled light against plain estimates, under five lights, partly hidden |
//! | `lobes_sum_to_value` | values and densities of lobes alone and together |
//! | `masks_select_lobes` | masked lobes neither scatter nor are sampled |
//! | `albedo_is_the_integral` | `albedo` against quadrature |
//! | `white_furnace` | white materials return all light, if claimed |
//! | `weights_are_bounded` | weights are below the bound that the subject states, if any |
//! | `eval_is_reciprocal` | S with its directions exchanged, if claimed |
//! | `agrees_with_reference` | agreement with the reference in double precision, if there is one |
//! | `lanes_are_inlined` | no level is much slower than portable lanes: all is inlined |
//!
//! All tests run on every level that the CPU has. Each property is also a function that returns an [`Outcome`].
//! `cargo test -- --nocapture` prints the largest error of each property beside the claim that states its tolerance, and the properties
//! of claims that the subject does not make.
//!
//! # Failures
//!
//! Properties that are not statistical draw packets of eight materials, hits, directions and numbers from strategies of [`proptest`].
//! Properties without a tolerance draw the ends of ranges, grazing hits and the axes more often than chance, and half of their materials
//! from [`Subject::any_material`], if the subject has it. A failure reports the worst case, and its [`case`](Failure::case) is the
//! smallest case that fails, as a block of code. Pasted into a test, the block fails again:
//!
//! ```
//! # use hairis::{Gaussian, HairParams, Published};
//! # use hairis_conformance::{Claims, Materials, Subject};
//! # struct GaussianHair;
//! # impl Subject for GaussianHair {
//! #     type Model = Published<Gaussian>;
//! #     fn model(&self) -> Self::Model {
//! #         Published(Gaussian)
//! #     }
//! #     fn materials(&self) -> Materials<Self> {
//! #         vec![("brown", HairParams::brown()), ("white", HairParams::white())]
//! #     }
//! # }
//! let subject = GaussianHair;
//! let outcome = {
//!     use glam::Vec3;
//!     use hairis::Hit;
//!     use hairis_conformance::{Case, Replay, Row, totality};
//!     let case = Case::new(|| Row {
//!         material: subject.materials().swap_remove(0).1,
//!         hit: Hit::new(Vec3::new(0.0, 1.0, 0.0), 0.0),
//!         wi: Vec3::new(1.0, 0.0, 0.0),
//!         xi: [0.0, 0.0, 0.0],
//!         tolerances: true,
//!     });
//!     totality::results_are_finite(&Replay::pasted(&subject, case))
//! };
//! assert!(outcome.is_ok());
//! ```
//!
//! The tests of [`conformance!`] also keep the seed of the case in the file `proptest-regressions/conformance.txt` of the package under
//! test, and run this case before all others. Add that file to the repository.
//!
//! Cases are the same in every run. The environment variable `HAIRIS_SEED`, a whole number, draws other cases.
//!
//! # Sizes
//!
//! Counts of cases are those of a run that checks every change, for example in CI: set `HAIRIS_CASES=1` there. Without the variable a run has
//! a quarter of the cases, which a person waits for, and `HAIRIS_CASES=10` draws ten times as many. [`cases()`] applies it to tests of
//! your own. The properties that integrate the density take two of seven hits per material in the usual size, slices have their shortest
//! and their longest lengths, and statistical bounds follow from the number of samples.
//!
//! # False alarms
//!
//! Two properties are random; the others compare numbers within bounds. Either repeats what looks wrong with other numbers, four times as
//! many, and fails if that looks wrong too:
//!
//! | property | looks wrong | fails again | a sound model fails |
//! |---|---|---|---|
//! | [`samples_follow_density`](chi_square::samples_follow_density) | 0.01 | 2e-4 | 2e-6 |
//! | [`resampling_is_unbiased`](resampling::resampling_is_unbiased) | 2e-3 | 2e-3 | 4e-6 |
//!
//! With 12 tests of the first and 6 of the second, those of kernels and variants, a round fails by chance 5 times in 100,000. The
//! repetition costs no power: a density or a mean that is wrong stands out by twice as many standard errors.
//!
//! A bound that is a little above the largest error of some seeds falls with others. Values, densities and samples therefore have bounds by
//! argument, [`Reference::error_bound`], which random points reach to .3 to .8. What has none (sums of lobes, distributions of angles,
//! albedos, reciprocity of hair) may be twice as far off with another seed than CI's, as no seed was: extrapolated from the worst cases of
//! 22 seeds, one such bound would fall in 5000 rounds as it is, and none in a billion when it is doubled.
//!
//! # Limits
//!
//! Quadrature may miss a peak of the density that is narrower than a degree if no sample falls there, unless [`Subject::edges`] names the
//! peak. Relative accuracy within 1e-3 rad of the axis is left to the model's own tests.

pub mod bounds;
mod cases;
pub mod chi_square;
pub mod comparison;
pub mod environment;
mod erased;
mod failure;
pub mod hits;
pub mod integral;
pub mod inversion;
pub mod lanes;
pub mod lobes;
mod mesh;
mod near;
pub mod not_numbers;
mod probe;
#[doc(hidden)]
#[expect(
    clippy::must_use_candidate,
    clippy::unwrap_used,
    reason = "tests and their support: a panic is how a test fails"
)]
pub mod published;
pub mod reference;
pub mod resampling;
pub mod sampling;
mod size;
pub mod slices;
pub mod speed;
pub mod statistics;
pub mod strategies;
mod subject;
pub mod totality;

pub use cases::{Case, Replay, Row};
pub use erased::ErasedSubject;
pub use erased::hits::HitsSubject;
pub use failure::{Failure, Outcome};
pub use hairis_reference::{LobeAt, Reference, ReferenceSample};
pub use proptest;
pub use size::{cases, is_full, is_kept};
pub use subject::{
    AnyMaterial, AsConserving, Claims, Expected, Materials, ParamsOf, Subject, Tolerance,
};

/// Declares a module with a `#[test]` for each property of a [`Subject`].
///
/// The subject is an expression that captures no variables: a unit struct, or a constant. A word after it leaves properties out:
///
/// - `but hits`: slices of hits and resampling, which take the longest to compile.
/// - `sampler`: the same, for a model with another sampler for the values of a model with every test, such as one with other constants.
///   Six properties depend on the sampler: density, chi-square, inversion, samples against evaluation, levels, and the reference. The
///   others are ignored; `cargo test -- --include-ignored` runs them.
#[macro_export]
macro_rules! conformance {
    ($name:ident, $subject:expr) => {
        $crate::conformance!(+[] $name, $subject, hits hits_equal_packets, resampling resampling_is_unbiased,);
    };
    ($name:ident, $subject:expr, but hits) => {
        $crate::conformance!(+[] $name, $subject,);
    };
    ($name:ident, $subject:expr, sampler) => {
        $crate::conformance!(+[ignore = "tested on the model with the same values: --include-ignored runs it"] $name, $subject,);
    };
    (+$attribute:tt $name:ident, $subject:expr, $($more:tt)*) => {
        $crate::conformance!(
            @$attribute $name, $subject,
            [
                integral density_integrates_to_one,
                chi_square samples_follow_density,
                inversion even_points_invert_density,
                sampling samples_agree_with_eval,
                lanes levels_agree,
                reference agrees_with_reference,
            ]
            [
                totality results_are_finite,
                environment any_rounding_is_finite,
                environment everyday_input_raises_no_exception,
                not_numbers inputs_that_are_no_numbers_are_black,
                lanes lanes_equal_scalar,
                lanes lanes_permute,
                lanes lobes_and_albedo_equal_scalar,
                slices slices_equal_packets,
                lobes lobes_sum_to_value,
                lobes masks_select_lobes,
                bounds albedo_is_the_integral,
                bounds white_furnace,
                bounds weights_are_bounded,
                bounds eval_is_reciprocal,
                speed lanes_are_inlined,
                $($more)*
            ]
        );
    };
    (
        @$attribute:tt $name:ident, $subject:expr,
        [$($module:ident $property:ident,)*] [$($other_module:ident $other:ident,)*]
    ) => {
        #[cfg(test)]
        mod $name {
            #[allow(unused_imports, reason = "the subject may be named by a path")]
            use super::*;
            $( $crate::conformance!(#[] $subject, $module $property); )*
            $( $crate::conformance!(#$attribute $subject, $other_module $other); )*
        }
    };
    (#[$($attribute:meta)?] $subject:expr, $module:ident $property:ident) => {
        #[test]
        $(#[$attribute])?
        fn $property() {
            let (subject, package) = (&$subject, env!("CARGO_MANIFEST_DIR"));
            let subject = $crate::Replay::kept(subject, package, module_path!());
            if let Err(failure) = $crate::$module::$property(&subject) {
                panic!("{failure}");
            }
        }
    };
}
