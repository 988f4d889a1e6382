//! Materials of hair that are recovered from pictures.
//!
//! # Method
//!
//! Each iteration draws two independent sets of paths with the material that it has reached, for light that hair has scattered once or
//! twice. The derivatives of both pictures by the parameters are exact for these paths, because densities and directions stay fixed
//! (detached sampling). The residual of one set times the derivative of the other is an unbiased estimate of the gradient of the
//! squared error of the picture. Products of both derivatives estimate the curvature by the rule of Gauss and Newton.
//!
//! A step goes to the minimum of the sum of the quadratic models of all iterations so far, except the first quarter. The noise of the
//! models averages out, and the scatter of their gradients about that minimum gives standard errors.

mod objective;
mod target;
mod variables;

pub use objective::{Halves, Objective, Slope, halves};
pub use target::Target;
pub use variables::Variables;

use crate::hair::{Choice, Energy};
use crate::linear::solve;
use crate::scene::Scene;
use crate::transport::{Integrator, Settings};
use hairis_instruments::error::Error;
use hairis_variants::Values;

/// Damping of the first step, relative to the squares of the derivatives. Later steps have less, because the curvature is known better.
const DAMPING: f64 = 0.02;

/// Inverse of the share of all iterations, counted from the first, that are left out of the sum of models.
const FORGOTTEN: usize = 4;

/// Settings of a fit: the fields that vary, the paths, and the count of iterations.
#[derive(Clone, Debug, PartialEq)]
pub struct FitSettings {
    /// Names of the fields that stay as they are.
    pub fixed: Vec<String>,
    /// Names of the fields whose numbers are variables of their own.
    pub free: Vec<String>,
    /// Count of iterations.
    pub iterations: u32,
    /// Samples per pixel and iteration, an even number.
    pub samples: u32,
    /// Largest number of scatterings of a path: 1 or 2.
    pub depth: u32,
    /// Seed of the paths.
    pub seed: u64,
    /// Whether light goes on from hair to hair.
    pub multiple: bool,
}

impl Default for FitSettings {
    fn default() -> Self {
        Self {
            fixed: Vec::new(),
            free: Vec::new(),
            iterations: 12,
            samples: 8,
            depth: 2,
            seed: 1,
            multiple: true,
        }
    }
}

/// Iteration of a fit: its variables, and the slope of the objective for them.
#[derive(Clone, Debug)]
struct Iteration {
    x: Vec<f64>,
    slope: Slope,
}

/// Result of a fit: the values that were found, with their errors and the way there.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Names of the numbers that were fitted.
    pub names: Vec<String>,
    /// Values of the material that were found.
    pub values: Values,
    /// Numbers that were found, in the order of `names`.
    pub numbers: Vec<f64>,
    /// Standard errors of the numbers by the noise of the paths; the noise of the target comes on top.
    pub errors: Vec<f64>,
    /// Numbers at the start of each iteration, and at the end.
    pub history: Vec<Vec<f64>>,
    /// Weighted squared error of the picture at the start of each iteration.
    pub distances: Vec<f64>,
}

/// Fits the material of the hair of a scene to a target, from `start` on. Calls `progress` after each iteration with the count of
/// iterations that are done.
///
/// # Errors
///
/// Returns an error if the target shows no hair, if no variable is left, or if the model rejects a value.
pub fn fit(
    scene: &Scene,
    start: &Choice,
    target: &Target,
    settings: &FitSettings,
    progress: &dyn Fn(u32),
) -> Result<Fit, Error> {
    let variables = Variables::new(&start.values, &settings.fixed, &settings.free);
    if variables.is_empty() {
        let problem = "there must be a parameter to fit, got --fix for each: leave one out";
        return Err(Error::Usage(problem.to_owned()));
    }
    let objective = Objective::new(target.clone(), start.id, variables.clone());
    let mut scene = scene.clone();
    let mut all: Vec<Iteration> = Vec::new();
    let mut x = vec![0.0; variables.len()];
    let mut errors = Vec::new();
    for iteration in 0..settings.iterations {
        let choice = Choice {
            values: variables.values(&x),
            ..start.clone()
        };
        scene.hair = choice.hair(Energy::Raw)?;
        let paths = Settings {
            integrator: Integrator::Path,
            seed: seed(settings.seed, iteration),
            depth: Some(settings.depth),
            multiple: settings.multiple,
            ..Settings::default()
        };
        let paths = halves(&scene, &paths, target.crop(), settings.samples / 2);
        let slope = objective.slope(&paths, &x)?;
        if slope.squares.iter().all(|square| *square == 0.0) {
            let problem = "the picture must show the hair of the scene, got none: give the scene, camera and size of the target";
            return Err(Error::Usage(problem.to_owned()));
        }
        all.push(Iteration {
            x: x.clone(),
            slope,
        });
        let (step, found) = minimum(&all[all.len() / FORGOTTEN..], &x);
        (x, errors) = (variables.after(&x, &step), found);
        progress(iteration + 1);
    }
    let numbers = variables.numbers(&x);
    let slopes = variables.slopes(&x);
    let spread = variables.spread(&errors).into_iter().zip(slopes);
    let history = all.iter().map(|one| variables.numbers(&one.x));
    Ok(Fit {
        names: variables.names(),
        values: variables.values(&x),
        errors: spread.map(|(e, slope)| (e * slope).abs()).collect(),
        history: history.chain([numbers.clone()]).collect(),
        numbers,
        distances: all.iter().map(|one| one.slope.distance).collect(),
    })
}

/// Returns the seed of the paths of an iteration.
fn seed(seed: u64, iteration: u32) -> u64 {
    hairis_instruments::sequence::mix(seed) ^ u64::from(iteration)
}

/// Returns the step from `x` to the minimum of the sum of the iterations' quadratic models, and the standard errors of that minimum.
///
/// Variables that the picture hardly depends on stay where they are, with large errors, because their derivatives are damped. If it does
/// not depend on a variable at all, the error of that variable alone is infinite.
fn minimum(all: &[Iteration], x: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let count = x.len();
    let mut matrix = vec![vec![0.0; count]; count];
    let mut slope = vec![0.0; count];
    let mut squares = vec![0.0; count];
    // Slope of an iteration's model at a place.
    let slope_at = |one: &Iteration, x: &[f64]| -> Vec<f64> {
        let away: Vec<f64> = x.iter().zip(&one.x).map(|(to, from)| to - from).collect();
        let rows = one.slope.curvature.iter().zip(&one.slope.gradient);
        rows.map(|(row, slope)| slope + dot(row, &away)).collect()
    };
    for one in all {
        for (sum, slope) in slope.iter_mut().zip(slope_at(one, x)) {
            *sum -= slope;
        }
        for (sum, square) in squares.iter_mut().zip(&one.slope.squares) {
            *sum += square;
        }
        for (row, other) in matrix.iter_mut().zip(&one.slope.curvature) {
            row.iter_mut().zip(other).for_each(|(to, from)| *to += from);
        }
    }
    let mut errors = vec![0.0; count];
    // A variable that the picture does not depend on would leave the matrix without an inverse.
    for k in (0..count).filter(|k| squares[*k] == 0.0) {
        (matrix[k][k], errors[k]) = (1.0, f64::INFINITY);
    }
    let largest = squares.iter().fold(0.0, |a: f64, b| a.max(*b));
    let damping = DAMPING / all.len() as f64;
    let mut damped = matrix.clone();
    for (k, row) in damped.iter_mut().enumerate() {
        row[k] += damping * squares[k] + 1e-12 * largest;
    }
    let Some(step) = solve(&mut damped.clone(), &slope) else {
        return (vec![0.0; count], vec![f64::INFINITY; count]);
    };
    // Scatter, about the common step, of the steps to the minima of single iterations.
    let end: Vec<f64> = x.iter().zip(&step).map(|(x, step)| x + step).collect();
    for one in all {
        let Some(off) = solve(&mut matrix.clone(), &slope_at(one, &end)) else {
            return (step, vec![f64::INFINITY; count]);
        };
        for (error, off) in errors.iter_mut().zip(off) {
            *error += off * off;
        }
    }
    let n = all.len() as f64;
    let scale = if n > 1.0 {
        n / (n - 1.0)
    } else {
        f64::INFINITY
    };
    (step, errors.iter().map(|e| (scale * e).sqrt()).collect())
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
