//! Order statistics of timing samples, which have a long right tail, so that the median and the quartiles describe them better than the
//! mean.

/// Returns the value below which a fraction `p` of `sorted` lies, by linear interpolation between order statistics.
///
/// `h = p (n - 1)`; type 7 of Hyndman and Fan 1996, the default of R and `NumPy`.
///
/// - Units: those of the samples; `p` in [0, 1], clamped.
/// - Shape: `sorted` ascending.
/// - Domain: NaN without samples.
#[must_use]
pub fn percentile(sorted: &[f64], p: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let h = p.clamp(0.0, 1.0) * last as f64;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 0 to `last`"
    )]
    let lo = h as usize;
    let (t, hi) = (h.fract(), (lo + 1).min(last));
    // The interpolation between equal neighbours must be exact, also if they are infinite.
    if t == 0.0 || sorted[lo] == sorted[hi] {
        sorted[lo]
    } else {
        sorted[lo] + t * (sorted[hi] - sorted[lo])
    }
}
