//! BSDFs: materials at hits, which evaluate and sample directions.

use super::kernels::{Albedo, EvalPdf, Lobes, SampleWi};
use super::{handle_impls, level_methods};
use crate::frame::Vec3x8;
use crate::model::{Eval, Eval8, LobeEval, LobeEval8, LobeMask, Model, PerLobe, Sample, Sample8};
use crate::simd::{LaneStruct, Level, Schedule, Vec3x, f32x8};

/// BSDF at a hit: a material with its `wo` fixed. Evaluate and sample it any number of times, one direction or eight at a time.
pub struct Bsdf<M: Model> {
    pub(crate) prepared: M::Prepared<f32>,
    pub(crate) level: Level,
}

/// BSDFs at eight hits, one per lane.
pub struct Bsdf8<M: Model> {
    pub(crate) prepared: M::Prepared<f32x8>,
    pub(crate) level: Level,
}

handle_impls! { Bsdf prepared Prepared<f32>; Bsdf8 prepared Prepared<f32x8>; }

impl<M: Model> Bsdf<M> {
    level_methods! {}

    /// Evaluates S at `wi`, without the cosine, linear RGB, per steradian. Every scalar call takes a `Vec3`, a `Vec3A` or a
    /// [`Vec3x`].
    ///
    /// - Domain: a unit `wi`. S is 0 within 1e-5 rad of the fibre's axis and where a component is not finite. Any other finite
    ///   vector gives finite numbers without meaning; builds with debug assertions panic on it.
    #[inline]
    #[must_use]
    pub fn eval(&self, wi: impl Into<Vec3x<f32>>) -> [f32; 3] {
        self.eval_pdf(wi).value
    }

    /// Returns the density of sampling `wi`, per steradian; the domain is that of [`eval`](Self::eval).
    ///
    /// - Integral: 1 over the sphere, unless the model discards samples.
    #[inline]
    #[must_use]
    pub fn pdf(&self, wi: impl Into<Vec3x<f32>>) -> f32 {
        self.eval_pdf(wi).pdf
    }

    /// Evaluates S and the density at `wi`, for little more than the cost of either.
    #[inline]
    #[must_use]
    pub fn eval_pdf(&self, wi: impl Into<Vec3x<f32>>) -> Eval {
        M::eval::<f32, f32>(&self.prepared, unit(wi.into()).alone())
    }

    /// Evaluates each lobe's value, colour and own density at `wi`.
    #[inline]
    #[must_use]
    pub fn lobes(&self, wi: impl Into<Vec3x<f32>>) -> PerLobe<LobeEval> {
        M::lobes::<f32, f32>(&self.prepared, unit(wi.into()).alone())
    }

    /// Draws a direction by three uniform numbers in `[0, 1)`, of which the first chooses the lobe.
    ///
    /// `None` is a discarded sample. It counts as a sample whose contribution is 0, so do not draw it again. NaN among the numbers
    /// discards the sample.
    #[inline]
    #[must_use]
    pub fn sample(&self, xi: [f32; 3]) -> Option<Sample> {
        Sample::from_lanes(&M::sample::<f32, f32>(
            &self.prepared,
            [xi[0].alone(), xi[1].alone(), xi[2].alone()],
        ))
    }

    /// Evaluates S and the density of eight directions, like [`eval_pdf`](Self::eval_pdf).
    #[inline]
    #[must_use]
    pub fn eval_pdf8(&self, wi: &Vec3x8) -> Eval8 {
        self.level.run(EvalPdf::<M::Inner, f32> {
            prepared: &self.prepared,
            wi,
        })
    }

    /// Evaluates each lobe at eight directions, like [`lobes`](Self::lobes).
    #[inline]
    #[must_use]
    pub fn lobes8(&self, wi: &Vec3x8) -> PerLobe<LobeEval8> {
        self.level.run(Lobes::<M::Inner, f32> {
            prepared: &self.prepared,
            wi,
        })
    }

    /// Draws eight directions by eight triples of uniform numbers, like [`sample`](Self::sample).
    #[inline]
    #[must_use]
    pub fn sample8(&self, xi: &[f32x8; 3]) -> Sample8 {
        self.level.run(SampleWi::<M::Inner, f32> {
            prepared: &self.prepared,
            xi,
        })
    }

    /// Returns the constants of the model at this hit, for what a model offers beyond the calls of every model.
    #[inline]
    #[must_use]
    pub const fn constants(&self) -> &M::Prepared<f32> {
        &self.prepared
    }

    /// Returns the BSDF with only some of its lobes: the others neither scatter nor are sampled.
    #[inline]
    #[must_use]
    pub fn with_lobes(&self, lobes: LobeMask) -> Self {
        Self {
            prepared: M::restrict::<f32>(&self.prepared, lobes),
            level: self.level,
        }
    }

    /// Returns the directional albedo of each lobe, linear RGB: the integral of `S cos theta_i` over all `wi`.
    ///
    /// - Accuracy, for the published model: 1e-4 relative for lobes of any width, viewed from further than 1e-5 rad from the axis, or what
    ///   6e-8 rad of `alpha` change where that is more. It is more for narrow lobes next to a pole or beyond it: 4e-3 for the narrowest,
    ///   six widths beyond.
    #[inline]
    #[must_use]
    pub fn albedo(&self) -> PerLobe<[f32; 3]> {
        M::albedo::<f32, f32>(&self.prepared)
    }
}

impl<M: Model> Bsdf8<M> {
    level_methods! {}

    /// Evaluates S and the density at `wi`, each lane at its own hit.
    #[inline]
    #[must_use]
    pub fn eval_pdf8(&self, wi: &Vec3x8) -> Eval8 {
        self.level.run(EvalPdf::<M::Inner, f32x8> {
            prepared: &self.prepared,
            wi,
        })
    }

    /// Evaluates each lobe's value, colour and own density, each lane at its own hit.
    #[inline]
    #[must_use]
    pub fn lobes8(&self, wi: &Vec3x8) -> PerLobe<LobeEval8> {
        self.level.run(Lobes::<M::Inner, f32x8> {
            prepared: &self.prepared,
            wi,
        })
    }

    /// Draws one direction for each hit, each by three uniform numbers in `[0, 1)`.
    #[inline]
    #[must_use]
    pub fn sample8(&self, xi: &[f32x8; 3]) -> Sample8 {
        self.level.run(SampleWi::<M::Inner, f32x8> {
            prepared: &self.prepared,
            xi,
        })
    }

    /// Returns the BSDF at the hit of one lane.
    ///
    /// # Panics
    ///
    /// Panics if `lane` is above 7.
    #[inline]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Bsdf<M> {
        Bsdf {
            prepared: <M::Prepared<f32> as LaneStruct>::lane(&self.prepared, lane),
            level: self.level,
        }
    }

    /// Returns the BSDFs with only some of their lobes: the others neither scatter nor are sampled.
    #[inline]
    #[must_use]
    pub fn with_lobes(&self, lobes: LobeMask) -> Self {
        Self {
            prepared: M::restrict::<f32x8>(&self.prepared, lobes),
            level: self.level,
        }
    }

    /// Returns the directional albedo of each lobe, linear RGB, each lane at its own hit.
    #[inline]
    #[must_use]
    pub fn albedo8(&self) -> PerLobe<[f32x8; 3]> {
        self.level.run(Albedo::<M::Inner> {
            prepared: &self.prepared,
        })
    }
}

/// Returns the direction, which callers promise to be of unit length; zero and non-finite directions evaluate to zero.
#[inline(always)]
pub(super) fn unit(wi: Vec3x<f32>) -> Vec3x<f32> {
    let length_sq = wi.dot(wi);
    debug_assert!(
        length_sq == 0.0 || !length_sq.is_finite() || (length_sq - 1.0).abs() < 0.02,
        "wi must be of unit length, got {wi:?}"
    );
    wi
}
