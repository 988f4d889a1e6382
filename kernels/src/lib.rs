//! Hair scattering, evaluated and sampled eight lanes at a time, without std and without an allocator.
//!
//! [`Published`] is the model of Sadeghi et al. 2010 as Ou et al. 2012 state it, with the importance sampler published there, and
//! [`Matched`] is the same model with a sampler of lower variance. Their bells are Gaussians ([`Gaussian`]) or any other
//! [`Bell`](model::Bell); the all-Cauchy variant is in the crate `hairis-variants`. Other scattering models implement
//! [`LobeModel`](model::LobeModel) once over [`Lanes`](simd::Lanes), and get scalar calls, eight lanes, run-time dispatch and calls
//! on columns from it.
//!
//! ```
//! use glam::Vec3;
//! use hairis::{FiberFrame, Gaussian, HairParams, Material, Published};
//!
//! // Once per material.
//! let hair = Material::new(&Published(Gaussian), &HairParams::brown());
//! // Once per hit: the tangent from root to tip, and the direction towards the viewer.
//! let frame = FiberFrame::from_tangent(Vec3::new(0.1, 0.9, 0.2));
//! let bsdf = hair.prepare(frame.to_local(Vec3::new(0.6, 0.0, 0.8)));
//! // Once per path: a direction towards the light.
//! let sample = bsdf.sample([0.3, 0.6, 0.9]).expect("not along the fibre");
//! let towards_light = frame.to_world(sample.wi);
//! assert!(towards_light.is_normalized() && sample.weight[0] > 0.0);
//! ```
//!
//! # From parameters to a sample
//!
//! | step | once per | call |
//! |---|---|---|
//! | describe | material | [`HairDesc`](params::HairDesc) and [`HairParams::new`], a preset, or [`HairParams::from_artist`] |
//! | build | material | [`Material::new`]; eight different ones: [`Material8::pack`] |
//! | prepare | hit | [`Material::prepare`]; eight hits: [`Material::prepare8`], [`Material8::prepare8`] |
//! | evaluate, sample | direction | [`Bsdf::eval_pdf`], [`Bsdf::sample`]; eight directions at one hit: [`Bsdf::eval_pdf8`], [`Bsdf::sample8`]; one at each of eight hits: [`Bsdf8::eval_pdf8`], [`Bsdf8::sample8`]; columns: [`Bsdf::eval_columns`], [`Bsdf::sample_columns`] |
//! | both in one | hit and direction | [`Material::eval_hit`], [`Material::sample_hit`]; slices of hits: [`Material::eval_hits`], [`Material::sample_hits`], [`Material::eval_sample_hits`]; a material per hit: [`MaterialTable`](columns::MaterialTable) |
//!
//! The [`guide`] shades a hit with light sampling, chooses models and samplers, and embeds the crate in other hosts.
//!
//! # Conventions
//!
//! - **Frame.** A fibre has the frame (u, v, w): u along the fibre from root to tip, v and w across. In this frame a direction is
//!   `(sin theta, cos theta cos phi, cos theta sin phi)`, so that `theta`, in `[-pi/2, pi/2]`, is measured from the normal plane.
//!   Vectors hold u, v, w in `x`, `y`, `z`. Both directions point away from the fibre.
//! - **Directions.** `wo` is given (towards the viewer), and `wi` is sampled (towards the light). Both are unit vectors: in builds
//!   with debug assertions scalar calls reject a `wi` of another length, while [`Material::prepare`] accepts a `wo` of any length.
//! - **Relative angles.** `phi = phi_o - phi_i`, `theta_h = (theta_i + theta_o) / 2`, `theta_d = (theta_o - theta_i) / 2`.
//! - **Measures.** `L_o` is the integral of `L_i S cos theta_i` over `wi`. `eval` is S without the cosine, `pdf` is per
//!   steradian, and `weight` is `S cos theta_i / pdf`. Angles are radians, and colours linear RGB.
//! - **Lanes.** A lane is one sample, of the shading point of a [`Bsdf`] or of the shading point in the same lane of a [`Bsdf8`].
//!   Lanes never mix.
//! - **Totality.** [`HairParams::new`] rejects invalid parameters, so that later calls return errors only for slices of different
//!   lengths and for indices without a material. For every finite input, results are finite and not negative. Directions within
//!   [`GRAZING`](model::GRAZING) of the axis have value and density 0, and a sample there is discarded. A discarded sample counts,
//!   so do not draw it again.
//! - **NaN and infinity.** Non-finite directions evaluate to zero. With a non-finite `wo`, or a NaN among the random numbers, the
//!   sample is discarded: value, density and weight are 0, the slot is -1, and the direction may be NaN. An infinite random number
//!   discards the sample or counts as the end of the range. The rule holds for every model and entry point (test
//!   `inputs_that_are_no_numbers_are_black`).
//! - **Energy.** The model is reciprocal but does not conserve energy, so wrap it in [`Conserving`] before path tracing
//!   ([choices](guide::energy)).
//! - **Bits.** The last bits of results depend on whether a level fuses multiply and add ([`Level::fuses`](simd::Level::fuses)), and
//!   on nothing else of the machine or the build. Scalar calls and frames use no level and never fuse. The promise needs IEEE single
//!   precision, because x87 arithmetic (`i586`) rounds differently.
//!
//! # Limits
//!
//! The crate traces no rays, reads no files, and draws no random numbers except through [`random`]. Multiple scattering is the
//! path tracer's task. Spectral hosts take the lobes without their colours from [`Bsdf::lobes`].
#![no_std]
#![warn(clippy::missing_inline_in_public_items)]

pub mod columns;
pub mod dual_scattering;
mod frame;
#[cfg(any(doc, doctest))]
pub mod guide;
mod hair;
mod handle;
pub mod model;
pub mod params;
pub mod random;
pub mod resample;
pub mod simd;

pub use frame::{FiberFrame, FiberFrame8, Vec3x8};
pub use hair::{Gaussian, Matched, Published};
pub use handle::{Bsdf, Bsdf8, Material, Material8};
pub use model::{Conserving, Eval, Eval8, Hit, Hit8, Lobe, LobeMask, PerLobe, Sample, Sample8};
pub use params::{HairParams, ParamError};
pub use simd::f32x8;

/// Examples of the package's README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
#[derive(Debug)]
pub struct Readme;
