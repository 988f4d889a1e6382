//! Packets of eight candidates: drawn, looked up and weighed.

use super::MOST;
use crate::sampler::Scatter;
use core::array;
use hairis::resample::{Counts, Partition, Weighed8};
use hairis::{Eval8, Vec3x8};
use hairis_instruments::direction::cosine;
use hairis_instruments::light::{Light, Seen8, rounded};
use hairis_instruments::sequence::{Independent, XiSource};
use wide::f32x8;

/// Eight directions that were drawn from a light, one per lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightBlock {
    wi: Vec3x8,
    seen: Seen8,
}

impl LightBlock {
    pub(super) fn draw(light: &dyn Light, source: &mut Independent) -> Self {
        let samples = light.sample8(array::from_fn(|_| source.next_xi()));
        let wi = samples.map(|sample| sample.dir.as_vec3()).into();
        let radiance =
            array::from_fn(|c| f32x8::new(samples.map(|sample| rounded(sample.radiance[c]))));
        Self {
            wi,
            seen: Seen8 {
                radiance,
                pdf: f32x8::new(samples.map(|sample| rounded(sample.pdf))),
            },
        }
    }
}

/// Number of packets of each technique in the largest pool.
pub(super) const PACKETS: usize = MOST / 8;

/// Directions of a light that were drawn beforehand, for several pools of the largest size.
#[derive(Debug)]
pub struct LightBlocks(pub(super) Vec<[LightBlock; PACKETS]>);

impl LightBlocks {
    /// Draws the directions for so many of the largest pools.
    pub fn draw(light: &dyn Light, source: &mut Independent, pools: usize) -> Self {
        Self(
            (0..pools)
                .map(|_| array::from_fn(|_| LightBlock::draw(light, source)))
                .collect(),
        )
    }
}

/// Draws three rows of eight uniform numbers.
pub fn numbers(source: &mut Independent) -> [f32x8; 3] {
    array::from_fn(|_| f32x8::new(array::from_fn(|_| source.next_f32())))
}

/// Shading point under a light.
#[derive(Clone, Copy, Debug)]
pub struct Lit<'a> {
    /// Sampler at the point.
    pub scatter: &'a Scatter,
    /// Light.
    pub light: &'a dyn Light,
}

/// Eight candidates of one technique at one hit, one per lane, with everything that a weight needs.
pub(super) struct Candidates8 {
    eval: Eval8,
    cos_theta_i: f32x8,
    seen: Seen8,
}

impl Lit<'_> {
    /// Draws candidates from the BSDF. Its samples include value and density.
    #[inline]
    pub(super) fn of_bsdf(&self, xi: &[f32x8; 3]) -> Candidates8 {
        let sample = self.scatter.sample8(xi);
        let eval = Eval8 {
            value: sample.value,
            pdf: sample.pdf,
        };
        Candidates8 {
            eval,
            cos_theta_i: cosine(&sample.wi),
            seen: self.light.see8(&sample.wi),
        }
    }

    /// Evaluates candidates that were drawn from the light.
    #[inline]
    pub(super) fn of_light(&self, block: &LightBlock) -> Candidates8 {
        let eval = self.scatter.eval_pdf8(&block.wi);
        Candidates8 {
            eval,
            cos_theta_i: cosine(&block.wi),
            seen: block.seen,
        }
    }
}

impl Candidates8 {
    /// Weighs the candidates in a pool of `count` candidates of each technique.
    #[inline]
    pub(super) fn weigh(&self, count: u32) -> Weighed8 {
        let Self {
            eval,
            cos_theta_i,
            seen,
        } = self;
        let counts = Counts {
            bsdf: count,
            light: count,
        };
        Weighed8::new(
            eval,
            cos_theta_i,
            &seen.radiance,
            &seen.pdf,
            counts,
            Partition::All,
        )
    }

    /// Returns the densities of the BSDF's technique and of the light's, per steradian.
    pub(super) const fn pdf(&self) -> [f32x8; 2] {
        [self.eval.pdf, self.seen.pdf]
    }

    /// Returns the estimate of one-sample MIS along each direction, linear RGB.
    #[inline]
    pub(super) fn one_sample_mis(&self) -> [f32x8; 3] {
        let density = f32x8::splat(0.5) * (self.eval.pdf + self.seen.pdf);
        let scale = self.cos_theta_i / density.max(f32x8::splat(f32::MIN_POSITIVE));
        array::from_fn(|c| self.eval.value[c] * self.seen.radiance[c] * scale)
    }
}
