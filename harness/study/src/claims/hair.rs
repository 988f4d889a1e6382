//! Hair seen from one direction, by quadrature over the oracle: the published density beside the misprinted ones.

use super::bounded::Bounded;
use crate::study::Grid;
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::params::HairDesc;
use hairis::{HairParams, Lobe, PerLobe};
use hairis_harness::efficiency::with_beta;
use hairis_harness::subject::ModelKind;
use hairis_instruments::direction::fibre_direction;
use hairis_instruments::quadrature::{Tolerance, bell_breakpoints, integrate_rectangle};
use hairis_reference::{CauchyDensity, HairReference, Reference, errata};

/// Returns the interval of `theta_h` as `theta_i` runs over all inclinations, rad.
#[must_use]
pub fn theta_h_interval(theta_o: f64) -> [f64; 2] {
    [-FRAC_PI_2, FRAC_PI_2].map(|end| 0.5 * (theta_o + end))
}

/// Longitudinal factor M of a lobe, seen from an inclination; in rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Longitudinal {
    /// Centre, rad.
    pub alpha: f64,
    /// Deviation, rad.
    pub beta: f64,
    /// Inclination of the viewer, rad.
    pub theta_o: f64,
}

impl Longitudinal {
    /// Returns the longitudinal term of R, TT or TRT, selected by slot.
    #[must_use]
    pub fn of(p: &HairDesc<f64>, lobe: usize, theta_o: f64) -> Self {
        Self {
            alpha: p.alpha[lobe],
            beta: p.beta[lobe],
            theta_o,
        }
    }

    /// Returns the share of the printed sampler's `theta_i` that are valid inclinations. As printed, without the factor of a half, A and B
    /// normalise the density on an interval twice as long as that of `theta_h`.
    #[must_use]
    pub fn printed_mass(&self) -> f64 {
        let Self {
            alpha,
            beta,
            theta_o,
        } = *self;
        let printed = errata::longitudinal(alpha, beta, theta_o);
        let [lo, hi] = theta_h_interval(theta_o);
        printed.cdf(hi) - printed.cdf(lo)
    }
}

/// Returns every factor M of the parameter grid: three lobes for each width of R, from each inclination.
#[must_use]
pub fn longitudinal_grid() -> Vec<Longitudinal> {
    let widths = Grid::FULL
        .beta_r_deg
        .iter()
        .filter_map(|beta_r| with_beta(&HairParams::bright(), *beta_r).ok());
    let of_width = |params: HairParams| {
        let p = params.desc().map(f64::from);
        let theta_o = Grid::FULL
            .theta_o_deg
            .iter()
            .map(|theta_o| f64::from(*theta_o).to_radians());
        theta_o.flat_map(move |theta_o| [0, 1, 2].map(|lobe| Longitudinal::of(&p, lobe, theta_o)))
    };
    widths.flat_map(of_width).collect()
}

/// Returns a glint's density of `|phi|` on [0, pi]. The printed density, which has no end, is this density over its cdf at a right angle.
fn whole_glint(p: &HairDesc<f64>) -> CauchyDensity<f64> {
    CauchyDensity::new(p.phi_g, p.gamma_g, 0.0, PI)
}

/// Returns the sum over the lobes, each weighted by its share of the samples.
fn mixture(shares: &PerLobe<f64>, of: &PerLobe<f64>) -> f64 {
    Lobe::FOUR
        .into_iter()
        .map(|lobe| shares[lobe] * of[lobe])
        .sum()
}

/// Hair of a model, seen from an inclination.
#[derive(Debug)]
pub struct Hair {
    parameters: HairDesc<f64>,
    oracle: HairReference<f64>,
    theta_o: f64,
}

/// Figures of a hair, all under constant light and for the mean of RGB.
#[derive(Clone, Copy, Debug)]
pub struct HairFigures {
    /// V of uniform sampling.
    pub uniform: Bounded,
    /// V of the published sampler.
    pub published: Bounded,
    /// V of the published sampler with the printed A and B. Samples off the sphere count, and contribute nothing.
    pub printed: Bounded,
    /// V of the published sampler with glints drawn from [0, pi].
    pub(super) whole: Bounded,
    /// Relative bias of an estimator that draws as published and divides by the density whose glint has no end.
    pub uncut_bias: Bounded,
    /// Share of the samples that the printed A and B lose.
    pub lost: f64,
}

impl HairFigures {
    /// Returns all numbers of the figures, for the journal.
    #[must_use]
    pub fn numbers(&self) -> [f64; 11] {
        let Self {
            uniform,
            published,
            printed,
            whole,
            uncut_bias,
            lost,
        } = self;
        let mut numbers = [*lost; 11];
        let pairs = [uniform, published, printed, whole, uncut_bias];
        for (pair, of) in numbers.as_chunks_mut::<2>().0.iter_mut().zip(pairs) {
            *pair = [of.value, of.error];
        }
        numbers
    }

    /// Restores figures from their numbers.
    #[must_use]
    pub fn from_numbers(numbers: [f64; 11]) -> Self {
        let of = |place: usize| Bounded {
            value: numbers[place],
            error: numbers[place + 1],
        };
        Self {
            uniform: of(0),
            published: of(2),
            printed: of(4),
            whole: of(6),
            uncut_bias: of(8),
            lost: numbers[10],
        }
    }
}

impl Hair {
    /// Prepares the hair of a model, seen from the inclination `theta_o` in rad.
    pub fn new(model: ModelKind, params: &HairParams, theta_o: f64) -> Self {
        let parameters = params.desc().map(f64::from);
        let wo = fibre_direction(theta_o, 0.0).to_array();
        Self {
            parameters,
            oracle: HairReference::prepare(&parameters, model.shape(), wo),
            theta_o,
        }
    }

    /// Returns, per lobe, the share of the samples that the printed A and B leave on the sphere.
    fn masses(&self) -> PerLobe<f64> {
        let [r, tt, trt] = [0, 1, 2]
            .map(|lobe| Longitudinal::of(&self.parameters, lobe, self.theta_o).printed_mass());
        PerLobe::padded([r, tt, trt, trt], 0.0)
    }

    /// Returns integrals, by index: y, the mean of RGB of `S cos theta_i`; its square over each density; and y times the ratio of the
    /// published density to the one whose glint has no end.
    fn integrals(&self, phi: &[f64]) -> [Bounded; 6] {
        let (masses, shares) = (self.masses(), self.oracle.probabilities());
        let mut kept = shares;
        Lobe::FOUR
            .into_iter()
            .for_each(|lobe| kept[lobe] *= masses[lobe]);
        let glint = whole_glint(&self.parameters);
        let within = glint.cdf(FRAC_PI_2);
        let integrand = |theta_i: f64, phi: f64| {
            let wi = fibre_direction(theta_i, phi).to_array();
            let cos_theta_i = theta_i.cos();
            let y = self.oracle.eval(wi).iter().sum::<f64>() / 3.0 * cos_theta_i;
            let mut pdfs = self.oracle.lobe_pdfs(wi);
            let published = mixture(&shares, &pdfs);
            if published <= 0.0 {
                return [0.0; 6];
            }
            let printed = mixture(&kept, &pdfs);
            pdfs[Lobe::GLINT] =
                self.oracle.pdf_theta(Lobe::TRT, theta_i) * 0.5 * glint.pdf(phi) / cos_theta_i;
            let whole = mixture(&shares, &pdfs);
            pdfs[Lobe::GLINT] /= within;
            let uncut = mixture(&shares, &pdfs);
            let y_sq = y * y;
            [
                y,
                y_sq * 4.0 * PI,
                y_sq / published,
                y_sq / printed,
                y_sq / whole,
                y * (published / uncut),
            ]
            .map(|x| x * cos_theta_i)
        };
        let r = integrate_rectangle(
            integrand,
            &self.theta_breakpoints(),
            phi,
            &Tolerance::relative(1e-6),
        );
        // Half of the sphere suffices, because hair is the same for phi and -phi.
        core::array::from_fn(|k| Bounded {
            value: 2.0 * r.value[k],
            error: 2.0 * r.error[k],
        })
    }

    /// Computes all figures of the hair.
    #[must_use]
    pub fn found(&self) -> HairFigures {
        let all = self.integrals(&self.phi_breakpoints());
        let mean = all[0];
        let v = |k: usize| all[k].over(mean.times(mean)).plus(-1.0);
        HairFigures {
            uniform: v(1),
            published: v(2),
            printed: v(3),
            whole: v(4),
            uncut_bias: all[5].over(mean).plus(-1.0),
            lost: 1.0 - mixture(&self.oracle.probabilities(), &self.masses()),
        }
    }

    /// Returns the contribution of azimuths between `ends`, in [0, pi], to `E[y^2] / E[y]^2`: for the published sampler, and with glints
    /// drawn from [0, pi].
    pub(super) fn second_moments(&self, ends: &[f64]) -> [Bounded; 2] {
        let whole = self.phi_breakpoints();
        let mean = self.integrals(&whole)[0];
        let [lo, hi] = [ends[0], ends[ends.len() - 1]];
        let inside = whole.into_iter().filter(|x| (lo..=hi).contains(x));
        let phi: Vec<f64> = inside.chain(ends.iter().copied()).collect();
        let all = self.integrals(&phi);
        [2, 4].map(|k| all[k].over(mean.times(mean)))
    }

    /// Returns ends of panels in `theta_i`, which announce every bell to the quadrature.
    fn theta_breakpoints(&self) -> Vec<f64> {
        let p = &self.parameters;
        let mut theta = vec![-FRAC_PI_2, 0.0, FRAC_PI_2];
        for (alpha, beta) in p.alpha.iter().zip(p.beta) {
            theta.extend(bell_breakpoints(2.0 * alpha - self.theta_o, 2.0 * beta));
        }
        theta.retain(|x| x.abs() <= FRAC_PI_2);
        theta
    }

    /// Returns ends of panels in `phi`, which announce every bell to the quadrature.
    fn phi_breakpoints(&self) -> Vec<f64> {
        let p = &self.parameters;
        let mut phi = vec![0.0, FRAC_PI_2, PI];
        phi.extend(
            bell_breakpoints(p.phi_g, p.gamma_g)
                .into_iter()
                .chain(bell_breakpoints(PI, p.gamma_tt)),
        );
        phi.retain(|x| (0.0..=PI).contains(x));
        phi
    }
}
