//! Bounds on the errors of the kernels' lobes: the rounding of angles times the steepness of the bells.

use super::cut::Cut;
use super::{Angles, CauchyDensity, HairReference, Shape};
use crate::real::Real;
use crate::steps::four;
use hairis::{Lobe, PerLobe};

/// Error of a lobe besides those of its bells: half a dozen roundings, and the shares of the lobes.
pub(super) const ROUNDINGS: f64 = 2e-6;
/// Error of `theta_h` and of its distance from a centre, rad: 1.2e-7 of half an angle, and two sums of angles of up to `3 pi / 4`.
pub(super) const INCLINATION: f64 = 3e-7;
/// Error of `phi` and of its distance from a centre, rad: twice the error of half an angle, of 8.5e-8 and as much for its tangent, and
/// of two sums.
const AZIMUTH: f64 = 5e-7;
/// Error of a Gaussian over its exponent, whose square takes four roundings: 3e-7, and twice the unit in the last place as the argument
/// of a power.
const EXPONENT: f64 = 5.5e-7;

/// Error of a function that integrates a bell from its centre, relative to its result.
const FUNCTION: f64 = 3e-7;

/// Returns the relative error of a bell of this width, at the distance `x` from its centre, as the distance errs by `off`: its logarithm
/// is quadratic, or flatter.
fn bell<T: Real>(shape: Shape, width: T, x: T, off: f64) -> T {
    let (two, off) = (T::from_f64(2.0), T::from_f64(off));
    let square = two * x.abs() * off + off * off;
    match shape {
        Shape::Gaussian => {
            let rounded = x * x * T::from_f64(EXPONENT);
            (square + rounded) / (two * width * width)
        }
        Shape::Cauchy => square / (x * x + width * width),
    }
}

/// Returns the error of the integral of a cut bell from its centre to `x` widths: what moves across `x` as it errs by `off` widths, the
/// rounding of the exponent there, and that of the function.
pub(super) fn integral<T: Real>(shape: Shape, cut: &Cut<T>, x: T, off: T) -> T {
    let rounded = match shape {
        Shape::Gaussian => x.abs() * T::from_f64(0.5 * EXPONENT),
        Shape::Cauchy => T::default(),
    };
    shape.bell(T::from_f64(1.0), x) * (off + rounded) + cut.centre_to(x) * T::from_f64(FUNCTION)
}

/// Returns the relative error of a density's integral as the distances of its ends from the centre err by `off`: what moves across them.
fn ends<T: Real>(density: &CauchyDensity<T>, [lo, hi]: [T; 2], off: f64) -> T {
    (density.pdf(lo) + density.pdf(hi)) * T::from_f64(off)
}

/// Returns the relative error of the integral of a cut bell over the azimuth, as its ends err.
pub(super) fn around<T: Real>(shape: Shape, cut: &Cut<T>, width: T) -> T {
    let off = T::from_f64(AZIMUTH) / width;
    let moved = cut.ends().map(|x| integral(shape, cut, x, off));
    if cut.area > T::default() {
        (moved[0] + moved[1]) / cut.area
    } else {
        T::default()
    }
}

/// Returns the relative errors of each lobe's value, whose bells have the shape of the model, and of its density, whose bells are cut
/// Cauchy bells.
pub(super) fn lobes<T: Real>(book: &HairReference<T>, at: &Angles<T>) -> PerLobe<[T; 2]> {
    let (p, half) = (&book.parameters, T::from_f64(0.5));
    let (theta_h, right) = ((at.theta_i + book.theta_o) * half, T::PI * half);
    let around = [(book.theta_o - right) * half, (book.theta_o + right) * half];
    let azimuth = |shape: Shape, lobe: Lobe| match lobe {
        Lobe::TT => bell(shape, p.gamma_tt, T::PI - at.phi.abs(), AZIMUTH),
        Lobe::GLINT => bell(shape, p.gamma_g, at.phi.abs() - p.phi_g, AZIMUTH),
        _ => T::default(),
    };
    let cut = |lobe: Lobe| match lobe {
        Lobe::TT => ends(&book.transmission, [T::default(), T::PI + T::PI], AZIMUTH),
        Lobe::GLINT => ends(&book.glint, [T::default(), right], AZIMUTH),
        _ => T::default(),
    };
    four(Lobe::FOUR.map(|lobe| {
        let l = lobe.index().min(2);
        let of = |shape: Shape| {
            let inclination = bell(shape, p.beta[l], theta_h - p.alpha[l], INCLINATION);
            T::from_f64(ROUNDINGS) + inclination + azimuth(shape, lobe)
        };
        let longitudinal = ends(&book.longitudinal[lobe], around, INCLINATION);
        [of(book.shape), of(Shape::Cauchy) + longitudinal + cut(lobe)]
    }))
}
