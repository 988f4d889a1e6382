//! Lambertian cylinder in the far field: its azimuth, and its sampler.

use crate::real::Real;

/// Computes `sin x - x cos x`, of which a Lambertian cylinder's azimuth is an eighth at `x` less than half a turn. Small numbers take the
/// series, because the difference cancels.
pub(crate) fn cylinder<T: Real>(x: T) -> T {
    const SERIES: [f64; 6] = [
        1.0 / 3.0,
        -1.0 / 30.0,
        1.0 / 840.0,
        -1.0 / 45_360.0,
        1.0 / 3_991_680.0,
        -1.0 / 518_918_400.0,
    ];
    if x < T::from_f64(0.25) {
        let square = x * x;
        let terms = SERIES.iter().rev();
        let sum = terms.fold(T::default(), |sum, c| sum * square + T::from_f64(*c));
        return square * x * sum;
    }
    x.sin() - x * x.cos()
}

/// Draws sine and cosine of `theta_i`, and the azimuth from that of `wo`: a point of the side that is seen, and a direction about its normal
/// by the cosine.
pub(crate) fn draw<T: Real>(xi: [T; 3]) -> ([T; 2], T) {
    let (one, two) = (T::from_f64(1.0), T::from_f64(2.0));
    let normal = (two * xi[0] - one).asin();
    let (radius, height) = (xi[1].sqrt(), (one - xi[1]).sqrt());
    let turn = T::PI * (two * xi[2] - one);
    let (along, across) = (radius * turn.sin(), radius * turn.cos());
    ([along, across.hypot(height)], normal + across.atan2(height))
}
