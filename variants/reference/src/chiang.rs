//! The energy-conserving fibre of Chiang et al., formula by formula, in either precision.

mod azimuth;
mod bessel;
mod cone;
mod parameters;

use crate::interface::{LobeAt, Reference, ReferenceSample};
use crate::real::Real;
use crate::steps::{
    Fixed, GRAZING, choose, finish_sample, fixed, four, inclination, mix, sum_to_one,
};
use azimuth::Logistic;
use hairis::{Lobe, PerLobe};
use hairis_variants::ChiangDesc;

pub(crate) use azimuth::wrap;
pub use bessel::bessel_i0_scaled;
pub(crate) use cone::Cone;
use parameters::Medulla;
pub use parameters::{ChiangFormulas, Selection};

/// Lobe of all paths with two and more internal reflections, TRRT and beyond.
const REST: Lobe = Lobe::slot(3);

/// The model of Chiang et al. and its sampler, for one set of parameters, one `wo` and one offset across the fibre.
///
/// `S = sum_p A_p M_p N_p / cos theta_i`, p = R, TT, TRT and the rest. Tints are factors on A, and the rest has that of TRT.
///
/// - Source: Chiang et al. 2016; M from d'Eon et al. 2011, and its sampling from d'Eon et al. 2013, corrected by variants/ERRATA.md.
/// - Energy: the integral of `S cos theta_i` is the sum of A, exactly 1 without absorption and tints. The model is not reciprocal.
/// - Domain: within 1e-5 rad of the fibre axis `eval` and `pdf` are 0 and samples are discarded. `wo` may have any length; `h` is
///   clamped to `[-1, 1]`.
/// - Accuracy: in `f32`, at directions that it draws itself, within `2e-6 / min(sqrt(v_tt), s)`.
///
/// ```
/// use hairis_reference::{ChiangReference, Reference, Selection};
/// use hairis_variants::ChiangParams;
/// let parameters = ChiangParams::brown().desc().map(f64::from);
/// let fiber = ChiangReference::<f64>::prepare(&parameters, Selection::Mean, [0.0, 1.0, 0.0], 0.4);
/// let drawn = fiber.sample([0.1, 0.4, 0.7]);
/// assert!((fiber.eval_pdf(drawn.wi).1 / drawn.pdf - 1.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiangReference<T> {
    phi_o: T,
    cones: PerLobe<Cone<T>>,
    logistics: PerLobe<Logistic<T>>,
    /// Relative errors that widths by `wo` may have in the kernels, along the fibre and about it.
    width_errors: PerLobe<[T; 2]>,
    /// Azimuth of each lobe's centre from that of `wo`.
    centres: PerLobe<T>,
    fresnel: T,
    path_length: T,
    /// Optical depth of one passage, linear RGB.
    depth: [T; 3],
    attenuation: PerLobe<[T; 3]>,
    probabilities: PerLobe<T>,
}

/// Constants of a material: variances, the logistics, the shifts, and the tints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiangConstants<T> {
    eta: T,
    sigma_a: [T; 3],
    selection: Selection,
    variances: PerLobe<T>,
    /// Sine and cosine of each shift.
    shifts: PerLobe<[T; 2]>,
    logistics: PerLobe<Logistic<T>>,
    tints: PerLobe<[T; 3]>,
    medulla: Option<Medulla<T>>,
}

impl<T: Real> ChiangConstants<T> {
    /// Computes the constants of a material from its parameters and the criterion for the choice of a lobe.
    #[inline]
    #[must_use]
    pub fn new(parameters: &ChiangDesc<T>, selection: Selection) -> Self {
        Self {
            eta: parameters.eta,
            sigma_a: parameters.sigma_a,
            selection,
            variances: parameters.variances(),
            shifts: PerLobe(
                parameters
                    .shift_angles()
                    .0
                    .map(|shift| [shift.sin(), shift.cos()]),
            ),
            logistics: PerLobe(parameters.scales().0.map(Logistic::new)),
            tints: four([
                parameters.tint_r,
                parameters.tint_tt,
                parameters.tint_trt,
                parameters.tint_trt,
            ]),
            medulla: None,
        }
    }

    /// Adds the medulla of [`ScatteringChiang`](hairis_variants::chiang::ScatteringChiang) to a fibre with these parameters.
    #[inline]
    #[must_use]
    pub fn with_scattering(self, parameters: &ChiangDesc<T>, scattering: T) -> Self {
        let medulla = (scattering > T::default()).then(|| Medulla::new(parameters, scattering));
        Self { medulla, ..self }
    }

    /// Computes the constants of the direction `wo` and the offset `h`.
    #[inline]
    #[must_use]
    pub fn prepare(&self, wo: [T; 3], h: T) -> ChiangReference<T> {
        let number = T::from_f64;
        let (zero, one, two) = (T::default(), number(1.0), number(2.0));
        let Fixed {
            sin_theta_o,
            cos_theta_o,
            phi_o,
        } = fixed(wo);
        let h = h.max(-one).min(one);

        let (mut variances, mut logistics) = (self.variances, self.logistics);
        let mut width_errors = PerLobe::default();
        if let Some(medulla) = &self.medulla {
            let [along, about] = medulla.widths(cos_theta_o.max(number(1e-18)));
            let [v_tt, v_trt] = along.map(|root| root.width * root.width);
            variances = four([variances[Lobe::R], v_tt, v_trt, v_trt]);
            let [s_tt, s_trt] = about.map(|scale| Logistic::new(scale.width));
            logistics = PerLobe::padded([logistics[Lobe::R], s_tt], s_trt);
            let [tt, trt] = [0, 1].map(|lobe| [along[lobe].error, about[lobe].error]);
            width_errors = four([[zero; 2], tt, trt, trt]);
        }

        // Cones about theta' = theta_o - shift, folded back beyond a pole.
        let cone = |lobe: Lobe| {
            let [sin, cos] = self.shifts[lobe];
            let folded = (cos_theta_o * cos + sin_theta_o * sin).abs();
            Cone::new(
                variances[lobe],
                sin_theta_o * cos - cos_theta_o * sin,
                folded,
            )
        };

        // The refracted ray: sin gamma_t = h / eta', of the projected index eta' = sqrt(eta^2 - sin^2 theta_o) / cos theta_o.
        let contrast = (self.eta - one) * (self.eta + one);
        let root = (contrast + cos_theta_o * cos_theta_o).sqrt();
        let sin_gamma_t = if root > zero {
            (h * cos_theta_o / root).max(-one).min(one)
        } else {
            h
        };
        let cos_gamma_t = ((one - sin_gamma_t) * (one + sin_gamma_t)).sqrt();
        let (gamma_o, gamma_t) = (h.asin(), sin_gamma_t.asin());
        let centre = |p: f64| number(2.0 * p) * gamma_t - two * gamma_o + number(p) * T::PI;
        // One passage through the fibre, 2 cos gamma_t / cos theta_t, in radii.
        let path_length = two * self.eta * cos_gamma_t / root.max(number(1e-30));

        let cos_gamma_o = ((one - h) * (one + h)).sqrt();
        let [fresnel, passed] = fresnel(contrast, self.eta, cos_theta_o * cos_gamma_o);
        let depth = self.sigma_a.map(|sigma| sigma * path_length);
        let mut attenuation = attenuation(fresnel, passed, depth);
        for (lobe, tint) in attenuation.0.iter_mut().zip(self.tints.0) {
            *lobe = [0, 1, 2].map(|c| tint[c] * lobe[c]);
        }
        ChiangReference {
            phi_o,
            cones: PerLobe::padded([cone(Lobe::R), cone(Lobe::TT), cone(Lobe::TRT)], cone(REST)),
            logistics,
            width_errors,
            centres: four([centre(0.0), centre(1.0), centre(2.0), centre(3.0)]),
            fresnel,
            path_length,
            depth,
            attenuation,
            probabilities: probabilities(&attenuation, self.selection),
        }
    }
}

impl<T: Real> ChiangReference<T> {
    /// Computes the constants of `parameters`, `wo` and the offset `h`; for many hits, see [`ChiangConstants`].
    #[inline]
    #[must_use]
    pub fn prepare(parameters: &ChiangDesc<T>, selection: Selection, wo: [T; 3], h: T) -> Self {
        ChiangConstants::new(parameters, selection).prepare(wo, h)
    }

    /// Returns the unpolarised reflectance F of the surface at the hit.
    #[inline]
    #[must_use]
    pub fn fresnel(&self) -> T {
        self.fresnel
    }

    /// Returns the length of one passage through the fibre, in radii.
    #[inline]
    #[must_use]
    pub fn path_length(&self) -> T {
        self.path_length
    }

    /// Returns the azimuth of a lobe's centre from that of `wo`, in rad and of any number of turns:
    /// `2 p gamma_t - 2 gamma_o + p pi`.
    #[inline]
    #[must_use]
    pub fn centre(&self, lobe: Lobe) -> T {
        self.centres[lobe]
    }

    /// Returns the inclination of a lobe's cone, in rad: `-theta'`, where M peaks unless the lobe is wide.
    #[inline]
    #[must_use]
    pub fn cone(&self, lobe: Lobe) -> T {
        self.cones[lobe].inclination()
    }

    /// Evaluates the longitudinal term M of a lobe, after d'Eon et al. 2011.
    ///
    /// - Integral: `M cos theta_i` is 1 over `[-pi/2, pi/2]`.
    #[inline]
    #[must_use]
    pub fn longitudinal(&self, lobe: Lobe, theta_i: T) -> T {
        self.cones[lobe].density(theta_i.sin(), theta_i.cos())
    }

    /// Evaluates the azimuthal term N of a lobe at `phi_i - phi_o`, which may have any number of turns.
    ///
    /// - Integral: 1 over a turn.
    #[inline]
    #[must_use]
    pub fn azimuthal(&self, lobe: Lobe, phi: T) -> T {
        if lobe == REST {
            T::from_f64(0.5) / T::PI
        } else {
            self.logistics[lobe].density(wrap(phi - self.centres[lobe]))
        }
    }

    fn lobes_at(&self, sin_theta_i: T, cos_theta_i: T, phi: T) -> PerLobe<LobeAt<T>> {
        let mut lobes = PerLobe::default();
        for lobe in Lobe::FOUR {
            let pdf =
                self.cones[lobe].density(sin_theta_i, cos_theta_i) * self.azimuthal(lobe, phi);
            lobes[lobe] = LobeAt {
                value: pdf / cos_theta_i,
                color: self.attenuation[lobe],
                pdf,
            };
        }
        lobes
    }

    /// Draws sine and cosine of `theta_i` from a lobe, after d'Eon et al. 2013.
    #[inline]
    #[must_use]
    pub fn sample_inclination(&self, lobe: Lobe, xi_cone: T, xi_turn: T) -> [T; 2] {
        self.cones[lobe].direction(self.cones[lobe].sample(xi_cone), xi_turn)
    }

    /// Draws `1 - cos` of the angle from a lobe's cone, in `[0, 2]`, by one uniform number.
    #[inline]
    #[must_use]
    pub fn sample_cone(&self, lobe: Lobe, xi: T) -> T {
        self.cones[lobe].sample(xi)
    }

    /// Returns the cdf of the number that [`sample_cone`](Self::sample_cone) draws, which is its inverse.
    #[inline]
    #[must_use]
    pub fn cdf_cone(&self, lobe: Lobe, delta: T) -> T {
        self.cones[lobe].cdf(delta)
    }

    /// Draws the azimuth from a lobe's centre, in `[-pi, pi]`, by one uniform number.
    #[inline]
    #[must_use]
    pub fn sample_azimuth(&self, lobe: Lobe, xi: T) -> T {
        if lobe == REST {
            T::PI * (xi + xi - T::from_f64(1.0))
        } else {
            self.logistics[lobe].sample(xi)
        }
    }

    /// Returns the cdf of the azimuth that [`sample_azimuth`](Self::sample_azimuth) draws, which is its inverse.
    #[inline]
    #[must_use]
    pub fn cdf_azimuth(&self, lobe: Lobe, x: T) -> T {
        if lobe == REST {
            T::from_f64(0.5) * (x / T::PI + T::from_f64(1.0))
        } else {
            self.logistics[lobe].cdf(x)
        }
    }
}

impl<T: Real> Reference<T> for ChiangReference<T> {
    /// Evaluates S and the density of the mixture, per steradian.
    #[inline]
    fn eval_pdf(&self, wi: [T; 3]) -> ([T; 3], T) {
        mix(&self.lobes(wi), &self.probabilities)
    }

    /// Evaluates each lobe's value, colour and own density: `M N / cos theta_i`, A, `M N`.
    #[inline]
    fn lobes(&self, wi: [T; 3]) -> PerLobe<LobeAt<T>> {
        let [sin_theta_i, cos_theta_i] = inclination(wi);
        if cos_theta_i < T::from_f64(GRAZING) {
            return PerLobe::default();
        }
        self.lobes_at(sin_theta_i, cos_theta_i, wi[2].atan2(wi[1]) - self.phi_o)
    }

    /// Returns, for each lobe, the error of the arithmetic, and the rounding of angles times the steepness of M and N. Along the fibre it is
    /// 2.4e-7 rad: up to an exponent of 12 M changes by less than `5 / sqrt(v)`, and beyond the error grows as the exponent does. About
    /// the fibre it grows with the azimuth of the lobe's centre, and N changes by less than `1 / s`. Errors of widths by `wo` count as often
    /// as `d ln M / d ln v <= exponent + 1` and `d ln N / d ln s <= |x| / s + 1` say.
    fn lobe_errors(&self, wi: [T; 3]) -> Option<PerLobe<[T; 2]>> {
        let [sin, cos] = inclination(wi);
        let phi = wi[2].atan2(wi[1]) - self.phi_o;
        let number = T::from_f64;
        Some(four(Lobe::FOUR.map(|lobe| {
            let [exponent, width] = self.cones[lobe].exponent(sin, cos);
            let mut errors = number(6.5e-6) + number(1.2e-6) / width;
            let mut from_centre = number(0.0);
            if lobe != REST {
                let scale = self.logistics[lobe].scale();
                errors = errors + number(5e-7 * (1 + lobe.index()) as f64) / scale;
                from_centre = wrap(phi - self.centres[lobe]).abs() / scale;
            }
            let [along, about] = self.width_errors[lobe];
            let of_widths =
                (along + along) * (exponent + number(1.0)) + about * (from_centre + number(1.0));
            [errors * (exponent / number(12.0)).max(number(1.0)) + of_widths; 2]
        })))
    }

    /// Returns the error of a colour besides that of its lobe: six roundings of its optical depth.
    fn color_error(&self, lobe: Lobe, channel: usize) -> T {
        T::from_f64(3.6e-7 * lobe.index() as f64) * self.depth[channel]
    }

    /// Returns the probability of each lobe; all are 0 if everything is absorbed.
    #[inline]
    fn probabilities(&self) -> PerLobe<T> {
        self.probabilities
    }

    /// Draws a sample by three uniform numbers in `[0, 1)`.
    ///
    /// - The first number chooses the lobe, and its remainder the azimuth; the other two choose the inclination.
    /// - A sample within 1e-5 rad of the axis, or of zero density, is discarded, but counts as a sample.
    #[inline]
    fn sample(&self, xi: [T; 3]) -> ReferenceSample<T> {
        let Some((lobe, rest)) = choose(&self.probabilities, xi[0]) else {
            return ReferenceSample::default();
        };
        let inclination @ [sin_theta_i, cos_theta_i] = self.sample_inclination(lobe, xi[1], xi[2]);
        let phi = self.centres[lobe] + self.sample_azimuth(lobe, rest);
        if cos_theta_i < T::from_f64(GRAZING) {
            return ReferenceSample::default();
        }
        let lobes = self.lobes_at(sin_theta_i, cos_theta_i, phi);
        finish_sample(
            lobe,
            inclination,
            self.phi_o + phi,
            mix(&lobes, &self.probabilities),
        )
    }

    /// Returns A of each lobe, linear RGB and tinted: the share of the light that leaves by the lobe, which is its directional albedo.
    #[inline]
    fn albedo(&self) -> PerLobe<[T; 3]> {
        self.attenuation
    }
}

/// Computes F and `1 - F` of unpolarised light at an angle of this cosine; the difference is exact where F is nearly 1.
fn fresnel<T: Real>(contrast: T, eta: T, cos: T) -> [T; 2] {
    let (half, two, one) = (T::from_f64(0.5), T::from_f64(2.0), T::from_f64(1.0));
    // eta cos of the refracted angle.
    let inner = (contrast + cos * cos).sqrt();
    let (eta_sq, outer) = (eta * eta, cos + inner);
    if outer <= T::default() {
        return [T::default(), one];
    }
    let parallel_sum = eta_sq * cos + inner;
    let [perpendicular, parallel] = [(cos - inner) / outer, (eta_sq * cos - inner) / parallel_sum];
    let passed =
        two * cos * inner * (one / (outer * outer) + eta_sq / (parallel_sum * parallel_sum));
    [
        half * (perpendicular * perpendicular + parallel * parallel),
        passed,
    ]
}

/// Computes A of R, TT, TRT and of all the rest, a geometric series, after Chiang et al. 2016, section 3; `depth` is that of one
/// passage.
fn attenuation<T: Real>(fresnel: T, passed: T, depth: [T; 3]) -> PerLobe<[T; 3]> {
    let mut all = PerLobe::padded([[fresnel; 3]], [T::default(); 3]);
    for (channel, depth) in depth.into_iter().enumerate() {
        let (transmitted, absorbed) = ((-depth).exp(), -(-depth).exp_m1());
        let tt = passed * passed * transmitted;
        let trt = tt * fresnel * transmitted;
        // 1 - F T.
        let lost = (passed + fresnel * absorbed).max(T::from_f64(1e-30));
        all[Lobe::TT][channel] = tt;
        all[Lobe::TRT][channel] = trt;
        all[REST][channel] = trt * fresnel * transmitted / lost;
    }
    all
}

fn probabilities<T: Real>(attenuation: &PerLobe<[T; 3]>, selection: Selection) -> PerLobe<T> {
    let zero = T::default();
    let mut returned = [zero; 3];
    for (channel, sum) in returned.iter_mut().enumerate() {
        *sum = attenuation
            .0
            .into_iter()
            .fold(zero, |sum, lobe| sum + lobe[channel]);
    }
    sum_to_one(PerLobe(attenuation.0.map(|lobe| match selection {
        Selection::Mean => lobe[0] + lobe[1] + lobe[2],
        Selection::ByChannel => {
            let share = |c: usize| {
                if returned[c] > zero {
                    lobe[c] / returned[c]
                } else {
                    zero
                }
            };
            let [r, g, b] = [share(0), share(1), share(2)];
            (r * r + g * g + b * b).sqrt()
        }
    })))
}
