//! Variances at one shading point.

use super::candidates::{Candidates8, LightBlock, numbers};
use super::result::{BiasScore, OneRay, PoolFigures, RayFigures, RayPose};
use super::{HALF, MOST, RAYS, SIZES, pools};
use crate::efficiency::{Reference, bias_z, is_tested};
use crate::light::Light;
use crate::sampler::Scatter;
use crate::sequence::Independent;
use crate::stats::{Estimate, Moments};
use hairis::resample::choose;

/// Candidates of both techniques.
const ALL: usize = 2 * MOST;

/// Candidates by column. Those of both techniques alternate in pairs, so that the pools of every size are adjacent.
struct Columns {
    contribution: [[f32; ALL]; 3],
    /// In pools of each size.
    weight: [[f32; ALL]; SIZES.len()],
    /// Densities of the BSDF's technique and of the light's.
    pdf: [[f32; ALL]; 2],
}

impl Columns {
    /// As many candidates of each technique as the largest pool has.
    fn draw(scatter: &Scatter, light: &dyn Light, source: &mut Independent) -> Self {
        let mut columns =
            Self { contribution: [[0.0; ALL]; 3], weight: [[0.0; ALL]; SIZES.len()], pdf: [[0.0; ALL]; 2] };
        for packet in 0..MOST / 8 {
            let drawn = [
                Candidates8::of_bsdf(scatter, light, &numbers(source)),
                Candidates8::of_light(scatter, &LightBlock::draw(light, source)),
            ];
            for (technique, drawn) in drawn.iter().enumerate() {
                let weighed = SIZES.map(|count| drawn.weigh(count));
                for lane in 0..8 {
                    let place = place(technique, 8 * packet + lane);
                    for (column, channel) in columns.contribution.iter_mut().zip(&weighed[0].contribution) {
                        column[place] = channel.as_array()[lane];
                    }
                    for (column, weighed) in columns.weight.iter_mut().zip(&weighed) {
                        column[place] = weighed.weight.as_array()[lane];
                    }
                    for (column, pdf) in columns.pdf.iter_mut().zip(drawn.pdf()) {
                        column[place] = pdf.as_array()[lane];
                    }
                }
            }
        }
        columns
    }

    /// Contribution of a candidate, the mean of RGB, and its densities.
    fn at(&self, place: usize) -> (f64, [f64; 2]) {
        let f = self.contribution.iter().map(|column| f64::from(column[place])).sum::<f64>() / 3.0;
        (f, [0, 1].map(|technique: usize| f64::from(self.pdf[technique][place])))
    }
}

/// Place of candidate `index` of a technique.
const fn place(technique: usize, index: usize) -> usize {
    4 * (index / 2) + 2 * technique + index % 2
}

/// Squared deviations of the plain estimators from the reference, and the means of those that see every light.
#[derive(Default)]
struct Plain {
    /// Of the BSDF's sampler, the light's and one-sample MIS.
    squares: [Moments; 3],
    light: Moments,
    mis: Moments,
}

impl Plain {
    fn add(&mut self, columns: &Columns, mean: f64) {
        for place in 0..ALL {
            let is_light = place % 4 > 1;
            let (f, [bsdf, light]) = columns.at(place);
            let mixture = 0.5 * (bsdf + light);
            if !is_light && bsdf == 0.0 {
                // A discarded sample is an event of the BSDF's sampler that the mixture has half as often.
                for (moments, times) in self.squares.iter_mut().zip([2.0, 0.0, 1.0]) {
                    moments.push(times * mean * mean);
                }
                self.mis.push(0.0);
                continue;
            }
            for (moments, pdf) in self.squares.iter_mut().zip([bsdf, light, mixture]) {
                let deviation = f - mean * pdf;
                moments.push(if deviation == 0.0 { 0.0 } else { deviation * deviation / (pdf * mixture) });
            }
            self.mis.push(if f > 0.0 { f / mixture } else { 0.0 });
            if is_light {
                self.light.push(if f > 0.0 { f / light } else { 0.0 });
            }
        }
    }

    fn v(&self, mean: f64) -> [Estimate; 3] {
        [0, 1, 2].map(|estimator: usize| self.squares[estimator].mean_estimate().scale(1.0 / (mean * mean)))
    }
}

/// Estimates from pools, by place.
#[derive(Default)]
struct Pooled {
    /// One ray without occlusion, by size.
    chosen: [Moments; SIZES.len()],
    /// Half of the directions visible, and how many rays were traced.
    half: [[(Moments, u64); RAYS.len()]; SIZES.len()],
}

impl Pooled {
    fn add(&mut self, columns: &Columns, visible: &[bool; ALL], source: &mut Independent) {
        for (size, count) in SIZES.into_iter().enumerate() {
            let length = 2 * count as usize;
            for from in (0..ALL).step_by(length) {
                let to = from + length;
                let contribution = columns.contribution.each_ref().map(|column| &column[from..to]);
                let weight = &columns.weight[size][from..to];
                for (rays, k) in RAYS.into_iter().enumerate().filter(|(_, k)| *k <= 2 * count) {
                    let (mut open, mut half) = (0.0, 0.0);
                    let (moments, traced) = &mut self.half[size][rays];
                    for choice in choose(contribution, weight, k, source.next_f32()) {
                        let y = choice.contribution.into_iter().map(f64::from).sum::<f64>() / 3.0;
                        open += y;
                        half += if visible[from + choice.index] { y } else { 0.0 };
                        *traced += 1;
                    }
                    moments.push(half);
                    if k == 1 {
                        self.chosen[size].push(open);
                    }
                }
            }
        }
    }
}

/// Measures a shading point with `count` of the largest pools, and their parts.
pub(super) fn pose(
    scatter: &Scatter,
    light: &dyn Light,
    theta_o_deg: f64,
    reference: &Reference,
    [seed, stream]: [u64; 2],
    count: usize,
) -> RayPose {
    let mut source = Independent::new(seed, stream);
    let (mut plain, mut pooled) = (Plain::default(), Pooled::default());
    for _ in 0..count {
        let columns = Columns::draw(scatter, light, &mut source);
        let visible = core::array::from_fn(|_| f64::from(source.next_f32()) < HALF);
        plain.add(&columns, reference.value);
        pooled.add(&columns, &visible, &mut source);
    }
    let [bsdf, from_light, mis] = plain.v(reference.value).map(OneRay::new);
    let chosen = pooled.chosen.iter().map(|moments| OneRay::new(moments.relative_variance())).collect();
    let half = pools().map(|(size, rays)| {
        let (moments, traced) = &pooled.half[size][rays];
        PoolFigures {
            candidates_each: SIZES[size],
            rays: RAYS[rays],
            traced: *traced as f64 / moments.count() as f64,
            v: moments.relative_variance(),
        }
    });
    RayPose {
        theta_o_deg,
        reference: Estimate { value: reference.value, standard_error: reference.standard_error },
        figures: RayFigures { bsdf, light: from_light, mis, chosen, half: half.collect() },
        z: scores(&plain, &pooled, reference),
    }
}

fn scores(plain: &Plain, pooled: &Pooled, reference: &Reference) -> Vec<BiasScore> {
    let at_half = Reference {
        value: HALF * reference.value,
        standard_error: HALF * reference.standard_error,
        quadrature_error: HALF * reference.quadrature_error,
        ..*reference
    };
    let score = |estimator: String, moments: &Moments, reference: &Reference| {
        let deviation = moments.variance().sqrt();
        let shape = [moments.relative_variance().value, moments.higher_moments()[0] / deviation.powi(3)];
        let count = usize::try_from(moments.count()).unwrap_or(usize::MAX);
        BiasScore { estimator, z: bias_z(moments, reference), tested: is_tested(count, shape) }
    };
    let mut scores = vec![
        score("light only".to_owned(), &plain.light, reference),
        score("one-sample MIS".to_owned(), &plain.mis, reference),
    ];
    for (count, moments) in SIZES.iter().zip(&pooled.chosen) {
        scores.push(score(format!("{count} + {count}"), moments, reference));
    }
    for (size, rays) in pools() {
        let [count, k] = [SIZES[size], RAYS[rays]];
        scores.push(score(format!("{k} of {count} + {count}, half visible"), &pooled.half[size][rays].0, &at_half));
    }
    scores
}
