//! The published model, formula by formula, with the published sampler and the matched one.
//!
//! Angles are computed by `atan2`, every factor is computed as it is printed, and [`HairReference`] keeps only the constants that
//! section 3.3 of the paper amortises.
//!
//! - Source: Ou et al. 2012, sections 3.1 to 3.3 and appendices A to D, corrected by ERRATA E1, E2 and E3.
//! - Domain: within 1e-5 rad of the fibre axis `eval` and `pdf` are 0 and samples are discarded. A `wo` on the axis is legal; its
//!   azimuth counts as 0.
//! - Accuracy: in `f32`, rounded angles cost up to 1e-7 rad, so that a lobe of width `b` is accurate to about `1e-7 / b` beside its
//!   peak; intensities above 1e27 may overflow.

mod albedo;
mod cauchy;
mod cut;
mod errors;
mod formulas;
mod matched;
mod sampler;
mod shape;

use crate::interface::{LobeAt, Reference, ReferenceSample};
use crate::real::Real;
use crate::steps::{GRAZING, choose, mix_pdfs, shares, sum};
use hairis::params::HairDesc;
use hairis::{Lobe, PerLobe};

pub use cauchy::CauchyDensity;
pub(crate) use cut::Cut;
pub use formulas::HairFormulas;
pub use matched::MatchedReference;
pub use shape::Shape;

/// The published model and its published sampler, for one set of parameters and one `wo`.
///
/// ```
/// use hairis::HairParams;
/// use hairis_reference::{HairReference, Reference, Shape};
/// let parameters = HairParams::brown().desc().map(f64::from);
/// let hair = HairReference::prepare(&parameters, Shape::Gaussian, [0.0, 1.0, 0.0]);
/// let drawn = hair.sample([0.1, 0.4, 0.7]);
/// assert!((hair.pdf(drawn.wi) / drawn.pdf - 1.0).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HairReference<T> {
    parameters: HairDesc<T>,
    shape: Shape,
    theta_o: T,
    phi_o: T,
    /// Densities of `theta_h`; the glint has the density of TRT.
    longitudinal: PerLobe<CauchyDensity<T>>,
    /// Density of the `phi` of TT in [0, 2 pi].
    transmission: CauchyDensity<T>,
    /// Density of the `|phi|` of the glint.
    glint: CauchyDensity<T>,
    energies: PerLobe<T>,
    probabilities: PerLobe<T>,
}

/// Angles of a pair of directions, for value and density.
#[derive(Clone, Copy)]
struct Angles<T> {
    theta_i: T,
    cos_theta_i: T,
    /// `phi_o - phi_i` in (-pi, pi].
    phi: T,
    /// `cos(phi / 2)`, a factor of R and TRT-g in both value and density.
    cos_half_phi: T,
}

impl<T: Real> Angles<T> {
    /// Makes the angles of a sample from an inclination and an azimuth within a turn of [-pi, pi].
    fn new(theta_i: T, phi: T) -> Self {
        let phi = wrapped(phi);
        Self {
            theta_i,
            cos_theta_i: theta_i.cos(),
            phi,
            cos_half_phi: cos_half(phi),
        }
    }
}

impl<T: Real> HairReference<T> {
    /// Computes the constants of `parameters` and `wo`: A, B, C, D and the energies (section 3.3).
    ///
    /// - Units: rad; `wo` a unit vector in (u, v, w).
    #[inline]
    #[must_use]
    pub fn prepare(parameters: &HairDesc<T>, shape: Shape, wo: [T; 3]) -> Self {
        let zero = T::default();
        let half = T::from_f64(0.5);
        let right = T::PI * half;
        let p = parameters;
        let theta_o = wo[0].atan2(wo[1].hypot(wo[2]));
        let phi_o = azimuth(wo);

        // Interval of theta_h = (theta_i + theta_o) / 2 as theta_i runs over [-pi/2, pi/2] (ERRATA E1).
        let lo = (theta_o - right) * half;
        let hi = (theta_o + right) * half;
        let trt = CauchyDensity::new(p.alpha[2], p.beta[2], lo, hi);
        let mut longitudinal = PerLobe::default();
        longitudinal[Lobe::R] = CauchyDensity::new(p.alpha[0], p.beta[0], lo, hi);
        longitudinal[Lobe::TT] = CauchyDensity::new(p.alpha[1], p.beta[1], lo, hi);
        longitudinal[Lobe::TRT] = trt;
        longitudinal[Lobe::GLINT] = trt;

        let energies = energies(p);
        Self {
            parameters: *p,
            shape,
            theta_o,
            phi_o,
            longitudinal,
            transmission: CauchyDensity::new(T::PI, p.gamma_tt, zero, T::PI + T::PI),
            glint: CauchyDensity::new(p.phi_g, p.gamma_g, zero, right),
            energies,
            probabilities: shares(&energies),
        }
    }

    /// Returns the estimated energies of the lobes, by which a lobe is chosen: section 3.2.3, with `I` the mean of the three
    /// channels.
    ///
    /// - Integral: each energy is the integral of its `M(theta_h) N(phi)` over the whole line for Gaussians (ERRATA E4, E6).
    #[inline]
    #[must_use]
    pub fn energies(&self) -> PerLobe<T> {
        self.energies
    }

    /// Computes the angles of `wi`, or returns `None` within 1e-5 rad of the axis.
    #[inline]
    fn angles(&self, wi: [T; 3]) -> Option<Angles<T>> {
        let cos_theta_i = (wi[1] * wi[1] + wi[2] * wi[2]).sqrt();
        if cos_theta_i < T::from_f64(GRAZING) {
            return None;
        }
        let theta_i = wi[0].atan2(cos_theta_i);
        let phi = wrapped(self.phi_o - azimuth(wi));
        Some(Angles {
            theta_i,
            cos_theta_i,
            phi,
            cos_half_phi: cos_half(phi),
        })
    }

    #[inline]
    fn values_at(&self, at: &Angles<T>) -> PerLobe<T> {
        let half = T::from_f64(0.5);
        let p = &self.parameters;
        let theta_h = (at.theta_i + self.theta_o) * half;
        let theta_d = (self.theta_o - at.theta_i) * half;
        let cos_theta_d = theta_d.cos();
        let cos_sq_theta_d = cos_theta_d * cos_theta_d;
        let m_r = self.shape.bell(p.beta[0], theta_h - p.alpha[0]);
        let m_tt = self.shape.bell(p.beta[1], theta_h - p.alpha[1]);
        let m_trt = self.shape.bell(p.beta[2], theta_h - p.alpha[2]);
        let n_tt = self.shape.bell(p.gamma_tt, T::PI - at.phi.abs());
        let n_g = self.shape.bell(p.gamma_g, at.phi.abs() - p.phi_g);
        let mut values = PerLobe::default();
        values[Lobe::R] = m_r * at.cos_half_phi / cos_sq_theta_d;
        values[Lobe::TT] = m_tt * n_tt / cos_sq_theta_d;
        values[Lobe::TRT] = m_trt * at.cos_half_phi / cos_sq_theta_d;
        values[Lobe::GLINT] = m_trt * p.i_g * n_g / cos_sq_theta_d;
        values
    }

    #[inline]
    fn colour(&self, values: &PerLobe<T>) -> [T; 3] {
        let p = &self.parameters;
        let channel = |c: usize| {
            p.i_r[c] * values[Lobe::R]
                + p.i_tt[c] * values[Lobe::TT]
                + p.i_trt[c] * values[Lobe::TRT]
                + p.i_trt[c] * values[Lobe::GLINT]
        };
        [channel(0), channel(1), channel(2)]
    }

    #[inline]
    fn pdfs_at(&self, at: &Angles<T>) -> PerLobe<T> {
        let theta_trt = self.pdf_theta(Lobe::TRT, at.theta_i);
        let phi_cosine = at.cos_half_phi / T::from_f64(4.0);
        let mut pdfs = PerLobe::default();
        pdfs[Lobe::R] = self.pdf_theta(Lobe::R, at.theta_i) * phi_cosine / at.cos_theta_i;
        pdfs[Lobe::TT] =
            self.pdf_theta(Lobe::TT, at.theta_i) * self.pdf_phi(Lobe::TT, at.phi) / at.cos_theta_i;
        pdfs[Lobe::TRT] = theta_trt * phi_cosine / at.cos_theta_i;
        pdfs[Lobe::GLINT] = theta_trt * self.pdf_phi(Lobe::GLINT, at.phi) / at.cos_theta_i;
        pdfs
    }

    /// Computes each lobe's value, colour and density, where the densities are given.
    #[inline]
    fn lobes_with(&self, at: &Angles<T>, pdfs: &PerLobe<T>) -> PerLobe<LobeAt<T>> {
        let (values, colours) = (self.values_at(at), colours(&self.parameters));
        let mut lobes = PerLobe::default();
        for lobe in Lobe::FOUR {
            lobes[lobe] = LobeAt {
                value: values[lobe],
                color: colours[lobe],
                pdf: pdfs[lobe],
            };
        }
        lobes
    }

    /// Makes the sample of `lobe` at these angles, with S and the given density.
    fn finish(&self, lobe: Lobe, wi: [T; 3], at: &Angles<T>, pdf: T) -> ReferenceSample<T> {
        if at.cos_theta_i < T::from_f64(GRAZING) || pdf <= T::default() {
            return ReferenceSample::default();
        }
        let value = self.colour(&self.values_at(at));
        ReferenceSample {
            wi,
            value,
            pdf,
            weight: value.map(|s| s * at.cos_theta_i / pdf),
            lobe: Some(lobe),
        }
    }
}

/// The published model at `wi`, and the published sampler.
impl<T: Real> Reference<T> for HairReference<T> {
    #[inline]
    fn eval_pdf(&self, wi: [T; 3]) -> ([T; 3], T) {
        self.angles(wi)
            .map_or(([T::default(); 3], T::default()), |at| {
                (
                    self.colour(&self.values_at(&at)),
                    mix_pdfs(&self.probabilities, &self.pdfs_at(&at)),
                )
            })
    }

    #[inline]
    fn eval(&self, wi: [T; 3]) -> [T; 3] {
        self.angles(wi)
            .map_or([T::default(); 3], |at| self.colour(&self.values_at(&at)))
    }

    #[inline]
    fn pdf(&self, wi: [T; 3]) -> T {
        self.angles(wi).map_or_else(T::default, |at| {
            mix_pdfs(&self.probabilities, &self.pdfs_at(&at))
        })
    }

    fn lobes(&self, wi: [T; 3]) -> PerLobe<LobeAt<T>> {
        self.angles(wi).map_or_else(PerLobe::default, |at| {
            self.lobes_with(&at, &self.pdfs_at(&at))
        })
    }

    /// Returns the probability of each lobe: its energy over the sum of the energies.
    #[inline]
    fn probabilities(&self) -> PerLobe<T> {
        self.probabilities
    }

    /// Draws a lobe by its energy, and `theta_i` and `phi` by inversion (section 3.2).
    ///
    /// Value and density are computed from the angles drawn; those computed from `wi` are the same except for the rounding of the
    /// angles.
    #[inline]
    fn sample(&self, xi: [T; 3]) -> ReferenceSample<T> {
        let Some((lobe, _)) = choose(&self.probabilities, xi[0]) else {
            return ReferenceSample::default();
        };
        let theta_i = self.sample_theta(lobe, xi[1]);
        let phi = self.sample_phi(lobe, xi[2]);
        let at = Angles::new(theta_i, phi);
        let pdf = mix_pdfs(&self.probabilities, &self.pdfs_at(&at));
        self.finish(lobe, self.direction(theta_i, at.phi), &at, pdf)
    }

    fn albedo(&self) -> PerLobe<[T; 3]> {
        albedo::albedo(self)
    }

    /// Returns twice the sum of the [`energies`](HairReference::energies), because `theta_i` moves by twice as much as `theta_h`.
    fn energy(&self) -> T {
        T::from_f64(2.0) * sum(&self.energies)
    }

    fn cdf(&self, lobe: Lobe, theta_i: T, phi: T) -> Option<[T; 2]> {
        Some([self.cdf_theta(lobe, theta_i), self.cdf_phi(lobe, phi)])
    }

    /// Returns the rounding of angles times the steepness of the bells, further than 1e-3 rad from the axis. In the kernels each Gaussian
    /// besides is 0 below `2^-114`.
    fn lobe_errors(&self, wi: [T; 3]) -> Option<PerLobe<[T; 2]>> {
        Some(errors::lobes(self, &self.angles(wi)?))
    }
}

/// Returns the colour of each lobe; the strength of the glint is in its value.
fn colours<T: Real>(p: &HairDesc<T>) -> PerLobe<[T; 3]> {
    PerLobe::padded([p.i_r, p.i_tt, p.i_trt, p.i_trt], [T::default(); 3])
}

/// Computes the energies of the lobes by section 3.2.3.
#[inline]
fn energies<T: Real>(p: &HairDesc<T>) -> PerLobe<T> {
    let mean = |rgb: [T; 3]| (rgb[0] + rgb[1] + rgb[2]) / T::from_f64(3.0);
    let cosine = T::from_f64(4.0) * (T::PI + T::PI).sqrt();
    let trt = mean(p.i_trt);
    let mut energies = PerLobe::default();
    energies[Lobe::R] = cosine * p.beta[0] * mean(p.i_r);
    energies[Lobe::TT] = T::from_f64(2.0) * T::PI * p.beta[1] * p.gamma_tt * mean(p.i_tt);
    energies[Lobe::TRT] = cosine * p.beta[2] * trt;
    energies[Lobe::GLINT] = T::from_f64(4.0) * T::PI * p.beta[2] * p.gamma_g * trt * p.i_g;
    energies
}

/// Returns the azimuth of `w`, which is 0 on the axis whatever the signs of its zeros.
#[inline]
fn azimuth<T: Real>(w: [T; 3]) -> T {
    if w[1] == T::default() && w[2] == T::default() {
        T::default()
    } else {
        w[2].atan2(w[1])
    }
}

/// Moves `phi` from [-2 pi, 2 pi] to (-pi, pi].
#[inline]
fn wrapped<T: Real>(phi: T) -> T {
    if phi > T::PI {
        phi - T::PI - T::PI
    } else if phi <= -T::PI {
        phi + T::PI + T::PI
    } else {
        phi
    }
}

/// Returns `cos(phi / 2)`, which is never below 0 at the seam.
#[inline]
fn cos_half<T: Real>(phi: T) -> T {
    (phi * T::from_f64(0.5)).cos().max(T::default())
}
