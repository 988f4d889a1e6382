//! Residuals: the distance by view and by lobe.

use super::points::{Points, ratio};
use super::{Look, Norm};
use hairis::ParamError;
use serde::Serialize;

/// Distance of two models seen from one inclination, in several norms.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Residual {
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// Distance in L1, relative to the norm of the first model.
    pub l1: f64,
    /// Distance in L2, relative to the norm of the first model.
    pub l2: f64,
    /// L1 of the mean of RGB, as [`difference`](crate::difference) measures it.
    pub l1_mean: f64,
    /// Albedo of the first model: the integral of `S cos theta_i`, mean of RGB.
    pub albedo_from: f64,
    /// Albedo of the other model.
    pub albedo_to: f64,
    /// Distance in L1 by the lobes of the first model. At each direction the distance is divided as S is.
    pub lobes: Vec<f64>,
}

/// Returns the residuals of a model from each view of the points.
///
/// # Errors
///
/// Returns an error if a value is out of its range.
pub fn residuals(from: &Look, other: &Look, points: &Points) -> Result<Vec<Residual>, ParamError> {
    let material = from.model.material(&from.values)?;
    let values = points.values(&other.model.material(&other.values)?);
    let rows = values.iter().enumerate().map(|(view, values)| {
        let [l1, l2] = [Norm::L1, Norm::L2].map(|norm| {
            let [difference, own] = points.sums(view, values, norm);
            ratio(difference, own, norm)
        });
        let mut mean = [0.0; 2];
        let pairs = points.look[view].iter().zip(values);
        for ([weight, _], (look, value)) in points.weights[view].iter().zip(pairs) {
            let [look, value] = [look, value].map(|s| s.iter().sum::<f64>() / 3.0);
            mean[0] += weight * (look - value).abs();
            mean[1] += weight * look;
        }
        let albedo = |of: &[[f64; 3]]| -> f64 {
            let terms = points.weights[view].iter().zip(of);
            terms
                .map(|([weight, _], s)| weight * s.iter().sum::<f64>() / 3.0)
                .sum()
        };
        let own = points.sums(view, values, Norm::L1)[1].max(f64::MIN_POSITIVE);
        let mut lobes = vec![0.0; from.model.lobes().len()];
        let bsdfs = points.bsdfs(&material, view);
        for (place, ([weight, _], value)) in points.weights[view].iter().zip(values).enumerate() {
            let [x, y, z] = points.wi[view].each_ref().map(|column| column[place]);
            let mut shares = vec![0.0; lobes.len()];
            for bsdf in &bsdfs {
                for (share, lobe) in shares
                    .iter_mut()
                    .zip(bsdf.lobes(glam::Vec3::new(x, y, z)).0)
                {
                    *share += f64::from(lobe.value) * f64::from(lobe.color.iter().sum::<f32>());
                }
            }
            let total: f64 = shares.iter().sum();
            let look = &points.look[view][place];
            let difference: f64 = look.iter().zip(value).map(|(a, b)| (a - b).abs()).sum();
            for (lobe, share) in lobes.iter_mut().zip(&shares) {
                // If the first model evaluates to zero, every lobe gets the same share.
                let share = if total > 0.0 {
                    share / total
                } else {
                    1.0 / shares.len() as f64
                };
                *lobe += weight * difference * share / own;
            }
        }
        Residual {
            theta_o_deg: f64::from(points.views[view].x).asin().to_degrees(),
            l1,
            l2,
            l1_mean: mean[0] / mean[1].max(f64::MIN_POSITIVE),
            albedo_from: albedo(&points.look[view]) / points.view_weights[view],
            albedo_to: albedo(values) / points.view_weights[view],
            lobes,
        }
    });
    Ok(rows.collect())
}
