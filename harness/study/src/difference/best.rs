//! Width factor that fits best, by a search in one dimension.

use core::f64::consts;

/// Range of the factors that are tried, which the kernels accept.
pub const RANGE: [f64; 2] = [0.5, 4.0];

/// Relative precision to which the best factor is found.
const PRECISION: f64 = 1e-6;

/// Finds the minimum of `f` in [`RANGE`]: scans the range, then takes golden sections on either side of the best point.
///
/// # Errors
///
/// Returns the first error of `f`.
pub fn least<E>(mut f: impl FnMut(f64) -> Result<f64, E>) -> Result<f64, E> {
    const STEPS: i32 = 16;
    let [low, high] = RANGE.map(f64::ln);
    let at = |step: i32| low + (high - low) * f64::from(step) / f64::from(STEPS);
    let mut best = (0, f64::INFINITY);
    for step in 0..=STEPS {
        let value = f(at(step).exp())?;
        if value < best.1 {
            best = (step, value);
        }
    }
    let (mut low, mut high) = (at((best.0 - 1).max(0)), at((best.0 + 1).min(STEPS)));
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut a, mut b) = (high - golden * (high - low), low + golden * (high - low));
    let (mut f_a, mut f_b) = (f(a.exp())?, f(b.exp())?);
    while high - low > PRECISION {
        if f_a < f_b {
            (high, b, f_b) = (b, a, f_a);
            a = high - golden * (high - low);
            f_a = f(a.exp())?;
        } else {
            (low, a, f_a) = (a, b, f_b);
            b = low + golden * (high - low);
            f_b = f(b.exp())?;
        }
    }
    Ok(consts::E.powf(0.5 * (low + high)))
}
