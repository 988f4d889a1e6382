//! Formulas of the sources that do not hold, as they are printed.
//!
//! `kernels/ERRATA.md` lists the errata of Ou et al. 2012, and `variants/ERRATA.md` those of the second source. Tests show that the
//! corrected formulas pass where these fail, and the claims of the harness measure how far these are off.

use crate::published::CauchyDensity;
use crate::real::Real;

/// Makes the density of E1 of Ou et al., the longitudinal term in `theta_h`, whose constants A and B lack the half. The density is
/// normalised on an interval twice as long as the interval of `theta_h`.
#[must_use]
pub fn longitudinal<T: Real>(alpha: T, beta: T, theta_o: T) -> CauchyDensity<T> {
    let right = T::PI * T::from_f64(0.5);
    CauchyDensity::new(alpha, beta, theta_o - right, theta_o + right)
}

/// Computes the cdf of `theta_i` of E1 of Ou et al., which lacks the half and does not invert the printed sampler.
#[must_use]
pub fn longitudinal_cdf<T: Real>(alpha: T, beta: T, theta_o: T, theta_i: T) -> T {
    longitudinal(alpha, beta, theta_o).cdf(theta_i + theta_o)
}

/// Computes the antiderivative of the Cauchy density of E2 of Ou et al., which lacks 1/2.
#[must_use]
pub fn cauchy_antiderivative<T: Real>(width: T, x: T) -> T {
    (x / width).atan() / T::PI
}

/// Evaluates the density of the glint's azimuth of E3 of Ou et al., which lacks its end at a right angle.
#[must_use]
pub fn glint<T: Real>(phi_g: T, gamma_g: T, phi: T) -> T {
    let (half, right) = (T::from_f64(0.5), T::PI * T::from_f64(0.5));
    let whole = CauchyDensity::new(phi_g, gamma_g, T::default(), T::PI);
    half * whole.pdf(phi.abs()) / whole.cdf(right)
}

/// Evaluates the diffuse term of E3 of the second source, with the cosine that the integral has already.
#[must_use]
pub fn diffuse<T: Real>(kd: T, theta_i: T) -> T {
    kd * theta_i.cos() / (T::PI * T::PI)
}

/// Evaluates the cosine of the highlight of E4 of the second source, which peaks at the viewer.
#[must_use]
pub fn highlight_cosine<T: Real>(theta_i: T, theta_o: T) -> T {
    (theta_i - theta_o).cos()
}

/// Computes the sampled cosine from the cone's mantle of E8 of the second source, which overflows.
#[must_use]
pub fn cone_sample<T: Real>(variance: T, xi: T) -> T {
    let (two, inverse) = (T::from_f64(2.0), T::from_f64(1.0) / variance);
    let sinh = (inverse.exp() - (-inverse).exp()) / two;
    variance * (inverse.exp() - two * xi * sinh).ln()
}

/// Computes the length of a passage of E11 of the second source, in radii, for a ray of this refracted angle.
#[must_use]
pub fn path_length<T: Real>(gamma_t: T) -> T {
    let two = T::from_f64(2.0);
    two + two * (two * gamma_t).cos()
}

/// Computes `exp(-x) I0(x)` as several renderers do: by ten terms of the power series up to 12, and with half of `1 / (8 x)` in the
/// logarithm beyond.
#[must_use]
pub fn bessel_i0_scaled<T: Real>(x: T) -> T {
    let number = T::from_f64;
    if x > number(12.0) {
        let one = number(1.0);
        let log = -(number(2.0) * T::PI).ln() + (one / x).ln() + one / (number(8.0) * x);
        return (number(0.5) * log).exp();
    }
    let (mut term, mut sum) = (number(1.0), number(1.0));
    for k in 1..10_u32 {
        term = term * x * x / number(4.0 * f64::from(k * k));
        sum = sum + term;
    }
    sum * (-x).exp()
}
