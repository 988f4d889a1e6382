//! Bands of inclination, in each of which W is taken for constant.

use crate::Lanes;
use crate::lanes::pair::Pair;

/// A band between two inclinations of one sign.
#[derive(Clone, Copy)]
pub(super) struct Band {
    /// Sine of its end towards the pole.
    pub(super) outer: f32,
    /// Half of the inclination of its end towards the normal plane, rad.
    pub(super) half_inner: f32,
    /// Half of sine and cosine of the inclination where W is taken: at half of its area.
    half_sin: f32,
    half_cos: f32,
}

/// Most bands a side.
const MOST: usize = 12;

/// Where bands end, the pole and the normal plane left out: sine of the inclination, and half of it. By the distance of the sine
/// from 1 they shrink by a constant factor towards the pole, as W does there. Factors and first ends minimise the variance over
/// the grid of the efficiency figures; the distance of the last bounds how much of a lobe on the pole has a weight of
/// its own.
const ENDS: [&[[f32; 2]]; 3] = [
    &[[0.96875, 0.66007033], [0.875, 0.53271791], [0.5, 0.26179939]],
    &[[0.996, 0.74066188], [0.986, 0.70163424], [0.951, 0.62822711], [0.829, 0.48865860], [0.4, 0.20575842]],
    &[
        [0.9983, 0.75623927],
        [0.9969, 0.74601795],
        [0.9943, 0.73198738],
        [0.9897, 0.71357292],
        [0.9811, 0.68803329],
        [0.9655, 0.65367835],
        [0.937, 0.60697053],
        [0.885, 0.54324701],
        [0.79, 0.45540450],
        [0.617, 0.33246243],
        [0.3, 0.15234633],
    ],
];

/// The `N` bands of a side, from the pole to the normal plane.
#[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
pub(super) const fn bands<const N: usize>() -> [Band; N] {
    let ends = match N {
        4 => ENDS[0],
        6 => ENDS[1],
        MOST => ENDS[2],
        _ => panic!("4, 6 or 12 bands a side"),
    };
    let mut all = [Band { outer: 1.0, half_inner: 0.0, half_sin: 0.5, half_cos: 0.0 }; N];
    let mut j = 0;
    while j < N {
        let outer = if j > 0 { ends[j - 1][0] } else { 1.0 };
        let [inner, half_inner] = if j + 1 < N { ends[j] } else { [0.0, 0.0] };
        // In double precision: next to 1 the last digit of a sine is the fourth of its cosine.
        let sine = 0.5 * (outer as f64 + inner as f64);
        let (half_sin, half_cos) = ((0.5 * sine) as f32, (0.5 * cosine_of(sine)) as f32);
        all[j] = Band { outer, half_inner, half_sin, half_cos };
        j += 1;
    }
    all
}

/// The cosine that goes with a sine below 1, by Newton's rule.
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
    /// `W = (cos theta_i / cos theta_d)^2` in the middle of the band, below the normal plane and above it.
    #[inline(always)]
    pub(super) fn residual<L: Lanes>(&self, [half_sin_theta_o, half_cos_theta_o]: [L; 2]) -> Pair<L> {
        let c = L::splat;
        let (sin, cos) = (c(self.half_sin), half_cos_theta_o + c(self.half_cos));
        let (below, above, cos_sq) = (half_sin_theta_o - sin, half_sin_theta_o + sin, cos * cos);
        let cos_sq_theta_d = Pair(below.mul_add(below, cos_sq), above.mul_add(above, cos_sq));
        Pair::splat(4.0 * self.half_cos * self.half_cos) / cos_sq_theta_d
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check<const N: usize>() {
        let all = bands::<N>();
        for (j, band) in all.iter().enumerate() {
            let inner = libm::sin(2.0 * f64::from(band.half_inner));
            let next = all.get(j + 1).map_or(0.0, |next| f64::from(next.outer));
            assert!((inner - next).abs() < 1e-7, "{N}: the sine of the inner end of {j}: {inner} for {next}");
            assert!(next < f64::from(band.outer), "{N}: {j} has no area");
            let (sin, cos) = (2.0 * f64::from(band.half_sin), 2.0 * f64::from(band.half_cos));
            assert!((sin - 0.5 * (next + f64::from(band.outer))).abs() < 1e-7, "{N}: middle of {j}");
            assert!((sin.hypot(cos) - 1.0).abs() < 1e-7, "{N}: length of the middle of {j}");
        }
        assert_eq!(all[0].outer, 1.0, "from the pole");
        assert_eq!(all[N - 1].half_inner, 0.0, "to the normal plane");
    }

    #[test]
    fn bands_fill_a_side_without_a_gap() {
        check::<4>();
        check::<6>();
        check::<12>();
    }
}
