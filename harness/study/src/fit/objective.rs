//! Objective of the optimiser: the distance of two models and its derivatives.

use super::points::Points;
use super::variables::Variables;
use super::{FitConfig, Norm};
use basin::{
    BoxBounds, ConstraintDescription, ConstraintSet, ConstraintSolveError, Constraints,
    CostFunction, Executor, FirstOrderState, Gradient, Lbfgsb,
};
use hairis::ParamError;
use hairis::columns::HitColumns;
use hairis_gradients::{Differentiable, GradColumns, Gradients, Visitor, Weights, visit};
use hairis_materials::material::single;
use hairis_variants::{ModelId, Values};

/// Number of iterations after which the optimiser ends.
const ITERATIONS: u64 = 600;
/// Number of pairs of steps that the optimiser keeps.
const HISTORY: usize = 20;
/// Relative reduction of the distance below which the optimiser ends.
const REDUCTION: f64 = 1e-14;
/// Share of the mean below which L1 is smoothed.
const SMOOTH: f64 = 0.01;

/// Finds the nearest values from a start, and returns them with the number of iterations.
pub(super) fn minimise(
    model: ModelId,
    start: &Values,
    points: &Points,
    config: &FitConfig,
) -> Result<(Values, u64), ParamError> {
    let variables = Variables::new(start, &config.fixed);
    let x = variables.start();
    if x.is_empty() {
        return Ok((*start, 0));
    }
    let problem = Distance::new(model, points, &variables, config.norm);
    let solver = Lbfgsb::new()
        .with_m_capacity(HISTORY)
        .with_relative_cost_reduction_tolerance(REDUCTION);
    let run = Executor::new(problem, solver, FirstOrderState::new(x))
        .max_iter(ITERATIONS)
        .run();
    match run {
        Ok(result) => Ok((variables.values(result.best_param()), result.iter())),
        Err(ConstraintSolveError::Evaluation(error)) => Err(error),
        Err(error) => {
            unreachable!("the bounds are in order: {error}")
        }
    }
}

/// Norm of the look, and the magnitude below which L1 is smoothed.
#[derive(Clone, Copy, Debug)]
struct Scale {
    norm: f64,
    smooth: f64,
}

impl Scale {
    fn new(points: &Points, norm: Norm) -> Self {
        let views = 0..points.views.len();
        let own = |norm| -> f64 {
            let own = |view| points.sums(view, &points.look[view], norm)[1];
            views.clone().map(own).sum()
        };
        let weights = points.weights.iter().flatten();
        let total: f64 = weights.map(|[weight, _]| 3.0 * weight).sum();
        Self {
            norm: own(norm).max(f64::MIN_POSITIVE),
            smooth: SMOOTH * own(Norm::L1).max(f64::MIN_POSITIVE) / total.max(f64::MIN_POSITIVE),
        }
    }
}

/// Hits and directions, one row per view, offset and direction.
#[derive(Debug)]
struct Rows {
    wo: [Vec<f32>; 3],
    h: Vec<f32>,
    wi: [Vec<f32>; 3],
}

impl Rows {
    fn new(points: &Points) -> Self {
        let mut rows = Self {
            wo: [const { Vec::new() }; 3],
            h: Vec::new(),
            wi: [const { Vec::new() }; 3],
        };
        for (view, wi) in points.views.iter().zip(&points.wi) {
            for h in &points.offsets {
                for (k, x) in view.to_array().into_iter().enumerate() {
                    rows.wo[k].resize(rows.wo[k].len() + wi[0].len(), x);
                    rows.wi[k].extend(&wi[k]);
                }
                rows.h.resize(rows.h.len() + wi[0].len(), *h);
            }
        }
        rows
    }
}

/// Distance of a model from a look, as the optimiser's problem.
#[derive(Debug)]
pub struct Distance<'a> {
    model: ModelId,
    points: &'a Points,
    variables: &'a Variables,
    norm: Norm,
    scale: Scale,
    rows: Rows,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl<'a> Distance<'a> {
    /// Makes the problem of a model whose free numbers are `variables`, from the look at `points`.
    #[must_use]
    pub fn new(model: ModelId, points: &'a Points, variables: &'a Variables, norm: Norm) -> Self {
        let [lower, upper] = variables.bounds();
        Self {
            model,
            points,
            variables,
            norm,
            scale: Scale::new(points, norm),
            rows: Rows::new(points),
            lower,
            upper,
        }
    }

    /// Returns the distance. Appends the weights of S, which are its derivatives by the values of every row, to `weights` if given.
    fn distance(
        &self,
        values: &Values,
        mut weights: Option<&mut [Vec<f32>; 3]>,
    ) -> Result<f64, ParamError> {
        let Self { points, scale, .. } = self;
        let other = points.values(&self.model.material(values)?);
        let offsets = points.offsets.len() as f64;
        let mut distance = 0.0;
        for (view, other) in other.iter().enumerate() {
            let difference: Vec<[f64; 3]> = (other.iter().zip(&points.look[view]))
                .map(|(a, b)| core::array::from_fn(|channel| a[channel] - b[channel]))
                .collect();
            let (compared, shares) = points.compared(view, &difference, self.norm);
            let slope = |(values, [weight, cos]): (&[f64; 3], &[f64; 2])| {
                let share = weight / scale.norm;
                values.map(|x| {
                    let (term, slope) = match self.norm {
                        Norm::L1 | Norm::Blurred => {
                            // Faster than `hypot`; radiance is far from the limits of double precision.
                            let root = (x * x + scale.smooth * scale.smooth).sqrt();
                            (root - scale.smooth, x / root)
                        }
                        Norm::L2 => (x * x * cos, 2.0 * x * cos),
                    };
                    distance += share * term;
                    share * slope / offsets
                })
            };
            let slopes: Vec<[f64; 3]> = compared.iter().zip(shares.iter()).map(slope).collect();
            if let Some(weights) = &mut weights {
                let slopes = points.derivatives(view, slopes, self.norm);
                for _ in &points.offsets {
                    for (channel, to) in weights.iter_mut().enumerate() {
                        to.extend(slopes.iter().map(|slope| single(slope[channel])));
                    }
                }
            }
        }
        Ok(distance)
    }
}

/// Visitor that returns the derivatives by the numbers of a model's fields.
struct ByNumbers<'a> {
    rows: &'a Rows,
    values: &'a Values,
    weights: &'a [Vec<f32>; 3],
}

impl Visitor for ByNumbers<'_> {
    type Output = Result<Values<f64>, ParamError>;

    fn visit<M: Differentiable>(self) -> Self::Output {
        // Only the first entry of each name, because others have the same S.
        if const { ModelId::of::<M>().is_default() } {
            let gradients = Gradients::<M>::from_values(self.values)?;
            let Rows { wo, h, wi } = self.rows;
            let hits = HitColumns {
                wo: wo.each_ref().map(|column| &column[..]),
                h: Some(h),
            };
            let weights = Weights {
                value: Some(self.weights.each_ref().map(|column| &column[..])),
                pdf: None,
            };
            let mut sums = vec![0.0; Gradients::<M>::NUMBERS];
            let out = GradColumns {
                d_material: Some(&mut sums),
                ..GradColumns::default()
            };
            gradients
                .eval_grad(hits, wi.each_ref().map(|column| &column[..]), weights, out)
                .expect("columns of one length");
            Ok(gradients.by_parameters(&sums))
        } else {
            unreachable!("a fit is of the first entry of its name")
        }
    }
}

impl CostFunction for Distance<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = ParamError;

    fn cost(&self, x: &Vec<f64>) -> Result<f64, ParamError> {
        self.distance(&self.variables.values(x), None)
    }
}

impl Gradient for Distance<'_> {
    type Gradient = Vec<f64>;

    fn gradient(&self, x: &Vec<f64>) -> Result<Vec<f64>, ParamError> {
        Ok(self.cost_and_gradient(x)?.1)
    }

    fn cost_and_gradient(&self, x: &Vec<f64>) -> Result<(f64, Vec<f64>), ParamError> {
        let values = self.variables.values(x);
        let mut weights = [const { Vec::new() }; 3];
        let distance = self.distance(&values, Some(&mut weights))?;
        let by_number = visit(
            self.model,
            ByNumbers {
                rows: &self.rows,
                values: &values,
                weights: &weights,
            },
        )?;
        Ok((distance, self.variables.derivatives(x, &by_number)))
    }
}

impl Constraints for Distance<'_> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new().with_bounds(BoxBounds::new(Some(&self.lower), Some(&self.upper)))
    }
}
