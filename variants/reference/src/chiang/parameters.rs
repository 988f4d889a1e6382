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
    /// Sets the tilt from a cuticle angle of `MaterialX`: see [`ChiangDesc::with_cuticle_angle`].
    #[must_use]
    fn with_cuticle_angle(self, angle: T) -> Self;

    /// Sets the absorption of melanin: see [`ChiangDesc::with_melanin`].
    #[must_use]
    fn with_melanin(self, eumelanin: T, pheomelanin: T) -> Self;

    /// Sets the absorption of an artist's melanin: see [`ChiangDesc::with_melanin_amount`].
    #[must_use]
    fn with_melanin_amount(self, amount: T, redness: T) -> Self;

    /// Sets the absorption of a colour: see [`ChiangDesc::with_color`].
    #[must_use]
    fn with_color(self, color: [T; 3]) -> Self;

    /// Computes the longitudinal variances of R, TT, TRT and the rest: `(width v)^2`, with `width` the lobe's `width_m` and
    /// `v = .726 beta_m + .812 beta_m^2 + 3.7 beta_m^20`. The rest has that of TRT.
    ///
    /// - Source: Chiang et al. 2016, section 4, with widths of 1, 1/2 and 2.
    #[must_use]
    fn variances(&self) -> PerLobe<T>;

    /// Computes the scales of the azimuthal logistics, rad: `width sqrt(pi / 8) (.265 beta_n + 1.194 beta_n^2 + 5.372 beta_n^22)`, with
    /// `width` the lobe's `width_n`. The rest, which has no logistic, has that of TRT.
    ///
    /// - Source: Chiang et al. 2016, section 4, with widths of 1.
    #[must_use]
    fn scales(&self) -> PerLobe<T>;

    /// Computes the shifts of `theta_i + theta_o`, rad: -2, +1, +4 and 0 tilts (d'Eon et al. 2011), or `2 p eta - 2` tilts.
    #[must_use]
    fn shift_angles(&self) -> PerLobe<T>;
}

impl<T: Real> ChiangFormulas<T> for ChiangDesc<T> {
    #[inline]
    fn with_cuticle_angle(self, angle: T) -> Self {
        Self {
            tilt: angle * T::PI - T::PI / T::from_f64(2.0),
            ..self
        }
    }

    #[inline]
    fn with_melanin(self, eumelanin: T, pheomelanin: T) -> Self {
        let (e, p) = (self.eumelanin, self.pheomelanin);
        Self {
            sigma_a: [0, 1, 2].map(|c| e[c] * eumelanin + p[c] * pheomelanin),
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
        let [root, _] = along(self.beta_m);
        let [r, tt, trt] = self.width_m.map(|width| width * root * (width * root));
        PerLobe::padded([r, tt], trt)
    }

    #[inline]
    fn scales(&self) -> PerLobe<T> {
        let [scale, _] = about(self.beta_n);
        let [r, tt, trt] = self.width_n.map(|width| width * scale);
        PerLobe::padded([r, tt], trt)
    }

    #[inline]
    fn shift_angles(&self) -> PerLobe<T> {
        let (number, tilt) = (T::from_f64, self.tilt);
        let two = number(2.0);
        let [tt, trt] = match self.shifts {
            Shifts::DEon => [number(1.0), number(4.0)],
            Shifts::SmallAngle => [two * self.eta - two, number(4.0) * self.eta - two],
        };
        PerLobe::padded([-two * tilt, tt * tilt, trt * tilt], T::default())
    }
}

/// Computes the longitudinal width of a roughness, and `d ln width / d ln m`.
fn along<T: Real>(m: T) -> [T; 2] {
    width(m, [0.726, 0.812, 3.7], 20.0)
}

/// Computes the scale of the azimuthal logistic of a roughness, rad, and `d ln scale / d ln n`.
fn about<T: Real>(n: T) -> [T; 2] {
    let [scale, steepness] = width(n, [0.265, 1.194, 5.372], 22.0);
    [(T::PI / T::from_f64(8.0)).sqrt() * scale, steepness]
}

/// Computes `a x + b x^2 + c x^power` and its steepness.
fn width<T: Real>(x: T, terms: [f64; 3], power: f64) -> [T; 2] {
    let power = T::from_f64(power);
    let [a, b, c] = terms.map(T::from_f64);
    let (first, second, last) = (a * x, b * x * x, c * x.powf(power));
    let sum = first + second + last;
    [sum, (first + second + second + power * last) / sum]
}

/// Width of a lobe along the fibre or about it, and the relative error that it may have in the kernels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Widened<T> {
    pub(super) width: T,
    pub(super) error: T,
}

/// Medulla of OSL's fibre, which widens TT, TRT and the rest by the share of the light that it has scattered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Medulla<T> {
    /// Optical depth of a passage across the fibre, and the relative error that it may have in the kernels.
    depth: T,
    depth_error: T,
    /// Roughnesses of TT and TRT along the fibre, and about it.
    along: [T; 2],
    about: [T; 2],
}

impl<T: Real> Medulla<T> {
    pub(super) fn new(parameters: &ChiangDesc<T>, scattering: T) -> Self {
        let (number, one) = (T::from_f64, T::from_f64(1.0));
        let [_, tt, trt] = parameters.width_m;
        let [width, _] = along(parameters.beta_m);
        let [_, tt_about, trt_about] = parameters.width_n;
        let [scale, _] = about(parameters.beta_n);
        let scattered = (scattering * scattering).min(number(0.99));
        let depth = -(-scattered).ln_1p();
        Self {
            depth,
            // Errors of the logarithm and of the quotient by the cosine, and the rounding of its argument: `d ln depth / d ln scattered` is
            // less than the second factor.
            depth_error: number(4e-7) + number(6e-8) / (one - scattered),
            along: [tt / number(0.5), trt / number(2.0)].map(|by| inverse(along, by * width)),
            about: [tt_about, trt_about].map(|by| inverse(about, by * scale)),
        }
    }

    /// Computes the widths of TT and TRT along the fibre, and about it, for a direction with this cosine of its inclination.
    pub(super) fn widths(&self, cos_theta_o: T) -> [[Widened<T>; 2]; 2] {
        let (number, one) = (T::from_f64, T::from_f64(1.0));
        let widened = |of: fn(T) -> [T; 2], roughness: T, passages: f64| {
            let depth = number(passages) * self.depth / cos_theta_o;
            let scattered = -(-depth).exp_m1();
            let (grown, most) = (roughness + scattered, roughness.max(one));
            // Six roundings of the share of the light, and that of its depth. A roughness beyond the end has no error.
            let off = number(3.6e-7) * scattered + self.depth_error * depth * (one - scattered);
            let off = if grown < most * number(1.0 + 1e-6) {
                off / grown
            } else {
                T::default()
            };
            let [width, steepness] = of(grown.min(most));
            Widened {
                width,
                // The roughness and its sum round once each, powers as often as half their steepness says, and the width four times.
                error: steepness * (off + number(1.8e-7)) + number(2.4e-7),
            }
        };
        let ([tt, trt], [tt_about, trt_about]) = (self.along, self.about);
        let times = |by: f64, widened: Widened<T>| Widened {
            width: number(by) * widened.width,
            ..widened
        };
        [
            [
                times(0.5, widened(along, tt, 1.0)),
                times(2.0, widened(along, trt, 2.0)),
            ],
            [
                widened(about, tt_about, 1.0),
                widened(about, trt_about, 2.0),
            ],
        ]
    }
}

/// Computes the roughness of a width by bisection.
fn inverse<T: Real>(of: fn(T) -> [T; 2], width: T) -> T {
    let half = T::from_f64(0.5);
    let (mut least, mut most) = (T::default(), T::from_f64(2.0));
    loop {
        let middle = half * (least + most);
        if middle <= least || middle >= most {
            return middle;
        }
        if of(middle)[0] < width {
            least = middle;
        } else {
            most = middle;
        }
    }
}
