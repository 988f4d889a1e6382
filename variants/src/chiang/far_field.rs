//! The far field of the near-field fibre: the mean over the offset `h`, by Gauss nodes of `h` in lanes.

use super::{Chiang, ChiangDesc};
use hairis::simd::{Vec3x, f32x8};
use hairis::{Bsdf8, Eval, Hit, LobeMask, Material, PerLobe, Sample, Vec3x8};

/// Gauss-Legendre nodes of the offset `h` over `[-1, 1]`, eight per packet: build it once, for all materials and hits.
///
/// - Number: [`ChiangDesc::far_field_nodes`] gives the number that a roughness needs. With `8 PACKETS` of 8, 16, 32 and 64 the sum of
///   `A N` is off by (mean over the azimuth) .8%, .1%, 0 and 0 at a `beta_n` of .5; 6%, .5%, 0 and 0 at .3; 26%, 4%, .3% and 0
///   at .2; 90%, 43%, 10% and 1% at .1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffsetNodes<const PACKETS: usize> {
    h: [[f32; 8]; PACKETS],
    weight: [[f32; 8]; PACKETS],
}

impl<const PACKETS: usize> OffsetNodes<PACKETS> {
    /// The nodes: zeros of the Legendre polynomial of degree `8 PACKETS`, by Newton's method in `f64`.
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
            // Half of the rule's weight: they sum to 1.
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
    /// Nodes of `h` that the far field of this roughness needs: `1.7 / s`, `s` the [scale](Self::azimuthal_scale) of the
    /// azimuth, in whole packets of eight. Below a `beta_n` of .05 it is cheaper to draw `h` per hit.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 8 to 10,300"
    )]
    #[inline]
    #[must_use]
    pub fn far_field_nodes(&self) -> usize {
        let nodes = 1.7 / self.azimuthal_scale();
        8 * (libm::ceilf(nodes / 8.0).max(1.0) as usize)
    }
}

/// A shading point in the far field: `wo` is given, and `h` is uniform.
///
/// Value and density are means over the nodes. Energy is that of the near field, whatever the nodes.
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
    /// The shading point of a material seen from `wo`, whose domain is that of [`Material::prepare`].
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

    /// S at `wi`, without the cosine, and the density of sampling it, per steradian.
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

    /// A direction for three uniform numbers in `[0, 1)`: the first chooses the node, its lobe and the azimuth. `None` is a
    /// discarded sample, which counts.
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

    /// The shading point with only some of its lobes.
    #[inline]
    #[must_use]
    pub fn with_lobes(&self, lobes: LobeMask) -> Self {
        Self {
            near: self.near.map(|near| near.with_lobes(lobes)),
            ..*self
        }
    }

    /// Directional albedo of each lobe, linear RGB: the mean over the nodes.
    #[inline]
    #[must_use]
    pub fn albedo(&self) -> PerLobe<[f32; 3]> {
        let mut sum = PerLobe([[0.0; 3]; 4]);
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

/// The sum of the lanes, in their order: that of `reduce_add` depends on the build, and so do its last bits.
#[inline(always)]
fn total(lanes: f32x8) -> f32 {
    lanes.as_array().iter().sum()
}
