//! The chi-square distribution.

/// Probability of a chi-square value of at least `x` with `freedom` degrees: the upper regularised incomplete gamma
/// function of `freedom / 2` and `x / 2`, to about 1e-12.
///
/// - Source: Abramowitz and Stegun 6.5.29 below the mean, and the continued fraction 6.5.31 (Lentz) above.
pub(crate) fn chi_square_tail(x: f64, freedom: usize) -> f64 {
    let (a, x) = (0.5 * freedom as f64, 0.5 * x);
    if x <= 0.0 {
        return 1.0;
    }
    let scale = (a * x.ln() - x - ln_gamma(a)).exp();
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        while term > sum * 1e-16 {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        return 1.0 - scale * sum;
    }
    let mut b = x + 1.0 - a;
    let (mut c, mut d) = (1e300, 1.0 / b);
    let mut fraction = d;
    for n in 1..100_000_u32 {
        let n = f64::from(n);
        let numerator = -n * (n - a);
        b += 2.0;
        d = 1.0 / numerator.mul_add(d, b);
        c = b + numerator / c;
        fraction *= d * c;
        if (d * c - 1.0).abs() < 1e-15 {
            break;
        }
    }
    scale * fraction
}

/// Stirling's series, from 10 on; below, by recurrence.
fn ln_gamma(x: f64) -> f64 {
    if x < 10.0 {
        return ln_gamma(x + 1.0) - x.ln();
    }
    let r = 1.0 / (x * x);
    let series = (1.0 / 12.0 - r * (1.0 / 360.0 - r * (1.0 / 1260.0 - r / 1680.0))) / x;
    (x - 0.5) * x.ln() - x + 0.5 * (2.0 * core::f64::consts::PI).ln() + series
}

#[cfg(test)]
mod tests {
    use super::chi_square_tail;

    #[test]
    fn tails_are_those_of_the_tables() {
        // Percentiles of the chi-square distribution, from tables of five decimals or closed forms.
        let two = |x: f64| (-0.5 * x).exp();
        for x in [0.1, 1.0, 5.0, 30.0] {
            assert!((chi_square_tail(x, 2) / two(x) - 1.0).abs() < 1e-9, "two degrees at {x}");
        }
        for (x, freedom, tail) in
            [(3.841_459, 1, 0.05), (18.307_04, 10, 0.05), (23.209_25, 10, 0.01), (149.449_25, 100, 0.001)]
        {
            let got = chi_square_tail(x, freedom);
            assert!((got / tail - 1.0).abs() < 1e-4, "{freedom} degrees at {x}: {got}, not {tail}");
        }
    }
}
