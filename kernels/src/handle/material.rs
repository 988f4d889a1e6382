//! Materials: a model with its parameters.

use super::bsdf::{Bsdf, Bsdf8, unit};
use super::kernels::Prepare;
use super::{handle_impls, level_methods};
use crate::model::{Eval, Hit, Hit8, Model, PerLobe, Sample};
use crate::simd::dispatch::clean_upper_halves;
use crate::simd::{LaneStruct, Level, Schedule, Vec3x, f32x8};
use core::f32::consts::FRAC_PI_2;
use core::mem::MaybeUninit;
use glam::Vec3;

/// Material: a model with its parameters, made once per material and prepared once per hit.
///
/// Two materials are equal if their constants are equal, whatever their levels.
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
    pub(crate) constants: M::Material<f32>,
    pub(crate) level: Level,
}

/// Eight materials, one per lane, for eight hits on different hair.
pub struct Material8<M: Model> {
    pub(crate) constants: M::Material<f32x8>,
    pub(crate) level: Level,
}

handle_impls! { Material constants Material<f32>; Material8 constants Material<f32x8>; }

impl<M: Model> Material<M> {
    /// Makes a material from checked parameters, on the best instruction set of the CPU.
    #[inline]
    #[must_use]
    pub fn new(model: &M, params: &M::Params) -> Self {
        Self {
            constants: model.material(params),
            level: Level::detect(),
        }
    }

    level_methods! {}

    /// Prepares the BSDF at a hit, which is a [`Hit`] or `wo` alone.
    ///
    /// - Domain: `wo` in the fibre's frame, of any length. Zero counts as a direction in the normal plane, and along the fibre the
    ///   azimuth counts as 0. With a `wo` that is not finite the BSDF evaluates to zero.
    #[inline]
    #[must_use]
    pub fn prepare(&self, hit: impl Into<Hit>) -> Bsdf<M> {
        let hit = hit.into();
        if const { M::INTEGRATES } && self.is_integrating() {
            return self.prepare_integrated(hit);
        }
        Bsdf {
            prepared: M::prepare_one(&self.constants, hit.alone()),
            level: self.level,
        }
    }

    /// Evaluates S and the density at one hit, with the bits of [`prepare`](Self::prepare) and [`Bsdf::eval_pdf`] in less time,
    /// because constants that the evaluation does not need are not computed, and the others stay in registers.
    ///
    /// ```
    /// use glam::Vec3;
    /// use hairis::{Gaussian, HairParams, Material, Published};
    /// let hair = Material::new(&Published(Gaussian), &HairParams::brown());
    /// let (wo, wi) = (Vec3::new(0.6, 0.8, 0.0), Vec3::new(0.0, 0.6, 0.8));
    /// assert_eq!(hair.eval_hit(wo, wi), hair.prepare(wo).eval_pdf(wi));
    /// ```
    #[inline]
    #[must_use]
    pub fn eval_hit(&self, hit: impl Into<Hit>, wi: impl Into<Vec3x<f32>>) -> Eval {
        let (hit, wi) = (hit.into(), wi.into());
        if const { M::INTEGRATES } && self.is_integrating() {
            return self.prepare_integrated(hit).eval_pdf(wi);
        }
        let prepared = M::prepare_one(&self.constants, hit.alone());
        M::eval::<f32, f32>(&prepared, unit(wi).alone())
    }

    /// Draws a sample at one hit, with the bits of [`prepare`](Self::prepare) and [`Bsdf::sample`] in less time.
    #[inline]
    #[must_use]
    pub fn sample_hit(&self, hit: impl Into<Hit>, xi: [f32; 3]) -> Option<Sample> {
        let hit = hit.into();
        if const { M::INTEGRATES } && self.is_integrating() {
            return self.prepare_integrated(hit).sample(xi);
        }
        let prepared = M::prepare_one(&self.constants, hit.alone());
        let xi = [xi[0].alone(), xi[1].alone(), xi[2].alone()];
        Sample::from_lanes(&M::sample::<f32, f32>(&prepared, xi))
    }

    /// Returns true if each hit integrates the lobes. Compared by bits, because a comparison of floats is legacy SSE in a plain
    /// build, which takes 120 ns if a host has left the upper halves of the vector registers dirty.
    #[inline(always)]
    pub(super) fn is_integrating(&self) -> bool {
        M::integrates::<f32, f32>(&self.constants).to_bits() != 0
    }

    #[cold]
    #[inline(never)]
    fn prepare_integrated(&self, hit: Hit) -> Bsdf<M> {
        let prepared = M::prepare_one(&self.constants, hit.alone());
        Bsdf {
            prepared: M::conserving::<f32>(&prepared, true),
            level: self.level,
        }
    }

    /// Prepares the BSDF like [`prepare`](Self::prepare), and writes it to the caller's memory, because a BSDF is 200 to 900 bytes.
    #[inline]
    pub fn prepare_into<'a>(
        &self,
        hit: impl Into<Hit>,
        out: &'a mut MaybeUninit<Bsdf<M>>,
    ) -> &'a mut Bsdf<M> {
        out.write(self.prepare(hit))
    }

    /// Prepares the BSDFs at eight hits on this material, one per lane, from a [`Hit8`] or eight `wo`.
    #[inline]
    #[must_use]
    pub fn prepare8(&self, hits: impl Into<Hit8>) -> Bsdf8<M> {
        if const { M::INTEGRATES } && self.is_integrating() {
            return self.prepare8_at(hits).conserving();
        }
        self.prepare8_at(hits)
    }

    /// Not inlined, because the code of the portable level, up to 80 kB, would be in both branches of [`prepare8`](Self::prepare8).
    #[inline(never)]
    fn prepare8_at(&self, hits: impl Into<Hit8>) -> Bsdf8<M> {
        let (material, level) = (&self.constants, self.level);
        let kernel = Prepare::<M, f32, _> { material, hits };
        level.run_into(kernel, |prepared| Bsdf8 { prepared, level })
    }

    /// Returns the largest directional albedo over all `wo` and the three channels. Above 1 the hair returns more light than it
    /// receives.
    ///
    /// The maximum is searched on 294 inclinations, ever closer towards the poles, and then between the neighbours of the best. With
    /// a margin of 1e-3 it is an upper bound, tested against integrals in double precision on materials of every width.
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

    /// Returns the factor on all intensities that keeps the directional albedo at most 1 for every `wo`: 1 if it already is.
    ///
    /// Path tracing needs such a factor; one factor for all directions keeps the model reciprocal. It does not help with intensities
    /// whose albedo overflows (above 1e37).
    #[must_use]
    #[inline]
    pub fn conserving_scale(&self) -> f32 {
        let most = self.max_albedo();
        if most > 1.0 { 1.0 / most } else { 1.0 }
    }
}

/// Number of inclinations per side of the normal plane, without the pole, at which [`Material::max_albedo`] evaluates albedos.
const INCLINATIONS: u16 = 147;

/// Returns the angle of an inclination from the pole, near which albedos change on any scale; elsewhere they change slowly.
#[inline]
fn angle_from_pole(step: f32) -> f32 {
    const LEAST: f32 = 1e-5;
    const EVEN_FROM: f32 = 104.0;
    let grown = LEAST * libm::expf(0.1 * (step.clamp(1.0, EVEN_FROM) - 1.0));
    (grown * step.min(1.0) + 0.1 * grown * (step - EVEN_FROM).max(0.0)).min(FRAC_PI_2)
}

impl<M: Model> Material8<M> {
    /// Packs eight materials, one per lane, on the level of the first.
    #[inline]
    #[must_use]
    pub fn pack(materials: [&Material<M>; 8]) -> Self {
        Self {
            constants: <M::Material<f32> as LaneStruct>::pack(materials.map(|m| &m.constants)),
            level: materials[0].level,
        }
    }

    level_methods! {}

    /// Prepares the BSDFs at eight hits, each on the material of its lane, from a [`Hit8`] or eight `wo`.
    #[inline]
    #[must_use]
    pub fn prepare8(&self, hits: impl Into<Hit8>) -> Bsdf8<M> {
        if const { M::INTEGRATES } {
            // What follows compares floats outside the level.
            clean_upper_halves();
            if let Some(lanes) = self.integrating() {
                return self.prepare8_at(hits).conserving_where(lanes);
            }
        }
        self.prepare8_at(hits)
    }

    /// Not inlined, as for one material.
    #[inline(never)]
    fn prepare8_at(&self, hits: impl Into<Hit8>) -> Bsdf8<M> {
        let (material, level) = (&self.constants, self.level);
        let kernel = Prepare::<M, f32x8, _> { material, hits };
        level.run_into(kernel, |prepared| Bsdf8 { prepared, level })
    }

    /// Returns 1 in the lanes that integrate the lobes, or `None` if no lane does. The caller has cleaned the upper halves of the
    /// vector registers.
    #[inline(always)]
    pub(super) fn integrating(&self) -> Option<f32x8> {
        let lanes = M::integrates::<f32x8, f32x8>(&self.constants);
        // Compared as numbers instead of by a mask of the CPU, because compilers then drop the test for models that never integrate.
        let any = lanes.as_array().iter().any(|lane| *lane > 0.0);
        any.then_some(lanes)
    }
}
