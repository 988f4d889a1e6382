//! Material of hair: a model of the registry, and the way in which it is sampled.

use crate::lights::uniform_direction;
use core::f32::consts::{FRAC_PI_2, PI};
use glam::Vec3;
use hairis::simd::f32x8;
use hairis::{Eval8, Hit, Hit8, Sample8, Vec3x8};
use hairis_instruments::direction::cosine;
use hairis_variants::{AnyBsdf, AnyBsdf8, AnyMaterial};

/// Method that draws directions at a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// Draws directions by the model's own sampler.
    Own,
    /// Draws directions uniformly over the sphere.
    Uniform,
}

/// Hair of a scene: a material, and the method that draws directions.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::large_enum_variant, reason = "there is one per scene")]
pub enum Hair {
    /// Model of the registry, and one factor on all that it scatters: 1, but for [`Energy::Scaled`](crate::hair::Energy::Scaled).
    Model(AnyMaterial, Sampling, f32),
    /// Hair that scatters equally into all directions and absorbs nothing: `S cos theta_i = 1 / (4 pi)`. For tests of transport.
    Isotropic,
}

/// Eight hits, or one hit for eight directions.
#[expect(
    clippy::large_enum_variant,
    reason = "on the stack of a wave, and read at once"
)]
enum Points {
    Each(AnyBsdf8),
    One(AnyBsdf),
}

/// Hits prepared for evaluation and sampling of eight directions at a time.
#[expect(missing_debug_implementations, reason = "short-lived")]
pub struct Prepared(Option<(Points, Sampling, f32)>);

impl Hair {
    /// Prepares eight hits, one per lane, each for one direction at a time.
    #[inline]
    #[must_use]
    pub fn prepare8(&self, hits: &Hit8) -> Prepared {
        Prepared(match self {
            Self::Model(material, sampling, factor) => {
                Some((Points::Each(material.prepare8(hits)), *sampling, *factor))
            }
            Self::Isotropic => None,
        })
    }

    /// Prepares one hit for the evaluation and sampling of eight directions at a time.
    #[inline]
    #[must_use]
    pub fn prepare(&self, hit: Hit) -> Prepared {
        Prepared(match self {
            Self::Model(material, sampling, factor) => {
                Some((Points::One(material.prepare(hit)), *sampling, *factor))
            }
            Self::Isotropic => None,
        })
    }

    /// Returns the directional albedo at an inclination of `wo` in rad and an offset `h`, by channel.
    #[must_use]
    pub fn albedo(&self, theta_o: f32, h: f32) -> [f32; 3] {
        let Self::Model(material, _, factor) = self else {
            return [1.0; 3];
        };
        let hit = Hit::new(Vec3::new(theta_o.sin(), theta_o.cos(), 0.0), h);
        let lobes = material.prepare(hit).albedo().0;
        core::array::from_fn(|c| lobes.iter().map(|lobe| lobe[c]).sum::<f32>() * factor)
    }

    /// Returns the largest mean albedo of a channel, and the largest albedo of all.
    ///
    /// The mean is over hits as isotropic light makes them: of density `cos^2 theta_o` in inclination, and uniform in `h`.
    #[must_use]
    pub fn mean_and_worst_albedo(&self) -> [f32; 2] {
        const STEPS: u16 = 90;
        let offsets: &[f32] = match self {
            Self::Model(material, ..) if material.model().is_near_field() => {
                &[-0.9, -0.7, -0.5, -0.3, -0.1, 0.1, 0.3, 0.5, 0.7, 0.9]
            }
            _ => &[0.0],
        };
        let (mut sum, mut weights, mut worst) = ([0.0; 3], 0.0, 0.0_f32);
        for step in 0..STEPS {
            let theta = ((f32::from(step) + 0.5) / f32::from(STEPS) * 2.0 - 1.0) * FRAC_PI_2;
            let weight = theta.cos().powi(2);
            for h in offsets {
                let albedo = self.albedo(theta, *h);
                weights += weight;
                for (sum, albedo) in sum.iter_mut().zip(albedo) {
                    *sum += weight * albedo;
                    worst = worst.max(albedo);
                }
            }
        }
        [sum.into_iter().fold(0.0, f32::max) / weights, worst]
    }
}

impl Prepared {
    /// Returns the value of the BSDF and the density at a direction per lane, in the fibre's frame.
    #[inline]
    #[must_use]
    pub fn eval8(&self, wi: &Vec3x8) -> Eval8 {
        let uniform = f32x8::splat(0.25 / PI);
        let Some((points, sampling, factor)) = &self.0 else {
            return Eval8 {
                value: [uniform / cosine(wi).max(f32x8::splat(1e-6)); 3],
                pdf: uniform,
            };
        };
        let eval = match points {
            Points::Each(points) => points.eval_pdf8(wi),
            Points::One(point) => point.eval_pdf8(wi),
        };
        let pdf = if *sampling == Sampling::Uniform {
            uniform
        } else {
            eval.pdf
        };
        Eval8 {
            value: eval.value.map(|channel| channel * f32x8::splat(*factor)),
            pdf,
        }
    }

    /// Draws a direction per lane, in the fibre's frame, from three uniform numbers.
    #[inline]
    #[must_use]
    pub fn sample8(&self, xi: &[[f32; 8]; 3]) -> Sample8 {
        if let Some((points, Sampling::Own, factor)) = &self.0 {
            let xi = xi.map(f32x8::new);
            let sample = match points {
                Points::Each(points) => points.sample8(&xi),
                Points::One(point) => point.sample8(&xi),
            };
            let factor = f32x8::splat(*factor);
            return Sample8 {
                value: sample.value.map(|channel| channel * factor),
                weight: sample.weight.map(|channel| channel * factor),
                ..sample
            };
        }
        let wi = Vec3x8::from(core::array::from_fn::<Vec3, 8, _>(|lane| {
            uniform_direction([xi[1][lane], xi[2][lane]])
        }));
        let Eval8 { value, .. } = self.eval8(&wi);
        let by = cosine(&wi) * f32x8::splat(4.0 * PI);
        Sample8 {
            wi,
            value,
            pdf: f32x8::splat(0.25 / PI),
            weight: value.map(|channel| channel * by),
            slot: f32x8::ZERO,
        }
    }
}
