//! Directional albedo of the published model, by quadrature in the sampler's own coordinates.

use super::HairPoint;
use crate::lanes3;
use crate::math::sin_cos_twice;
use crate::quadrature::GAUSS_LEGENDRE_32;
use crate::truncated::TruncatedCauchy;
use crate::{Bell, Broadcast, Lanes, PerLobe};

/// Integral of a bell of width `width` over `[lo, hi]`, its centre at 0.
///
/// Over the cdf of the truncated Cauchy the integrand is bounded and smooth however narrow the bell.
#[inline]
pub(super) fn bell_area<B: Bell>(lo: f32, hi: f32, width: f32) -> f32 {
    let cauchy = TruncatedCauchy::new(lo, hi, width);
    let mut sum = 0.0;
    for (xi, weight) in GAUSS_LEGENDRE_32 {
        let x = cauchy.invert(xi);
        let d = 1.0 + x * x;
        sum += weight * d * B::one(x * x, 1.0 / d);
    }
    sum * cauchy.span * width
}

/// Directional albedo of each lobe, linear RGB.
#[inline(always)]
pub(crate) fn albedo<B: Bell, L: Lanes, C: Broadcast<L>>(point: &HairPoint<C>) -> PerLobe<[L; 3]> {
    let hair = &point.lobes;
    let (r, tt, trt) = (lanes3(&hair.color_r), lanes3(&hair.color_tt), lanes3(&hair.color_trt));
    // The azimuthal term of R and TRT-g, cos(phi / 2), has an area of 4.
    let four = L::splat(4.0);
    let area =
        [longitudinal::<B, L, C>(point, 0), longitudinal::<B, L, C>(point, 1), longitudinal::<B, L, C>(point, 2)];
    PerLobe([
        lobe(point, 0, area[0] * four, r),
        lobe(point, 1, area[1] * hair.azimuth_area[0].lanes(), tt),
        lobe(point, 2, area[2] * four, trt),
        lobe(point, 3, area[2] * hair.azimuth_area[1].lanes(), trt),
    ])
}

#[inline(always)]
fn lobe<L: Lanes, C: Broadcast<L>>(point: &HairPoint<C>, l: usize, area: L, color: [L; 3]) -> [L; 3] {
    let hair = &point.lobes;
    let albedo = area * hair.strength[l].lanes();
    let most = L::splat(f32::MAX);
    [(albedo * color[0]).min(most), (albedo * color[1]).min(most), (albedo * color[2]).min(most)]
}

/// `W = (cos theta_i / cos theta_d)^2`, what the bells leave out of `S cos theta_i`, from half of `theta_i`, and half the sine
/// and half the cosine of `theta_o`. Where both directions lie on opposite poles it is 0 / 0, and its limit is 0.
#[inline(always)]
fn residual<L: Lanes>(half_theta_i: L, [half_sin_theta_o, half_cos_theta_o]: [L; 2]) -> L {
    let quarter = L::splat(core::f32::consts::FRAC_PI_4);
    let (sin, cos) = sin_cos_twice((-quarter).max(quarter.min(half_theta_i)));
    let half = L::splat(0.5);
    let (mean_u, mean_c) = (sin.mul_add(half, half_sin_theta_o), cos.mul_add(half, half_cos_theta_o));
    cos * cos / mean_u.mul_add(mean_u, mean_c * mean_c).max(L::splat(f32::MIN_POSITIVE))
}

/// Integral of `M cos^2 theta_i / cos^2 theta_d` over `theta_i`.
#[inline(always)]
fn longitudinal<B: Bell, L: Lanes, C: Broadcast<L>>(point: &HairPoint<C>, l: usize) -> L {
    let c = L::splat;
    let one = c(1.0);
    let (beta, shift) = (point.lobes.beta[l].lanes(), point.shift[l].lanes());
    let quarter = c(core::f32::consts::FRAC_PI_4);
    let cauchy = TruncatedCauchy::new(shift - quarter, shift + quarter, beta);
    let half_theta_o = [point.half_sin_theta_o.lanes(), point.half_cos_theta_o.lanes()];
    let mut sum = c(0.0);
    let mut k = 0;
    while k < GAUSS_LEGENDRE_32.len() {
        let (xi, weight) = GAUSS_LEGENDRE_32[k];
        let x = cauchy.invert(c(xi));
        let w = residual(x.mul_add(beta, -shift), half_theta_o);
        let d = x.mul_add(x, one);
        sum = (d * B::one(x * x, one / d) * w).mul_add(c(weight), sum);
        k += 1;
    }
    // dtheta_i = 2 beta d(x).
    sum * cauchy.span * beta * c(2.0)
}
