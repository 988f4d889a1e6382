//! The paper's formulas line by line, in `f32` and in `f64` (feature `textbook`).
//!
//! Two uses: in `f64` the oracle of the tests, in `f32` the scalar baseline of the figures, the code people write
//! from the paper today. So it is plain: angles come from `atan2`, every factor is formed as it is printed, and
//! only what section 3.3 of the paper amortises is kept in [`HairReference`]. The kernels share no code with it.
//!
//! - Source: Ou et al. 2012, sections 3.1 to 3.3 and appendices A to D, mended by ERRATA E1, E2 and E3.
//! - Conventions: those of the crate. `wo` is the paper's `omega_r`, `wi` its `omega_i`.
//! - Domain: within 1e-5 rad of the fibre axis `eval` and `pdf` are 0 and samples are discarded. A `wo` on the axis
//!   is legal; its azimuth is taken as 0.
//! - Accuracy: in `f32`, rounded angles cost up to 1e-7 rad, so a lobe of width `b` is good to about `1e-7 / b`
//!   beside its peak; intensities above 1e27 may overflow.

mod cauchy;
mod cut;
mod interface;
mod matched;
mod oracle;
mod parameters;
mod quadrature;
mod real;
mod sampler;

use crate::{Lobe, PerLobe};

pub use cauchy::CauchyDensity;
pub use interface::{LobeAt, Reference};
pub use matched::MatchedReference;
pub use oracle::Oracle;
pub use parameters::{Parameters, Shape};
pub use quadrature::integrate;
pub use real::Real;

/// Directions closer than this to the fibre axis (in cosine of `theta_i`) are discarded: section 3.3.
const GRAZING: f64 = 1e-5;

/// A sample of [`HairReference::sample`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceSample<T> {
    /// The direction; the zero vector if the sample was discarded.
    pub wi: [T; 3],
    /// S, without the cosine.
    pub value: [T; 3],
    /// Density of the mixture, per steradian.
    pub pdf: T,
    /// `value cos_theta_i / pdf`.
    pub weight: [T; 3],
    /// The lobe it was drawn from; `None` if it was discarded, in which case everything else is 0.
    pub lobe: Option<Lobe>,
}

/// The model and its published sampler for one set of parameters and one `wo`.
///
/// ```
/// use hairis::{HairParams, reference::HairReference, reference::Parameters, reference::Shape};
/// let parameters = Parameters::<f64>::from(&HairParams::brown());
/// let hair = HairReference::prepare(&parameters, Shape::Gaussian, [0.0, 1.0, 0.0]);
/// let drawn = hair.sample([0.1, 0.4, 0.7]);
/// assert!((hair.pdf(drawn.wi) / drawn.pdf - 1.0).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HairReference<T> {
    parameters: Parameters<T>,
    shape: Shape,
    theta_o: T,
    phi_o: T,
    /// Densities of `theta_h`; the glint has that of TRT.
    longitudinal: PerLobe<CauchyDensity<T>>,
    /// Density of `phi` in [0, 2 pi] of TT.
    transmission: CauchyDensity<T>,
    /// Density of `|phi|` of the glint.
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
    /// `cos(phi / 2)`: R and TRT-g have it in their value and in their density.
    cos_half_phi: T,
}

impl<T: Real> HairReference<T> {
    /// Computes what is constant for `parameters` and `wo`: A, B, C, D and the energies (section 3.3).
    ///
    /// - Units: rad; `wo` a unit vector in (u, v, w).
    #[inline]
    #[must_use]
    pub fn prepare(parameters: &Parameters<T>, shape: Shape, wo: [T; 3]) -> Self {
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
        let total = Lobe::ALL
            .into_iter()
            .fold(zero, |sum, lobe| sum + energies[lobe]);
        let mut probabilities = PerLobe::default();
        if total > zero {
            for lobe in Lobe::ALL {
                probabilities[lobe] = energies[lobe] / total;
            }
        }
        Self {
            parameters: *p,
            shape,
            theta_o,
            phi_o,
            longitudinal,
            transmission: CauchyDensity::new(T::PI, p.gamma_tt, zero, T::PI + T::PI),
            glint: CauchyDensity::new(p.phi_g, p.gamma_g, zero, right),
            energies,
            probabilities,
        }
    }

    /// The estimated energies of the lobes, on which the choice of a lobe rests: section 3.2.3, with `I` the mean of
    /// the three channels.
    ///
    /// - Integral: each is that of its `M(theta_h) N(phi)` over the whole line for Gaussians (ERRATA E4, E6).
    #[inline]
    #[must_use]
    pub fn energies(&self) -> PerLobe<T> {
        self.energies
    }

    /// The probability of each lobe, its energy over their sum; all 0 if every energy is 0.
    #[inline]
    #[must_use]
    pub fn probabilities(&self) -> PerLobe<T> {
        self.probabilities
    }

    /// S, linear RGB: equation (1).
    ///
    /// - Units: per steradian, without the cosine of `theta_i`; `wi` a unit vector.
    /// - Domain: 0 within 1e-5 rad of the axis.
    #[inline]
    #[must_use]
    pub fn eval(&self, wi: [T; 3]) -> [T; 3] {
        self.angles(wi)
            .map_or([T::default(); 3], |at| self.colour(&self.values_at(&at)))
    }

    /// The four terms of equation (1) without their RGB intensity: `M N / cos^2 theta_d`, the glint's times `I_g`.
    #[inline]
    #[must_use]
    pub fn lobe_values(&self, wi: [T; 3]) -> PerLobe<T> {
        self.angles(wi)
            .map_or_else(PerLobe::default, |at| self.values_at(&at))
    }

    /// Density of [`sample`](Self::sample) at `wi`: the mixture of the four lobes.
    ///
    /// - Units: per steradian.
    /// - Integral: 1 over the sphere, less the caps of 1e-5 rad (test
    ///   `reference::each_lobe_and_the_mixture_integrate_to_one`).
    #[inline]
    #[must_use]
    pub fn pdf(&self, wi: [T; 3]) -> T {
        self.angles(wi)
            .map_or_else(T::default, |at| self.mixture(&self.pdfs_at(&at)))
    }

    /// [`eval`](Self::eval) and [`pdf`](Self::pdf) at once: the angles are computed from `wi` once.
    #[inline]
    #[must_use]
    pub fn eval_pdf(&self, wi: [T; 3]) -> ([T; 3], T) {
        self.angles(wi)
            .map_or(([T::default(); 3], T::default()), |at| {
                (
                    self.colour(&self.values_at(&at)),
                    self.mixture(&self.pdfs_at(&at)),
                )
            })
    }

    /// Density of [`sample_lobe`](Self::sample_lobe) for each lobe at `wi`, per steradian.
    #[inline]
    #[must_use]
    pub fn lobe_pdfs(&self, wi: [T; 3]) -> PerLobe<T> {
        self.angles(wi)
            .map_or_else(PerLobe::default, |at| self.pdfs_at(&at))
    }

    /// Itself: what [`Reference`] reads of every form of the model.
    fn book(&self) -> &Self {
        self
    }

    /// `None` within 1e-5 rad of the axis.
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
        values[Lobe::GLINT] = m_trt * p.intensity_g * n_g / cos_sq_theta_d;
        values
    }

    #[inline]
    fn colour(&self, values: &PerLobe<T>) -> [T; 3] {
        let p = &self.parameters;
        let channel = |c: usize| {
            p.intensity_r[c] * values[Lobe::R]
                + p.intensity_tt[c] * values[Lobe::TT]
                + p.intensity_trt[c] * values[Lobe::TRT]
                + p.intensity_trt[c] * values[Lobe::GLINT]
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

    #[inline]
    fn mixture(&self, pdfs: &PerLobe<T>) -> T {
        Lobe::ALL.into_iter().fold(T::default(), |sum, lobe| {
            sum + self.probabilities[lobe] * pdfs[lobe]
        })
    }
}

/// Section 3.2.3.
#[inline]
fn energies<T: Real>(p: &Parameters<T>) -> PerLobe<T> {
    let mean = |rgb: [T; 3]| (rgb[0] + rgb[1] + rgb[2]) / T::from_f64(3.0);
    let cosine = T::from_f64(4.0) * (T::PI + T::PI).sqrt();
    let trt = mean(p.intensity_trt);
    let mut energies = PerLobe::default();
    energies[Lobe::R] = cosine * p.beta[0] * mean(p.intensity_r);
    energies[Lobe::TT] = T::from_f64(2.0) * T::PI * p.beta[1] * p.gamma_tt * mean(p.intensity_tt);
    energies[Lobe::TRT] = cosine * p.beta[2] * trt;
    energies[Lobe::GLINT] = T::from_f64(4.0) * T::PI * p.beta[2] * p.gamma_g * trt * p.intensity_g;
    energies
}

/// Azimuth of `w`, 0 on the axis whatever the signs of its zeros.
#[inline]
fn azimuth<T: Real>(w: [T; 3]) -> T {
    if w[1] == T::default() && w[2] == T::default() {
        T::default()
    } else {
        w[2].atan2(w[1])
    }
}

/// `phi` in [-2 pi, 2 pi] brought to (-pi, pi].
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

/// `cos(phi / 2)`, never below 0 at the seam.
#[inline]
fn cos_half<T: Real>(phi: T) -> T {
    (phi * T::from_f64(0.5)).cos().max(T::default())
}
