//! Candidates for rays under a sky: the pool of one hit and the reservoirs of eight hits, from uniform numbers to chosen rays.

use crate::inputs::{Column, DIRECTIONS, Inputs, packets, xi_packets};
use crate::task::{Answer, Output, Task};
use core::array::from_fn;
use core::hint::black_box;
use glam::Vec3;
use hairis::columns::LengthError;
use hairis::model::Model;
use hairis::resample::{
    CandidateColumns, Counts, Partition, Reservoir8, Weighed8, WeightColumns, choose,
};
use hairis::simd::f32x8;
use hairis::{Bsdf, Bsdf8, Vec3x8};

/// Number of candidates of each technique in a pool.
const EACH: usize = 32;
/// Number of rays chosen from a pool.
const RAYS: u32 = 16;
/// Number of candidates of both techniques in a pool.
const ALL: usize = 2 * EACH;
/// Number of packets of candidates of each technique, for eight hits.
const PACKETS: usize = 4;

/// Numbers of candidates of each technique, which enter every weight.
pub const COUNTS: Counts = Counts {
    bsdf: 32,
    light: 32,
};

/// Density of every direction of the sky, per steradian; candidates are drawn from it uniformly.
pub const SKY_PDF: f32 = 0.079_577_47;

/// Returns the radiance of the sky in the channel that belongs to the coordinate `x`. It stands for a look-up and takes next to no
/// time.
#[inline(always)]
fn sky_along(x: f32) -> f32 {
    1.0 + 0.5 * x
}

/// Returns the radiance of the sky in eight directions, one per lane.
#[must_use]
pub fn sky8(wi: &Vec3x8) -> [f32x8; 3] {
    [wi.x, wi.y, wi.z].map(|x| f32x8::splat(1.0) + f32x8::splat(0.5) * x)
}

/// Returns one row per direction drawn from the sky, with its direction, radiance and density: the columns to weigh.
#[must_use]
pub fn looked_up(wi: &[Vec3]) -> Vec<[f32; 7]> {
    let row = |wi: &Vec3| {
        let ([x, y, z], [r, g, b]) = (wi.to_array(), wi.to_array().map(sky_along));
        [x, y, z, r, g, b, SKY_PDF]
    };
    wi.iter().map(row).collect()
}

/// Pool of one hit. A call proposes 32 directions, looks up their radiance, adds 32 directions of the light that were drawn beforehand,
/// weighs all candidates and chooses 16 rays. The directions of a call are its candidates.
#[derive(Debug)]
pub struct PoolTask<M: Model> {
    bsdf: Bsdf<M>,
    xi: [Column; 3],
    /// Candidates of the light, drawn beforehand.
    block: [Column; 7],
    pool: Columns,
}

/// Columns of the candidates: direction, radiance, density, contribution and weight. Candidates of the BSDF come first.
#[derive(Debug)]
struct Columns {
    wi: [[f32; ALL]; 3],
    radiance: [[f32; ALL]; 3],
    pdf_light: [f32; ALL],
    contribution: [[f32; ALL]; 3],
    weight: [f32; ALL],
}

impl<M: Model> PoolTask<M> {
    /// Makes the pools at the hit of `bsdf`, from the numbers and the directions of `inputs`.
    #[must_use]
    pub fn new(bsdf: Bsdf<M>, inputs: &Inputs) -> Self {
        let block = looked_up(&inputs.wi);
        let (three, one) = ([[0.0; ALL]; 3], [0.0; ALL]);
        Self {
            bsdf,
            xi: from_fn(|k| Column::new(k, inputs.xi.iter().map(|xi| xi[k]))),
            block: from_fn(|k| Column::new(3 + k, block.iter().map(|row| row[k]))),
            pool: Columns {
                wi: three,
                radiance: three,
                pdf_light: one,
                contribution: three,
                weight: one,
            },
        }
    }

    #[inline(always)]
    fn fill(&mut self, index: usize) -> Result<(), LengthError> {
        let at = index * EACH;
        let Columns {
            wi,
            radiance,
            pdf_light,
            contribution,
            weight,
        } = &mut self.pool;
        let xi = black_box(&self.xi)
            .each_ref()
            .map(|column| column.part(at, EACH));
        let proposed = wi.each_mut().map(|column| &mut column[..EACH]);
        self.bsdf.propose_columns(xi, proposed)?;
        for (radiance, wi) in radiance.iter_mut().zip(&*wi) {
            for (radiance, x) in radiance[..EACH].iter_mut().zip(wi) {
                *radiance = sky_along(*x);
            }
        }
        pdf_light[..EACH].fill(SKY_PDF);
        let columns = wi
            .iter_mut()
            .chain(radiance.iter_mut())
            .chain([&mut *pdf_light]);
        for (column, drawn) in columns.zip(black_box(&self.block)) {
            column[EACH..].copy_from_slice(drawn.part(at, EACH));
        }
        let candidates = CandidateColumns {
            wi: wi.each_ref().map(|column| &column[..]),
            radiance: radiance.each_ref().map(|column| &column[..]),
            pdf_light,
        };
        let out = WeightColumns {
            contribution: contribution.each_mut().map(|column| &mut column[..]),
            weight,
        };
        self.bsdf
            .weigh_columns(candidates, COUNTS, Partition::All, out)
    }
}

impl<M: Model> Task for PoolTask<M> {
    fn calls(&self) -> usize {
        DIRECTIONS / EACH
    }
    fn directions(&self) -> usize {
        ALL
    }
    #[inline(always)]
    fn call(&mut self, index: usize) {
        // All columns have the same length; if they had not, the check of the answers would fail.
        let done = self.fill(index);
        let contribution = self.pool.contribution.each_ref().map(|column| &column[..]);
        for choice in choose(contribution, &self.pool.weight, RAYS, black_box(0.5)) {
            black_box(&choice);
        }
        black_box((&self.pool, done.is_ok()));
    }
    fn answers(&mut self) -> Vec<Answer> {
        let mut out = Vec::new();
        for index in 0..self.calls() {
            self.call(index);
            let Columns {
                wi,
                contribution,
                weight,
                ..
            } = &self.pool;
            let contribution = contribution.each_ref().map(|column| &column[..]);
            let choices = choose(contribution, weight, RAYS, 0.5);
            let (sum, mut shares) = (choices.total(), 0.0_f32);
            for choice in choices {
                shares += choice.contribution.iter().sum::<f32>() / (3.0 * sum);
            }
            // The contributions of the chosen rays, averaged over the channels, add up to the sum of the weights; if not, every answer
            // is wrong.
            let weight = weight.map(|w| {
                if (shares - 1.0).abs() < 1e-4 {
                    w
                } else {
                    f32::NAN
                }
            });
            out.extend((0..ALL).map(|i| Answer {
                wi: Some(Vec3::from_array(wi.map(|column| column[i]))),
                value: Some([0, 1, 2].map(|c: usize| contribution[c][i])),
                pdf: Some(weight[i]),
            }));
        }
        out
    }
}

/// Candidates of eight hits: uniform numbers for the BSDF, directions of the light, and one number per candidate that decides whether
/// the reservoir keeps it.
#[derive(Clone, Debug)]
pub struct Stream {
    xi: [[f32x8; 3]; PACKETS],
    wi: [Vec3x8; PACKETS],
    u: [f32x8; 2 * PACKETS],
}

/// Number of candidates in a [`Stream`], over all eight hits.
pub const STREAMED: usize = 2 * PACKETS * 8;

impl Stream {
    /// Splits `inputs` into streams, each with four packets of candidates of either technique.
    #[must_use]
    pub fn of(inputs: &Inputs) -> Vec<Self> {
        let (xi, wi) = (xi_packets(&inputs.xi), packets(&inputs.wi));
        let (xi, wi) = (xi.as_chunks::<PACKETS>().0, wi.as_chunks::<PACKETS>().0);
        // Taken from packets elsewhere, so that they differ from the numbers by which candidates are drawn.
        let u = |at: usize| from_fn(|k| xi[(at + 1 + k / PACKETS) % xi.len()][k % PACKETS][0]);
        xi.iter()
            .zip(wi)
            .enumerate()
            .map(|(at, (xi, wi))| Self {
                xi: *xi,
                wi: *wi,
                u: u(at),
            })
            .collect()
    }

    /// Proposes, looks up, weighs and adds all candidates, and then computes the estimate of each hit.
    #[inline(always)]
    #[must_use]
    pub fn keep<M: Model>(&self, bsdf: &Bsdf8<M>) -> Kept {
        let pdf = f32x8::splat(SKY_PDF);
        let mut reservoir = Reservoir8::default().with_level(bsdf.level());
        let mut add = |wi: &Vec3x8, u: &f32x8| {
            let weighed = bsdf.weigh8(wi, &sky8(wi), &pdf, COUNTS, Partition::All);
            reservoir.add(wi, &weighed, u);
        };
        let (first, second) = self.u.split_at(PACKETS);
        self.xi
            .iter()
            .zip(first)
            .for_each(|(xi, u)| add(&bsdf.propose8(xi), u));
        self.wi.iter().zip(second).for_each(|(wi, u)| add(wi, u));
        Kept {
            reservoir,
            estimate: reservoir.estimate(),
        }
    }
}

/// Reservoir of each hit with its estimate.
#[derive(Clone, Copy, Debug)]
pub struct Kept {
    reservoir: Reservoir8,
    estimate: [f32x8; 3],
}

impl Output for Kept {
    fn answers(&self, out: &mut Vec<Answer>) {
        let Self {
            reservoir:
                Reservoir8 {
                    wi,
                    contribution,
                    sum,
                    ..
                },
            estimate,
        } = self;
        for lane in 0..8 {
            let colour = |of: &[f32x8; 3]| of.map(|channel| channel.to_array()[lane]);
            // The mean over the channels is the sum of the weights; if it is not, the answer is wrong.
            let mean = colour(estimate).iter().sum::<f32>() / 3.0;
            let is_sum = (mean / sum.to_array()[lane] - 1.0).abs() < 1e-5;
            let value = if is_sum {
                colour(contribution)
            } else {
                [f32::NAN; 3]
            };
            out.push(Answer {
                wi: Some(wi.lane(lane)),
                value: Some(value),
                pdf: None,
            });
        }
    }
}

/// Returns the answer of a proposed direction; a discarded sample has density 0.
#[must_use]
pub fn proposed(wi: Vec3) -> Answer {
    Answer {
        wi: Some(wi),
        value: None,
        pdf: (wi == Vec3::ZERO).then_some(0.0),
    }
}

impl Output for Vec3x8 {
    fn answers(&self, out: &mut Vec<Answer>) {
        out.extend((0..8).map(|lane| proposed(self.lane(lane))));
    }
}

/// Answers with contributions as values and weights as densities.
impl Output for Weighed8 {
    fn answers(&self, out: &mut Vec<Answer>) {
        let ([r, g, b], weight) = (
            self.contribution.map(f32x8::to_array),
            self.weight.to_array(),
        );
        let answer = |i: usize| Answer {
            wi: None,
            value: Some([r[i], g[i], b[i]]),
            pdf: Some(weight[i]),
        };
        out.extend((0..8).map(answer));
    }
}
