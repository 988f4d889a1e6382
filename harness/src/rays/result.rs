//! Figures as plain data, which reports print and JSON keeps.

use super::VISIBLE;
use hairis_instruments::stats::Estimate;
use serde::Serialize;

/// Variances of one model and sampler under one light.
#[derive(Clone, Debug, Serialize)]
pub struct RayRow {
    /// Name of the model.
    pub model: &'static str,
    /// Name of the sampler that draws the candidates.
    pub sampler: &'static str,
    /// Name of the light.
    pub light: String,
    /// Geometric means over the poses.
    pub mean: RayFigures,
    /// Variances of each pose.
    pub poses: Vec<RayPose>,
}

/// Variances and biases at one shading point.
#[derive(Clone, Debug, Serialize)]
pub struct RayPose {
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// Expected value, as the mean of RGB, with its standard error.
    pub reference: Estimate,
    /// Relative variances at this point.
    pub figures: RayFigures,
    /// Bias of each mean in standard errors, corrected for skewness.
    pub z: Vec<BiasScore>,
}

/// Bias of one mean against its reference.
#[derive(Clone, Debug, Serialize)]
pub struct BiasScore {
    /// Name of the estimator.
    pub estimator: String,
    /// Bias in standard errors.
    pub z: f64,
    /// Whether there were enough effective samples for a test.
    pub tested: bool,
}

/// Relative variances of direct light, by estimator.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RayFigures {
    /// V of a ray by the BSDF's sampler.
    pub bsdf: OneRay,
    /// V of a ray by the light's sampler.
    pub light: OneRay,
    /// V of a ray by one-sample MIS.
    pub mis: OneRay,
    /// V of a ray chosen from a pool, one for each of [`SIZES`](super::SIZES).
    pub chosen: Vec<OneRay>,
    /// V from pools by number of rays, with half of the directions visible.
    pub half: Vec<PoolFigures>,
}

/// V of one ray, without occlusion and with partial visibility.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OneRay {
    /// V without occlusion.
    pub unoccluded: Estimate,
    /// V if the shares of [`VISIBLE`] are visible: `(V + 1)/v - 1`.
    pub visible: [Estimate; 3],
}

impl OneRay {
    /// Returns all figures, given V without occlusion.
    #[must_use]
    pub fn new(unoccluded: Estimate) -> Self {
        Self {
            unoccluded,
            visible: VISIBLE.map(|share| occluded(unoccluded, share)),
        }
    }
}

/// Returns V of one ray that passes with probability `share`, whatever its direction, from `E[X^2]/share` over the squared mean.
#[must_use]
pub fn occluded(v: Estimate, share: f64) -> Estimate {
    Estimate {
        value: (v.value + 1.0) / share - 1.0,
        standard_error: v.standard_error / share,
    }
}

/// V of several rays that are chosen from one pool.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PoolFigures {
    /// Number of candidates of the BSDF, and of the light.
    pub candidates_each: u32,
    /// Number of choices.
    pub rays: u32,
    /// Number of rays that are traced, on average, because equal choices are one ray.
    pub traced: f64,
    /// V of the sum over the rays, with half of the directions visible.
    pub v: Estimate,
}

impl RayFigures {
    /// Returns geometric means of V, and arithmetic means of the numbers of rays.
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

    /// Returns every V of the figures.
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
