//! Fit of one model's parameters, so that its look is nearest to that of another.
//!
//! # What is minimised
//!
//! The distance of `S cos theta_i` of the two models over all directions and some views, per channel, relative to the norm of the first. In
//! L1, the distance is the light that is reflected elsewhere, not at all, or in addition; blurred, it is the same after a blur of
//! [`SIGMA_DEG`](crate::difference::SIGMA_DEG); in L2, it is the root mean square, in which peaks count more. For near-field models, the
//! mean over the offsets counts. L1 is smoothed near 0, by a hundredth of the mean.
//!
//! # Method
//!
//! The sphere of each view is integrated by [`Points`]: half of them are drawn by the first model's sampler and half uniformly, and weighed
//! by the density of the mixture. L-BFGS-B minimises, with the derivatives of [`hairis_gradients`], within the ranges of the fields, from
//! several starts. Distances are measured at other [`Points`], which the optimiser does not use. The result is the nearest, by the true
//! norm, of all ends, starts and [`rules`], so that it is never further away than any of them.

mod blur;
pub mod objective;
mod over;
pub(crate) mod page;
pub mod points;
mod residual;
mod rules;
pub mod truth;
pub mod variables;

pub(crate) use over::value_columns;
pub use over::{Refit, columns, hair_of, refits, table, verdicts};
pub use points::Points;
pub use residual::{Residual, residuals};
pub use rules::{RULES, first_start, rules};

use crate::study::Grid;
use hairis::ParamError;
use hairis_instruments::progress::Progress;
use hairis_instruments::sequence::Independent;
use hairis_variants::{ModelId, Values};
use objective::minimise;
use serde::Serialize;
use variables::Variables;

/// Norm that measures the distance of two models.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Norm {
    /// Integral of the magnitude.
    L1,
    /// Root of the integral of the square.
    L2,
    /// Integral of the magnitude after a blur of [`SIGMA_DEG`](crate::difference::SIGMA_DEG).
    Blurred,
}

impl Norm {
    /// Returns the name of the norm in sentences.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::L1 => "L1",
            Self::L2 => "L2",
            Self::Blurred => "blurred L1",
        }
    }
}

/// Settings of a fit: norm, views, fixed fields and starts.
#[derive(Clone, Debug, PartialEq)]
pub struct FitConfig {
    /// Norm of the distance.
    pub norm: Norm,
    /// Inclinations of the viewer, rad, within (-pi/2, pi/2).
    pub views: Vec<f64>,
    /// Weight of each view, above 0. Only ratios of weights count.
    pub weights: Vec<f64>,
    /// Fields that keep their values of the start.
    pub fixed: Vec<String>,
    /// Number of starts, at least 1.
    pub starts: usize,
    /// Seed of the points and of the starts.
    pub seed: u64,
    /// Number of directions per view.
    pub directions: usize,
}

impl Default for FitConfig {
    /// Returns eight views, each of the same solid angle, with equal weights.
    fn default() -> Self {
        let views: Vec<f64> = (0..8)
            .map(|i| ((f64::from(i) + 0.5) / 4.0 - 1.0).asin())
            .collect();
        Self {
            norm: Norm::L1,
            weights: vec![1.0; views.len()],
            views,
            fixed: Vec::new(),
            starts: 4,
            seed: 1,
            directions: 1024,
        }
    }
}

impl FitConfig {
    /// Returns settings with the inclinations of a grid as views, which count equally.
    #[must_use]
    pub fn of_grid(grid: &Grid) -> Self {
        let views = grid.theta_o_deg.iter();
        Self {
            views: views.map(|angle| f64::from(*angle).to_radians()).collect(),
            weights: vec![1.0; grid.theta_o_deg.len()],
            ..Self::default()
        }
    }

    /// Returns settings with as many directions as distances are measured at.
    fn finer(&self) -> Self {
        Self {
            directions: 8 * self.directions,
            ..self.clone()
        }
    }
}

/// Model with the values of its fields, whose look is fitted or fitted to.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Model that evaluates the look.
    pub model: ModelId,
    /// Values of the model's fields.
    pub values: Values,
}

/// Start of the optimiser, with the end that it led to.
#[derive(Clone, Copy, Debug)]
pub struct End {
    /// Values at the start.
    pub start: Values,
    /// Values at the end.
    pub values: Values,
    /// Distance at the start, relative to the norm of the first model.
    pub distance_of_start: f64,
    /// Distance at the end.
    pub distance: f64,
    /// Iterations of the optimiser.
    pub iterations: u64,
}

/// Result of a fit: the values that were found, and their distance.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Fitted model, with the values that were found.
    pub found: Look,
    /// Distance of the values that were found.
    pub distance: f64,
    /// Error of the distance, as its difference from the distance at a third set of points.
    pub error: f64,
    /// Distance of the first start.
    pub distance_of_start: f64,
    /// Distance of each of the [`rules`], in their order.
    pub distances_of_rules: Vec<f64>,
    /// Ends of all starts, with the first start first.
    pub ends: Vec<End>,
    /// Points at which all these distances are measured. The optimiser used others.
    pub points: Points,
}

/// Returns the starts of a fit: the `given` ones, and others whose numbers are up to 30% away from one of those.
fn starts(given: &[Values], config: &FitConfig) -> Vec<Values> {
    let start = |place: usize| {
        if let Some(values) = given.get(place) {
            return *values;
        }
        let mut xi = Independent::new(config.seed, 1 + place as u64);
        let variables = Variables::new(&given[place % given.len()], &config.fixed);
        let moved = variables.start().into_iter().zip(variables.spreads());
        let moved: Vec<f64> = moved
            .map(|(x, spread)| x + spread * (2.0 * xi.next_f64() - 1.0))
            .collect();
        variables.values(&variables.clamped(moved))
    };
    (0..config.starts).map(start).collect()
}

/// Fits the model `to` to a look. Starts are the [first](first_start); the presets of `to` if it has other fields, or else the best of the
/// [`rules`]; and others around those.
///
/// # Errors
///
/// Returns an error if a value of `from` is out of its range.
pub fn fit(
    from: &Look,
    to: ModelId,
    config: &FitConfig,
    report: &(dyn Fn(usize, usize) + Sync),
) -> Result<Fit, ParamError> {
    let to = ModelId::find(to.name(), None).unwrap_or(to);
    let points = Points::new(from, to, config, 0)?;
    let others = Points::new(from, to, &config.finer(), 1)?;
    let distance = |values: &Values| others.distance(to, values, config.norm);
    let rules = rules(from, to, config, |values| {
        points.distance(to, values, config.norm)
    })?;
    let mut given = vec![rules[0]];
    if from.model.fields() == to.fields() {
        given.extend(rules[1..].last());
    } else {
        let presets = to.presets().map(|(_, values)| values);
        given.extend(presets.filter(|values| *values != rules[0]));
    }
    let starts = starts(&given, config);
    let progress = Progress::new(starts.len(), report);
    let ends = progress.map(&starts, |start| {
        let (values, iterations) = minimise(to, start, &points, config)?;
        Ok(End {
            start: *start,
            values,
            distance_of_start: distance(start)?,
            distance: distance(&values)?,
            iterations,
        })
    });
    let ends = ends.into_iter().collect::<Result<Vec<End>, ParamError>>()?;
    let distances_of_rules = rules.iter().map(distance);
    let distances_of_rules = distances_of_rules.collect::<Result<Vec<f64>, ParamError>>()?;
    // The first rule is the first start.
    let (mut nearest, mut values) = (distances_of_rules[0], rules[0]);
    let of_starts = ends.iter().map(|end| (end.distance_of_start, end.start));
    let of_ends = ends.iter().map(|end| (end.distance, end.values));
    let of_rules = distances_of_rules
        .iter()
        .copied()
        .zip(rules.iter().copied());
    for (distance, candidate) in of_rules.chain(of_starts).chain(of_ends) {
        if distance < nearest {
            (nearest, values) = (distance, candidate);
        }
    }
    let third = Points::new(from, to, &config.finer(), 2)?;
    Ok(Fit {
        found: Look { model: to, values },
        distance: nearest,
        error: (third.distance(to, &values, config.norm)? - nearest).abs(),
        distance_of_start: ends[0].distance_of_start,
        distances_of_rules,
        ends,
        points: others,
    })
}
