//! Public handles: a material and a shading point of any model.

use crate::handle::kernels::{Albedo, EvalPdf, Lobes, Prepare, SampleWi};
use crate::model::{Eval, Eval8, Hit, Hit8, LobeEval, LobeEval8, Model, Sample, Sample8};
use crate::simd::{LaneStruct, Lanes, Level, Vec3x};
use crate::{LobeMask, PerLobe, Vec3x8};
use core::f32::consts::FRAC_PI_2;
use core::fmt;
use glam::Vec3;
use wide::f32x8;

/// A material: a model with its parameters, made once per material and prepared once per shading point.
///
/// ```
/// use glam::Vec3;
/// use hairis::{Gaussian, HairParams, Material, Published};
/// let hair = Material::new(&Published(Gaussian), &HairParams::default());
/// let bsdf = hair.prepare(Vec3::new(0.6, 0.8, 0.0)); // wo, in the fibre's frame
/// let sample = bsdf.sample([0.2, 0.5, 0.5]).expect("not along the fibre");
/// assert!((bsdf.pdf(sample.wi) / sample.pdf - 1.0).abs() < 1e-4);
/// ```
pub struct Material<M: Model> {
    pub(crate) material: M::Material<f32>,
}

/// Eight materials, one per lane: for eight shading points on different hair.
pub struct Material8<M: Model> {
    pub(crate) material: M::Material<f32x8>,
}

/// A prepared shading point: a material seen from one direction. Evaluate and sample it any number of times, one direction or
/// eight at a time.
pub struct Bsdf<M: Model> {
    pub(crate) inner: M::Prepared<f32>,
}

/// Eight shading points, one per lane.
pub struct Bsdf8<M: Model> {
    pub(crate) inner: M::Prepared<f32x8>,
}

macro_rules! plain_data {
    ($($name:ident $field:ident;)*) => { $(
        impl<M: Model> Clone for $name<M> {
            #[inline]
            fn clone(&self) -> Self {
                *self
            }
        }
        impl<M: Model> Copy for $name<M> {}
        impl<M: Model> fmt::Debug for $name<M> {
            #[inline]
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.debug_tuple(stringify!($name)).field(&self.$field).finish()
            }
        }
    )* };
}
plain_data! { Material material; Material8 material; Bsdf inner; Bsdf8 inner; }

impl<M: Model> Material<M> {
    /// The material of checked parameters.
    #[inline]
    #[must_use]
    pub fn new(model: &M, params: &M::Params) -> Self {
        Self {
            material: model.material(params),
        }
    }

    /// The shading point of a hit: a [`Hit`], or `wo` alone.
    ///
    /// - Domain: `wo` in the fibre's frame, of any length; zero counts as the normal plane. Along the fibre its
    ///   azimuth counts as 0. NaN and infinite ones see black.
    #[inline]
    #[must_use]
    pub fn prepare(&self, hit: impl Into<Hit>) -> Bsdf<M> {
        let Hit { wo, h } = hit.into();
        Bsdf {
            inner: M::prepare_one(
                &self.material,
                Hit {
                    wo: wo.alone(),
                    h: h.alone(),
                },
            ),
        }
    }

    /// Eight shading points on this material, one per lane: a [`Hit8`], or eight `wo`.
    #[inline]
    #[must_use]
    pub fn prepare8(&self, hits: impl Into<Hit8>) -> Bsdf8<M> {
        self.prepare8_at(Level::detect(), hits)
    }

    /// As [`prepare8`](Self::prepare8), on a given instruction set.
    #[inline]
    #[must_use]
    pub fn prepare8_at(&self, level: Level, hits: impl Into<Hit8>) -> Bsdf8<M> {
        level.run(Prepare::<M, f32, _> {
            material: &self.material,
            hits,
        })
    }

    /// The largest directional albedo over all `wo` and the three channels: above 1 the hair gives back more light
    /// than it receives.
    ///
    /// Found on 294 inclinations, ever closer towards the poles, and between the neighbours of the best; it is an upper bound
    /// by a margin of 1e-3, and tested against integrals in double precision on materials of every width.
    #[must_use]
    #[inline(never)]
    pub fn max_albedo(&self) -> f32 {
        let at = |side: f32, step: f32| {
            let from_pole = angle_from_pole(step);
            let wo = Vec3::new(side * libm::cosf(from_pole), libm::sinf(from_pole), 0.0);
            let PerLobe(lobes) = self.prepare(wo).albedo();
            let sums = [0, 1, 2].map(|c| lobes.iter().map(|lobe| lobe[c]).sum::<f32>());
            sums.into_iter().fold(0.0, f32::max).min(f32::MAX)
        };
        let (mut most, mut peak, mut where_to_look) = (0.0_f32, 0.0, (1.0, 0.0));
        for side in [-1.0, 1.0] {
            let mut last = [at(side, 0.0); 2];
            for step in 1..=INCLINATIONS {
                let (step, [before, here]) = (f32::from(step), last);
                let next = at(side, step);
                // As high as the parabola through the three rises.
                let bend = 2.0 * here - before - next;
                let rise = if bend > 0.0 {
                    (before - next) * (before - next) / (8.0 * bend)
                } else {
                    0.0
                };
                let estimate = if here >= before && here >= next {
                    here + rise
                } else {
                    next
                };
                if estimate > peak {
                    (peak, where_to_look) = (
                        estimate,
                        (side, if estimate == next { step } else { step - 1.0 }),
                    );
                }
                most = most.max(here).max(next);
                last = [here, next];
            }
        }
        let (side, mut centre) = where_to_look;
        let mut here = at(side, centre);
        let mut reach = 0.5;
        for _ in 0..6 {
            for step in [(centre - reach).max(0.0), centre + reach] {
                let value = at(side, step);
                if value > here {
                    (here, centre) = (value, step);
                }
            }
            reach *= 0.5;
        }
        (most.max(here) * 1.001).min(f32::MAX)
    }

    /// The factor on all intensities that keeps the directional albedo at most 1 whatever `wo`: 1 if it is already.
    ///
    /// One factor for all directions, so that the model stays reciprocal; path tracing needs it. It does not help with
    /// intensities whose albedo overflows (above 1e37).
    #[must_use]
    #[inline]
    pub fn conserving_scale(&self) -> f32 {
        let most = self.max_albedo();
        if most > 1.0 { 1.0 / most } else { 1.0 }
    }
}

/// Inclinations per side of the normal plane on which [`Material::max_albedo`] looks, the pole left out.
const INCLINATIONS: u16 = 147;

/// Their angles from the pole: albedos change on any scale there, and slowly elsewhere.
#[inline]
fn angle_from_pole(step: f32) -> f32 {
    const LEAST: f32 = 1e-5;
    const EVEN_FROM: f32 = 104.0;
    let grown = LEAST * libm::expf(0.1 * (step.clamp(1.0, EVEN_FROM) - 1.0));
    (grown * step.min(1.0) + 0.1 * grown * (step - EVEN_FROM).max(0.0)).min(FRAC_PI_2)
}

impl<M: Model> Material8<M> {
    /// Eight materials, one per lane.
    #[inline]
    #[must_use]
    pub fn pack(materials: [&Material<M>; 8]) -> Self {
        Self {
            material: <M::Material<f32> as LaneStruct>::pack(materials.map(|m| &m.material)),
        }
    }

    /// Eight shading points, lane by lane: a [`Hit8`], or eight `wo`.
    #[inline]
    #[must_use]
    pub fn prepare8(&self, hits: impl Into<Hit8>) -> Bsdf8<M> {
        self.prepare8_at(Level::detect(), hits)
    }

    /// As [`prepare8`](Self::prepare8), on a given instruction set.
    #[inline]
    #[must_use]
    pub fn prepare8_at(&self, level: Level, hits: impl Into<Hit8>) -> Bsdf8<M> {
        level.run(Prepare::<M, f32x8, _> {
            material: &self.material,
            hits,
        })
    }
}

impl<M: Model> Bsdf<M> {
    /// S at `wi`, without the cosine, linear RGB, per steradian. Every scalar call takes a `Vec3`, a `Vec3A` or a
    /// [`Vec3x`].
    ///
    /// - Domain: any `wi`; 0 within 1e-5 rad of the fibre's axis, for a vector longer than 2, and where a component is NaN.
    #[inline]
    #[must_use]
    pub fn eval(&self, wi: impl Into<Vec3x<f32>>) -> [f32; 3] {
        self.eval_pdf(wi).value
    }

    /// Density of sampling `wi`, per steradian; the domain is that of [`eval`](Self::eval).
    ///
    /// - Integral: 1 over the sphere, unless the model discards samples.
    #[inline]
    #[must_use]
    pub fn pdf(&self, wi: impl Into<Vec3x<f32>>) -> f32 {
        self.eval_pdf(wi).pdf
    }

    /// Value and density at `wi`, for little more than the cost of either.
    #[inline]
    #[must_use]
    pub fn eval_pdf(&self, wi: impl Into<Vec3x<f32>>) -> Eval {
        M::eval::<f32, f32>(&self.inner, wi.into().alone())
    }

    /// Each lobe's value, colour and own density.
    #[inline]
    #[must_use]
    pub fn lobes(&self, wi: impl Into<Vec3x<f32>>) -> PerLobe<LobeEval> {
        M::lobes::<f32, f32>(&self.inner, wi.into().alone())
    }

    /// A direction for three uniform numbers in `[0, 1)`; the first chooses the lobe.
    ///
    /// `None` is a discarded sample. It counts, with a contribution of 0; do not draw it again. NaN among the numbers
    /// gives one.
    #[inline]
    #[must_use]
    pub fn sample(&self, xi: [f32; 3]) -> Option<Sample> {
        Sample::from_lanes(&M::sample::<f32, f32>(
            &self.inner,
            [xi[0].alone(), xi[1].alone(), xi[2].alone()],
        ))
    }

    /// As [`eval_pdf`](Self::eval_pdf), for eight directions.
    #[inline]
    #[must_use]
    pub fn eval_pdf8(&self, wi: &Vec3x8) -> Eval8 {
        self.eval_pdf8_at(Level::detect(), wi)
    }

    /// As [`eval_pdf8`](Self::eval_pdf8), on a given instruction set.
    #[inline]
    #[must_use]
    pub fn eval_pdf8_at(&self, level: Level, wi: &Vec3x8) -> Eval8 {
        level.run(EvalPdf::<M, f32> {
            prepared: &self.inner,
            wi,
        })
    }

    /// As [`lobes`](Self::lobes), for eight directions.
    #[inline]
    #[must_use]
    pub fn lobes8(&self, wi: &Vec3x8) -> PerLobe<LobeEval8> {
        self.lobes8_at(Level::detect(), wi)
    }

    /// As [`lobes8`](Self::lobes8), on a given instruction set.
    #[inline]
    #[must_use]
    pub fn lobes8_at(&self, level: Level, wi: &Vec3x8) -> PerLobe<LobeEval8> {
        level.run(Lobes::<M, f32> {
            prepared: &self.inner,
            wi,
        })
    }

    /// As [`sample`](Self::sample), for eight triples of numbers.
    #[inline]
    #[must_use]
    pub fn sample8(&self, xi: &[f32x8; 3]) -> Sample8 {
        self.sample8_at(Level::detect(), xi)
    }

    /// As [`sample8`](Self::sample8), on a given instruction set.
    #[inline]
    #[must_use]
    pub fn sample8_at(&self, level: Level, xi: &[f32x8; 3]) -> Sample8 {
        level.run(SampleWi::<M, f32> {
            prepared: &self.inner,
            xi,
        })
    }

    /// The constants of the model at this shading point.
    #[inline]
    #[must_use]
    pub const fn constants(&self) -> &M::Prepared<f32> {
        &self.inner
    }

    /// The shading point with only some of its lobes: the others neither scatter nor are sampled.
    #[inline]
    #[must_use]
    pub fn with_lobes(&self, lobes: LobeMask) -> Self {
        Self {
            inner: M::restrict::<f32>(&self.inner, lobes),
        }
    }

    /// Directional albedo of each lobe, linear RGB: the integral of `S cos theta_i` over all `wi`.
    ///
    /// - Accuracy, of the published model: 1e-4 relative for lobes of any width, seen from further than 1e-5 rad from the axis.
    #[inline]
    #[must_use]
    pub fn albedo(&self) -> PerLobe<[f32; 3]> {
        M::albedo::<f32, f32>(&self.inner)
    }
}

impl<M: Model> Bsdf8<M> {
    /// Value and density at `wi`, each lane at its own shading point.
    #[inline]
    #[must_use]
    pub fn eval_pdf8(&self, wi: &Vec3x8) -> Eval8 {
        self.eval_pdf8_at(Level::detect(), wi)
    }

    /// As [`eval_pdf8`](Self::eval_pdf8), on a given instruction set.
    #[inline]
    #[must_use]
    pub fn eval_pdf8_at(&self, level: Level, wi: &Vec3x8) -> Eval8 {
        level.run(EvalPdf::<M, f32x8> {
            prepared: &self.inner,
            wi,
        })
    }

    /// Each lobe's value, colour and own density, each lane at its own shading point.
    #[inline]
    #[must_use]
    pub fn lobes8(&self, wi: &Vec3x8) -> PerLobe<LobeEval8> {
        self.lobes8_at(Level::detect(), wi)
    }

    /// As [`lobes8`](Self::lobes8), on a given instruction set.
    #[inline]
    #[must_use]
    pub fn lobes8_at(&self, level: Level, wi: &Vec3x8) -> PerLobe<LobeEval8> {
        level.run(Lobes::<M, f32x8> {
            prepared: &self.inner,
            wi,
        })
    }

    /// One direction for each shading point.
    #[inline]
    #[must_use]
    pub fn sample8(&self, xi: &[f32x8; 3]) -> Sample8 {
        self.sample8_at(Level::detect(), xi)
    }

    /// As [`sample8`](Self::sample8), on a given instruction set.
    #[inline]
    #[must_use]
    pub fn sample8_at(&self, level: Level, xi: &[f32x8; 3]) -> Sample8 {
        level.run(SampleWi::<M, f32x8> {
            prepared: &self.inner,
            xi,
        })
    }

    /// The constants of the model at these shading points.
    #[inline]
    #[must_use]
    pub const fn constants(&self) -> &M::Prepared<f32x8> {
        &self.inner
    }

    /// The shading point of one lane.
    ///
    /// # Panics
    ///
    /// If `lane` is above 7.
    #[inline]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Bsdf<M> {
        Bsdf {
            inner: <M::Prepared<f32> as LaneStruct>::lane(&self.inner, lane),
        }
    }

    /// The shading points with only some of their lobes: the others neither scatter nor are sampled.
    #[inline]
    #[must_use]
    pub fn with_lobes(&self, lobes: LobeMask) -> Self {
        Self {
            inner: M::restrict::<f32x8>(&self.inner, lobes),
        }
    }

    /// Directional albedo of each lobe, linear RGB, each lane at its own shading point.
    #[inline]
    #[must_use]
    pub fn albedo8(&self) -> PerLobe<[f32x8; 3]> {
        self.albedo8_at(Level::detect())
    }

    /// As [`albedo8`](Self::albedo8), on a given instruction set.
    #[inline]
    #[must_use]
    pub fn albedo8_at(&self, level: Level) -> PerLobe<[f32x8; 3]> {
        level.run(Albedo::<M> {
            prepared: &self.inner,
        })
    }
}
