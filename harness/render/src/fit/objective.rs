//! Distance of a picture from the target of a fit, with its derivatives.

use super::target::Target;
use super::variables::Variables;
use crate::film::{Crop, TILE};
use crate::scene::Scene;
use crate::transport::{Recorded, Settings, record};
use hairis::ParamError;
use hairis::columns::HitColumns;
use hairis_gradients::{AnyGradients, GradColumns, Weights};
use hairis_variants::{ModelId, Values};
use rayon::prelude::*;

/// Recorded paths of a tile, in two independent halves.
#[derive(Clone, Debug)]
pub struct Halves {
    place: Crop,
    halves: [Recorded; 2],
    samples: u32,
}

/// Records the paths of a picture tile by tile, in two independent halves of `samples` per pixel each.
#[must_use]
pub fn halves(scene: &Scene, settings: &Settings, crop: Crop, samples: u32) -> Vec<Halves> {
    let tiles: Vec<Crop> = crop.tiles(TILE).collect();
    let half = |place, half: u64| {
        let settings = Settings {
            seed: settings.seed.wrapping_mul(2).wrapping_add(half),
            ..*settings
        };
        record(scene, &settings, place, samples)
    };
    let of_tile = |place: Crop| Halves {
        place,
        halves: [half(place, 0), half(place, 1)],
        samples,
    };
    tiles.into_par_iter().map(of_tile).collect()
}

/// Distance of a picture from its target, with its derivatives by the variables.
///
/// The distance is the sum of `weight (A - T) (B - T)` over pixels and channels, where `T` is the target, and the pictures `A` and `B`
/// are made of independent halves of the paths. It is therefore an unbiased estimate of the weighted squared error, and its derivative
/// is an unbiased estimate of the derivative of that error.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Slope {
    /// Distance of the picture from the target.
    pub distance: f64,
    /// Derivative of the distance by each variable.
    pub gradient: Vec<f64>,
    /// Second derivatives by the rule of Gauss and Newton: products of the first derivatives of both halves, by rows.
    pub curvature: Vec<Vec<f64>>,
    /// Weighted squares of the first derivatives of each half, which exceed the diagonal of the curvature by the noise of the paths.
    pub squares: Vec<f64>,
}

impl Slope {
    fn none(count: usize) -> Self {
        Self {
            distance: 0.0,
            gradient: vec![0.0; count],
            curvature: vec![vec![0.0; count]; count],
            squares: vec![0.0; count],
        }
    }

    fn add(&mut self, other: &Self) {
        let add = |to: &mut [f64], from: &[f64]| {
            to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
        };
        self.distance += other.distance;
        add(&mut self.gradient, &other.gradient);
        add(&mut self.squares, &other.squares);
        for (to, from) in self.curvature.iter_mut().zip(&other.curvature) {
            add(to, from);
        }
    }
}

/// Objective of a fit: the variables of a model, and the target that its picture is to match.
#[derive(Clone, Debug)]
pub struct Objective {
    target: Target,
    variables: Variables,
    model: ModelId,
}

impl Objective {
    /// Creates the objective for the variables of a model. The sampler of `model` is not used.
    #[must_use]
    pub fn new(target: Target, model: ModelId, variables: Variables) -> Self {
        // All samplers of a model share one BSDF, and the first sampler has the fewest numbers.
        let model = ModelId::find(model.name(), None).unwrap_or(model);
        Self {
            target,
            variables,
            model,
        }
    }

    /// Returns the distance of the picture of these paths at the variables `x`, with its derivatives.
    ///
    /// # Errors
    ///
    /// Returns an error if the model rejects a value.
    pub fn slope(&self, paths: &[Halves], x: &[f64]) -> Result<Slope, ParamError> {
        let values = self.variables.values(x);
        let gradients = AnyGradients::new(self.model, &values)?;
        let by_numbers = self.by_numbers(&gradients, x);
        let tiles: Vec<Slope> = paths
            .par_iter()
            .map(|tile| self.tile(tile, &gradients, &by_numbers))
            .collect();
        let mut sum = Slope::none(self.variables.len());
        tiles.iter().for_each(|tile| sum.add(tile));
        Ok(sum)
    }

    /// Returns the derivatives of the numbers of the material by the variables, one row per number.
    fn by_numbers(&self, gradients: &AnyGradients, x: &[f64]) -> Vec<Vec<f64>> {
        let count = gradients.material().len();
        let slopes = self.variables.slopes(x);
        let row = |number: usize| {
            let mut unit = vec![0.0; count];
            unit[number] = 1.0;
            let found: Values<f64> = gradients.by_parameters(&unit);
            self.variables.derivatives(&found, &slopes)
        };
        (0..count).map(row).collect()
    }

    fn tile(&self, tile: &Halves, gradients: &AnyGradients, by_numbers: &[Vec<f64>]) -> Slope {
        let count = self.variables.len();
        let picture = |recorded| Pixels::new(recorded, tile.samples, gradients, by_numbers, count);
        let [a, b] = tile.halves.each_ref().map(picture);
        let mut slope = Slope::none(count);
        for (place, pixel) in tile.place.pixels().enumerate() {
            let (target, weight) = self.target.pixel(pixel);
            for c in 0..3 {
                let at = 3 * place + c;
                let [off_a, off_b] = [&a, &b].map(|half| half.radiance[at] - target[c]);
                slope.distance += weight[c] * off_a * off_b;
                let rows = [&a, &b].map(|half| &half.derivatives[at * count..][..count]);
                let [by_a, by_b] = rows;
                // Most pixels beside the hair have no derivatives.
                if rows.iter().all(|row| row.iter().all(|d| *d == 0.0)) {
                    continue;
                }
                for i in 0..count {
                    slope.gradient[i] += weight[c] * (off_b * by_a[i] + off_a * by_b[i]);
                    slope.squares[i] += weight[c] * (by_a[i] * by_a[i] + by_b[i] * by_b[i]);
                    for j in 0..count {
                        let product = by_a[i] * by_b[j] + by_b[i] * by_a[j];
                        slope.curvature[i][j] += weight[c] * product;
                    }
                }
            }
        }
        slope
    }
}

/// Pixels of recorded paths, evaluated with a material.
struct Pixels {
    /// Radiance, three channels per pixel.
    radiance: Vec<f64>,
    /// Derivatives by each variable, for each channel of a pixel.
    derivatives: Vec<f64>,
}

impl Pixels {
    fn new(
        recorded: &Recorded,
        samples: u32,
        gradients: &AnyGradients,
        by_numbers: &[Vec<f64>],
        count: usize,
    ) -> Self {
        let share = 1.0 / f64::from(samples);
        let (len, numbers) = (recorded.h.len(), by_numbers.len());
        let mut radiance: Vec<f64> = recorded.beside.as_flattened().to_vec();
        let mut by_material = vec![0.0; radiance.len() * numbers];
        let (ones, zeros) = (vec![1.0; len], vec![0.0; len]);
        let hits = HitColumns {
            wo: recorded.wo.each_ref().map(|column| &column[..]),
            h: Some(&recorded.h),
        };
        for c in 0..3 {
            let weights = [0, 1, 2].map(|channel| if channel == c { &ones[..] } else { &zeros });
            let mut value = [vec![0.0; len], vec![0.0; len], vec![0.0; len]];
            let mut each = vec![vec![0.0; len]; numbers];
            let mut columns: Vec<&mut [f32]> = each.iter_mut().map(|one| &mut one[..]).collect();
            let out = GradColumns {
                value: Some(value.each_mut().map(|column| &mut column[..])),
                d_material_of_hits: Some(&mut columns),
                ..GradColumns::default()
            };
            let weights = Weights {
                value: Some(weights),
                pdf: None,
            };
            let wi = recorded.wi.each_ref().map(|column| &column[..]);
            gradients
                .eval_grad(hits, wi, weights, out)
                .expect("columns of one length");
            for term in &recorded.terms {
                let factor = f64::from(term.factor[c]);
                let at = 3 * term.pixel as usize + c;
                let product = |all: &mut dyn Iterator<Item = usize>| -> f64 {
                    all.map(|at| f64::from(value[c][at])).product()
                };
                radiance[at] += factor * product(&mut term.scatterings());
                for one in term.scatterings() {
                    let others = factor * product(&mut term.scatterings().filter(|at| *at != one));
                    let sums = &mut by_material[at * numbers..][..numbers];
                    for (sum, column) in sums.iter_mut().zip(&each) {
                        *sum += others * f64::from(column[one]);
                    }
                }
            }
        }
        let mut derivatives = vec![0.0; radiance.len() * count];
        let rows = derivatives.chunks_exact_mut(count.max(1));
        for (row, by_material) in rows.zip(by_material.chunks_exact(numbers.max(1))) {
            for (d, by_number) in by_material
                .iter()
                .zip(by_numbers)
                .filter(|(d, _)| **d != 0.0)
            {
                for (to, by) in row.iter_mut().zip(by_number) {
                    *to += share * d * by;
                }
            }
        }
        radiance.iter_mut().for_each(|sum| *sum *= share);
        Self {
            radiance,
            derivatives,
        }
    }
}
