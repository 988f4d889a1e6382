//! Formulas of widths, shifts and absorption, and the criterion for the choice of a lobe.

use crate::real::Real;
use hairis::PerLobe;
use hairis_variants::chiang::{ChiangDesc, Shifts};

/// Criterion by which the sampler chooses a lobe.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Selection {
    /// Mean over the channels of each lobe's attenuation, which gives the least variance of a grey result.
    #[default]
    Mean,
    /// The lobe's shares of red, green and blue, `sqrt(sum_c (A_pc / sum_k A_kc)^2)`, which even out the variances of the channels.
    ByChannel,
}

impl Selection {
    /// Returns the criterion of [`Chiang`](hairis_variants::Chiang) with this value of its constant.
    #[inline]
    #[must_use]
    pub const fn of(by_channel: bool) -> Self {
        if by_channel {
            Self::ByChannel
        } else {
            Self::Mean
        }
    }
}

/// Formulas of the parameters of the model of Chiang et al., in either precision.
pub trait ChiangFormulas<T: Real>: Sized {
    /// Sets the absorption of melanin: see [`ChiangDesc::with_melanin`].
    #[must_use]
    fn with_melanin(self, eumelanin: T, pheomelanin: T) -> Self;

    /// Sets the absorption of an artist's melanin: see [`ChiangDesc::with_melanin_amount`].
    #[must_use]
    fn with_melanin_amount(self, amount: T, redness: T) -> Self;

    /// Sets the absorption of a colour: see [`ChiangDesc::with_color`].
    #[must_use]
    fn with_color(self, color: [T; 3]) -> Self;

    /// Computes the longitudinal variances of R, TT, TRT and the rest: `v0`, `v0 / 4`, `4 v0`, `4 v0`, with
    /// `v0 = (.726 beta_m + .812 beta_m^2 + 3.7 beta_m^20)^2`.
    ///
    /// - Source: Chiang et al. 2016, section 4.
    #[must_use]
    fn variances(&self) -> PerLobe<T>;

    /// Computes the scale of the azimuthal logistic, rad: `sqrt(pi / 8) (.265 beta_n + 1.194 beta_n^2 + 5.372 beta_n^22)`.
    ///
    /// - Source: Chiang et al. 2016, section 4.
    #[must_use]
    fn scale(&self) -> T;

    /// Computes the shifts of `theta_i + theta_o`, rad: -2, +1, +4 and 0 tilts (d'Eon et al. 2011), or `2 p eta - 2` tilts.
    #[must_use]
    fn shift_angles(&self) -> PerLobe<T>;
}

impl<T: Real> ChiangFormulas<T> for ChiangDesc<T> {
    #[inline]
    fn with_melanin(self, eumelanin: T, pheomelanin: T) -> Self {
        let channel = |e: f64, p: f64| T::from_f64(e) * eumelanin + T::from_f64(p) * pheomelanin;
        Self {
            sigma_a: [
                channel(0.419, 0.187),
                channel(0.697, 0.4),
                channel(1.37, 1.05),
            ],
            ..self
        }
    }

    #[inline]
    fn with_melanin_amount(self, amount: T, redness: T) -> Self {
        let one = T::from_f64(1.0);
        let quantity = -(one - amount).max(T::from_f64(1e-4)).ln();
        self.with_melanin(quantity * (one - redness), quantity * redness)
    }

    #[inline]
    fn with_color(self, color: [T; 3]) -> Self {
        let (number, n) = (T::from_f64, self.beta_n);
        let coefficients = [0.245, 5.574, -10.73, 2.532, -0.215, 5.969];
        let denominator = coefficients
            .into_iter()
            .fold(T::default(), |sum, c| sum * n + number(c));
        let absorption = |c: T| {
            let root = c.max(number(1e-3)).ln() / denominator;
            root * root
        };
        Self {
            sigma_a: color.map(absorption),
            ..self
        }
    }

    #[inline]
    fn variances(&self) -> PerLobe<T> {
        let (number, m) = (T::from_f64, self.beta_m);
        let root = number(0.726) * m + number(0.812) * m * m + number(3.7) * m.powf(number(20.0));
        let v = root * root;
        PerLobe([v, v / number(4.0), number(4.0) * v, number(4.0) * v])
    }

    #[inline]
    fn scale(&self) -> T {
        let (number, n) = (T::from_f64, self.beta_n);
        let sum = number(0.265) * n + number(1.194) * n * n + number(5.372) * n.powf(number(22.0));
        (T::PI / number(8.0)).sqrt() * sum
    }

    #[inline]
    fn shift_angles(&self) -> PerLobe<T> {
        let (number, tilt) = (T::from_f64, self.tilt);
        let two = number(2.0);
        let [tt, trt] = match self.shifts {
            Shifts::DEon => [number(1.0), number(4.0)],
            Shifts::SmallAngle => [two * self.eta - two, number(4.0) * self.eta - two],
        };
        PerLobe([-two * tilt, tt * tilt, trt * tilt, T::default()])
    }
}
