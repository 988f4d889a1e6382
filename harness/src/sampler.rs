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
    pub const fn dims(self) -> usize {
        match self {
            Self::Uniform => 2,
            _ => 3,
        }
    }

    /// Returns the number of bands of a sampler that is matched to the model.
    pub const fn bands(self) -> Option<usize> {
        match self {
            Self::Uniform | Self::Published => None,
            Self::Matched5 => Some(5),
            Self::Matched => Some(9),
            Self::Matched25 => Some(25),
        }
    }

    /// Returns the sampler's number among the streams of random numbers, ordered by the number of bands.
    pub const fn index(self) -> u64 {
        self.color() as u64
    }

    /// Returns the number of the sampler's colour, the same in every chart of every report.
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
    pub fn new(model: ModelKind, sampler: Sampler, params: &HairParams, wo: Vec3) -> Self {
        Self {
            bsdf: material(model, sampler, params).prepare(wo),
            is_uniform: sampler == Sampler::Uniform,
        }
    }

    /// Wraps a prepared shading point, with the model's own sampler or with uniform directions.
    pub const fn at(bsdf: AnyBsdf, is_uniform: bool) -> Self {
        Self { bsdf, is_uniform }
    }

    /// Draws eight samples, one per lane, from three rows of uniform numbers.
    pub fn sample8(&self, xi: &[f32x8; 3]) -> Sample8 {
        if self.is_uniform {
            let wi = uniform8(xi);
            uniform_sample8(wi, self.bsdf.eval_pdf8(&wi))
        } else {
            self.bsdf.sample8(xi)
        }
    }

    /// Returns value and density of eight directions, one per lane.
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
pub fn material(model: ModelKind, sampler: Sampler, params: &HairParams) -> AnyMaterial {
    let word = sampler.bands().map(|_| sampler.name());
    let id = ModelId::find(model.name(), word).expect("a registered sampler");
    id.material(&params.values()).expect("parameters of hair")
}

/// Returns eight directions uniform on the sphere, from the last two of three numbers.
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

#[cfg(test)]
mod tests {
    use super::*;
    use hairis_instruments::sequence::Independent;

    fn numbers(from: &mut Independent) -> [f32x8; 3] {
        core::array::from_fn(|_| f32x8::new(core::array::from_fn(|_| from.next_f32())))
    }

    #[test]
    fn uniform_directions_are_unit_and_fill_the_sphere() {
        let mut from = Independent::new(1, 0);
        let (mut sum, mut squares) = (Vec3::ZERO, Vec3::ZERO);
        for _ in 0..4_000 {
            let wi = uniform8(&numbers(&mut from));
            for lane in 0..8 {
                let wi = wi.lane(lane);
                assert!((wi.length() - 1.0).abs() < 1e-6, "{wi}");
                sum += wi / 32_000.0;
                squares += wi * wi / 32_000.0;
            }
        }
        // Standard errors of 0.0032 and 0.0017.
        assert!(sum.abs().max_element() < 0.015, "{sum}");
        assert!(
            (squares - Vec3::splat(1.0 / 3.0)).abs().max_element() < 0.008,
            "{squares}"
        );
    }

    #[test]
    fn samples_agree_with_what_their_sampler_says_of_the_direction() {
        let params = HairParams::bright();
        let wo = Vec3::new(0.6, 0.64, 0.48);
        let mut from = Independent::new(1, 1);
        for model in ModelKind::ALL {
            for sampler in Sampler::ALL {
                let bsdf = Scatter::new(model, sampler, &params, wo);
                for _ in 0..200 {
                    let sample = bsdf.sample8(&numbers(&mut from));
                    let eval = bsdf.eval_pdf8(&sample.wi);
                    for lane in 0..8 {
                        let at = |x: &f32x8| f64::from(x.as_array()[lane]);
                        if at(&sample.pdf) == 0.0 {
                            continue;
                        }
                        let wi = sample.wi.lane(lane);
                        let cos = f64::from(wi.y).hypot(f64::from(wi.z));
                        let place = format!("{model:?} {sampler:?} at {wi}");
                        assert!(
                            (at(&sample.pdf) / at(&eval.pdf) - 1.0).abs() < 1e-3,
                            "{place}: pdf"
                        );
                        for c in 0..3 {
                            let want = at(&eval.value[c]) * cos / at(&eval.pdf);
                            assert!(
                                (at(&sample.weight[c]) - want).abs() <= 1e-3 * want + 1e-20,
                                "{place}: weight"
                            );
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn bounds_of_weights_are_held_and_nearly_reached() {
        let params = HairParams::bright();
        let mut from = Independent::new(1, 2);
        for theta_o in [0.0_f64, 0.8, 1.4] {
            let wo = hairis_instruments::direction::direction(theta_o.sin(), theta_o.cos(), 1.0);
            for model in ModelKind::ALL {
                for sampler in Sampler::ALL
                    .into_iter()
                    .filter(|sampler| *sampler != Sampler::Published)
                {
                    let bound =
                        weight_bound(model, sampler, &params, theta_o).expect("there is one");
                    let bsdf = Scatter::new(model, sampler, &params, wo);
                    let mut most = 0.0_f32;
                    for _ in 0..20_000 {
                        let weight = bsdf.sample8(&numbers(&mut from)).weight;
                        most = (weight[0] + weight[1] + weight[2])
                            .to_array()
                            .into_iter()
                            .fold(most, f32::max);
                    }
                    let (most, near) = (
                        f64::from(most) / 3.0,
                        if sampler == Sampler::Uniform {
                            0.1
                        } else {
                            0.5
                        },
                    );
                    let place = format!("{model:?} {sampler:?} at {theta_o}");
                    assert!(
                        most <= bound * (1.0 + 1e-5) && most > near * bound,
                        "{place}: {most} of {bound}"
                    );
                }
            }
        }
    }
}
