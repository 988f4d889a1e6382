//! D'Eon's far field, formula by formula, in either precision.

mod azimuth;
mod errors;
mod rtxcr;

use crate::chiang::{Cone, wrap};
use crate::cylinder::{self, cylinder};
use crate::interface::{LobeAt, Reference, ReferenceSample};
use crate::quadrature::integrate;
use crate::real::Real;
use crate::steps::{
    Fixed, GRAZING, choose, finish_sample, fixed, four, inclination, mix, sum_to_one,
};
use azimuth::{Passage, ThreeGaussians, mean_reflectance, normal_reflectance, schlick};
use hairis::params::Pigments;
use hairis::{Lobe, LobeMask, PerLobe};
use hairis_variants::DEonDesc;

pub use rtxcr::{RtxcrFaults, RtxcrReference};

const DIFFUSE: Lobe = Lobe::slot(3);
/// Least `cos(phi/2)` in the width of R.
const LEAST_SQUEEZE: f64 = 0.1;
/// Least `cos theta_o` in the width of TT.
const LEAST_COSINE: f64 = 1e-3;
/// Largest reflectance over the density of the offset that R draws, in multiples of the mean reflectance, away from the edge.
const MIDDLE: f64 = 1.65;

/// D'Eon's far field and its sampler, for one set of parameters and one `wo`.
///
/// `S = sum_p A_p(phi) M_p N_p / cos theta_i` over R, TT and TRT, and a Lambertian cylinder as fourth lobe.
///
/// - Source: N, widths and attenuations of d'Eon 2022 as RTXCR has them, at the inclination of `wo`; M of d'Eon et al. 2011; TRT with the
///   light of all further paths. The guide of `hairis_variants::d_eon` derives each.
/// - Energy: the integral of `S cos theta_i` is exactly 1 without absorption.
/// - Domain: within 1e-5 rad of the fibre axis `eval` and `pdf` are 0 and samples are discarded. `wo` may have any length.
///
/// ```
/// use hairis_reference::{DEonReference, Reference};
/// use hairis_variants::DEonParams;
/// let fiber = DEonReference::<f64>::prepare(&DEonParams::brown().desc().map(f64::from), [0.0, 1.0, 0.0]);
/// let drawn = fiber.sample([0.6, 0.4, 0.7]);
/// assert!((fiber.eval_pdf(drawn.wi).1 / drawn.pdf - 1.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DEonReference<T> {
    roughness: T,
    phi_o: T,
    cos_theta_o: T,
    /// Magnitude of `theta_o`, rad.
    theta_o: T,
    f0: T,
    /// Sine and cosine of the cone of R, whose width depends on the azimuth.
    cone_r: [T; 2],
    cone_tt: Cone<T>,
    cone_trt: Cone<T>,
    passage: Passage<T>,
    gaussians: ThreeGaussians<T>,
    /// Depth of a diameter in the normal plane: `2 sigma_a / cos theta_t`.
    depth: [T; 3],
    /// Share of R, TT and TRT.
    kept: T,
    attenuation_trt: [T; 3],
    diffuse: [T; 3],
    /// Mean of the reflectance over the width.
    reflectance: T,
    /// Share of the uniform offsets among those of which R draws one.
    uniform: T,
    probabilities: PerLobe<T>,
}

/// Returns the absorption of these concentrations of eumelanin and pheomelanin, with d'Eon's pigments.
pub(crate) fn absorption_of_melanin<T: Real>([eumelanin, pheomelanin]: [T; 2]) -> [T; 3] {
    let Pigments {
        eumelanin: e,
        pheomelanin: p,
    } = Pigments::D_EON;
    [0, 1, 2].map(|c| T::from_f32(e[c]) * eumelanin + T::from_f32(p[c]) * pheomelanin)
}

impl<T: Real> DEonReference<T> {
    /// Computes the constants of `parameters` and `wo`.
    #[inline]
    #[must_use]
    pub fn prepare(parameters: &DEonDesc<T>, wo: [T; 3]) -> Self {
        let number = T::from_f64;
        let (one, two) = (number(1.0), number(2.0));
        let Fixed {
            sin_theta_o: sin,
            cos_theta_o: k,
            phi_o,
        } = fixed(wo);
        let DEonDesc {
            roughness,
            tilt,
            eta,
            sigma_a,
            diffuse,
            diffuse_color,
        } = *parameters;
        let f0 = normal_reflectance(eta);
        let contrast = (eta - one) * (eta + one);

        // Cones about theta' = theta_o - shift, folded back beyond a pole.
        let cone = |tilts: f64| {
            let (s, c) = ((number(tilts) * tilt).sin(), (number(tilts) * tilt).cos());
            [sin * c - k * s, (k * c + sin * s).abs()]
        };
        let squared = |x: T| x * x;
        let [sin_tt, cos_tt] = cone(1.0);
        let [sin_trt, cos_trt] = cone(3.0);
        let theta = sin.atan2(k).abs();
        let variance_tt =
            squared(roughness / two) * contrast / squared(k.max(number(LEAST_COSINE)));
        let variance_trt = squared(roughness * (two + theta * theta.sqrt()));

        let inv_cos_t = eta / (contrast + k * k).sqrt();
        let depth = sigma_a.map(|sigma| two * sigma * inv_cos_t);
        let passage = Passage::new(eta, k);
        let [mean, passed, both] = mean_reflectance(f0, k);
        let kept = one - diffuse;
        let attenuation_trt = depth.map(|depth| kept * both * (number(-1.875) * depth).exp());
        let diffuse = diffuse_color.map(|c| diffuse * c);

        // The mean of F, TT along its shortest path, TRT and the diffuse lobe.
        let shortest = passage.cos_gamma_t(one);
        let mean_of = |rgb: [T; 3]| (rgb[0] + rgb[1] + rgb[2]) / number(3.0);
        let probabilities = sum_to_one(four([
            kept * mean,
            kept * passed * mean_of(depth.map(|depth| (-depth * shortest).exp())),
            mean_of(attenuation_trt),
            mean_of(diffuse),
        ]));
        Self {
            roughness,
            phi_o,
            cos_theta_o: k,
            theta_o: theta,
            f0,
            cone_r: cone(-2.0),
            cone_tt: Cone::new(variance_tt, sin_tt, cos_tt),
            cone_trt: Cone::new(variance_trt, sin_trt, cos_trt),
            passage,
            gaussians: ThreeGaussians::new(roughness, theta),
            depth,
            kept,
            attenuation_trt,
            diffuse,
            reflectance: mean,
            uniform: schlick(f0, k) / mean,
            probabilities,
        }
    }

    /// Returns the cone of a lobe at the azimuth `phi` of `wi` from that of `wo`; the diffuse lobe has none.
    fn cone(&self, lobe: Lobe, phi: T) -> Cone<T> {
        match lobe {
            Lobe::TT => self.cone_tt,
            Lobe::TRT => self.cone_trt,
            _ => {
                let squeeze = self.half(phi)[1].max(T::from_f64(LEAST_SQUEEZE));
                let width = self.roughness * squeeze;
                let [sin, cos] = self.cone_r;
                Cone::new(T::from_f64(2.0) * width * width, sin, cos)
            }
        }
    }

    /// Returns the magnitude of the sine, and the cosine, of half an azimuth of any number of turns.
    fn half(&self, phi: T) -> [T; 2] {
        let half = T::from_f64(0.5) * wrap(phi);
        [half.sin().abs(), half.cos().max(T::default())]
    }

    /// Returns the inclination of a lobe's cone, in rad, where M peaks unless the lobe is wide.
    #[inline]
    #[must_use]
    pub fn cone_inclination(&self, lobe: Lobe) -> T {
        self.cone(lobe, T::default()).inclination()
    }

    /// Evaluates the longitudinal term M of R, TT or TRT at the azimuth `phi` of `wi` from that of `wo`, which matters for R.
    ///
    /// - Integral: `M cos theta_i` is 1 over `[-pi/2, pi/2]`.
    #[inline]
    #[must_use]
    pub fn longitudinal(&self, lobe: Lobe, theta_i: T, phi: T) -> T {
        self.cone(lobe, phi).density(theta_i.sin(), theta_i.cos())
    }

    /// Evaluates the azimuthal term N of a lobe at `phi_i - phi_o`, which may have any number of turns.
    ///
    /// - Integral: 1 over a turn.
    #[inline]
    #[must_use]
    pub fn azimuthal(&self, lobe: Lobe, phi: T) -> T {
        let half @ [_, cos_half] = self.half(phi);
        match lobe {
            Lobe::R => T::from_f64(0.25) * cos_half,
            Lobe::TT => self.passage.at(half)[0],
            Lobe::TRT => self.gaussians.density(wrap(phi)),
            _ => T::from_f64(0.125) * cylinder(T::PI - wrap(phi).abs()),
        }
    }

    /// Evaluates the density of a lobe's azimuth: N, and for R about `F N`, from the mixture of [`sample_azimuth`](Self::sample_azimuth).
    ///
    /// - Integral: 1 over a turn.
    #[inline]
    #[must_use]
    pub fn azimuth_pdf(&self, lobe: Lobe, phi: T) -> T {
        let n = self.azimuthal(lobe, phi);
        if lobe == Lobe::R {
            let h = self.half(phi)[0];
            n * self.offset_pdf(h)
        } else {
            n
        }
    }

    /// Evaluates the density of the magnitude of the offset `h` in `[0, 1]` that R draws: of a uniform number with the share of `F(k)` in
    /// the mean of F, and of the eighth root of one.
    fn offset_pdf(&self, h: T) -> T {
        let (square, one) = (h * h, T::from_f64(1.0));
        self.uniform + (one - self.uniform) * T::from_f64(8.0) * (square * square * square * h)
    }

    /// Evaluates the attenuation A of a lobe at an azimuth, linear RGB.
    #[inline]
    #[must_use]
    pub fn attenuation(&self, lobe: Lobe, phi: T) -> [T; 3] {
        let half @ [_, cos_half] = self.half(phi);
        match lobe {
            Lobe::R => [self.kept * schlick(self.f0, self.cos_theta_o * cos_half); 3],
            Lobe::TT => {
                let [_, cos_gamma_i, cos_gamma_t] = self.passage.at(half);
                self.attenuation_tt(cos_gamma_i, cos_gamma_t)
            }
            Lobe::TRT => self.attenuation_trt,
            _ => self.diffuse,
        }
    }

    fn attenuation_tt(&self, cos_gamma_i: T, cos_gamma_t: T) -> [T; 3] {
        let passed = T::from_f64(1.0) - schlick(self.f0, self.cos_theta_o * cos_gamma_i);
        let clear = self.kept * passed * passed;
        self.depth.map(|depth| clear * (-depth * cos_gamma_t).exp())
    }

    /// Returns the largest weight of each lobe alone, linear RGB, of which [`weight_bound`](Reference::weight_bound) is made: the
    /// attenuation, and for R its ratio to the density of the offset.
    #[inline]
    #[must_use]
    pub fn largest_weights(&self) -> PerLobe<[T; 3]> {
        let one = T::from_f64(1.0);
        // At the edge F is 1; elsewhere the ratio is at most 1.65 times the mean of F, which a test finds on a grid.
        let inside = T::from_f64(MIDDLE) * self.reflectance;
        four([
            [self.kept * (one / self.offset_pdf(one)).max(inside); 3],
            self.attenuation_tt(one, self.passage.cos_gamma_t(one)),
            self.attenuation_trt,
            self.diffuse,
        ])
    }

    fn lobes_at(&self, [sin_theta_i, cos_theta_i]: [T; 2], phi: T) -> PerLobe<LobeAt<T>> {
        let mut lobes = PerLobe::default();
        for lobe in Lobe::FOUR {
            let along = if lobe == DIFFUSE {
                T::from_f64(2.0) * cos_theta_i / T::PI
            } else {
                self.cone(lobe, phi).density(sin_theta_i, cos_theta_i)
            };
            lobes[lobe] = LobeAt {
                value: along * self.azimuthal(lobe, phi) / cos_theta_i,
                color: self.attenuation(lobe, phi),
                pdf: along * self.azimuth_pdf(lobe, phi),
            };
        }
        lobes
    }

    /// Draws the azimuth of R, TT or TRT, from that of `wo`, by one uniform number.
    #[inline]
    #[must_use]
    pub fn sample_azimuth(&self, lobe: Lobe, xi: T) -> T {
        let (zero, one) = (T::default(), T::from_f64(1.0));
        let signed = |xi: T| xi + xi - one;
        match lobe {
            Lobe::R => {
                let h = if xi < self.uniform {
                    signed(xi / self.uniform)
                } else {
                    let power = signed((xi - self.uniform) / (one - self.uniform));
                    let h = power.abs().sqrt().sqrt().sqrt();
                    if power < zero { -h } else { h }
                };
                T::from_f64(2.0) * h.max(-one).min(one).asin()
            }
            Lobe::TT => self.passage.azimuth(signed(xi)),
            _ => self.gaussians.sample(xi),
        }
    }

    /// Draws sine and cosine of `theta_i`, and the azimuth from that of `wo`.
    fn draw(&self, lobe: Lobe, xi: [T; 3]) -> ([T; 2], T) {
        if lobe == DIFFUSE {
            return cylinder::draw(xi);
        }
        let phi = self.sample_azimuth(lobe, xi[1]);
        let cone = self.cone(lobe, phi);
        (cone.direction(cone.sample(xi[0]), xi[2]), phi)
    }
}

impl<T: Real> Reference<T> for DEonReference<T> {
    /// Evaluates S and the density of the mixture, per steradian.
    #[inline]
    fn eval_pdf(&self, wi: [T; 3]) -> ([T; 3], T) {
        mix(&self.lobes(wi), &self.probabilities)
    }

    /// Evaluates each lobe's value, colour and own density: `M N / cos theta_i`, A, and M times [`azimuth_pdf`](Self::azimuth_pdf).
    #[inline]
    fn lobes(&self, wi: [T; 3]) -> PerLobe<LobeAt<T>> {
        let theta @ [_, cos_theta_i] = inclination(wi);
        if cos_theta_i < T::from_f64(GRAZING) {
            return PerLobe::default();
        }
        self.lobes_at(theta, wi[2].atan2(wi[1]) - self.phi_o)
    }

    /// Returns, for each lobe, the error of the arithmetic, and the rounding of angles times the steepness of M and N. N of TT vanishes at an
    /// azimuth, next to which its error grows, and TRT jumps with `theta_o` where the pieces of its fit meet.
    fn lobe_errors(&self, wi: [T; 3]) -> Option<PerLobe<[T; 2]>> {
        self.errors(wi)
    }

    /// Returns the error of a colour besides that of its lobe: the roundings of its reflectance and of its optical depth.
    fn color_error(&self, lobe: Lobe, channel: usize) -> T {
        let paths = match lobe {
            Lobe::TT => 1.0,
            Lobe::TRT => 1.875,
            _ => 0.0,
        };
        T::from_f64(4e-6) + T::from_f64(6e-7 * paths) * self.depth[channel]
    }

    /// Returns the probability of each lobe; all are 0 if everything is absorbed.
    #[inline]
    fn probabilities(&self) -> PerLobe<T> {
        self.probabilities
    }

    /// Draws a sample by three uniform numbers in `[0, 1)`.
    ///
    /// - The first number chooses the lobe, and its remainder the angle from the cone, as the third does; the second chooses the azimuth.
    /// - A sample within 1e-5 rad of the axis, or of zero density, is discarded, but counts as a sample.
    #[inline]
    fn sample(&self, xi: [T; 3]) -> ReferenceSample<T> {
        let Some((lobe, rest)) = choose(&self.probabilities, xi[0]) else {
            return ReferenceSample::default();
        };
        let (theta, phi) = self.draw(lobe, [rest, xi[1], xi[2]]);
        if theta[1] < T::from_f64(GRAZING) {
            return ReferenceSample::default();
        }
        let lobes = self.lobes_at(theta, phi);
        finish_sample(
            lobe,
            theta,
            self.phi_o + phi,
            mix(&lobes, &self.probabilities),
        )
    }

    /// Returns the directional albedo of each lobe: closed forms, and for TT an integral over the width of the fibre.
    #[inline]
    fn albedo(&self) -> PerLobe<[T; 3]> {
        let (right, zero) = (T::from_f64(0.5) * T::PI, T::default());
        let passed = |channel: usize| {
            integrate([zero, right], zero, right, |gamma: T| {
                let inside = self.passage.cos_gamma_t(gamma.sin());
                gamma.cos() * self.attenuation_tt(gamma.cos(), inside)[channel]
            })
        };
        four([
            [self.kept * self.reflectance; 3],
            [passed(0), passed(1), passed(2)],
            self.attenuation_trt,
            self.diffuse,
        ])
    }

    /// Returns the largest ratio of a lobe's largest attenuation, in the mean of the channels, to its share in the probabilities.
    #[inline]
    fn weight_bound(&self, mask: LobeMask) -> Option<T> {
        let zero = T::default();
        let lit = Lobe::FOUR.into_iter().filter(|lobe| mask.contains(*lobe));
        let share = lit
            .clone()
            .fold(zero, |sum, lobe| sum + self.probabilities[lobe]);
        let largest = self.largest_weights();
        Some(lit.fold(zero, |most, lobe| {
            let [r, g, b] = largest[lobe];
            let probability = self.probabilities[lobe];
            if probability > zero {
                most.max((r + g + b) / T::from_f64(3.0) * share / probability)
            } else {
                most
            }
        }))
    }
}
