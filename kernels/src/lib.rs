//! Hair scattering, evaluated and sampled eight lanes at a time, without std and without an allocator.
//!
//! [`Published`] is the model of Sadeghi et al. 2010 as Ou et al. 2012 state it, with the importance sampler published there.
//! [`Matched`] is the same model with a sampler of lower variance. Their bells are Gaussians ([`Gaussian`]) or any other
//! [`Bell`](model::Bell); the all-Cauchy variant is in the crate `hairis-variants`. Other scattering models implement [`LobeModel`](model::LobeModel), once
//! over [`Lanes`](simd::Lanes); scalar calls, eight lanes, run-time dispatch and slices follow.
//!
//! ```
//! use glam::Vec3;
//! use hairis::{FiberFrame, Gaussian, HairParams, Material, Published};
//!
//! let hair = Material::new(&Published(Gaussian), &HairParams::brown()); // once per material
//! let frame = FiberFrame::from_tangent(Vec3::new(0.1, 0.9, 0.2)); // once per hit, root to tip
//! let bsdf = hair.prepare(frame.to_local(Vec3::new(0.6, 0.0, 0.8))); // towards the viewer
//!
//! let sample = bsdf.sample([0.3, 0.6, 0.9]).expect("not along the fibre"); // once per path
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
//! | both in one | hit and direction | slices of hits: [`Material::eval_hits`], [`Material::sample_hits`]; a material per hit: [`MaterialTable`](columns::MaterialTable) |
//!
//! # Direct light by multiple importance sampling
//!
//! Both techniques at one hit, with the balance heuristic: a direction of the light, weighed by `cos theta_i` over the sum of both
//! densities, and one of the BSDF, whose `weight` is multiplied by its share. Under light of radiance 1 from everywhere the sum is
//! the albedo:
//!
//! ```
//! use core::f32::consts::PI;
//! use glam::Vec3;
//! use hairis::{Conserving, FiberFrame, Gaussian, HairParams, Matched, Material, random};
//! # use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
//! # let mut rng = ChaCha8Rng::seed_from_u64(1);
//!
//! const PDF_LIGHT: f32 = 0.25 / PI;
//! fn from_light([_, u, v]: [f32; 3]) -> Vec3 {
//!     let (sin, phi) = (2.0 * u - 1.0, 2.0 * PI * v);
//!     let cos = (1.0 - sin * sin).sqrt();
//!     Vec3::new(sin, cos * phi.cos(), cos * phi.sin())
//! }
//!
//! let hair = Material::new(&Conserving(Matched::new(Gaussian)), &HairParams::brown());
//! let bsdf = hair.prepare(Vec3::new(0.6, 0.0, 0.8));
//! let (mut red, n) = (0.0, 4096);
//! for _ in 0..n {
//!     let wi = from_light(random::xi(&mut rng));
//!     let eval = bsdf.eval_pdf(wi);
//!     red += eval.value[0] * FiberFrame::cos_theta(wi) / (PDF_LIGHT + eval.pdf);
//!     if let Some(sample) = bsdf.sample(random::xi(&mut rng)) {
//!         red += sample.weight[0] * sample.pdf / (PDF_LIGHT + sample.pdf);
//!     }
//! }
//! let albedo: f32 = bsdf.albedo().0.iter().map(|lobe| lobe[0]).sum();
//! assert!((red / n as f32 / albedo - 1.0).abs() < 0.05);
//!
//! // The same in eight lanes: a discarded lane has weight 0.
//! use hairis::{Vec3x8, f32x8};
//! let (mut red, pdf_light) = (f32x8::ZERO, f32x8::splat(PDF_LIGHT));
//! for _ in 0..n / 8 {
//!     let wi = Vec3x8::from(core::array::from_fn(|_| from_light(random::xi(&mut rng))));
//!     let eval = bsdf.eval_pdf8(&wi);
//!     red += eval.value[0] * wi.cos_theta() / (pdf_light + eval.pdf);
//!     let sample = bsdf.sample8(&random::xi8(&mut rng));
//!     red += sample.weight[0] * sample.pdf / (pdf_light + sample.pdf);
//! }
//! assert!((red.reduce_add() / n as f32 / albedo - 1.0).abs() < 0.05);
//! ```
//!
//! # Conventions
//!
//! - **Frame.** A fibre has the frame (u, v, w): u along it from root to tip, v and w across. A direction is
//!   `(sin theta, cos theta cos phi, cos theta sin phi)` in it, so that `theta`, in `[-pi/2, pi/2]`, is measured from
//!   the normal plane. Vectors hold u, v, w in `x`, `y`, `z`. Both directions point away from the fibre.
//! - **Directions.** `wo` is given (towards the viewer), `wi` is sampled (towards the light).
//! - **Relative angles.** `phi = phi_o - phi_i`, `theta_h = (theta_i + theta_o) / 2`, `theta_d = (theta_o - theta_i) / 2`.
//! - **Measures.** `L_o` is the integral of `L_i S cos theta_i` over `wi`. `eval` is S without the cosine; `pdf` is per
//!   steradian; `weight` is `S cos theta_i / pdf`. Angles are radians.
//! - **Lanes.** A lane is one sample: of the one shading point of a [`Bsdf`], or of the shading point in the same lane
//!   of a [`Bsdf8`]. Lanes never mix.
//! - **Totality.** Parameters are checked once, by [`HairParams::new`]. After that nothing fails: for every finite
//!   input, results are finite and not negative. Directions within [`GRAZING`](model::GRAZING) of the axis have value and density 0,
//!   and a sample there is discarded. It counts; do not draw it again.
//! - **NaN and infinity.** A direction that is not finite is black. With such a component in `wo` every value, density and albedo
//!   is 0 and every sample is discarded. With one in `wi` value and density are 0. With NaN among the uniform numbers the
//!   sample is discarded: value, density and weight are 0 and the slot is -1; its direction may be NaN. (An infinite number
//!   discards it, or counts as the end of the range.) The rule holds for every model and entry point (test
//!   `inputs_that_are_no_numbers_are_black`).
//! - **Energy.** The model is reciprocal but does not conserve energy. Before path tracing, wrap it in [`Conserving`], or scale
//!   the material by [`Material::conserving_scale`] through [`HairParams::scaled`].
//! - **Bits.** Results depend on whether a level fuses multiply and add ([`Level::fuses`](simd::Level::fuses)), in the last bits, and on
//!   nothing else of the machine or the build. What takes no level, scalar calls and frames, never fuses. This needs IEEE
//!   single precision: x87 arithmetic (`i586`) rounds otherwise.
//!
//! # Signs and frames elsewhere
//!
//! | renderer | along the fibre | how its values translate |
//! |---|---|---|
//! | Cycles (Hair BSDF) | - | `alpha` is minus Offset, `beta` is Roughness U; its R stretches `phi` by Roughness V (use 1) and is cut at `|phi|` = 90 degrees, its TT at the back half; its value equals its pdf |
//! | Mitsuba 3 (`hair`) | y | with y from root to tip `scale_tilt` is `alpha_R` of the published model (+5 degrees peak at `theta_i + theta_o` = +10), and minus the `tilt` of Chiang's; its `eval` includes the cosine |
//! | pbrt-v4 | x | a model of its own (Chiang et al. 2016) |
//!
//! # What this crate does not do
//!
//! It traces no rays, reads no files, and draws no random numbers except through [`random`]. Multiple scattering is the
//! path tracer's task. Spectral hosts take the lobes without their colours from [`Bsdf::lobes`].
#![no_std]
#![warn(clippy::missing_inline_in_public_items)]

pub mod columns;
mod frame;
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
