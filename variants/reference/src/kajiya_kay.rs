//! The model of Kajiya and Kay, formula by formula, in either precision.

use crate::interface::{LobeAt, Reference, ReferenceSample};
use crate::quadrature::integrate;
use crate::real::Real;
use crate::steps::{Fixed, GRAZING, choose, finish_sample, fixed, inclination, mix, sum_to_one};
use hairis::{Lobe, PerLobe};
use hairis_variants::kajiya_kay::{Form, KajiyaKayDesc};

const DIFFUSE: Lobe = Lobe::slot(0);
const SPECULAR: Lobe = Lobe::slot(1);

/// The model of Kajiya and Kay and its sampler, for one set of parameters and one `wo`.
///
/// `S = kd / pi^2 + ks c^p / (2 pi B(p + m) cos^(2 - m) theta_i)`, with `c = max(0, cos(theta_i + theta_o))`, `m` 2 for
/// [`Form::Reciprocal`] and 1 for [`Form::Published`], and `B(n)` the integral of `cos^n` over `[-pi/2, pi/2]`.
///
/// - Source: Kajiya & Kay 1989, section 4, with its cosines once (variants/ERRATA.md E3, E4) and normalised (E5). The sampler is
///   ours: the polar method for a power of a cosine, and a choice of sign for the factor that the power leaves out.
/// - Domain: within 1e-5 rad of the fibre axis `eval` and `pdf` are 0 and samples are discarded. `wo` may have any length.
/// - Accuracy: in `f32` the highlight is accurate to about `1e-7 exponent`; intensities above 1e37 may overflow.
///
/// ```
/// use hairis_reference::{KajiyaKayReference, Reference};
/// use hairis_variants::KajiyaKayParams;
/// let fiber = KajiyaKayReference::<f64>::prepare(&KajiyaKayParams::brown().desc().map(f64::from), [0.0, 1.0, 0.0]);
/// let drawn = fiber.sample([0.6, 0.4, 0.7]);
/// assert!((fiber.eval_pdf(drawn.wi).1 / drawn.pdf - 1.0).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KajiyaKayReference<T> {
    parameters: KajiyaKayDesc<T>,
    sin_theta_o: T,
    cos_theta_o: T,
    /// `B(p + m)` and `B(p)`.
    norm: T,
    norm_pdf: T,
    probabilities: PerLobe<T>,
}

/// Computes `B(n) = sqrt(pi) Gamma((n + 1) / 2) / Gamma(n / 2 + 1)`, the integral of `cos^n x` over `[-pi/2, pi/2]`, `n > -1`.
///
/// - Accuracy: 1e-11 relative for `n` up to 1e4 in `f64`. The computation is in `f64` whatever `T`, because the two logarithms
///   cancel.
///
/// ```
/// use hairis_reference::cosine_power_integral;
/// assert!((cosine_power_integral(2.0_f64) - 0.5 * core::f64::consts::PI).abs() < 1e-15);
/// ```
#[inline]
#[must_use]
pub fn cosine_power_integral<T: Real>(n: T) -> T {
    let n = n.to_f64();
    let log = Real::ln_gamma(0.5 * n + 0.5) - Real::ln_gamma(0.5 * n + 1.0);
    T::from_f64(Real::sqrt(core::f64::consts::PI) * Real::exp(log))
}

/// Returns `cos^m`, or 0 if the cosine is negative.
fn positive_power<T: Real>(cos: T, form: Form) -> T {
    let cos = cos.max(T::default());
    match form {
        Form::Reciprocal => cos * cos,
        Form::Published => cos,
    }
}

/// Constants of a material: the norms, which take four logarithms of the gamma function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KajiyaKayConstants<T> {
    parameters: KajiyaKayDesc<T>,
    /// `B(p + m)` and `B(p)`.
    norm: T,
    norm_pdf: T,
    /// Means of `kd` and of `ks`.
    weights: [T; 2],
    /// Share of `ks` that returns if `theta_o` is a right angle, without the tail beyond the pole.
    grazing: T,
}

impl<T: Real> KajiyaKayConstants<T> {
    /// Computes the constants of a material from its parameters.
    #[inline]
    #[must_use]
    pub fn new(parameters: &KajiyaKayDesc<T>) -> Self {
        let number = T::from_f64;
        let (p, one) = (parameters.exponent, number(1.0));
        let (norm, grazing) = match parameters.form {
            Form::Reciprocal => (cosine_power_integral(p + number(2.0)), one / (p + one)),
            Form::Published => {
                let norm = cosine_power_integral(p + one);
                (norm, one / ((p + one) * norm))
            }
        };
        let third = number(1.0 / 3.0);
        let mean = |rgb: [T; 3]| rgb[0] * third + rgb[1] * third + rgb[2] * third;
        Self {
            parameters: *parameters,
            norm,
            norm_pdf: cosine_power_integral(p),
            weights: [mean(parameters.kd), mean(parameters.ks)],
            grazing,
        }
    }

    /// Computes the constants of `wo`. Lobes are chosen by `kd`, and by `ks` times the share of it that is reflected, without the
    /// highlight's tail beyond the poles.
    #[inline]
    #[must_use]
    pub fn prepare(&self, wo: [T; 3]) -> KajiyaKayReference<T> {
        let Fixed {
            sin_theta_o,
            cos_theta_o,
            ..
        } = fixed(wo);
        let returned = match self.parameters.form {
            Form::Reciprocal => {
                cos_theta_o * cos_theta_o + sin_theta_o * sin_theta_o * self.grazing
            }
            Form::Published => cos_theta_o.hypot(sin_theta_o * self.grazing),
        };
        let ([diffuse, specular], zero) = (self.weights, T::default());
        KajiyaKayReference {
            parameters: self.parameters,
            sin_theta_o,
            cos_theta_o,
            norm: self.norm,
            norm_pdf: self.norm_pdf,
            probabilities: sum_to_one(PerLobe::padded([diffuse, specular * returned], zero)),
        }
    }
}

impl<T: Real> KajiyaKayReference<T> {
    /// Computes the constants of `parameters` and `wo`; for many `wo`, see [`KajiyaKayConstants`].
    #[inline]
    #[must_use]
    pub fn prepare(parameters: &KajiyaKayDesc<T>, wo: [T; 3]) -> Self {
        KajiyaKayConstants::new(parameters).prepare(wo)
    }

    fn lobes_at(&self, [sin_theta_i, cos_theta_i]: [T; 2]) -> PerLobe<LobeAt<T>> {
        let (two, p) = (T::from_f64(2.0), &self.parameters);
        let mut lobes = PerLobe::default();
        if cos_theta_i < T::from_f64(GRAZING) {
            return lobes;
        }
        let (sin_o, cos_o) = (self.sin_theta_o, self.cos_theta_o);
        // Cosines of theta_i + theta_o and of theta_i + 2 theta_o.
        let cos_sum = cos_theta_i * cos_o - sin_theta_i * sin_o;
        let cos_mirrored = cos_sum * cos_o - (sin_theta_i * cos_o + cos_theta_i * sin_o) * sin_o;
        let highlight = cos_sum.max(T::default()).powf(p.exponent);
        let weighted = positive_power(cos_theta_i, p.form);
        let per_cosine = weighted / cos_theta_i;
        lobes[DIFFUSE] = LobeAt {
            value: T::from_f64(1.0) / (T::PI * T::PI),
            color: p.kd,
            pdf: cos_theta_i / (T::PI * T::PI),
        };
        lobes[SPECULAR] = LobeAt {
            value: highlight * per_cosine / (two * T::PI * self.norm * cos_theta_i),
            color: p.ks,
            pdf: highlight * per_cosine
                / (T::PI * self.norm_pdf * (weighted + positive_power(cos_mirrored, p.form))),
        };
        lobes
    }

    /// Draws sine and cosine of `theta_i` from the highlight, and returns the remainder of `xi_sign` for the azimuth. The
    /// inclination is the angle of [`sample_angle`](Self::sample_angle), or its negative, less `theta_o`.
    #[inline]
    #[must_use]
    pub fn sample_specular(&self, xi_radius: T, xi_turn: T, xi_sign: T) -> ([T; 2], T) {
        let (zero, one) = (T::default(), T::from_f64(1.0));
        let (sin_o, cos_o) = (self.sin_theta_o, self.cos_theta_o);
        let [sin_x, cos_x] = self.sample_angle(xi_radius, xi_turn);
        let share = self.share_kept(sin_x, cos_x);
        let (sin_x, rest) = if xi_sign < share {
            (sin_x, xi_sign / share)
        } else {
            (-sin_x, (xi_sign - share) / (one - share))
        };
        (
            [
                sin_x * cos_o - cos_x * sin_o,
                (cos_x * cos_o + sin_x * sin_o).max(zero),
            ],
            rest,
        )
    }

    /// Draws sine and cosine of an angle x from the cone of mirror directions, of density `cos^p x / B(p)`, by the polar method with
    /// the squared radius `1 - (1 - xi_radius)^(2 / p)`. For diffuse light p is 2, and the squared radius is `xi_radius`.
    #[inline]
    #[must_use]
    pub fn sample_angle(&self, xi_radius: T, xi_turn: T) -> [T; 2] {
        let power = T::from_f64(2.0) / self.parameters.exponent;
        from_disk(-(power * (-xi_radius).ln_1p()).exp_m1(), xi_turn)
    }

    /// Returns the probability that x is kept and not turned into -x: the share of `cos_+^m theta_i` at x in the sum of both.
    #[inline]
    #[must_use]
    pub fn share_kept(&self, sin_x: T, cos_x: T) -> T {
        let (sin_o, cos_o) = (self.sin_theta_o, self.cos_theta_o);
        let kept = positive_power(cos_x * cos_o + sin_x * sin_o, self.parameters.form);
        let turned = positive_power(cos_x * cos_o - sin_x * sin_o, self.parameters.form);
        // Both are 0 only for wo along the fibre and x = 0, a sample that is discarded.
        if kept + turned > T::default() {
            kept / (kept + turned)
        } else {
            T::from_f64(1.0)
        }
    }

    /// Integrates the share of `ks` that returns: the integral of `cos_+^p x cos_+^m (x - theta_o)` over x, divided by `B(p + m)`.
    ///
    /// - Accuracy: 1e-9 in `f64`. The share is at most 1, and is 1 at `theta_o = 0`.
    #[inline]
    #[must_use]
    pub fn specular_albedo(&self) -> T {
        let one = T::from_f64(1.0);
        let (p, right) = (&self.parameters, T::PI * T::from_f64(0.5));
        let theta_o = self.sin_theta_o.atan2(self.cos_theta_o);
        let domain = [(theta_o - right).max(-right), (theta_o + right).min(right)];
        let integrand = |x: T| {
            let weighted = positive_power((x - theta_o).cos(), p.form);
            x.cos().max(T::default()).powf(p.exponent) * weighted
        };
        integrate(domain, T::default(), one / p.exponent.sqrt(), integrand) / self.norm
    }
}

impl<T: Real> Reference<T> for KajiyaKayReference<T> {
    /// Evaluates S and the density of the mixture, per steradian.
    #[inline]
    fn eval_pdf(&self, wi: [T; 3]) -> ([T; 3], T) {
        mix(&self.lobes(wi), &self.probabilities)
    }

    /// Evaluates each lobe's value, colour and own density, which are zeros in slots 2 and 3.
    ///
    /// The specular density is `c^p cos^(m-1) theta_i / (pi B(p) (cos^m theta_i + cos_+^m (theta_i + 2 theta_o)))`.
    #[inline]
    fn lobes(&self, wi: [T; 3]) -> PerLobe<LobeAt<T>> {
        self.lobes_at(inclination(wi))
    }

    /// Returns, for the highlight, the rounding of an angle times the steepness of `c^p`, `p tan (theta_i + theta_o)`, and the rounding of
    /// its exponent, `p ln c`. The cosine `c` is rounded twice; the density has `1 / cos theta_i`.
    fn lobe_errors(&self, wi: [T; 3]) -> Option<PerLobe<[T; 2]>> {
        let (p, number) = (self.parameters.exponent, T::from_f64);
        let [sin_i, cos_i] = inclination(wi);
        let sum = sin_i.atan2(cos_i) + self.sin_theta_o.atan2(self.cos_theta_o);
        let angle = p * (number(1.0) + number(2.0) * sum.tan().abs()) * number(1.2e-7);
        let exponent = p * sum.cos().max(number(1e-30)).ln() * number(4e-7);
        let mut errors = PerLobe::<[T; 2]>::default();
        errors[DIFFUSE] = [number(1e-6); 2];
        errors[SPECULAR] = [number(3e-6) + angle - exponent; 2];
        Some(errors)
    }

    /// Returns the probability of each lobe; all are 0 if nothing scatters.
    #[inline]
    fn probabilities(&self) -> PerLobe<T> {
        self.probabilities
    }

    /// Draws a sample by three uniform numbers in `[0, 1)`.
    ///
    /// - The first number chooses the lobe, and its remainder is used again; the third chooses the sign of the highlight's angle,
    ///   and its remainder the azimuth.
    /// - A sample within 1e-5 rad of the axis, or of zero density, is discarded, but counts as a sample.
    #[inline]
    fn sample(&self, xi: [T; 3]) -> ReferenceSample<T> {
        let Some((lobe, rest)) = choose(&self.probabilities, xi[0]) else {
            return ReferenceSample::default();
        };
        let (inclination, xi_phi) = if lobe == DIFFUSE {
            (from_disk(xi[1], rest), xi[2])
        } else {
            self.sample_specular(xi[1], rest, xi[2])
        };
        let phi_i = T::PI * (T::from_f64(2.0) * xi_phi - T::from_f64(1.0));
        finish_sample(
            lobe,
            inclination,
            phi_i,
            mix(&self.lobes_at(inclination), &self.probabilities),
        )
    }

    /// Returns the directional albedo of each lobe, linear RGB.
    #[inline]
    fn albedo(&self) -> PerLobe<[T; 3]> {
        let (p, zero) = (&self.parameters, T::default());
        let specular = self.specular_albedo();
        PerLobe::padded([p.kd, p.ks.map(|c| c * specular)], [zero; 3])
    }
}

/// Returns sine and cosine of the angle at a squared radius of the unit disk and `xi_turn` of half a turn.
fn from_disk<T: Real>(radius_sq: T, xi_turn: T) -> [T; 2] {
    let one = T::from_f64(1.0);
    let (sin, cos) = ((T::PI * xi_turn).sin(), (T::PI * xi_turn).cos());
    [
        radius_sq.sqrt() * cos,
        (one - radius_sq + radius_sq * sin * sin).sqrt().min(one),
    ]
}
