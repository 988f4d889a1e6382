//! Errors of the kernels of d'Eon's far field, by argument: the rounding of each factor times its condition number.

use super::azimuth::{Fit, ThreeGaussians};
use super::{DEonReference, DIFFUSE};
use crate::chiang::wrap;
use crate::interface::Reference as _;
use crate::real::Real;
use crate::steps::{four, inclination};
use hairis::{Lobe, PerLobe};

/// Error of the arithmetic of a lobe, which has functions with errors of their own.
const ARITHMETIC: f64 = 6.5e-6;
/// Largest error of an angle along the fibre, rad, times 5: up to an exponent of 12 M changes by less than `5 / sqrt(v)`.
const ALONG: f64 = 1.2e-6;
/// Error of an azimuth, rad.
const AZIMUTH: f64 = 4e-7;
/// Error of `theta_o` in the fit of TRT, rad.
const INCLINATION: f64 = 3e-7;
/// Error of the cosine of half the azimuth where it vanishes: a difference of products, of which each is off by the square of a rounding.
const OPPOSITE: f64 = 4e-16;
/// Error of the sine of half the azimuth and of `q` together, relative: ten roundings.
const EDGE: f64 = 6e-7;

/// Returns the share that a number has of another one, at most 1.
fn share<T: Real>(of: T, whole: T) -> T {
    if whole > of {
        of / whole
    } else {
        T::from_f64(1.0)
    }
}

impl<T: Real> DEonReference<T> {
    /// Returns the relative errors of each lobe's value and density; none where rounding decides whether the azimuth is one of TT.
    pub(super) fn errors(&self, wi: [T; 3]) -> Option<PerLobe<[T; 2]>> {
        let number = T::from_f64;
        let [sin, cos] = inclination(wi);
        let phi = wi[2].atan2(wi[1]) - self.phi_o;
        let half @ [sin_half, cos_half] = self.half(phi);
        let (beyond, off) = (self.passage.beyond(half)[0], number(EDGE) * sin_half);
        if beyond.abs() < off + off {
            return None;
        }
        // N of TT vanishes with a difference of two sines, and A with the square of it.
        let edge = share(off, beyond);
        Some(four(Lobe::FOUR.map(|lobe| {
            let plain = number(ARITHMETIC);
            if lobe == DIFFUSE {
                return [plain; 2];
            }
            let [exponent, width] = self.cone(lobe, phi).exponent(sin, cos);
            let along =
                (plain + number(ALONG) / width) * (exponent / number(12.0)).max(number(1.0));
            let [value, pdf] = match lobe {
                // The exponent has the square of the cosine of half the azimuth, which is a difference of products next to half a turn.
                Lobe::R => [number(4e-7) * exponent + share(number(OPPOSITE), cos_half); 2],
                Lobe::TT => [number(3.0) * edge, edge],
                _ => [self.error_trt(wrap(phi)); 2],
            };
            [along + value, along + pdf]
        })))
    }

    /// Returns the absolute errors of S that TT has next to its last azimuth, with those of the density in the same shares of S.
    pub(crate) fn slack(&self, wi: [T; 3]) -> [T; 3] {
        let (lobes, (value, pdf)) = (self.lobes(wi), self.eval_pdf(wi));
        let [sin, cos] = inclination(wi);
        let half @ [sin_half, _] = self.half(wi[2].atan2(wi[1]) - self.phi_o);
        let [beyond, steepness] = self.passage.beyond(half);
        let off = T::from_f64(EDGE) * sin_half;
        let of_n = self.cone_tt.density(sin, cos) * steepness * off;
        let of_pdf = if pdf > T::default() {
            self.probabilities[Lobe::TT] * of_n / pdf
        } else {
            T::default()
        };
        let edge = T::from_f64(3.0) * share(off, beyond);
        let at = &lobes[Lobe::TT];
        [0, 1, 2].map(|c| at.value * at.color[c] * edge + value[c] * of_pdf)
    }

    /// Returns the relative error of the azimuth of TRT: how far it moves as its angles do, over a break of the fit as well, and as the
    /// terms of the fit do.
    fn error_trt(&self, phi: T) -> T {
        let (number, zero) = (T::from_f64, T::default());
        let here = self.gaussians.density(phi);
        if here < number(1e-100) {
            return zero;
        }
        let change = |gaussians: ThreeGaussians<T>, phi: T| {
            (gaussians.density(phi) / here - number(1.0)).abs()
        };
        let fitted = |fit: &Fit<T>| ThreeGaussians::of(fit, self.roughness);
        let by_angles = [1.0, -1.0].map(|sign| {
            let theta = self.theta_o + number(sign * INCLINATION);
            change(self.gaussians, phi + number(sign * AZIMUTH))
                + change(fitted(&Fit::new(theta)), phi)
        });
        let terms = Fit::new(self.theta_o).rounded(self.theta_o);
        let by_terms = terms
            .iter()
            .fold(zero, |sum, fit| sum + change(fitted(fit), phi));
        by_angles[0].max(by_angles[1]) + by_terms
    }
}
