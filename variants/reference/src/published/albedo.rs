//! Directional albedos of the lobes of the published model, by quadrature.

use super::{HairReference, colours};
use crate::quadrature::integrate;
use crate::real::Real;
use hairis::{Lobe, PerLobe};

/// Computes each albedo as the product of two integrals: `bell(theta_h - alpha) (cos theta_i / cos theta_d)^2` over `theta_i`, and N
/// over `phi`.
pub(super) fn albedo<T: Real>(book: &HairReference<T>) -> PerLobe<[T; 3]> {
    let (zero, half, two) = (T::default(), T::from_f64(0.5), T::from_f64(2.0));
    let p = &book.parameters;
    let (shape, right) = (book.shape, T::PI * half);
    let inclination = |i: usize| {
        let theta_o = book.theta_o;
        let integrand = |theta_i: T| {
            let ratio = theta_i.cos() / (half * (theta_o - theta_i)).cos();
            ratio * ratio * shape.bell(p.beta[i], half * (theta_i + theta_o) - p.alpha[i])
        };
        integrate(
            [-right, right],
            two * p.alpha[i] - theta_o,
            two * p.beta[i],
            integrand,
        )
    };
    let azimuth = |peak: T, width: T| {
        two * integrate([zero, T::PI], peak, width, |phi| {
            shape.bell(width, phi - peak)
        })
    };
    let cosine = T::from_f64(4.0);
    let areas = [
        cosine,
        azimuth(T::PI, p.gamma_tt),
        cosine,
        p.i_g * azimuth(p.phi_g, p.gamma_g),
    ];
    let inclinations = [inclination(0), inclination(1), inclination(2)];
    let colours = colours(p);
    let mut albedo = PerLobe::default();
    for lobe in Lobe::FOUR {
        let area = areas[lobe.index()] * inclinations[lobe.index().min(2)];
        albedo[lobe] = colours[lobe].map(|c| c * area);
    }
    albedo
}
