//! Samplers of each model that `compare` and `study` measure.
//!
//! To add a sampler, add a variant of [`Sampler`] with its arms in the methods and in `weight_bound`.

use crate::subject::ModelKind;
use core::f32::consts::{PI, TAU};
use glam::Vec3;
use hairis::{Eval8, HairParams, LobeMask, Sample8, Vec3x8};
use hairis_instruments::direction::{cosine, fibre_direction};
use hairis_variants::{AnyBsdf, AnyMaterial, ModelId, Parameters as _};
use serde::Serialize;
use wide::f32x8;

/// Sampler of directions, by which `compare` and `study` measure a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sampler {
    /// Uniform directions over the sphere.
    Uniform,
    /// Published sampler.
    Published,
    /// Sampler matched to the model, with nine bands.
    Matched,
    /// Matched sampler with five bands, the cheapest.
    #[serde(rename = "matched-5")]
    Matched5,
    /// Matched sampler with twenty-five bands, of the least variance.
    #[serde(rename = "matched-25")]
    Matched25,
}

/// Number of samplers of the build. Two of them come with the feature `every-sampler`.
const COUNT: usize = match ModelId::find("gaussian", Some("matched-25")) {
    Some(_) => 5,
    None => 3,
};

impl Sampler {
    /// Every sampler of the build, in the order of reports.
    pub const ALL: [Self; COUNT] = {
        let every = [
            Self::Uniform,
            Self::Published,
            Self::Matched,
            Self::Matched5,
            Self::Matched25,
        ];
        let mut all = [Self::Uniform; COUNT];
        let mut place = 0;
        while place < COUNT {
            all[place] = every[place];
            place += 1;
        }
        all
    };

    /// Returns the name of the sampler in reports and in rows.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Published => "published",
            Self::Matched5 => "matched-5",
            Self::Matched => "matched",
            Self::Matched25 => "matched-25",
        }
    }

    /// Returns the number of uniform numbers per sample.
    #[must_use]
    pub const fn dims(self) -> usize {
        match self {
            Self::Uniform => 2,
            _ => 3,
        }
    }

    /// Returns the number of bands of a sampler that is matched to the model.
    #[must_use]
    pub const fn bands(self) -> Option<usize> {
        match self {
            Self::Uniform | Self::Published => None,
            Self::Matched5 => Some(5),
            Self::Matched => Some(9),
            Self::Matched25 => Some(25),
        }
    }

    /// Returns the sampler's number among the streams of random numbers, ordered by the number of bands.
    #[must_use]
    pub const fn index(self) -> u64 {
        self.color() as u64
    }

    /// Returns the number of the sampler's colour, the same in every chart of every report.
    #[must_use]
    pub const fn color(self) -> usize {
        match self {
            Self::Uniform => 0,
            Self::Published => 1,
            Self::Matched5 => 2,
            Self::Matched => 3,
            Self::Matched25 => 4,
        }
    }
}

/// Returns a proven bound on the mean of RGB of every weight `S cos theta_i / pdf` seen from `theta_o`, if there is one.
///
/// - `uniform`: the lobes have peaks of 1, and `cos theta_i / cos^2 theta_d` is at most `1 / cos theta_o`, which it reaches at
///   `theta_i = -theta_o`.
/// - `published`: none in closed form. Its glints end at `|phi| = pi/2`; other lobes sample their tails beyond it.
/// - `matched`: the integral of all lobes, times the largest ratio of W to its constant in a band.
pub fn weight_bound(
    model: ModelKind,
    sampler: Sampler,
    params: &HairParams,
    theta_o: f64,
) -> Option<f64> {
    if sampler == Sampler::Uniform {
        let mean = |rgb: [f32; 3]| rgb.iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0;
        let desc = params.desc();
        let glints = 1.0 + f64::from(desc.i_g);
        let peak = mean(desc.i_r) + mean(desc.i_tt) + mean(desc.i_trt) * glints;
        return Some(4.0 * core::f64::consts::PI * peak / theta_o.cos());
    }
    let wo = fibre_direction(theta_o, 0.0).to_array();
    let formulas = model.formulas(sampler.bands());
    formulas
        .prepare(&params.desc().map(f64::from), wo)
        .weight_bound(LobeMask::ALL)
}

/// Density of a uniform direction, per steradian.
pub const UNIFORM_PDF: f32 = 0.25 / PI;

/// Shading point with one of the samplers.
#[derive(Clone, Copy, Debug)]
pub struct Scatter {
    bsdf: AnyBsdf,
    is_uniform: bool,
}

impl Scatter {
    /// Prepares this hair, seen from `wo`.
    #[must_use]
    pub fn new(model: ModelKind, sampler: Sampler, params: &HairParams, wo: Vec3) -> Self {
        Self {
            bsdf: material(model, sampler, params).prepare(wo),
            is_uniform: sampler == Sampler::Uniform,
        }
    }

    /// Wraps a prepared shading point, with the model's own sampler or with uniform directions.
    #[must_use]
    pub const fn at(bsdf: AnyBsdf, is_uniform: bool) -> Self {
        Self { bsdf, is_uniform }
    }

    /// Draws eight samples, one per lane, from three rows of uniform numbers.
    #[must_use]
    pub fn sample8(&self, xi: &[f32x8; 3]) -> Sample8 {
        if self.is_uniform {
            let wi = uniform8(xi);
            uniform_sample8(wi, self.bsdf.eval_pdf8(&wi))
        } else {
            self.bsdf.sample8(xi)
        }
    }

    /// Returns value and density of eight directions, one per lane.
    #[must_use]
    pub fn eval_pdf8(&self, wi: &Vec3x8) -> Eval8 {
        let eval = self.bsdf.eval_pdf8(wi);
        if self.is_uniform {
            Eval8 {
                pdf: f32x8::splat(UNIFORM_PDF),
                ..eval
            }
        } else {
            eval
        }
    }
}

/// Returns the material of this hair, with the sampler if it is one of the model.
///
/// # Panics
///
/// Never panics, because every sampler of the models is registered, and their parameters are those of hair.
#[must_use]
pub fn material(model: ModelKind, sampler: Sampler, params: &HairParams) -> AnyMaterial {
    let word = sampler.bands().map(|_| sampler.name());
    let id = ModelId::find(model.name(), word).expect("a registered sampler");
    id.material(&params.values()).expect("parameters of hair")
}

/// Returns eight directions uniform on the sphere, from the last two of three numbers.
#[must_use]
#[inline]
pub fn uniform8(xi: &[f32x8; 3]) -> Vec3x8 {
    let one = f32x8::splat(1.0);
    let u = one - (xi[1] + xi[1]);
    // As the product (1 - u)(1 + u), so that nothing cancels near the poles.
    let r = (f32x8::splat(4.0) * xi[1] * (one - xi[1])).sqrt();
    let (sin_phi, cos_phi) = (xi[2] * f32x8::splat(TAU)).sin_cos();
    Vec3x8::new(u, r * cos_phi, r * sin_phi)
}

/// Returns the samples of uniform directions that evaluate to `eval`.
#[must_use]
#[inline]
pub fn uniform_sample8(wi: Vec3x8, eval: Eval8) -> Sample8 {
    let factor = cosine(&wi) * f32x8::splat(1.0 / UNIFORM_PDF);
    let [r, g, b] = eval.value;
    let weight = [r * factor, g * factor, b * factor];
    Sample8 {
        wi,
        value: eval.value,
        pdf: f32x8::splat(UNIFORM_PDF),
        weight,
        slot: f32x8::ZERO,
    }
}
