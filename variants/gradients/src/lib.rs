//! Derivatives of the models of hairis at slices of hits: by the parameters of the material, by both directions and by the offset.
//!
//! [`Gradients`] is the handle of a material. Its method [`eval_grad`](Gradients::eval_grad) takes one weight per result of each hit, and
//! returns the derivative of the weighted sum of all results. The reverse pass is generated when this package is built: each model is
//! traced to a graph ([`hairis-shaders`](https://docs.rs/hairis-shaders)), differentiated, and printed as Rust over lanes. On every
//! level, the lanes have the bits of that graph's interpreter.
//!
//! ```
//! use hairis::columns::HitColumns;
//! use hairis::{Gaussian, HairParams, Published};
//! use hairis_gradients::{GradColumns, Gradients, Weights};
//!
//! let hair = Gradients::<Published<Gaussian>>::new(&HairParams::brown());
//! let (wo, wi) = ([[0.6], [0.8], [0.0]], [[-0.5], [0.0], [0.866_025_4]]);
//! let hits = HitColumns { wo: wo.each_ref().map(|c| &c[..]), h: None };
//! // The derivative of the red of S.
//! let weights = Weights { value: Some([&[1.0], &[0.0], &[0.0]]), pdf: None };
//! let mut d_material = [0.0; Gradients::<Published<Gaussian>>::NUMBERS];
//! let out = GradColumns { d_material: Some(&mut d_material), ..GradColumns::default() };
//! hair.eval_grad(hits, wi.each_ref().map(|c| &c[..]), weights, out)?;
//! let d_params = hair.by_parameters(&d_material);
//! assert!(d_params.numbers("i_r")[0] > 0.0 && d_params.numbers("i_r")[1] == 0.0);
//! # Ok::<(), hairis_gradients::GradError>(())
//! ```
//!
//! A call keeps the numbers of four packets on the stack. They take at most 78 kB, except for the density of `Matched`, for which they
//! take 113 kB, and 253 kB with 25 bands. In threads with a small stack, pass eight hits at a time, which take a quarter of that.
//!
//! # Rules where a model is not smooth
//!
//! A model computes some numbers by choice: clamps, masks, minima, signs. Derivatives are those of the branch that is taken:
//!
//! | in the model | derivative |
//! |---|---|
//! | `min`, `max`, clamps | that of the operand that is returned, and 0 for the other. Beyond a clamp it is 0: by an offset `h` outside `[-1, 1]`, for example |
//! | masks and their choices | that of the chosen side; the choice itself is constant, so that a jump between the sides has no derivative |
//! | rounding to an integer, exponents | 0: steps |
//! | magnitude, sign | the sign of the argument; 1 at 0 |
//! | seams of the azimuth | that of the side the value is computed on |
//! | non-finite inputs, `wi` along the fibre | 0, as the value |
//! | `wo` along the fibre | 0 by `wo`, because the azimuth jumps there |
//! | any other derivative that is infinite or undefined | 0 |
//!
//! Directions count as independent coordinates. If their length is within 1e-5 of one, they are not normalised, so that the derivative is
//! right along the sphere and arbitrary across it. Project it: `d - wi * dot(d, wi)`. The density is that of the model's sampler. A
//! discarded sample has no derivative, because no sample is drawn here (detached sampling).
//!
//! # Ends of ranges
//!
//! At the end of a parameter's range, or of the offset's, a derivative is the limit from within, or 0 where that limit is infinite:
//!
//! - **Offsets.** By an offset of -1 or 1 the derivative is 0, because the angle of the hit is infinitely steep at a silhouette.
//! - **Clamps.** If a clamp's operands are equal, up to rounding, the number has the derivative and the bound has none.
//! - **Zero intensities.** S is linear in them. The density of a lobe without intensity has the derivative of a lobe that is about to appear.
//! - **Several numbers.** A derivative by a number of the material that is infinite counts as 0 in
//!   [`by_parameters`](Gradients::by_parameters), and those by other numbers count as they are.
//!
//! The test `derivatives_at_the_ends_are_limits_from_within` compares them end by end with one-sided differences of the formulas, and prints
//! the table.
//!
//! # Fields in place of others
//!
//! A colour or melanin may stand in for the absorption of a fibre. If a handle is made by [`Gradients::from_values`] or
//! `AnyGradients::new`, [`by_parameters`](Gradients::by_parameters) returns the derivatives by the fields that the values have. The
//! derivative by the roughness then is that at a fixed colour.
#![no_std]
#![warn(clippy::missing_inline_in_public_items)]

#[cfg(feature = "any")]
mod any;
mod columns;
mod generated;
mod gradients;
mod parameters;

#[cfg(feature = "any")]
pub use any::AnyGradients;
pub use columns::{GradColumns, GradError, Weights};
pub use generated::{Differentiable, Visitor, visit};
pub use gradients::Gradients;

/// Examples of the package's README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
#[derive(Debug)]
pub struct Readme;
