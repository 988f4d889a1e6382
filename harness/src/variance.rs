//! Engine of the variances: every sampler of a hit under every light, from one set of directions each.
//!
//! Each subject's directions are drawn once and weighed by every light. Each light's directions are drawn once and weighed by every
//! subject. `study`, `claims` and the materials of `compare` are queries over its results.

pub mod check;
mod columns;
pub mod perfect;
pub mod tally;

pub use columns::{By, MIS, POOLS, RAYS, figures_of, half_visible, ray_v};
pub use perfect::SOURCE;
pub use tally::Figures;

use crate::rays::{LightBlocks, Lit, Unoccluded, numbers, unoccluded};
use crate::sampler::Scatter;
use hairis::Vec3x8;
use hairis_instruments::light::Light;
use hairis_instruments::sequence::{Independent, XiSource, stream_id};
use hairis_instruments::stats::Estimate;
use perfect::PerfectTally;
use serde::Serialize;
use tally::{Tally, figures, largest};
use wide::{f32x8, f64x8};

/// Relative standard error of V beyond which a figure is left out, because the light was hardly hit.
pub const MAX_RELATIVE_ERROR: f64 = 0.25;

/// Numbers of candidates of each technique in the pools from which rays are chosen.
pub const POOL_SIZES: [u32; 2] = [4, 8];

/// Numbers of samples for each subject. The first two are multiples of eight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleBudget {
    /// Number of samples of each sampler of each model.
    pub samples: usize,
    /// Number of samples of each light that is not visible from everywhere.
    pub light_samples: usize,
    /// Number of pools of 32 + 32 candidates of each sampler and light, from whose parts rays are chosen; none if 0.
    pub pools: usize,
}

impl SampleBudget {
    /// Returns the numbers of samples of the short run, or of the whole one.
    #[must_use]
    pub const fn of(quick: bool) -> Self {
        if quick {
            Self {
                samples: 1 << 15,
                light_samples: 1 << 12,
                pools: 128,
            }
        } else {
            Self {
                samples: 1 << 18,
                light_samples: 1 << 15,
                pools: 256,
            }
        }
    }

    /// Returns the ratio of a light's samples to those of a sampler.
    fn ratio(self) -> f32x8 {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a ratio of two small numbers"
        )]
        f32x8::splat((self.light_samples as f64 / self.samples as f64) as f32)
    }
}

/// Figures of one sampler of one model under one light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Measured {
    /// Mean, V and divergence.
    #[serde(flatten)]
    pub figures: Figures,
    /// Largest weight, as the mean of RGB, whatever the light.
    pub max_weight: f64,
    /// Proven bound on the weight, if there is one; set when a study is read.
    pub weight_bound: Option<f64>,
    /// Largest contribution in means, of the directions of the sampler and of the light.
    pub max_contribution: f64,
    /// V of one ray of direct light by one-sample MIS and from pools of [`POOL_SIZES`], if they were measured.
    pub rays: Option<[Estimate; 3]>,
    /// Bias of the mean of rays from the largest pools, in standard errors; none if there were too few for a test.
    pub bias: Option<f64>,
}

/// Sampler at a hit.
#[derive(Clone, Copy, Debug)]
pub struct Subject {
    /// Sampler at the hit.
    pub scatter: Scatter,
    /// Numbers of the model and of the sampler among the streams.
    pub stream: [u64; 2],
    /// Whether perfect sampling is estimated from the directions of this sampler.
    pub is_source: bool,
}

/// Figures of a subject under each light, and those of perfect sampling if the subject is its source.
#[derive(Clone, Debug)]
pub struct Found {
    /// Figures of the sampler, one per light.
    pub sampler: Vec<Measured>,
    /// Figures of perfect sampling, one per light, or none.
    pub perfect: Vec<Measured>,
}

/// Salt of the streams, from which no other part of the harness draws.
const SALT: u64 = 0x57d7_0000_0000_0001;

/// Eight directions drawn from a light.
struct LightDraw {
    wi: Vec3x8,
    /// A third of `cos theta_i`, the only factor that a mean of RGB needs besides S.
    cosine: f64x8,
    /// Product of `cosine` and the radiance.
    factor: [f64x8; 3],
    /// Density of the light, per steradian.
    pdf: f64x8,
}

/// Sums over the sampler's directions and over the light's. If the sampler is its source, perfect sampling has such sums as well.
#[derive(Clone)]
struct Strata {
    sampled: [Tally; 2],
    perfect: Option<[PerfectTally; 2]>,
}

/// Measures each subject at one hit, whose streams have the number `key`.
pub fn measure(
    [seed, key]: [u64; 2],
    budget: SampleBudget,
    lights: &[&dyn Light],
    subjects: &[Subject],
) -> Vec<Found> {
    let stream = |rest: &[u64]| Independent::new(seed, stream_id(&[SALT, key, stream_id(rest)]));
    let each_light = || lights.iter().copied().zip(0..);
    let draw = |(light, place): (&dyn Light, u64)| -> Vec<LightDraw> {
        let packets = if light.is_everywhere() {
            0
        } else {
            budget.light_samples / 8
        };
        let mut from = stream(&[0, place]);
        (0..packets)
            .map(|_| LightDraw::next(light, &mut from))
            .collect()
    };
    let draws: Vec<Vec<LightDraw>> = each_light().map(draw).collect();
    let draw = |(light, place)| LightBlocks::draw(light, &mut stream(&[2, place]), budget.pools);
    let blocks: Vec<LightBlocks> = each_light().map(draw).collect();
    let of_subject = |subject: &Subject| {
        let [model, sampler] = subject.stream;
        let scatter = &subject.scatter;
        let empty = Strata {
            sampled: Default::default(),
            perfect: subject.is_source.then(Default::default),
        };
        let mut strata = vec![empty; lights.len()];
        let mut from = stream(&[1, model, sampler]);
        let max_weight = by_sampler(scatter, &mut from, budget, lights, &mut strata);
        let of_light = |(place, strata): (usize, &mut Strata)| {
            by_light(scatter, &draws[place], budget, strata);
            let figures = figures(&strata.sampled);
            let rays = (budget.pools > 0).then(|| {
                let mut from = stream(&[3, model, sampler, place as u64]);
                let lit = Lit {
                    scatter,
                    light: lights[place],
                };
                unoccluded(lit, &blocks[place], POOL_SIZES, figures.mean, &mut from)
            });
            Measured {
                figures,
                max_weight,
                weight_bound: None,
                max_contribution: largest(&strata.sampled) / figures.mean.value,
                bias: rays.as_ref().and_then(|rays| rays.bias),
                rays: rays.map(
                    |Unoccluded {
                         mis,
                         chosen: [small, large],
                         ..
                     }| [mis, small, large],
                ),
            }
        };
        let sampler = strata.iter_mut().enumerate().map(of_light).collect();
        let perfect = strata.iter().filter_map(|strata| strata.perfect.as_ref());
        Found {
            sampler,
            perfect: perfect.map(perfect::measured).collect(),
        }
    };
    subjects.iter().map(of_subject).collect()
}

impl Strata {
    /// Adds eight directions of the sampler (0) or of the light (1), of weight `w` and contribution `y`, each counted `m`.
    fn push(&mut self, stratum: usize, w: impl FnOnce() -> f64x8, y: f64x8, m: f64x8) {
        self.sampled[stratum].push(y, m);
        if let Some(perfect) = &mut self.perfect {
            let w = w();
            perfect[stratum].push(if stratum == 0 { w } else { f64x8::ZERO }, w, y, m);
        }
    }
}

/// Adds a sampler's directions to the strata of each light, and returns the largest weight.
fn by_sampler(
    scatter: &Scatter,
    from: &mut Independent,
    budget: SampleBudget,
    lights: &[&dyn Light],
    strata: &mut [Strata],
) -> f64 {
    let mut max_weight = f32x8::ZERO;
    let third = f32x8::splat(1.0 / 3.0);
    for _ in 0..budget.samples / 8 {
        let sample = scatter.sample8(&numbers(from));
        let [r, g, b] = sample.weight.map(|w| w * third);
        let weight = r + g + b;
        max_weight = max_weight.max(weight);
        // A discarded sample has weights of 0: it counts, and contributes 0 whatever the density.
        let pdf = sample.pdf.max(f32x8::splat(f32::MIN_POSITIVE));
        for (strata, light) in strata.iter_mut().zip(lights) {
            let seen = light.see8(&sample.wi);
            // Directions of the light join those of the sampler, unless the light is everywhere.
            let ratio = if light.is_everywhere() {
                f32x8::ZERO
            } else {
                budget.ratio()
            };
            let y = widened(seen.radiance[0] * r + seen.radiance[1] * g + seen.radiance[2] * b);
            strata.push(
                0,
                || widened(weight),
                y,
                widened(pdf / (pdf + ratio * seen.pdf)),
            );
        }
    }
    f64::from(max_weight.to_array().into_iter().fold(0.0, f32::max))
}

/// Adds a light's directions to its strata.
fn by_light(scatter: &Scatter, draws: &[LightDraw], budget: SampleBudget, strata: &mut Strata) {
    let ratio = widened(budget.ratio());
    for draw in draws {
        let eval = scatter.eval_pdf8(&draw.wi);
        let pdf = widened(eval.pdf);
        let value = eval.value.map(widened);
        let [r, g, b] = [0, 1, 2].map(|c| value[c] * draw.factor[c]);
        // Double precision is needed, because the density alone may be tiny far from the lobes.
        let over_pdf = |x: f64x8| pdf.simd_gt(f64x8::ZERO).select(x / pdf, f64x8::ZERO);
        let weight = || over_pdf((value[0] + value[1] + value[2]) * draw.cosine);
        strata.push(
            1,
            weight,
            over_pdf(r + g + b),
            ratio * pdf / (pdf + ratio * draw.pdf),
        );
    }
}

impl LightDraw {
    fn next(light: &dyn Light, from: &mut Independent) -> Self {
        let samples: [_; 8] = core::array::from_fn(|_| light.sample(from.next_xi()));
        let cosines = samples.map(|sample| sample.dir.y.hypot(sample.dir.z));
        let factor = |lane: usize, c: usize| samples[lane].radiance[c] * cosines[lane] / 3.0;
        Self {
            wi: samples.map(|sample| sample.dir.as_vec3()).into(),
            cosine: f64x8::new(cosines.map(|cosine| cosine / 3.0)),
            factor: core::array::from_fn(|c| {
                f64x8::new(core::array::from_fn(|lane| factor(lane, c)))
            }),
            // Directions that cannot be drawn are dark, and contribute nothing either way.
            pdf: f64x8::new(samples.map(|sample| sample.pdf.max(f64::MIN_POSITIVE))),
        }
    }
}

fn widened(x: f32x8) -> f64x8 {
    f64x8::new(x.to_array().map(f64::from))
}
