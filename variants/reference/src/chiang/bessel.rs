//! Scaled modified Bessel function of the first kind and order 0.

use crate::real::Real;

/// Computes the scaled modified Bessel function `exp(-x) I0(x)`, for `x >= 0`.
///
/// - Source: in `f64` Abramowitz & Stegun 9.6.12 (power series) below 30 and 9.7.1 (asymptotic series) above, both summed to the
///   last bit. In `f32`, where it is the inner loop of a baseline, polynomials of the same accuracy and fit as those of the kernels.
///
/// ```
/// use hairis_reference::bessel_i0_scaled;
/// assert!((bessel_i0_scaled(1.0_f64) * 1.0_f64.exp() - 1.266_065_877_752_008_4).abs() < 1e-15);
/// ```
#[inline]
#[must_use]
pub fn bessel_i0_scaled<T: Real>(x: T) -> T {
    let single = T::EPSILON > T::from_f64(1e-10);
    if single { fitted(x) } else { summed(x) }
}

fn summed<T: Real>(x: T) -> T {
    let number = T::from_f64;
    let (mut term, mut sum, mut k) = (number(1.0), number(1.0), number(0.0));
    if x < number(30.0) {
        let quarter_sq = x * x * number(0.25);
        while term > T::EPSILON * number(0.01) * sum {
            k = k + number(1.0);
            term = term * quarter_sq / (k * k);
            sum = sum + term;
        }
        return sum * (-x).exp();
    }
    while term > T::EPSILON * number(0.01) * sum {
        let odd = k + k + number(1.0);
        k = k + number(1.0);
        term = term * odd * odd / (number(8.0) * k * x);
        sum = sum + term;
    }
    sum / (number(2.0) * T::PI * x).sqrt()
}

/// Evaluates polynomials fitted to 2e-7: in `x` squared below 5.5, and in its inverse above.
fn fitted<T: Real>(x: T) -> T {
    const SERIES: [f32; 8] = [
        0.999_999_964_93,
        0.250_000_247_14,
        0.015_624_746_521,
        4.341_184_831_1e-4,
        6.766_766_700_5e-6,
        6.908_044_545e-8,
        4.144_287_593_5e-10,
        3.643_167_776e-12,
    ];
    const TAIL: [f32; 6] = [
        0.398_942_300_81,
        0.049_868_737_73,
        0.027_805_208_42,
        0.037_460_558_19,
        -0.055_432_330_86,
        0.535_620_729_8,
    ];
    if x < T::from_f64(5.5) {
        (-x).exp() * polynomial(&SERIES, x * x)
    } else {
        polynomial(&TAIL, T::from_f64(1.0) / x) / x.sqrt()
    }
}

fn polynomial<T: Real>(coefficients: &[f32], x: T) -> T {
    coefficients
        .iter()
        .rev()
        .fold(T::default(), |sum, c| sum * x + T::from_f32(*c))
}
