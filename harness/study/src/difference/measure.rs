//! Measurement of one cell: the distance of a Cauchy model from the Gaussian one.

use super::blur::Blur;
use super::lobes::{BellValues, Kind, Rule, ViewedHair, dot};

/// Differences between a Cauchy model and the Gaussian one of the same hair: of `S cos theta_i`, the mean of RGB, over the sphere, relative
/// to the same norm of the Gaussian model alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Differences {
    /// Factor on the widths, 1 for fitted parameters.
    pub k: f64,
    /// Albedo of the Gaussian model: the integral of `S cos theta_i`.
    pub albedo_gaussian: f64,
    /// Albedo of the Cauchy model.
    pub albedo_cauchy: f64,
    /// Difference of the models as they are.
    pub plain: Norms,
    /// Difference in shape alone, with the Cauchy model scaled to the albedo of the Gaussian one.
    pub shape: Norms,
    /// Difference of the models as they are, after a blur of [`SIGMA_DEG`](super::SIGMA_DEG).
    pub blurred: Norms,
    /// Difference in shape alone, after the blur.
    pub blurred_shape: Norms,
}

/// Norms of a difference between two functions on the sphere, in L1 and in L2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Norms {
    /// Integral of the magnitude.
    pub l1: f64,
    /// Root of the integral of the square.
    pub l2: f64,
}

/// Count of the numbers of [`Differences`].
pub const NUMBERS: usize = 11;

impl Differences {
    /// Returns all numbers of the differences, for the journal.
    #[must_use]
    pub fn numbers(&self) -> [f64; NUMBERS] {
        let Self {
            k,
            albedo_gaussian,
            albedo_cauchy,
            plain,
            shape,
            blurred,
            blurred_shape,
        } = *self;
        let norms = [plain, shape, blurred, blurred_shape].map(|of| [of.l1, of.l2]);
        let mut numbers = [0.0; NUMBERS];
        numbers[..3].copy_from_slice(&[k, albedo_gaussian, albedo_cauchy]);
        numbers[3..].copy_from_slice(norms.as_flattened());
        numbers
    }

    /// Restores differences from their numbers.
    pub(super) fn from_numbers(numbers: [f64; NUMBERS]) -> Self {
        let norms = |place: usize| Norms {
            l1: numbers[place],
            l2: numbers[place + 1],
        };
        Self {
            k: numbers[0],
            albedo_gaussian: numbers[1],
            albedo_cauchy: numbers[2],
            plain: norms(3),
            shape: norms(5),
            blurred: norms(7),
            blurred_shape: norms(9),
        }
    }
}

/// Hair with the values of its Gaussian model at the points of its rule.
#[derive(Debug)]
pub struct HairValues {
    view: ViewedHair,
    rule: Rule,
    /// Rule of twice the order, because the magnitude of a difference has kinks at the angles at which the models cross.
    fine: Rule,
    gaussian: BellValues,
    /// Integral of the square of the Gaussian model.
    square: f64,
}

impl HairValues {
    /// Prepares a hair; `order` is the order of the rules on each panel.
    #[must_use]
    pub fn new(view: ViewedHair, order: usize) -> Self {
        let rule = view.rule(order);
        let gaussian = rule.values(&view, Kind::GAUSSIAN);
        let square = rule.product(&gaussian, &gaussian);
        Self {
            view,
            rule,
            fine: view.rule(2 * order),
            gaussian,
            square,
        }
    }

    /// Returns the square of the relative L2 difference of the Cauchy model with its widths times `k`.
    #[must_use]
    pub fn square_error(&self, k: f64) -> f64 {
        self.square_of(&self.rule.values(&self.view, Kind::cauchy(k)), 1.0)
    }

    fn square_of(&self, other: &BellValues, scale: f64) -> f64 {
        let (cross, square) = (
            self.rule.product(&self.gaussian, other),
            self.rule.product(other, other),
        );
        // If the models are equal, rounding may make the difference negative.
        ((self.square - 2.0 * scale * cross + scale * scale * square) / self.square).max(0.0)
    }

    /// Returns the figures of several models.
    #[must_use]
    pub fn figures(&self, kinds: &[Kind], blur: &Blur) -> Vec<Differences> {
        let mut models = vec![self.gaussian.clone()];
        models.extend(kinds.iter().map(|kind| self.rule.values(&self.view, *kind)));
        let albedos: Vec<f64> = models.iter().map(|model| self.rule.albedo(model)).collect();
        let sums = self.magnitudes(kinds, &albedos);
        let harmonics = blur.harmonics(&self.rule, &models);
        let blurred: Vec<Vec<f64>> = harmonics.iter().map(|of| blur.values(of)).collect();
        let norm = harmonics[0].norm();
        let albedo = albedos[0];
        (1..models.len())
            .map(|n| {
                let scale = albedo / albedos[n];
                let plain = |scale, l1: f64| Norms {
                    l1: l1 / albedo,
                    l2: self.square_of(&models[n], scale).sqrt(),
                };
                let soft = |scale| Norms {
                    l1: blur.l1(&blurred[0], &blurred[n], scale) / albedo,
                    l2: harmonics[0].l2(&harmonics[n], scale) / norm,
                };
                Differences {
                    k: kinds[n - 1].factor,
                    albedo_gaussian: albedo,
                    albedo_cauchy: albedos[n],
                    plain: plain(1.0, sums[n - 1][0]),
                    shape: plain(scale, sums[n - 1][1]),
                    blurred: soft(1.0),
                    blurred_shape: soft(scale),
                }
            })
            .collect()
    }

    /// Returns the integrals of the magnitude of the Gaussian model less each other model: as it is, and scaled to its albedo.
    fn magnitudes(&self, kinds: &[Kind], albedos: &[f64]) -> Vec<[f64; 2]> {
        let kinds = [Kind::GAUSSIAN].iter().chain(kinds);
        let models: Vec<BellValues> = kinds
            .map(|kind| self.fine.values(&self.view, *kind))
            .collect();
        let mut sums = vec![[0.0; 2]; models.len() - 1];
        for (place, [_, weight]) in self.fine.along.iter().enumerate() {
            // Values of the models on one latitude.
            let row = |model: &BellValues| {
                model
                    .around
                    .iter()
                    .map(|around| dot(&model.along[place], around))
                    .collect()
            };
            let rows: Vec<Vec<f64>> = models.iter().map(row).collect();
            for (n, sums) in sums.iter_mut().enumerate() {
                let scale = albedos[0] / albedos[n + 1];
                let mut row = [0.0; 2];
                for (([_, w], a), b) in self.fine.around.iter().zip(&rows[0]).zip(&rows[n + 1]) {
                    row[0] += w * (a - b).abs();
                    row[1] += w * (a - scale * b).abs();
                }
                sums.iter_mut()
                    .zip(row)
                    .for_each(|(sum, row)| *sum += weight * row);
            }
        }
        sums
    }
}
