//! Formulas of the matched sampler [`Matched`](hairis::Matched), line by line.

mod errors;

use super::cut::Cut;
use super::shape::Shape;
use super::{Angles, HairReference};
use crate::interface::{LobeAt, Reference, ReferenceSample};
use crate::real::Real;
use crate::steps::{choose, mix_pdfs, shares, sum};
use hairis::params::HairDesc;
use hairis::{Lobe, LobeMask, PerLobe};

/// Largest number of bands.
const MOST: usize = 25;

/// Returns the sines of the inclinations where bands end, without the pole, down to the band in the middle.
const fn ends(bands: usize) -> &'static [f32] {
    match bands {
        5 => &[0.935, 0.598],
        9 => &[0.979, 0.936, 0.803, 0.395],
        25 => &[
            0.9956, 0.993, 0.9886, 0.9817, 0.9705, 0.9525, 0.9235, 0.8767, 0.8014, 0.68, 0.4844,
            0.1694,
        ],
        _ => panic!("5, 9 or 25 bands"),
    }
}

/// The published model with its matched sampler, for one set of parameters and one `wo`.
///
/// ```
/// use hairis::HairParams;
/// use hairis_reference::{MatchedReference, Reference, Shape};
/// let parameters = HairParams::brown().desc().map(f64::from);
/// let hair = MatchedReference::prepare(&parameters, Shape::Gaussian, [0.0, 1.0, 0.0], 9);
/// let drawn = hair.sample([0.1, 0.4, 0.7]);
/// assert!((hair.pdf(drawn.wi) / drawn.pdf - 1.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MatchedReference<T> {
    book: HairReference<T>,
    longitudinal: PerLobe<Cut<T>>,
    /// Number of bands, the sines at their ends from the lower pole to the upper, and the constant for W in each.
    bands: usize,
    sines: [T; MOST + 1],
    heights: [T; MOST],
    /// Integral of each lobe's bell, times W, up to the start of each band.
    areas: PerLobe<[T; MOST + 1]>,
    /// Azimuth of TT from its centre to one side, and azimuth of a glint from `phi = 0` to pi.
    transmission: Cut<T>,
    glint: Cut<T>,
    /// Integral of each lobe, without its colour and with the mean of its channels.
    extents: PerLobe<T>,
    energies: PerLobe<T>,
    probabilities: PerLobe<T>,
}

/// Returns the mean intensity of each lobe.
fn intensities<T: Real>(p: &HairDesc<T>) -> PerLobe<T> {
    let [r, tt, trt] = [p.i_r, p.i_tt, p.i_trt].map(|[r, g, b]| (r + g + b) / T::from_f64(3.0));
    PerLobe::padded([r, tt, trt, trt * p.i_g], T::default())
}

/// Returns W, `(cos theta_i / cos theta_d)^2`.
fn w<T: Real>(theta_i: T, theta_o: T) -> T {
    let cos_theta_d = (T::from_f64(0.5) * (theta_o - theta_i)).cos();
    let ratio = theta_i.cos().max(T::default()) / cos_theta_d;
    if cos_theta_d > T::default() {
        ratio * ratio
    } else {
        T::default()
    }
}

impl<T: Real> MatchedReference<T> {
    /// Computes the constants of `parameters` and `wo`, with 5, 9 or 25 bands.
    ///
    /// # Panics
    ///
    /// Panics if `bands` is none of these numbers.
    #[inline]
    #[must_use]
    pub fn prepare(parameters: &HairDesc<T>, shape: Shape, wo: [T; 3], bands: usize) -> Self {
        let number = T::from_f64;
        let (zero, one, half) = (T::default(), number(1.0), number(0.5));
        let book = HairReference::prepare(parameters, shape, wo);
        let p = parameters;
        let transmission = Cut::new(shape, zero, T::PI / p.gamma_tt);
        let glint = Cut::new(shape, -p.phi_g / p.gamma_g, (T::PI - p.phi_g) / p.gamma_g);
        let side = ends(bands);
        let bands = 2 * side.len() + 1;
        let (mut sines, mut heights) = ([zero; MOST + 1], [zero; MOST]);
        (sines[0], sines[bands]) = (-one, one);
        for (j, end) in side.iter().enumerate() {
            (sines[j + 1], sines[bands - 1 - j]) = (-T::from_f32(*end), T::from_f32(*end));
        }
        for (height, ends) in heights.iter_mut().zip(sines[..=bands].windows(2)) {
            *height = w((half * (ends[0] + ends[1])).asin(), book.theta_o);
        }
        // The constants ascend to the band in the middle.
        for j in 1..=side.len() {
            heights[j] = heights[j].max(heights[j - 1]);
            heights[bands - 1 - j] = heights[bands - 1 - j].max(heights[bands - j]);
        }
        let intensity = intensities(p);
        let azimuth = [
            number(4.0),
            number(2.0) * p.gamma_tt * transmission.area,
            number(4.0),
            number(2.0) * p.gamma_g * glint.area,
        ];
        let azimuth = PerLobe::padded(azimuth, zero);
        let quarter = T::PI * number(0.25);
        let mut this = Self {
            book,
            longitudinal: PerLobe::default(),
            bands,
            sines,
            heights,
            areas: PerLobe([[zero; MOST + 1]; Lobe::COUNT]),
            transmission,
            glint,
            extents: PerLobe::default(),
            energies: PerLobe::default(),
            probabilities: PerLobe::default(),
        };
        for lobe in Lobe::FOUR {
            let i = lobe.index().min(2);
            let centre = half * book.theta_o - p.alpha[i];
            let cut = Cut::new(
                shape,
                (centre - quarter) / p.beta[i],
                (centre + quarter) / p.beta[i],
            );
            this.longitudinal[lobe] = cut;
            let below = |sine: T| cut.below(this.offset(lobe, sine.asin()));
            let (mut areas, mut from) = ([zero; MOST + 1], below(sines[0]));
            for (j, (height, end)) in heights.iter().zip(&sines[1..=bands]).enumerate() {
                let to = below(*end);
                areas[j + 1] = areas[j] + *height * (to - from);
                from = to;
            }
            this.areas[lobe] = areas;
            // Nothing is drawn from a bell that is 0 all over the sphere.
            let inclination = number(2.0)
                * p.beta[i]
                * if cut.area > zero {
                    this.areas[lobe][bands]
                } else {
                    zero
                };
            this.extents[lobe] = azimuth[lobe] * inclination;
            this.energies[lobe] = intensity[lobe] * this.extents[lobe];
        }
        this.probabilities = shares(&this.energies);
        this
    }

    /// Makes the sampler choose lobes by their shares of each channel.
    #[inline]
    #[must_use]
    pub fn by_channel(self) -> Self {
        let p = &self.book.parameters;
        let glint = p.i_trt.map(|i| i * p.i_g);
        let intensity = PerLobe::padded([p.i_r, p.i_tt, p.i_trt, glint], [T::default(); 3]);
        let mut sums = PerLobe::<T>::default();
        for channel in 0..3 {
            let mut energies = PerLobe::default();
            for lobe in Lobe::FOUR {
                energies[lobe] = intensity[lobe][channel] * self.extents[lobe];
            }
            let shares = shares(&energies);
            for lobe in Lobe::FOUR {
                sums[lobe] = sums[lobe] + shares[lobe] * shares[lobe];
            }
        }
        for lobe in Lobe::FOUR {
            sums[lobe] = sums[lobe].sqrt();
        }
        Self {
            probabilities: shares(&sums),
            ..self
        }
    }

    /// Returns the band of an inclination, which is given by its sine.
    fn band(&self, sin_theta_i: T) -> usize {
        // An end belongs to the band towards the pole.
        let below = |j: &usize| {
            if self.sines[*j] < T::default() {
                sin_theta_i <= self.sines[*j]
            } else {
                sin_theta_i < self.sines[*j]
            }
        };
        (1..self.bands).find(below).unwrap_or(self.bands) - 1
    }

    /// Returns `theta_i` at an offset of `x` widths from a lobe's centre.
    fn theta_i(&self, lobe: Lobe, x: T) -> T {
        let i = lobe.index().min(2);
        let p = &self.book.parameters;
        T::from_f64(2.0) * (x * p.beta[i] + p.alpha[i]) - self.book.theta_o
    }

    /// Returns the offset of an inclination from a lobe's centre, in widths.
    fn offset(&self, lobe: Lobe, theta_i: T) -> T {
        let i = lobe.index().min(2);
        let p = &self.book.parameters;
        (T::from_f64(0.5) * (theta_i + self.book.theta_o) - p.alpha[i]) / p.beta[i]
    }

    /// Finds the maximum of W by bisection: `ln W` is concave, because W is at most 4.
    fn mode(&self) -> T {
        let number = T::from_f64;
        let (mut lo, mut hi) = (number(-0.5) * T::PI, number(0.5) * T::PI);
        for _ in 0..60 {
            let t = number(0.5) * (lo + hi);
            let rises = number(-2.0) * t.tan() - (number(0.5) * (self.book.theta_o - t)).tan()
                > T::default();
            (lo, hi) = if rises { (t, hi) } else { (lo, t) };
        }
        number(0.5) * (lo + hi)
    }

    fn pdfs_at(&self, at: &Angles<T>, sin_theta_i: T) -> PerLobe<T> {
        let height = self.heights[self.band(sin_theta_i)];
        let mut pdfs = PerLobe::default();
        for lobe in Lobe::FOUR {
            pdfs[lobe] = height * self.bell_theta(lobe, at.theta_i) * self.pdf_phi(lobe, at.phi)
                / at.cos_theta_i;
        }
        pdfs
    }

    /// Returns the density of `theta_i` divided by the constant for W, per radian.
    fn bell_theta(&self, lobe: Lobe, theta_i: T) -> T {
        if self.longitudinal[lobe].area <= T::default() {
            return T::default();
        }
        let bell = self
            .book
            .shape
            .bell(T::from_f64(1.0), self.offset(lobe, theta_i));
        let width = T::from_f64(2.0) * self.book.parameters.beta[lobe.index().min(2)];
        bell / (self.areas[lobe][self.bands] * width)
    }

    /// Draws the inclination `theta_i` from a lobe by one uniform number.
    #[inline]
    #[must_use]
    pub fn sample_theta(&self, lobe: Lobe, xi: T) -> T {
        let (cut, areas) = (&self.longitudinal[lobe], &self.areas[lobe]);
        let area = xi * areas[self.bands];
        let j = (1..self.bands)
            .find(|j| area < areas[*j])
            .unwrap_or(self.bands)
            - 1;
        let from = cut.below(self.offset(lobe, self.sines[j].asin()));
        // No direction lies on a pole, so samples keep off it like those of the kernels.
        let least = T::from_f64(f64::from(f32::EPSILON) / 8.0);
        let share = (from + (area - areas[j]) / self.heights[j]) / cut.area;
        self.theta_i(
            lobe,
            cut.sample(share.max(least).min(T::from_f64(1.0) - least)),
        )
    }

    /// Returns the density with which [`sample_theta`](Self::sample_theta) draws `theta_i`, per radian.
    ///
    /// - Integral: 1 over [-pi/2, pi/2].
    #[inline]
    #[must_use]
    pub fn pdf_theta(&self, lobe: Lobe, theta_i: T) -> T {
        self.heights[self.band(theta_i.sin())] * self.bell_theta(lobe, theta_i)
    }

    /// Returns the probability of an inclination of at most `theta_i`.
    #[inline]
    #[must_use]
    pub fn cdf_theta(&self, lobe: Lobe, theta_i: T) -> T {
        let (cut, areas, j) = (
            &self.longitudinal[lobe],
            &self.areas[lobe],
            self.band(theta_i.sin()),
        );
        let part = cut.below(self.offset(lobe, theta_i))
            - cut.below(self.offset(lobe, self.sines[j].asin()));
        (areas[j] + self.heights[j] * part) / areas[self.bands]
    }

    /// Draws `phi = phi_o - phi_i` like [`HairReference::sample_phi`], except that the azimuth of the glint is in [-pi, pi].
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

    /// Returns the density of `phi`, per radian, for a `phi` in [-pi, pi].
    ///
    /// - Integral: 1 over [-pi, pi].
    #[inline]
    #[must_use]
    pub fn pdf_phi(&self, lobe: Lobe, phi: T) -> T {
        let half = T::from_f64(0.5);
        let p = &self.book.parameters;
        let bell = |cut: &Cut<T>, width: T, from: T| {
            half * self.book.shape.bell(width, from) / (width * cut.area)
        };
        match lobe {
            Lobe::R | Lobe::TRT => self.book.pdf_phi(lobe, phi),
            Lobe::TT => bell(&self.transmission, p.gamma_tt, T::PI - phi.abs()),
            _ => bell(&self.glint, p.gamma_g, phi.abs() - p.phi_g),
        }
    }

    /// Returns the `xi` from which [`sample_phi`](Self::sample_phi) draws `phi`, for a `phi` in (-pi, pi].
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
                half * if phi < zero {
                    one + across
                } else {
                    one - across
                }
            }
            _ => {
                let below = self.glint.cdf((phi.abs() - p.phi_g) / p.gamma_g);
                if phi < zero {
                    one - half * below
                } else {
                    half * below
                }
            }
        }
    }
}

impl<T: Real> Reference<T> for MatchedReference<T> {
    fn eval_pdf(&self, wi: [T; 3]) -> ([T; 3], T) {
        (self.eval(wi), self.pdf(wi))
    }

    /// Evaluates S, which is the same as with the published sampler.
    fn eval(&self, wi: [T; 3]) -> [T; 3] {
        self.book.eval(wi)
    }

    fn pdf(&self, wi: [T; 3]) -> T {
        self.book.angles(wi).map_or_else(T::default, |at| {
            mix_pdfs(&self.probabilities, &self.pdfs_at(&at, wi[0]))
        })
    }

    fn lobes(&self, wi: [T; 3]) -> PerLobe<LobeAt<T>> {
        self.book.angles(wi).map_or_else(PerLobe::default, |at| {
            self.book.lobes_with(&at, &self.pdfs_at(&at, wi[0]))
        })
    }

    /// Returns each lobe's share of the integrals of all lobes, by the mean of their channels or by channel.
    fn probabilities(&self) -> PerLobe<T> {
        self.probabilities
    }

    /// Draws a lobe, and then `theta_i` and `phi` by inversion.
    fn sample(&self, xi: [T; 3]) -> ReferenceSample<T> {
        let Some((lobe, _)) = choose(&self.probabilities, xi[0]) else {
            return ReferenceSample::default();
        };
        let theta_i = self.sample_theta(lobe, xi[1]);
        let at = Angles::new(theta_i, self.sample_phi(lobe, xi[2]));
        let wi = self.book.direction(theta_i, at.phi);
        let pdf = mix_pdfs(&self.probabilities, &self.pdfs_at(&at, wi[0]));
        self.book.finish(lobe, wi, &at, pdf)
    }

    fn albedo(&self) -> PerLobe<[T; 3]> {
        self.book.albedo()
    }

    /// Returns the sum of the energies by which a lobe is chosen.
    fn energy(&self) -> T {
        sum(&self.energies)
    }

    fn cdf(&self, lobe: Lobe, theta_i: T, phi: T) -> Option<[T; 2]> {
        Some([self.cdf_theta(lobe, theta_i), self.cdf_phi(lobe, phi)])
    }

    /// Returns the largest energy over a lobe's probability, times the largest ratio of W to its constant in a band. The first
    /// factor is the sum of the energies unless lobes are chosen by channel.
    fn weight_bound(&self, mask: LobeMask) -> Option<T> {
        let (zero, theta_o) = (T::default(), self.book.theta_o);
        let lobes = || {
            Lobe::FOUR
                .into_iter()
                .filter(|l| mask.contains(*l) && self.probabilities[*l] > zero)
        };
        let chosen = lobes().fold(zero, |sum, lobe| sum + self.probabilities[lobe]);
        let largest = lobes().fold(zero, |most, lobe| {
            most.max(self.energies[lobe] * chosen / self.probabilities[lobe])
        });
        // W has one mode, between the normal plane and the pole away from wo.
        let mode = self.mode();
        let most = (0..self.bands).fold(zero, |most, j| {
            let [from, to] = [j, j + 1].map(|j| self.sines[j].asin());
            most.max(w(mode.max(from).min(to), theta_o) / self.heights[j])
        });
        Some(largest * most)
    }

    fn lobe_errors(&self, wi: [T; 3]) -> Option<PerLobe<[T; 2]>> {
        self.errors(wi)
    }

    /// Returns the ends of the bands, both poles included.
    fn jumps(&self) -> Vec<T> {
        let ends = self.sines[..=self.bands].iter();
        ends.map(|sine| sine.asin()).collect()
    }
}
