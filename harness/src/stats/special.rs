//! The special function a chi-square p-value needs.

/// Upper regularised incomplete gamma function `Q(a, x) = Gamma(a, x) / Gamma(a)`.
///
/// The p-value of a chi-square statistic `s` with `k` degrees of freedom is `Q(k/2, s/2)`.
///
/// - Source: series below `a + 1`, modified Lentz continued fraction above (Press et al., Numerical Recipes, 6.2).
/// - Domain: `a > 0`, `x >= 0`; `x = 0` gives 1, infinity gives 0; anything else gives NaN.
/// - Accuracy: 1e-12 absolute up to `a = 1e4`, which is a test of twenty thousand cells.
#[must_use]
pub fn regularised_gamma_q(a: f64, x: f64) -> f64 {
    if a.is_nan() || x.is_nan() || a <= 0.0 || x < 0.0 {
        return f64::NAN;
    }
    if x == 0.0 {
        return 1.0;
    }
    if x.is_infinite() {
        return 0.0;
    }
    let ln_prefix = a * x.ln() - x - libm::lgamma(a);
    // Both expansions need a few times sqrt(a) terms around x = a; the bound only stops a runaway loop.
    let limit = 1_000.0 + 40.0 * a.sqrt();
    if x < a + 1.0 {
        let mut term = 1.0 / a;
        let mut sum = term;
        let mut n = 0.0;
        while n < limit {
            n += 1.0;
            term *= x / (a + n);
            sum += term;
            if term < sum * f64::EPSILON {
                break;
            }
        }
        return (1.0 - sum * ln_prefix.exp()).clamp(0.0, 1.0);
    }
    let tiny = 1e-300;
    let mut b = x + 1.0 - a;
    let mut c = 1.0 / tiny;
    let mut d = 1.0 / b;
    let mut h = d;
    let mut n = 0.0;
    while n < limit {
        n += 1.0;
        let an = -n * (n - a);
        b += 2.0;
        d = an * d + b;
        d = 1.0 / if d.abs() < tiny { tiny } else { d };
        c = b + an / c;
        c = if c.abs() < tiny { tiny } else { c };
        let delta = d * c;
        h *= delta;
        if (delta - 1.0).abs() < f64::EPSILON {
            break;
        }
    }
    (ln_prefix.exp() * h).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gamma_q_with_integer_shape_is_the_poisson_sum() {
        // Q(n, x) = exp(-x) * sum_{k < n} x^k / k!, an independent closed form.
        for n in [1_u32, 2, 5, 20, 60] {
            for x in [0.01, 0.5, 1.0, 4.0, 19.0, 21.0, 80.0] {
                let mut term = 1.0;
                let mut sum = 0.0;
                for k in 0..n {
                    sum += term;
                    term *= x / f64::from(k + 1);
                }
                let want = sum * (-x).exp();
                let got = regularised_gamma_q(f64::from(n), x);
                assert!((got - want).abs() < 1e-13, "Q({n}, {x}) = {got}, want {want}");
            }
        }
    }

    #[test]
    fn gamma_q_at_large_shape_follows_wilson_hilferty() {
        // The cube-root normal approximation is good to about 1e-5 here; it shows that the expansions still converge.
        let a = 10_000.0_f64;
        for x in [9_800.0_f64, 9_999.0, 10_000.0, 10_200.0] {
            let z = ((x / a).cbrt() - (1.0 - 1.0 / (9.0 * a))) * (9.0 * a).sqrt();
            let tail = 0.5 * regularised_gamma_q(0.5, 0.5 * z * z);
            let want = if z > 0.0 { tail } else { 1.0 - tail };
            let got = regularised_gamma_q(a, x);
            assert!((got - want).abs() < 2e-5, "Q({a}, {x}) = {got}, about {want}");
        }
    }

    #[test]
    fn gamma_q_edges() {
        assert_eq!(regularised_gamma_q(3.0, 0.0), 1.0);
        assert_eq!(regularised_gamma_q(3.0, f64::INFINITY), 0.0);
        assert!(regularised_gamma_q(0.0, 1.0).is_nan());
        assert!(regularised_gamma_q(1.0, -1.0).is_nan());
        assert!(regularised_gamma_q(f64::NAN, 1.0).is_nan());
    }
}
