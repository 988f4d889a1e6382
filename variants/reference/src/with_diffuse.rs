//! Any model with a diffuse part, formula by formula, in either precision.

use crate::cylinder::{self, cylinder};
use crate::interface::{LobeAt, Reference, ReferenceSample};
use crate::real::Real;
use crate::steps::{GRAZING, fixed, inclination};
use hairis::{Lobe, LobeMask, PerLobe};

/// Numbers of a material with a diffuse part: those of the model, the share of the cylinder, and its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithDiffuseConstants<K, T> {
    /// Constants of the model.
    pub fiber: K,
    /// Share of the cylinder in the light.
    pub diffuse: T,
    /// Colour of the cylinder, linear RGB.
    pub diffuse_color: [T; 3],
}

/// Formulas `R` of a model at a hit, with a Lambertian cylinder beside its lobes.
///
/// - Source: the integral of Lambert's law over the width of a cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithDiffuseReference<R, T> {
    fiber: R,
    /// Slot of the cylinder.
    slot: Lobe,
    phi_o: T,
    /// Share of the model.
    share: T,
    /// Albedo of the cylinder.
    color: [T; 3],
    /// Probabilities of the model and of the cylinder.
    selection: [T; 2],
}

/// Returns the mean of three channels.
fn mean<T: Real>(rgb: [T; 3]) -> T {
    (rgb[0] + rgb[1] + rgb[2]) / T::from_f64(3.0)
}

impl<T: Real, R: Reference<T>> WithDiffuseReference<R, T> {
    /// Combines the formulas of a model of so many `lobes`, for the direction `wo`, with a cylinder.
    ///
    /// # Panics
    ///
    /// Panics if the model has no slot left.
    #[inline]
    #[must_use]
    pub fn prepare<K>(
        constants: &WithDiffuseConstants<K, T>,
        fiber: R,
        lobes: usize,
        wo: [T; 3],
    ) -> Self {
        let share = T::from_f64(1.0) - constants.diffuse;
        let color = constants.diffuse_color.map(|c| constants.diffuse * c);
        let energies = [share * fiber.energy(), mean(color)];
        let sum = energies[0] + energies[1];
        let selection = energies.map(|e| if sum > T::default() { e / sum } else { sum });
        Self {
            fiber,
            slot: Lobe::ALL[lobes],
            phi_o: fixed(wo).phi_o,
            share,
            color,
            selection,
        }
    }

    /// Evaluates S of the cylinder without its colour, and its density, which integrates to 1, at an inclination and an azimuth.
    fn cylinder(&self, cos_theta_i: T, phi_i: T) -> [T; 2] {
        if cos_theta_i < T::from_f64(GRAZING) {
            return [T::default(); 2];
        }
        let (phi, turn) = ((phi_i - self.phi_o).abs(), T::PI + T::PI);
        let phi = if phi > T::PI { (turn - phi).abs() } else { phi };
        let s = cylinder(T::PI - phi) / (T::from_f64(4.0) * T::PI);
        [s, s * cos_theta_i]
    }

    /// Adds the cylinder to S and density of the model.
    fn sum(&self, (value, pdf): ([T; 3], T), [s, density]: [T; 2]) -> ([T; 3], T) {
        let [of_model, of_cylinder] = self.selection;
        let value = [0, 1, 2].map(|c| self.share * value[c] + self.color[c] * s);
        (value, of_model * pdf + of_cylinder * density)
    }
}

impl<T: Real, R: Reference<T>> Reference<T> for WithDiffuseReference<R, T> {
    #[inline]
    fn eval_pdf(&self, wi: [T; 3]) -> ([T; 3], T) {
        let [_, cos_theta_i] = inclination(wi);
        self.sum(
            self.fiber.eval_pdf(wi),
            self.cylinder(cos_theta_i, wi[2].atan2(wi[1])),
        )
    }

    #[inline]
    fn lobes(&self, wi: [T; 3]) -> PerLobe<LobeAt<T>> {
        let [_, cos_theta_i] = inclination(wi);
        let mut lobes = self.fiber.lobes(wi);
        for at in &mut lobes.0 {
            at.value = at.value * self.share;
        }
        let [value, pdf] = self.cylinder(cos_theta_i, wi[2].atan2(wi[1]));
        let color = if pdf > T::default() {
            self.color
        } else {
            [T::default(); 3]
        };
        lobes[self.slot] = LobeAt { value, color, pdf };
        lobes
    }

    #[inline]
    fn probabilities(&self) -> PerLobe<T> {
        let [of_model, of_cylinder] = self.selection;
        let mut all = PerLobe(self.fiber.probabilities().0.map(|one| one * of_model));
        all[self.slot] = of_cylinder;
        all
    }

    /// Draws from the model if the first number is below its probability, and from the cylinder elsewhere. Either gets the first number
    /// stretched to the whole interval.
    #[inline]
    fn sample(&self, xi: [T; 3]) -> ReferenceSample<T> {
        let (zero, [of_model, of_cylinder]) = (T::default(), self.selection);
        let largest = T::from_f64(1.0 - 0.5 * f64::from(f32::EPSILON));
        let stretched = |number: T| [number.max(zero).min(largest), xi[1], xi[2]];
        if xi[0] < of_model || of_cylinder <= zero {
            if of_model <= zero {
                return ReferenceSample::default();
            }
            let drawn = self.fiber.sample(stretched(xi[0] / of_model));
            if drawn.lobe.is_none() {
                return drawn;
            }
            let [_, cos_theta_i] = inclination(drawn.wi);
            let own = self.cylinder(cos_theta_i, drawn.wi[2].atan2(drawn.wi[1]));
            let (value, pdf) = self.sum((drawn.value, drawn.pdf), own);
            return ReferenceSample {
                value,
                pdf,
                weight: value.map(|s| s * cos_theta_i / pdf),
                ..drawn
            };
        }
        let ([sin, cos], phi) = cylinder::draw(stretched((xi[0] - of_model) / of_cylinder));
        if cos < T::from_f64(GRAZING) {
            return ReferenceSample::default();
        }
        let phi = self.phi_o + phi;
        let wi = [sin, cos * phi.cos(), cos * phi.sin()];
        let (value, pdf) = self.eval_pdf(wi);
        ReferenceSample {
            wi,
            value,
            pdf,
            weight: value.map(|s| s * cos / pdf),
            lobe: Some(self.slot),
        }
    }

    #[inline]
    fn albedo(&self) -> PerLobe<[T; 3]> {
        let scaled = |rgb: [T; 3]| rgb.map(|c| c * self.share);
        let mut all = PerLobe(self.fiber.albedo().0.map(scaled));
        all[self.slot] = self.color;
        all
    }

    fn energy(&self) -> T {
        self.share * self.fiber.energy() + mean(self.color)
    }

    /// Returns the numbers of the model's lobes; the azimuth of the cylinder takes all three numbers.
    fn cdf(&self, lobe: Lobe, theta_i: T, phi: T) -> Option<[T; 2]> {
        if lobe == self.slot {
            return None;
        }
        self.fiber.cdf(lobe, theta_i, phi)
    }

    /// Returns the larger of the bounds of both parts, each over its probability: a mean of ratios is at most the largest.
    fn weight_bound(&self, mask: LobeMask) -> Option<T> {
        let (zero, [of_model, of_cylinder]) = (T::default(), self.selection);
        let kept = |lobe: &Lobe| *lobe != self.slot && mask.contains(*lobe);
        let probabilities = self.fiber.probabilities();
        let of_model = Lobe::ALL
            .into_iter()
            .filter(kept)
            .fold(zero, |sum, lobe| sum + of_model * probabilities[lobe]);
        let of_cylinder = of_cylinder * T::from_f32(mask.factor(self.slot));
        let both = of_model + of_cylinder;
        let mut bound = zero;
        if of_model > zero {
            bound = self.fiber.weight_bound(mask)? * self.share * both / of_model;
        }
        if of_cylinder > zero {
            bound = bound.max(mean(self.color) * both / of_cylinder);
        }
        Some(bound)
    }

    fn lobe_errors(&self, wi: [T; 3]) -> Option<PerLobe<[T; 2]>> {
        let mut errors = self.fiber.lobe_errors(wi)?;
        errors[self.slot] = [T::from_f64(1e-5); 2];
        Some(errors)
    }

    fn color_error(&self, lobe: Lobe, channel: usize) -> T {
        if lobe == self.slot {
            return T::from_f64(4e-6);
        }
        self.fiber.color_error(lobe, channel)
    }

    fn jumps(&self) -> Vec<T> {
        self.fiber.jumps()
    }
}
