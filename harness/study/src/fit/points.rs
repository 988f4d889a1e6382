//! Points of the sphere with weights, at which models are compared.

use super::blur::Blur;
use super::{FitConfig, Look, Norm};
use core::f64::consts::{PI, TAU};
use glam::Vec3;
use hairis::columns::EvalColumns;
use hairis::{Hit, ParamError};
use hairis_instruments::direction::{direction, fibre_direction};
use hairis_instruments::sequence::{Halton, XiSource, to_unit_f32};
use hairis_variants::{AnyBsdf, AnyMaterial, ModelId, Values};
use std::borrow::Cow;

/// Number of offsets across the fibre over which near-field models are averaged; they are the middles of as many equal parts.
const OFFSETS: u16 = 8;

/// Least weight of a view, as a share of the largest. It is above 0 because residuals divide by the weight.
const LEAST_WEIGHT: f64 = 1e-100;

/// Number of random streams per view.
const STREAMS: u64 = 4;

/// Values, and their weights with the cosine of L2.
type Compared<'a> = (Cow<'a, [[f64; 3]]>, Cow<'a, [[f64; 2]]>);

/// Directions of every view with their weights, and the values of a look at them.
#[derive(Clone, Debug)]
pub struct Points {
    /// Direction to the viewer of each view.
    pub(super) views: Vec<Vec3>,
    /// Offsets of the hits across the fibre.
    pub(super) offsets: Vec<f32>,
    /// Directions of each view, by component.
    pub(super) wi: Vec<[Vec<f32>; 3]>,
    /// Weights of the integral of `S cos theta_i` over the directions of each view, times the weight of the view, paired with
    /// `cos theta_i`.
    pub(super) weights: Vec<Vec<[f64; 2]>>,
    /// Weight of each view, as a share of the largest.
    pub(super) view_weights: Vec<f64>,
    /// S of the look, by view and direction.
    pub(super) look: Vec<Vec<[f64; 3]>>,
    /// Blur of each view, if the norm has one.
    pub(super) blurs: Option<Vec<Blur>>,
}

impl Points {
    /// Draws the points for a look, which the model `to` is compared with. Another `stream`, below 4, draws other points.
    ///
    /// # Errors
    ///
    /// Returns an error if a value of the look is out of its range.
    pub fn new(
        from: &Look,
        to: ModelId,
        config: &FitConfig,
        stream: u64,
    ) -> Result<Self, ParamError> {
        let material = from.model.material(&from.values)?;
        let offsets = if from.model.is_near_field() || to.is_near_field() {
            let middle = |i: u16| (f32::from(i) + 0.5) / f32::from(OFFSETS) * 2.0 - 1.0;
            (0..OFFSETS).map(middle).collect()
        } else {
            vec![0.0]
        };
        // Only ratios of weights count, and sums of large weights would overflow.
        let largest = config.weights.iter().copied().fold(0.0, f64::max);
        let share = |weight: &f64| (weight / largest).max(LEAST_WEIGHT);
        let view_weights: Vec<f64> = config.weights.iter().map(share).collect();
        let mut points = Self {
            views: config
                .views
                .iter()
                .map(|theta| fibre_direction(*theta, 0.0).as_vec3())
                .collect(),
            offsets,
            wi: Vec::new(),
            weights: Vec::new(),
            view_weights,
            look: Vec::new(),
            blurs: None,
        };
        for view in 0..points.views.len() {
            let bsdfs = points.bsdfs(&material, view);
            let seed = (config.seed, STREAMS * view as u64 + stream);
            let weight = points.view_weights[view];
            let (wi, weights) = draw(&bsdfs, config.directions, seed, weight);
            points.wi.push(wi);
            points.weights.push(weights);
        }
        points.look = points.values(&material);
        if config.norm == Norm::Blurred {
            let views = points.wi.iter().zip(&points.weights);
            points.blurs = Some(views.map(|(wi, weights)| Blur::new(wi, weights)).collect());
        }
        Ok(points)
    }

    /// Returns true if the look reflects no light towards any view.
    #[must_use]
    pub fn is_black(&self) -> bool {
        let mut values = self.look.iter().flatten().flatten();
        values.all(|value| *value == 0.0)
    }

    /// Returns the material at a view, by offset.
    pub(super) fn bsdfs(&self, material: &AnyMaterial, view: usize) -> Vec<AnyBsdf> {
        let offsets = self.offsets.iter();
        offsets
            .map(|h| material.prepare(Hit::new(self.views[view], *h)))
            .collect()
    }

    /// Returns S of a material, by view and direction, as the mean over the offsets.
    pub(super) fn values(&self, material: &AnyMaterial) -> Vec<Vec<[f64; 3]>> {
        let views = 0..self.views.len();
        views
            .map(|view| {
                let wi = self.wi[view].each_ref().map(|column| &column[..]);
                let mut sums = vec![[0.0; 3]; wi[0].len()];
                let [mut r, mut g, mut b] = [0, 1, 2].map(|_| vec![0.0; wi[0].len()]);
                for bsdf in self.bsdfs(material, view) {
                    let out = EvalColumns {
                        value: Some([&mut r, &mut g, &mut b]),
                        pdf: None,
                    };
                    bsdf.eval_columns(wi, out).expect("columns of one length");
                    for (place, sum) in sums.iter_mut().enumerate() {
                        for (sum, column) in sum.iter_mut().zip([&r, &g, &b]) {
                            *sum += f64::from(column[place]) / self.offsets.len() as f64;
                        }
                    }
                }
                sums
            })
            .collect()
    }

    /// Returns the distance of a model from the look, relative to the norm of the look.
    ///
    /// # Errors
    ///
    /// Returns an error if a value is out of its range.
    pub fn distance(&self, model: ModelId, values: &Values, norm: Norm) -> Result<f64, ParamError> {
        let other = self.values(&model.material(values)?);
        let views = 0..self.views.len();
        let sums = views.map(|view| self.sums(view, &other[view], norm));
        let [difference, own] = sums.fold([0.0; 2], |sum, [a, b]| [sum[0] + a, sum[1] + b]);
        Ok(ratio(difference, own, norm))
    }

    /// Returns integrals over a view of the difference between other values and the look, and of the look alone: of magnitudes or of
    /// squares.
    ///
    /// # Panics
    ///
    /// Panics if the norm is blurred and the points were not made for it.
    pub(super) fn sums(&self, view: usize, other: &[[f64; 3]], norm: Norm) -> [f64; 2] {
        let look = &self.look[view];
        let difference: Vec<[f64; 3]> = (look.iter().zip(other))
            .map(|(a, b)| core::array::from_fn(|channel| a[channel] - b[channel]))
            .collect();
        [&difference, look].map(|values| {
            let (values, weights) = self.compared(view, values, norm);
            let terms = values
                .iter()
                .zip(weights.iter())
                .flat_map(|(value, [weight, cos])| {
                    value.map(|x| {
                        weight
                            * match norm {
                                Norm::L1 | Norm::Blurred => x.abs(),
                                Norm::L2 => x * x * cos,
                            }
                    })
                });
            terms.sum()
        })
    }

    /// Returns the values that are compared in a norm, given those of S, and their weights.
    pub(super) fn compared<'a>(
        &'a self,
        view: usize,
        values: &'a [[f64; 3]],
        norm: Norm,
    ) -> Compared<'a> {
        match norm {
            Norm::L1 | Norm::L2 => (values.into(), (&*self.weights[view]).into()),
            Norm::Blurred => (
                self.blur(view).values(values).into(),
                vec![[Blur::WEIGHT, 1.0]; Blur::PLACES].into(),
            ),
        }
    }

    /// Returns the derivatives by the values of S, given those by the values that are [compared](Self::compared).
    pub(super) fn derivatives(
        &self,
        view: usize,
        by_compared: Vec<[f64; 3]>,
        norm: Norm,
    ) -> Vec<[f64; 3]> {
        match norm {
            Norm::L1 | Norm::L2 => by_compared,
            Norm::Blurred => self
                .blur(view)
                .derivatives(&by_compared, self.look[view].len()),
        }
    }

    fn blur(&self, view: usize) -> &Blur {
        let blurs = self.blurs.as_ref().expect("points of the blurred norm");
        &blurs[view]
    }
}

/// Returns the relative distance, given the integrals of the difference and of the look.
pub(super) fn ratio(difference: f64, own: f64, norm: Norm) -> f64 {
    let ratio = difference / own.max(f64::MIN_POSITIVE);
    match norm {
        Norm::L1 | Norm::Blurred => ratio,
        Norm::L2 => ratio.sqrt(),
    }
}

/// Draws directions and weights of a view. Every second direction is a sample of the look, and the others are uniform.
fn draw(
    bsdfs: &[AnyBsdf],
    directions: usize,
    (seed, stream): (u64, u64),
    weight: f64,
) -> ([Vec<f32>; 3], Vec<[f64; 2]>) {
    // Each kind has its own sequence, because every second point of one sequence fills half of its range.
    let [mut samples, mut uniforms] = [0, 1].map(|kind| Halton::new(4, seed, 2 * stream + kind));
    let (mut wi, mut weights) = ([const { Vec::new() }; 3], Vec::new());
    for place in 0..directions {
        let is_sample = place % 2 == 0;
        let source = if is_sample {
            &mut samples
        } else {
            &mut uniforms
        };
        let xi: [f64; 4] = source.next_xi();
        let uniform = || {
            let sin = 2.0 * xi[0] - 1.0;
            direction(sin, (1.0 - sin * sin).sqrt(), TAU * xi[1])
        };
        let sampled = || {
            let choice = (1..bsdfs.len())
                .filter(|i| *i as f64 <= xi[3] * bsdfs.len() as f64)
                .count();
            let bsdf = &bsdfs[choice];
            let sample = bsdf.sample([xi[0], xi[1], xi[2]].map(to_unit_f32));
            sample.map(|sample| sample.wi)
        };
        let to = if is_sample {
            sampled()
        } else {
            Some(uniform())
        };
        // A discarded sample is a direction of weight 0.
        let to_or = to.unwrap_or(Vec3::Y);
        let pdf: f64 = bsdfs.iter().map(|bsdf| f64::from(bsdf.pdf(to_or))).sum();
        let density = 0.5 * pdf / bsdfs.len() as f64 + 0.5 / (4.0 * PI);
        let cos = f64::from(to_or.y).hypot(f64::from(to_or.z));
        let of_point = if to.is_some() {
            weight * cos / (density * directions as f64)
        } else {
            0.0
        };
        for (column, x) in wi.iter_mut().zip(to_or.to_array()) {
            column.push(x);
        }
        weights.push([of_point, cos]);
    }
    (wi, weights)
}
