//! Azimuthal lobe: a logistic distribution cut to one turn.

use crate::real::Real;

/// Logistic distribution of scale s on `[-pi, pi]`: Chiang et al. 2016, section 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Logistic<T> {
    scale: T,
    /// Mass of the uncut logistic below `-pi`, and within `[-pi, pi]`.
    below: T,
    within: T,
}

impl<T: Real> Logistic<T> {
    pub(super) fn scale(&self) -> T {
        self.scale
    }

    pub(super) fn new(scale: T) -> Self {
        let (one, two) = (T::from_f64(1.0), T::from_f64(2.0));
        let tail = (-T::PI / scale).exp();
        Self {
            scale,
            below: tail / (one + tail),
            within: (T::PI / (two * scale)).tanh(),
        }
    }

    /// Evaluates the density `e / (s (1 + e)^2 K)`, with `e = exp(-|x| / s)` and K the mass within `[-pi, pi]`.
    pub(super) fn density(&self, x: T) -> T {
        let e = (-x.abs() / self.scale).exp();
        let sum = T::from_f64(1.0) + e;
        e / (self.scale * sum * sum * self.within)
    }

    pub(super) fn sample(&self, xi: T) -> T {
        let one = T::from_f64(1.0);
        let odds = (self.below + xi * self.within) / (self.below + (one - xi) * self.within);
        (self.scale * odds.ln()).max(-T::PI).min(T::PI)
    }

    /// Computes the cdf from the nearer end, so that both tails keep their digits.
    pub(super) fn cdf(&self, x: T) -> T {
        let one = T::from_f64(1.0);
        let e = (-x.abs() / self.scale).exp();
        let tail = (e / (one + e) - self.below) / self.within;
        if x < T::default() { tail } else { one - tail }
    }
}

/// Moves `x` to `[-pi, pi]` by whole turns.
pub(crate) fn wrap<T: Real>(x: T) -> T {
    let turn = T::PI + T::PI;
    x - turn * (x / turn).round()
}
