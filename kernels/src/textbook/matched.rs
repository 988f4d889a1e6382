//! The matched sampler, formula by formula: what [`Matched`](crate::Matched) computes, without its economies.

use super::warped::{Cut, Warp};
use super::{Angles, Drawn, GRAZING, Parameters, Real, Shape, Textbook, cos_half, wrapped};
use crate::{Lobe, LobeMask, PerLobe};

/// The model with its matched sampler, for one set of parameters and one `wo`.
///
/// ```
/// use hairis::{HairParams, textbook::{MatchedTextbook, Parameters, Shape}};
/// let parameters = Parameters::<f64>::from(&HairParams::brown());
/// let hair = MatchedTextbook::prepare(&parameters, Shape::Gaussian, [0.0, 1.0, 0.0], 3);
/// let drawn = hair.sample([0.1, 0.4, 0.7]);
/// assert!((hair.pdf(drawn.wi) / drawn.pdf - 1.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MatchedTextbook<T> {
    book: Textbook<T>,
    longitudinal: PerLobe<Cut<T>>,
    warps: PerLobe<Warp<T>>,
    /// TT's azimuth from its centre to one side, and a glint's from `phi = 0` to pi.
    transmission: Cut<T>,
    glint: Cut<T>,
    energies: PerLobe<T>,
    probabilities: PerLobe<T>,
}

/// `(cos theta_i / cos theta_d)^2`.
fn w<T: Real>(theta_i: T, theta_o: T) -> T {
    let cos_theta_d = (T::from_f64(0.5) * (theta_o - theta_i)).cos();
    let ratio = theta_i.cos().max(T::default()) / cos_theta_d;
    if cos_theta_d > T::default() { ratio * ratio } else { T::default() }
}

impl<T: Real> MatchedTextbook<T> {
    /// What is constant for `parameters` and `wo`, with 2, 3 or 4 segments a side.
    #[inline]
    #[must_use]
    pub fn prepare(parameters: &Parameters<T>, shape: Shape, wo: [T; 3], segments: usize) -> Self {
        let number = T::from_f64;
        let (zero, one, half) = (T::default(), number(1.0), number(0.5));
        let book = Textbook::prepare(parameters, shape, wo);
        let p = parameters;
        let transmission = Cut::new(shape, zero, T::PI / p.gamma_tt);
        let glint = Cut::new(shape, -p.phi_g / p.gamma_g, (T::PI - p.phi_g) / p.gamma_g);
        let mut this = Self {
            book,
            longitudinal: PerLobe::default(),
            warps: PerLobe::default(),
            transmission,
            glint,
            energies: PerLobe::default(),
            probabilities: PerLobe::default(),
        };
        let side: &[f64] = match segments {
            2 => &[0.06],
            3 => &[0.023, 0.135],
            _ => &[0.012, 0.06, 0.2],
        };
        let mean = |rgb: [T; 3]| (rgb[0] + rgb[1] + rgb[2]) / number(3.0);
        let trt = mean(p.intensity_trt);
        let intensity = PerLobe([mean(p.intensity_r), mean(p.intensity_tt), trt, trt * p.intensity_g]);
        let azimuth = PerLobe([
            number(4.0),
            number(2.0) * p.gamma_tt * transmission.area,
            number(4.0),
            number(2.0) * p.gamma_g * glint.area,
        ]);
        let quarter = T::PI * number(0.25);
        for lobe in Lobe::ALL {
            let i = lobe.index().min(2);
            let centre = half * book.theta_o - p.alpha[i];
            let cut = Cut::new(shape, (centre - quarter) / p.beta[i], (centre + quarter) / p.beta[i]);
            this.longitudinal[lobe] = cut;
            let at = |xi: T| w(this.theta_i(lobe, cut.sample(xi)), book.theta_o);
            let least = number(1e-5) * (number(3.0) - number(2.0) * book.theta_o.cos());
            let count = 2 * side.len() + 3;
            let mut warp = Warp { count, ..Warp::default() };
            warp.nodes[count - 1] = one;
            warp.nodes[side.len() + 1] = half;
            warp.heights[side.len() + 1] = at(half).max(least);
            for (j, v) in side.iter().enumerate() {
                let v = T::from_f32(rounded(*v));
                (warp.nodes[j + 1], warp.nodes[count - 2 - j]) = (v, one - v);
                (warp.heights[j + 1], warp.heights[count - 2 - j]) = (at(v).max(least), at(one - v).max(least));
            }
            let (end, share) = (number(1e-3), number(0.25));
            warp.heights[0] = at(end).max(share * warp.heights[1]);
            warp.heights[count - 1] = at(one - end).max(share * warp.heights[count - 2]);
            this.warps[lobe] = warp;
            let longitude = number(2.0) * p.beta[i] * cut.area * warp.total();
            this.energies[lobe] = intensity[lobe] * azimuth[lobe] * longitude;
        }
        let total = Lobe::ALL.into_iter().fold(zero, |sum, lobe| sum + this.energies[lobe]);
        for lobe in Lobe::ALL {
            this.probabilities[lobe] = if total > zero { this.energies[lobe] / total } else { zero };
        }
        this
    }

    /// `theta_i` at an offset of `x` widths from a lobe's centre.
    fn theta_i(&self, lobe: Lobe, x: T) -> T {
        let i = lobe.index().min(2);
        let p = &self.book.parameters;
        T::from_f64(2.0) * (x * p.beta[i] + p.alpha[i]) - self.book.theta_o
    }

    /// The offset from a lobe's centre in widths.
    fn offset(&self, lobe: Lobe, theta_i: T) -> T {
        let i = lobe.index().min(2);
        let p = &self.book.parameters;
        (T::from_f64(0.5) * (theta_i + self.book.theta_o) - p.alpha[i]) / p.beta[i]
    }

    /// The probability of each lobe: its share of what all integrate to, by the mean of their channels.
    #[inline]
    #[must_use]
    pub fn probabilities(&self) -> PerLobe<T> {
        self.probabilities
    }

    /// What no weight exceeds, the mean of its three channels, of the lobes in `mask`: the sum of their energies times the
    /// largest ratio of W to the function in its place.
    ///
    /// In a segment that ratio is at most that of the two heights at its ends, as W is unimodal; where W has its mode,
    /// 4 over the lower of them.
    #[inline]
    #[must_use]
    pub fn weight_bound(&self, mask: LobeMask) -> T {
        let number = T::from_f64;
        let theta_o = self.book.theta_o;
        let rises = |t: T| number(-2.0) * t.tan() - (number(0.5) * (theta_o - t)).tan() > T::default();
        let right = T::PI * number(0.5);
        let (mut sum, mut most) = (T::default(), T::default());
        for lobe in Lobe::ALL.into_iter().filter(|l| mask.contains(*l) && self.energies[*l] > T::default()) {
            sum = sum + self.energies[lobe];
            let warp = &self.warps[lobe];
            for i in 1..warp.count {
                let (a, b) = (warp.heights[i - 1], warp.heights[i]);
                let [from, to] = [i - 1, i].map(|j| self.node(lobe, j).unwrap_or(right));
                // At the poles W rises inwards, whatever its tangent.
                let (from_rises, to_rises) = (i == 1 || rises(from), i + 1 < warp.count && rises(to));
                let top = if from_rises && !to_rises { number(4.0) } else { a.max(b) };
                most = most.max(top / a.min(b));
            }
        }
        sum * most
    }

    /// `theta_i` of the node `j` of a lobe's piecewise-linear function, both ends of the sphere included.
    #[inline]
    #[must_use]
    pub fn node(&self, lobe: Lobe, j: usize) -> Option<T> {
        let warp = &self.warps[lobe];
        let cut = &self.longitudinal[lobe];
        (j < warp.count).then(|| self.theta_i(lobe, cut.sample(warp.nodes[j])))
    }

    /// As [`Textbook::eval`]: the sampler does not change the model.
    #[inline]
    #[must_use]
    pub fn eval(&self, wi: [T; 3]) -> [T; 3] {
        self.book.eval(wi)
    }

    /// As [`Textbook::lobe_values`].
    #[inline]
    #[must_use]
    pub fn lobe_values(&self, wi: [T; 3]) -> PerLobe<T> {
        self.book.lobe_values(wi)
    }

    /// Density of [`sample`](Self::sample) at `wi`, per steradian.
    #[inline]
    #[must_use]
    pub fn pdf(&self, wi: [T; 3]) -> T {
        self.book.angles(wi).map_or_else(T::default, |at| self.mixture(&self.pdfs_at(&at)))
    }

    /// Density of each lobe alone at `wi`, per steradian.
    #[inline]
    #[must_use]
    pub fn lobe_pdfs(&self, wi: [T; 3]) -> PerLobe<T> {
        self.book.angles(wi).map_or_else(PerLobe::default, |at| self.pdfs_at(&at))
    }

    fn mixture(&self, pdfs: &PerLobe<T>) -> T {
        Lobe::ALL.into_iter().fold(T::default(), |sum, lobe| sum + self.probabilities[lobe] * pdfs[lobe])
    }

    fn pdfs_at(&self, at: &Angles<T>) -> PerLobe<T> {
        let mut pdfs = PerLobe::default();
        for lobe in Lobe::ALL {
            pdfs[lobe] = self.pdf_theta(lobe, at.theta_i) * self.pdf_phi(lobe, at.phi) / at.cos_theta_i;
        }
        pdfs
    }

    /// A lobe, then `theta_i` and `phi`, by inversion.
    #[inline]
    #[must_use]
    pub fn sample(&self, xi: [T; 3]) -> Drawn<T> {
        let zero = T::default();
        let discarded = Drawn { wi: [zero; 3], value: [zero; 3], pdf: zero, weight: [zero; 3], lobe: None };
        let Some(lobe) = super::sampler::choose(&self.probabilities, xi[0]) else { return discarded };
        let theta_i = self.sample_theta(lobe, xi[1]);
        let phi = wrapped(self.sample_phi(lobe, xi[2]));
        let at = Angles { theta_i, cos_theta_i: theta_i.cos(), phi, cos_half_phi: cos_half(phi) };
        let pdf = self.mixture(&self.pdfs_at(&at));
        if at.cos_theta_i < T::from_f64(GRAZING) || pdf <= zero {
            return discarded;
        }
        let value = self.book.colour(&self.book.values_at(&at));
        let weight = value.map(|s| s * at.cos_theta_i / pdf);
        Drawn { wi: self.book.direction(theta_i, phi), value, pdf, weight, lobe: Some(lobe) }
    }

    /// `theta_i` of a lobe.
    #[inline]
    #[must_use]
    pub fn sample_theta(&self, lobe: Lobe, xi: T) -> T {
        let warp = &self.warps[lobe];
        self.theta_i(lobe, self.longitudinal[lobe].sample(warp.invert(xi * warp.total())))
    }

    /// Density of `theta_i`, per radian.
    ///
    /// - Integral: 1 over [-pi/2, pi/2].
    #[inline]
    #[must_use]
    pub fn pdf_theta(&self, lobe: Lobe, theta_i: T) -> T {
        let (cut, warp, zero) = (&self.longitudinal[lobe], &self.warps[lobe], T::default());
        if cut.area <= zero {
            return zero;
        }
        let x = self.offset(lobe, theta_i);
        let bell = self.book.shape.bell(T::from_f64(1.0), x) / cut.area;
        let width = T::from_f64(2.0) * self.book.parameters.beta[lobe.index().min(2)];
        bell * warp.height(cut.cdf(x)) / warp.total() / width
    }

    /// Probability of an inclination of at most `theta_i`.
    #[inline]
    #[must_use]
    pub fn cdf_theta(&self, lobe: Lobe, theta_i: T) -> T {
        let warp = &self.warps[lobe];
        warp.cumulative(self.longitudinal[lobe].cdf(self.offset(lobe, theta_i))) / warp.total()
    }

    /// `phi = phi_o - phi_i`, as [`Textbook::sample_phi`] has it, the glint's in [-pi, pi].
    #[inline]
    #[must_use]
    pub fn sample_phi(&self, lobe: Lobe, xi: T) -> T {
        let (one, two) = (T::from_f64(1.0), T::from_f64(2.0));
        let p = &self.book.parameters;
        let (side, across) = (two * xi - one, (two * xi - one).abs());
        let signed = |x: T| if side < T::default() { -x } else { x };
        match lobe {
            Lobe::R | Lobe::TRT => self.book.sample_phi(lobe, xi),
            Lobe::TT => T::PI + signed(p.gamma_tt * self.transmission.sample(across)),
            _ => -signed(p.phi_g + p.gamma_g * self.glint.sample(one - across)),
        }
    }

    /// Density of `phi`, per radian, for a `phi` in [-pi, pi].
    ///
    /// - Integral: 1 over [-pi, pi].
    #[inline]
    #[must_use]
    pub fn pdf_phi(&self, lobe: Lobe, phi: T) -> T {
        let half = T::from_f64(0.5);
        let p = &self.book.parameters;
        let bell = |cut: &Cut<T>, width: T, from: T| half * self.book.shape.bell(width, from) / (width * cut.area);
        match lobe {
            Lobe::R | Lobe::TRT => self.book.pdf_phi(lobe, phi),
            Lobe::TT => bell(&self.transmission, p.gamma_tt, T::PI - phi.abs()),
            _ => bell(&self.glint, p.gamma_g, phi.abs() - p.phi_g),
        }
    }

    /// The `xi` from which [`sample_phi`](Self::sample_phi) draws `phi`, for a `phi` in (-pi, pi].
    #[inline]
    #[must_use]
    pub fn cdf_phi(&self, lobe: Lobe, phi: T) -> T {
        let (zero, one, half) = (T::default(), T::from_f64(1.0), T::from_f64(0.5));
        let p = &self.book.parameters;
        match lobe {
            Lobe::R | Lobe::TRT => self.book.cdf_phi(lobe, phi),
            Lobe::TT => {
                let across = self.transmission.cdf((T::PI - phi.abs()) / p.gamma_tt);
                // A phi above 0 comes before pi, from the first half.
                half * if phi < zero { one + across } else { one - across }
            }
            _ => {
                let below = self.glint.cdf((phi.abs() - p.phi_g) / p.gamma_g);
                if phi < zero { one - half * below } else { half * below }
            }
        }
    }
}

/// The nearest single, as the kernels have the nodes.
#[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
fn rounded(x: f64) -> f32 {
    x as f32
}
