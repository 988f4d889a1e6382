//! Bands of inclination, in each of which W is approximated by a constant.

use super::hemispheres::Hemispheres;
use crate::simd::Lanes;

/// Band of inclination, and the band as far on the other side of the normal plane.
#[derive(Clone, Copy)]
pub(super) struct Band {
    /// Sine of the inclination at the end towards the pole.
    pub(super) outer: f32,
    /// Half of the inclination at the end towards the normal plane, rad.
    pub(super) half_inner: f32,
    /// Half of sine and cosine of the inclination where W is taken: at half of its area.
    half_sin: f32,
    half_cos: f32,
}

/// Largest number of bands on one side of the band in the middle.
const MOST: usize = 12;

/// Ends of the bands, without the poles: sine of the inclination, and half of the inclination. By the distance of the sine from 1
/// the bands shrink by a constant factor towards the pole, as W does there. Factor and first end minimise the variance over the grid
/// of the efficiency figures. The distance of the last end bounds how much of a lobe on the pole has a weight of its own.
const ENDS: [&[[f32; 2]]; 3] = [
    &[[0.935, 0.60412954], [0.598, 0.32050172]],
    &[
        [0.979, 0.68274841],
        [0.936, 0.60554465],
        [0.803, 0.46615599],
        [0.395, 0.20303393],
    ],
    &[
        [0.9956, 0.73847671],
        [0.993, 0.72620268],
        [0.9886, 0.70982796],
        [0.9817, 0.68959606],
        [0.9705, 0.66364801],
        [0.9525, 0.63067116],
        [0.9235, 0.58855333],
        [0.8767, 0.53447926],
        [0.8014, 0.46481610],
        [0.68, 0.37388132],
        [0.4844, 0.25283860],
        [0.1694, 0.08511042],
    ],
];

/// Computes the bands on one side of `all`, from the pole inwards, and then the band in the middle. Entries after it have no
/// meaning.
#[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
pub(super) const fn bands(all: usize) -> [Band; MOST + 1] {
    let ends = match all {
        5 => ENDS[0],
        9 => ENDS[1],
        25 => ENDS[2],
        _ => panic!("5, 9 or 25 bands"),
    };
    let mut side = [Band {
        outer: 1.0,
        half_inner: 0.0,
        half_sin: 0.0,
        half_cos: 0.5,
    }; MOST + 1];
    let mut j = 0;
    while j < ends.len() {
        let [inner, half_inner] = ends[j];
        let band = &mut side[j];
        band.half_inner = half_inner;
        // In double precision, because next to 1 the last digit of a sine is the fourth of its cosine.
        let sine = 0.5 * (band.outer as f64 + inner as f64);
        (band.half_sin, band.half_cos) = ((0.5 * sine) as f32, (0.5 * cosine_of(sine)) as f32);
        j += 1;
        side[j].outer = inner;
    }
    side
}

/// Returns the cosine that belongs to a sine below 1, by Newton's rule.
const fn cosine_of(sine: f64) -> f64 {
    let square = (1.0 - sine) * (1.0 + sine);
    let mut root = 1.0;
    let mut round = 0;
    while round < 16 {
        root = 0.5 * (root + square / root);
        round += 1;
    }
    root
}

impl Band {
    /// Returns `cos^2 theta_d` in the middle of the band, below the normal plane and above it: W is `cos_sq_theta_i` divided by it.
    #[inline(always)]
    pub(super) fn cos_sq_theta_d<L: Lanes, P: Hemispheres<L, K>, const K: usize>(
        &self,
        [half_sin_theta_o, half_cos_theta_o]: [L; 2],
    ) -> P {
        let sin = P::of(half_sin_theta_o) + P::outwards(self.half_sin);
        let cos = half_cos_theta_o + self.half_cos;
        sin.mul_add(sin, P::of(cos * cos))
    }

    /// Returns `cos^2 theta_i` in the middle of the band.
    #[inline(always)]
    pub(super) const fn cos_sq_theta_i(&self) -> f32 {
        4.0 * self.half_cos * self.half_cos
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_fill_a_side_without_a_gap() {
        for all in [5, 9, 25] {
            let side = &bands(all)[..=all / 2];
            assert_eq!(side[0].outer, 1.0, "{all}: from the pole");
            for (j, ends) in side.windows(2).enumerate() {
                let (band, next) = (&ends[0], f64::from(ends[1].outer));
                let inner = libm::sin(2.0 * f64::from(band.half_inner));
                assert!(
                    (inner - next).abs() < 1e-7,
                    "{all}: the inner end of {j}: {inner} for {next}"
                );
                assert!(
                    0.0 < inner && inner < f64::from(band.outer),
                    "{all}: {j} has no area"
                );
                let (sin, cos) = (
                    2.0 * f64::from(band.half_sin),
                    2.0 * f64::from(band.half_cos),
                );
                assert!(
                    (sin - 0.5 * (inner + f64::from(band.outer))).abs() < 1e-7,
                    "{all}: middle of {j}"
                );
                assert!(
                    (sin.hypot(cos) - 1.0).abs() < 1e-7,
                    "{all}: length of the middle of {j}"
                );
            }
        }
    }
}
