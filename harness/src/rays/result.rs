//! The figures, as plain data: what reports print and JSON keeps.

use super::{EqualTime, RayTimes, VISIBLE};
use crate::efficiency::Check;
use hairis_instruments::stats::Estimate;
use serde::Serialize;

/// Everything about rays.
#[derive(Clone, Debug, Serialize)]
pub struct RaysResult {
    /// Pools of 32 + 32 candidates drawn per shading point; smaller pools are parts of them.
    pub pools: usize,
    /// Variances, by model, sampler and light: they depend on the seed alone.
    pub rows: Vec<RayRow>,
    /// Times of this machine, in the same order.
    pub times: Vec<RayTimes>,
    /// Efficiencies in equal time, in the same order.
    pub equal_time: Vec<EqualTime>,
    /// Whether the means agree with their references.
    pub check: Check,
}

/// One model and sampler under one light.
#[derive(Clone, Debug, Serialize)]
pub struct RayRow {
    /// The model.
    pub model: &'static str,
    /// The sampler of its candidates.
    pub sampler: &'static str,
    /// Name of the light.
    pub light: String,
    /// Geometric means over the poses.
    pub mean: RayFigures,
    /// Each pose.
    pub poses: Vec<RayPose>,
}

/// One shading point.
#[derive(Clone, Debug, Serialize)]
pub struct RayPose {
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// Expected value, the mean of RGB, with its standard error.
    pub reference: Estimate,
    /// Variances.
    pub figures: RayFigures,
    /// Bias of each mean in standard errors, corrected for skewness, where there were enough samples for a test.
    pub z: Vec<BiasScore>,
}

/// Bias of one mean.
#[derive(Clone, Debug, Serialize)]
pub struct BiasScore {
    /// The estimator.
    pub estimator: String,
    /// Bias in standard errors.
    pub z: f64,
    /// Whether there were enough effective samples for a test.
    pub tested: bool,
}

/// Relative variances of direct light.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RayFigures {
    /// A ray by the BSDF's sampler.
    pub bsdf: OneRay,
    /// A ray by the light's sampler.
    pub light: OneRay,
    /// A ray by one-sample MIS.
    pub mis: OneRay,
    /// A ray chosen from a pool, by [`SIZES`](super::SIZES).
    pub chosen: Vec<OneRay>,
    /// Pools and numbers of rays, half of the directions visible.
    pub half: Vec<PoolFigures>,
}

/// V of one ray.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OneRay {
    /// Without occlusion.
    pub unoccluded: Estimate,
    /// With the shares of [`VISIBLE`] visible: `(V + 1)/v - 1`.
    pub visible: [Estimate; 3],
}

impl OneRay {
    /// From V without occlusion.
    pub(super) fn new(unoccluded: Estimate) -> Self {
        Self {
            unoccluded,
            visible: VISIBLE.map(|share| occluded(unoccluded, share)),
        }
    }
}

/// V of one ray that passes with probability `share`, whatever its direction: from `E[X^2]/share` over the squared mean.
pub(crate) fn occluded(v: Estimate, share: f64) -> Estimate {
    Estimate {
        value: (v.value + 1.0) / share - 1.0,
        standard_error: v.standard_error / share,
    }
}

/// Several rays from one pool.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PoolFigures {
    /// Candidates of the BSDF, and as many of the light.
    pub candidates_each: u32,
    /// Choices.
    pub rays: u32,
    /// Rays that are left of them where equal choices are one ray, on average.
    pub traced: f64,
    /// V of the sum over the rays, half of the directions visible.
    pub v: Estimate,
}

impl RayFigures {
    /// Geometric means; numbers of rays have arithmetic ones.
    pub(super) fn mean(of: &[&Self]) -> Self {
        let mut mean = of[0].clone();
        let each: Vec<Vec<Estimate>> = of
            .iter()
            .map(|figures| {
                (*figures)
                    .clone()
                    .estimates()
                    .into_iter()
                    .map(|estimate| *estimate)
                    .collect()
            })
            .collect();
        for (place, estimate) in mean.estimates().into_iter().enumerate() {
            *estimate = Estimate::geometric_mean(
                &each
                    .iter()
                    .map(|figures| figures[place])
                    .collect::<Vec<_>>(),
            );
        }
        for (place, pool) in mean.half.iter_mut().enumerate() {
            pool.traced = of
                .iter()
                .map(|figures| figures.half[place].traced)
                .sum::<f64>()
                / of.len() as f64;
        }
        mean
    }

    /// Every V.
    fn estimates(&mut self) -> Vec<&mut Estimate> {
        let mut all = Vec::new();
        for ray in [&mut self.bsdf, &mut self.light, &mut self.mis]
            .into_iter()
            .chain(&mut self.chosen)
        {
            all.push(&mut ray.unoccluded);
            all.extend(&mut ray.visible);
        }
        all.extend(self.half.iter_mut().map(|pool| &mut pool.v));
        all
    }
}
