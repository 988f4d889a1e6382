//! Far field of the near-field fibre: the mean over the offset `h`, by Gauss nodes of `h` that fill the lanes.

use super::{Chiang, ChiangDesc};
use hairis::simd::{Vec3x, f32x8};
use hairis::{Bsdf8, Eval, Hit, LobeMask, Material, PerLobe, Sample, Vec3x8};

/// Gauss-Legendre nodes of the offset `h` over `[-1, 1]`, eight per packet. Build them once, for all materials and hits.
///
/// [`ChiangDesc::far_field_nodes`] returns the number of nodes that a roughness needs. With `8 PACKETS` nodes, the sum of `A N` has this
/// error, as a mean over the azimuth:
///
/// | `beta_n` | 8 nodes | 16 nodes | 32 nodes | 64 nodes |
/// |---|---|---|---|---|
/// | .5 | .8% | .1% | 0 | 0 |
/// | .3 | 6% | .5% | 0 | 0 |
/// | .2 | 26% | 4% | .3% | 0 |
/// | .1 | 90% | 43% | 10% | 1% |
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffsetNodes<const PACKETS: usize> {
    h: [[f32; 8]; PACKETS],
    weight: [[f32; 8]; PACKETS],
}

impl<const PACKETS: usize> OffsetNodes<PACKETS> {
    /// Computes the nodes, which are the zeros of the Legendre polynomial of degree `8 PACKETS`, by Newton's method in `f64`.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "nodes and weights in [-1, 1]"
    )]
    #[inline(never)]
    #[must_use]
    pub fn new() -> Self {
        let n = 8 * PACKETS;
        let degree = n as f64;
        let mut nodes = Self {
            h: [[0.0; 8]; PACKETS],
            weight: [[0.0; 8]; PACKETS],
        };
        for i in 0..n {
            let mut x = libm::cos(core::f64::consts::PI * (i as f64 + 0.75) / (degree + 0.5));
            let mut slope = 1.0;
            for _ in 0..8 {
                let (mut p, mut before) = (1.0, 0.0);
                for k in 0..n {
                    let k = k as f64;
                    (p, before) = (((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0), p);
                }
                slope = degree * (x * p - before) / (x * x - 1.0);
                x -= p / slope;
            }
            nodes.h[i / 8][i % 8] = x as f32;
            // Half of the weight of the rule, so that the weights sum to 1.
            nodes.weight[i / 8][i % 8] = (1.0 / ((1.0 - x * x) * slope * slope)) as f32;
        }
        nodes
    }
}

impl<const PACKETS: usize> Default for OffsetNodes<PACKETS> {
    #[inline]
    fn default() -> Self {
        Self::new()
    }
}

impl ChiangDesc {
    /// Returns the number of nodes of `h` that the far field of this roughness needs: `1.7 / s`, with `s` the least azimuthal
    /// [scale](Self::azimuthal_scale) of a lobe, in whole packets of eight. Below a `beta_n` of .05, drawing `h` per hit is cheaper.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 8 to 103,000"
    )]
    #[inline]
    #[must_use]
    pub fn far_field_nodes(&self) -> usize {
        let [r, tt, trt] = self.width_n;
        let nodes = 1.7 / (r.min(tt).min(trt) * self.azimuthal_scale());
        8 * (libm::ceilf(nodes / 8.0).max(1.0) as usize)
    }
}

/// Shading point in the far field, where `wo` is given and `h` is uniform.
///
/// Value and density are means over the nodes. The energy is the energy of the near field, whatever the nodes.
///
/// ```
/// use glam::Vec3;
/// use hairis::Material;
/// use hairis_variants::{Chiang, ChiangParams, chiang::{FarField, OffsetNodes}};
/// let nodes = OffsetNodes::<4>::new(); // once
/// assert!(ChiangParams::blond().desc().far_field_nodes() <= 32);
/// let hair = Material::new(&Chiang::MEAN, &ChiangParams::blond());
/// let prepared = FarField::prepare(&hair, &nodes, Vec3::Y);
/// let sample = prepared.sample([0.3, 0.6, 0.9]).expect("not along the fibre");
/// assert!((prepared.eval_pdf(sample.wi).pdf / sample.pdf - 1.0).abs() < 1e-5);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct FarField<const PACKETS: usize, const BY_CHANNEL: bool = false> {
    near: [Bsdf8<Chiang<BY_CHANNEL>>; PACKETS],
    nodes: OffsetNodes<PACKETS>,
}

impl<const PACKETS: usize, const BY_CHANNEL: bool> FarField<PACKETS, BY_CHANNEL> {
    /// Prepares the shading point of a material seen from `wo`, whose domain is that of [`Material::prepare`].
    #[inline]
    #[must_use]
    pub fn prepare(
        material: &Material<Chiang<BY_CHANNEL>>,
        nodes: &OffsetNodes<PACKETS>,
        wo: impl Into<Vec3x<f32>>,
    ) -> Self {
        let Vec3x { x, y, z } = wo.into();
        let wo = Vec3x8::new(f32x8::splat(x), f32x8::splat(y), f32x8::splat(z));
        Self {
            near: nodes
                .h
                .map(|h| material.prepare8(Hit::new(wo, f32x8::new(h)))),
            nodes: *nodes,
        }
    }

    /// Evaluates S at `wi`, without the cosine, and the density of sampling `wi`, per steradian.
    #[inline]
    #[must_use]
    pub fn eval_pdf(&self, wi: impl Into<Vec3x<f32>>) -> Eval {
        let Vec3x { x, y, z } = wi.into();
        let wi = Vec3x8::new(f32x8::splat(x), f32x8::splat(y), f32x8::splat(z));
        let mut sum = [f32x8::ZERO; 4];
        for (near, weight) in self.near.iter().zip(self.nodes.weight) {
            let eval = near.eval_pdf8(&wi);
            let [r, g, b] = eval.value;
            for (sum, lanes) in sum.iter_mut().zip([r, g, b, eval.pdf]) {
                *sum += lanes * f32x8::new(weight);
            }
        }
        let [r, g, b, pdf] = sum.map(total);
        Eval {
            value: [r, g, b],
            pdf,
        }
    }

    /// Draws a direction by three uniform numbers in `[0, 1)`, of which the first chooses the node, its lobe and the azimuth. `None`
    /// is a discarded sample, which still counts as a sample.
    #[inline]
    #[must_use]
    pub fn sample(&self, [first, second, third]: [f32; 3]) -> Option<Sample> {
        let (mut node, mut rest) = (0, first.clamp(0.0, 1.0));
        let weight = |node: usize| self.nodes.weight[node / 8][node % 8];
        while node + 1 < 8 * PACKETS && rest >= weight(node) {
            rest -= weight(node);
            node += 1;
        }
        let near = self.near.get(node / 8)?.lane(node % 8);
        let drawn = near.sample([
            (rest / weight(node)).min(1.0 - f32::EPSILON / 2.0),
            second,
            third,
        ])?;
        let Eval { value, pdf } = self.eval_pdf(drawn.wi);
        let by = libm::hypotf(drawn.wi.y, drawn.wi.z) / pdf;
        (pdf > 1e-30).then(|| Sample {
            value,
            pdf,
            weight: value.map(|s| (s * by).min(f32::MAX)),
            ..drawn
        })
    }

    /// Keeps only the lobes of the mask; the others neither scatter nor are sampled.
    #[inline]
    #[must_use]
    pub fn with_lobes(&self, lobes: LobeMask) -> Self {
        Self {
            near: self.near.map(|near| near.with_lobes(lobes)),
            ..*self
        }
    }

    /// Returns the directional albedo of each lobe, linear RGB, as the mean over the nodes.
    #[inline]
    #[must_use]
    pub fn albedo(&self) -> PerLobe<[f32; 3]> {
        let mut sum = PerLobe([[0.0; 3]; hairis::Lobe::COUNT]);
        for (near, weight) in self.near.iter().zip(self.nodes.weight) {
            let albedo = near.albedo8();
            for (sum, lobe) in sum.0.iter_mut().zip(albedo.0) {
                for (sum, lanes) in sum.iter_mut().zip(lobe) {
                    *sum += total(lanes * f32x8::new(weight));
                }
            }
        }
        sum
    }
}

/// Sums the lanes in their order. The order of `reduce_add` depends on the build, and so would the last bits of the sum.
#[inline(always)]
fn total(lanes: f32x8) -> f32 {
    lanes.as_array().iter().sum()
}
