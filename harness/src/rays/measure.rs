//! Measurement of variances at one shading point.

use super::candidates::{LightBlock, LightBlocks, Lit, PACKETS, numbers};
use super::result::{BiasScore, OneRay, PoolFigures, RayFigures, RayPose};
use super::{HALF, MOST, RAYS, SIZES, pools};
use crate::efficiency::{bias_z, is_tested};
use hairis::resample::{Choice, Choices, choose};
use hairis_instruments::sequence::Independent;
use hairis_instruments::stats::{Estimate, Moments};
use wide::f32x8;

/// Number of candidates of both techniques.
const ALL: usize = 2 * MOST;

/// Candidates by column, weighed in pools of each of `S` sizes. The candidates of both techniques alternate in pairs, so that the pools of
/// every size are adjacent.
struct Columns<const S: usize> {
    sizes: [u32; S],
    contribution: [[f32; ALL]; 3],
    /// Weights in pools of each size.
    weight: [[f32; ALL]; S],
    /// Densities of the BSDF's technique and of the light's.
    pdf: [[f32; ALL]; 2],
}

impl<const S: usize> Columns<S> {
    /// Draws as many candidates of each technique as the largest pool has; `block` returns those of the light, packet by packet.
    fn draw(
        lit: Lit<'_>,
        sizes: [u32; S],
        source: &mut Independent,
        block: impl Fn(usize, &mut Independent) -> LightBlock,
    ) -> Self {
        let mut columns = Self {
            sizes,
            contribution: [[0.0; ALL]; 3],
            weight: [[0.0; ALL]; S],
            pdf: [[0.0; ALL]; 2],
        };
        for packet in 0..PACKETS {
            let drawn = [
                lit.of_bsdf(&numbers(source)),
                lit.of_light(&block(packet, source)),
            ];
            for (technique, drawn) in drawn.iter().enumerate() {
                let store = |column: &mut [f32; ALL], lanes: &f32x8| {
                    for (lane, x) in lanes.as_array().iter().enumerate() {
                        column[place(technique, 8 * packet + lane)] = *x;
                    }
                };
                let weighed = sizes.map(|count| drawn.weigh(count));
                (0..3)
                    .for_each(|c| store(&mut columns.contribution[c], &weighed[0].contribution[c]));
                (0..S).for_each(|size| store(&mut columns.weight[size], &weighed[size].weight));
                (0..2).for_each(|of| store(&mut columns.pdf[of], &drawn.pdf()[of]));
            }
        }
        columns
    }

    /// Returns the index of the first candidate of each pool of a size.
    fn pools(&self, size: usize) -> impl Iterator<Item = usize> + use<S> {
        (0..ALL).step_by(2 * self.sizes[size] as usize)
    }

    /// Chooses `rays` candidates of the pool of a size that begins at `from`.
    fn choose(&self, size: usize, from: usize, rays: u32, u: f32) -> Choices<'_> {
        let to = from + 2 * self.sizes[size] as usize;
        let contribution = self.contribution.each_ref().map(|column| &column[from..to]);
        choose(contribution, &self.weight[size][from..to], rays, u)
    }

    /// Returns the squared deviations of the plain estimators from `mean` at a candidate: by the BSDF, by the light and by one-sample MIS.
    #[inline]
    fn squares(&self, place: usize, mean: f64) -> [f64; 3] {
        let (f, [bsdf, light]) = self.at(place);
        if !is_light(place) && bsdf == 0.0 {
            // A discarded sample is an event of the BSDF's sampler, which occurs half as often in the mixture.
            return [2.0, 0.0, 1.0].map(|times| times * mean * mean);
        }
        let mixture = 0.5 * (bsdf + light);
        [bsdf, light, mixture].map(|pdf| {
            let deviation = f - mean * pdf;
            if deviation == 0.0 {
                0.0
            } else {
                deviation * deviation / (pdf * mixture)
            }
        })
    }

    /// Returns the contribution of a candidate, as the mean of RGB, and its densities.
    #[inline]
    fn at(&self, place: usize) -> (f64, [f64; 2]) {
        let f = self
            .contribution
            .iter()
            .map(|column| f64::from(column[place]))
            .sum::<f64>()
            / 3.0;
        (
            f,
            [0, 1].map(|technique: usize| f64::from(self.pdf[technique][place])),
        )
    }
}

/// Returns the index of a technique's candidate among all.
const fn place(technique: usize, index: usize) -> usize {
    4 * (index / 2) + 2 * technique + index % 2
}

/// Returns true if the candidate at an index is one of the light.
const fn is_light(place: usize) -> bool {
    place % 4 > 1
}

/// Squared deviations of the plain estimators from the reference, and the means of those that sample every light.
#[derive(Default)]
struct Plain {
    /// Moments of the BSDF's sampler, the light's and one-sample MIS.
    squares: [Moments; 3],
    light: Moments,
    mis: Moments,
}

impl Plain {
    fn add<const S: usize>(&mut self, columns: &Columns<S>, mean: f64) {
        for place in 0..ALL {
            for (moments, square) in self.squares.iter_mut().zip(columns.squares(place, mean)) {
                moments.push(square);
            }
            let (f, [bsdf, light]) = columns.at(place);
            self.mis.push(if f > 0.0 {
                f / (0.5 * (bsdf + light))
            } else {
                0.0
            });
            if is_light(place) {
                self.light.push(if f > 0.0 { f / light } else { 0.0 });
            }
        }
    }

    fn v(&self, mean: f64) -> [Estimate; 3] {
        [0, 1, 2].map(|estimator: usize| {
            self.squares[estimator]
                .mean_estimate()
                .scale(1.0 / (mean * mean))
        })
    }
}

/// Estimates from pools, by place in [`SIZES`] and [`RAYS`].
#[derive(Default)]
struct Pooled {
    /// Moments of one ray without occlusion, by size.
    chosen: [Moments; SIZES.len()],
    /// Moments with half of the directions visible, and the number of rays that were traced.
    half: [[(Moments, u64); RAYS.len()]; SIZES.len()],
}

impl Pooled {
    fn add(
        &mut self,
        columns: &Columns<{ SIZES.len() }>,
        visible: &[bool; ALL],
        source: &mut Independent,
    ) {
        for (size, count) in SIZES.into_iter().enumerate() {
            for from in columns.pools(size) {
                for (rays, k) in RAYS
                    .into_iter()
                    .enumerate()
                    .filter(|(_, k)| *k <= 2 * count)
                {
                    let (mut open, mut half) = (0.0, 0.0);
                    let (moments, traced) = &mut self.half[size][rays];
                    for choice in columns.choose(size, from, k, source.next_f32()) {
                        let y = mean_of(&choice);
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

/// Returns the contribution of an unoccluded ray, as the mean of RGB.
fn mean_of(choice: &Choice) -> f64 {
    choice.contribution.into_iter().map(f64::from).sum::<f64>() / 3.0
}

/// V of one ray without occlusion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unoccluded<const S: usize> {
    /// V by one-sample MIS.
    pub mis: Estimate,
    /// V of a ray chosen from pools of each size.
    pub chosen: [Estimate; S],
    /// Bias of the mean over the pools of the last size, in standard errors and corrected for skewness; none if there were too few
    /// effective pools for a test.
    pub bias: Option<f64>,
}

/// Measures V of one ray from pools of some sizes, at most [`MOST`]. There are as many of the largest pools as `blocks`. The errors include
/// that of the mean, `reference`.
pub fn unoccluded<const S: usize>(
    lit: Lit<'_>,
    blocks: &LightBlocks,
    sizes: [u32; S],
    reference: Estimate,
    source: &mut Independent,
) -> Unoccluded<S> {
    let mean = reference.value;
    let (mut squares, mut chosen) = (Moments::new(), [Moments::new(); S]);
    for blocks in &blocks.0 {
        let columns = Columns::draw(lit, sizes, source, |packet, _| blocks[packet]);
        (0..ALL).for_each(|place| squares.push(columns.squares(place, mean)[2]));
        for (size, moments) in chosen.iter_mut().enumerate() {
            for from in columns.pools(size) {
                moments.push(
                    columns
                        .choose(size, from, 1, source.next_f32())
                        .map(|choice| mean_of(&choice))
                        .sum(),
                );
            }
        }
    }
    let mis = squares.mean_estimate().scale(1.0 / (mean * mean));
    // If the mean is off, V is off as well: its derivative by the mean is -2 V over the mean.
    let of_mean = 2.0 * mis.value * reference.standard_error / mean;
    let bias = chosen
        .last()
        .map(|moments| score(String::new(), moments, reference));
    Unoccluded {
        mis: Estimate {
            standard_error: mis.standard_error.hypot(of_mean),
            ..mis
        },
        chosen: chosen.map(|moments| moments.relative_variance()),
        bias: bias.filter(|score| score.tested).map(|score| score.z),
    }
}

/// Measures a shading point with `count` of the largest pools, and with their parts as smaller pools.
pub fn pose(
    lit: Lit<'_>,
    theta_o_deg: f64,
    reference: Estimate,
    [seed, stream]: [u64; 2],
    count: usize,
) -> RayPose {
    let mut source = Independent::new(seed, stream);
    let (mut plain, mut pooled) = (Plain::default(), Pooled::default());
    for _ in 0..count {
        let columns = Columns::draw(lit, SIZES, &mut source, |_, source| {
            LightBlock::draw(lit.light, source)
        });
        let visible = core::array::from_fn(|_| f64::from(source.next_f32()) < HALF);
        plain.add(&columns, reference.value);
        pooled.add(&columns, &visible, &mut source);
    }
    let [bsdf, from_light, mis] = plain.v(reference.value).map(OneRay::new);
    let chosen = pooled
        .chosen
        .iter()
        .map(|moments| OneRay::new(moments.relative_variance()))
        .collect();
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
        reference,
        figures: RayFigures {
            bsdf,
            light: from_light,
            mis,
            chosen,
            half: half.collect(),
        },
        z: scores(&plain, &pooled, reference),
    }
}

fn score(estimator: String, moments: &Moments, reference: Estimate) -> BiasScore {
    let deviation = moments.variance().sqrt();
    let shape = [
        moments.relative_variance().value,
        moments.higher_moments()[0] / deviation.powi(3),
    ];
    let count = usize::try_from(moments.count()).unwrap_or(usize::MAX);
    BiasScore {
        estimator,
        z: bias_z(moments, reference),
        tested: is_tested(count, shape),
    }
}

fn scores(plain: &Plain, pooled: &Pooled, reference: Estimate) -> Vec<BiasScore> {
    let plain = [("light only", &plain.light), ("one-sample MIS", &plain.mis)];
    let plain = plain.map(|(name, moments)| score(name.to_owned(), moments, reference));
    let one = |(count, moments): (&u32, &Moments)| {
        score(format!("{count} + {count}"), moments, reference)
    };
    let several = |(size, rays): (usize, usize)| {
        let [count, k] = [SIZES[size], RAYS[rays]];
        score(
            format!("{k} of {count} + {count}, half visible"),
            &pooled.half[size][rays].0,
            reference.scale(HALF),
        )
    };
    plain
        .into_iter()
        .chain(SIZES.iter().zip(&pooled.chosen).map(one))
        .chain(pools().map(several))
        .collect()
}
