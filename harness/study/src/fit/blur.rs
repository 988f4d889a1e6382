//! Blur of values that are given at directions of a quadrature.

use crate::difference::blur::SIGMA_DEG;
use core::f64::consts::{PI, TAU};
use hairis_instruments::direction::direction;

/// Number of deviations at which the blur ends. All but 0.03% of the density is within.
const DEVIATIONS: f64 = 4.0;

/// Blur by the von Mises-Fisher density of [`SIGMA_DEG`] around some places of the sphere, for values at the directions of a quadrature.
#[derive(Clone, Debug)]
pub(super) struct Blur {
    /// Directions near each place, and their weights times the density.
    near: Vec<Vec<(usize, f64)>>,
}

impl Blur {
    /// Number of places, which are spread evenly.
    pub(super) const PLACES: usize = 384;
    /// Solid angle of a place.
    pub(super) const WEIGHT: f64 = 4.0 * PI / Self::PLACES as f64;

    /// Prepares the blur of values at the directions `wi`, by component, whose integrals have these weights.
    pub(super) fn new(wi: &[Vec<f32>; 3], weights: &[[f64; 2]]) -> Self {
        let kappa = SIGMA_DEG.to_radians().powi(2).recip();
        // The density: kappa / (4 pi sinh kappa) exp(kappa cos), without its overflow.
        let peak = kappa / (TAU * (1.0 - (-2.0 * kappa).exp()));
        let least = (DEVIATIONS * SIGMA_DEG.to_radians()).cos();
        let near = |place: usize| {
            let sin = (2.0 * place as f64 + 1.0) / Self::PLACES as f64 - 1.0;
            let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
            let axis = direction(
                sin,
                (1.0 - sin * sin).sqrt(),
                TAU * (golden * place as f64).fract(),
            );
            let density = |(at, [weight, _]): (usize, &[f64; 2])| {
                let cos: f64 = (wi.iter().zip(axis.to_array()))
                    .map(|(column, x)| f64::from(column[at]) * f64::from(x))
                    .sum();
                (cos > least && *weight > 0.0)
                    .then(|| (at, weight * peak * (kappa * (cos - 1.0)).exp()))
            };
            weights.iter().enumerate().filter_map(density).collect()
        };
        Self {
            near: (0..Self::PLACES).map(near).collect(),
        }
    }

    /// Returns the blurred values, by place.
    pub(super) fn values(&self, of: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let blurred = |near: &Vec<(usize, f64)>| {
            let mut sum = [0.0; 3];
            for (at, weight) in near {
                for (sum, x) in sum.iter_mut().zip(of[*at]) {
                    *sum += weight * x;
                }
            }
            sum
        };
        self.near.iter().map(blurred).collect()
    }

    /// Returns the derivatives by the values at so many directions, given those by the blurred values.
    pub(super) fn derivatives(&self, by_blurred: &[[f64; 3]], directions: usize) -> Vec<[f64; 3]> {
        let mut sums = vec![[0.0; 3]; directions];
        for (near, slopes) in self.near.iter().zip(by_blurred) {
            for (at, weight) in near {
                for (sum, slope) in sums[*at].iter_mut().zip(slopes) {
                    *sum += weight * slope;
                }
            }
        }
        sums
    }
}
