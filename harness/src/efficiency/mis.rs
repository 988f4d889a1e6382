//! Light sampling, and multiple importance sampling with the power heuristic (section 4 of the paper).

use super::SAMPLERS;
use super::case::Case;
use super::measure::{CellMoments, contribution, independent};
use super::result::Technique;
use crate::light::{Light, LightSample};
use crate::sampler::Sampler;
use crate::sequence::{Independent, XiSource};
use crate::stats::Moments;
use glam::DVec3;

impl Technique {
    /// Every technique, in the order of reports.
    pub fn all() -> impl Iterator<Item = Self> {
        [Self::Light].into_iter().chain(SAMPLERS.map(Self::Bsdf)).chain(SAMPLERS.map(Self::Mis))
    }

    /// Name in reports.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Light => "light only".to_owned(),
            Self::Bsdf(sampler) => format!("{} only", sampler.name()),
            Self::Mis(sampler) => format!("{} + light", sampler.name()),
        }
    }

    /// Samples a contribution takes.
    #[must_use]
    pub fn samples_each(self) -> usize {
        match self {
            Self::Mis(_) => 2,
            _ => 1,
        }
    }
}

/// Moments of `n` contributions of `technique`: of single samples, or of pairs of one sample each.
pub(super) fn estimate(case: &Case, technique: Technique, light: &dyn Light, at: [u64; 2], n: usize) -> CellMoments {
    match technique {
        Technique::Bsdf(sampler) => independent(case, sampler, light, at, n),
        Technique::Light => pairs(case, None, light, at, n),
        Technique::Mis(sampler) => pairs(case, Some(sampler), light, at, n),
    }
}

/// Balance of the power heuristic for the technique of density `mine`; 0 where it has none.
fn power_heuristic(mine: f64, other: f64) -> f64 {
    if mine == 0.0 {
        return 0.0;
    }
    // The ratio rather than the squares: densities of narrow lights are large.
    let ratio = other / mine;
    1.0 / (1.0 + ratio * ratio)
}

/// One light sample, and with `partner` one sample of that too, a contribution.
fn pairs(case: &Case, partner: Option<Sampler>, light: &dyn Light, [seed, stream]: [u64; 2], n: usize) -> CellMoments {
    let mut source = Independent::new(seed, stream);
    let mut moments = Moments::new();
    let mut largest = 0.0_f64;
    let mut left = n;
    while left > 0 {
        let lanes = left.min(8);
        let mut y = [0.0; 8];
        if let Some(sampler) = partner {
            let draws = case.draw(sampler, &mut source, lanes);
            for (lane, y) in y.iter_mut().enumerate().take(lanes) {
                let (dir, pdf) = (draws.dir[lane], draws.pdf[lane]);
                // As for samples alone: a NaN is let through.
                if pdf != 0.0 {
                    let share = power_heuristic(pdf, light.pdf(dir));
                    *y += share * contribution(light.radiance(dir), draws.weight[lane]);
                }
            }
        }
        let blank = LightSample { dir: DVec3::Y, radiance: [0.0; 3], pdf: 0.0 };
        let mut from_light = [blank; 8];
        for sample in from_light.iter_mut().take(lanes) {
            *sample = light.sample(source.next_xi());
        }
        let (value, pdf) = case.eval(partner.unwrap_or(Sampler::Uniform), &from_light.map(|s| s.dir));
        for lane in 0..lanes {
            let s = &from_light[lane];
            if s.pdf != 0.0 {
                let share = if partner.is_some() { power_heuristic(s.pdf, pdf[lane]) } else { 1.0 };
                y[lane] += share * contribution(s.radiance, value[lane]) / s.pdf;
            }
        }
        for &y in &y[..lanes] {
            moments.push(y);
            largest = largest.max(y);
        }
        left -= lanes;
    }
    CellMoments { moments, max_weight: 0.0, max_contribution: largest }
}
