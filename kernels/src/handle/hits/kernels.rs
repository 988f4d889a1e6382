//! Kernels of columns of hits, in rows and in packets of eight.

use crate::handle::bsdf::Bsdf8;
use crate::handle::kernels::{columns, value_pdf};
use crate::model::{Hit, Model};
use crate::simd::{Broadcast, Kernel, Lanes, Row, Vec3x};
use core::marker::PhantomData;
use wide::f32x8;

/// Columns of hits: constants of each hit are computed and used in registers. The first four of the `I` inputs are `wo` and `h`.
pub(crate) trait HitRow<M: Model, const I: usize, const N: usize> {
    /// Computes the numbers of each lane at a prepared hit.
    fn at<L: Lanes, C: Broadcast<L>>(prepared: &M::Prepared<C>, input: [L; I]) -> [L; N];

    /// Computes the numbers of each lane at eight prepared hits, by their calls for packets.
    fn of_eight(bsdf: &Bsdf8<M>, input: &[f32x8; I]) -> [f32x8; N];

    /// Prepares the hits of a row and computes the numbers of each lane.
    #[inline(always)]
    fn row<L: Lanes, C: Broadcast<L>>(material: &M::Material<C>, input: [L; I]) -> [L; N] {
        let wo = Vec3x::new(input[0], input[1], input[2]);
        let prepared = M::prepare::<L, C>(material, Hit::new(wo, input[3]));
        Self::at::<L, L::Stored>(&prepared, input)
    }
}

/// Columns of S and of the density, from a direction.
pub(crate) struct HitEvals;
impl<M: Model> HitRow<M, 7, 4> for HitEvals {
    #[inline(always)]
    fn at<L: Lanes, C: Broadcast<L>>(
        prepared: &M::Prepared<C>,
        [_, _, _, _, x, y, z]: [L; 7],
    ) -> [L; 4] {
        value_pdf(M::eval::<L, C>(prepared, Vec3x::new(x, y, z)))
    }

    #[inline(never)]
    fn of_eight(bsdf: &Bsdf8<M>, [_, _, _, _, x, y, z]: &[f32x8; 7]) -> [f32x8; 4] {
        value_pdf(bsdf.eval_pdf8(&Vec3x::new(*x, *y, *z)))
    }
}

/// Columns of samples, from three uniform numbers.
pub(crate) struct HitSamples;
impl<M: Model> HitRow<M, 7, 11> for HitSamples {
    #[inline(always)]
    fn at<L: Lanes, C: Broadcast<L>>(
        prepared: &M::Prepared<C>,
        [_, _, _, _, x, y, z]: [L; 7],
    ) -> [L; 11] {
        columns(M::sample::<L, C>(prepared, [x, y, z]))
    }

    #[inline(never)]
    fn of_eight(bsdf: &Bsdf8<M>, [_, _, _, _, x, y, z]: &[f32x8; 7]) -> [f32x8; 11] {
        columns(bsdf.sample8(&[*x, *y, *z]))
    }
}

/// Columns of S and of the density, from a direction, and of samples, from three uniform numbers.
pub(crate) struct HitEvalsSamples;
impl<M: Model> HitRow<M, 10, 15> for HitEvalsSamples {
    #[inline(always)]
    fn at<L: Lanes, C: Broadcast<L>>(
        prepared: &M::Prepared<C>,
        [_, _, _, _, u, v, w, x, y, z]: [L; 10],
    ) -> [L; 15] {
        let eval = M::eval::<L, C>(prepared, Vec3x::new(u, v, w));
        joined(
            value_pdf(eval),
            columns(M::sample::<L, C>(prepared, [x, y, z])),
        )
    }

    #[inline]
    fn of_eight(bsdf: &Bsdf8<M>, [a, b, c, h, u, v, w, x, y, z]: &[f32x8; 10]) -> [f32x8; 15] {
        joined(
            HitEvals::of_eight(bsdf, &[*a, *b, *c, *h, *u, *v, *w]),
            HitSamples::of_eight(bsdf, &[*a, *b, *c, *h, *x, *y, *z]),
        )
    }
}

/// Joins the numbers of an evaluation and of a sample.
#[inline(always)]
fn joined<L>([r, g, b, p]: [L; 4], sample: [L; 11]) -> [L; 15] {
    let [u, v, w, sr, sg, sb, sp, wr, wg, wb, slot] = sample;
    [r, g, b, p, u, v, w, sr, sg, sb, sp, wr, wg, wb, slot]
}

/// Rows of hits on one material.
pub(crate) struct AtHits<'a, M: Model, K> {
    material: &'a M::Material<f32>,
    columns: PhantomData<K>,
}

impl<'a, M: Model, K> AtHits<'a, M, K> {
    #[inline(always)]
    pub(crate) fn new(material: &'a M::Material<f32>) -> Self {
        Self {
            material,
            columns: PhantomData,
        }
    }
}

impl<M: Model, K> Clone for AtHits<'_, M, K> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}
impl<M: Model, K> Copy for AtHits<'_, M, K> {}

impl<M: Model, K: HitRow<M, I, N>, const I: usize, const N: usize> Row<I, N> for AtHits<'_, M, K> {
    const OPTIONAL: bool = true;
    // A measure of the size of the code that computes these constants. For two packets of `Matched` with 25 bands, 904 bytes, the
    // code takes 60 kB, where CPUs cache 32 to 64 kB; with 9 bands, 520 bytes, it fits.
    const PAIRS: bool = size_of::<M::Prepared<f32>>() <= 768;

    #[inline(always)]
    fn row<L: Lanes>(self, input: [L; I]) -> [L; N] {
        K::row::<L, f32>(self.material, input)
    }
}

/// Loads packets as lanes.
#[inline(always)]
fn lanes_of<L: Lanes<Stored = f32x8>, const I: usize>(input: &[f32x8; I]) -> [L; I] {
    let mut lanes = [L::splat(0.0); I];
    let mut i = 0;
    while i < I {
        lanes[i] = input[i].fresh_lanes();
        i += 1;
    }
    lanes
}

/// Stores lanes as packets.
#[inline(always)]
fn store_lanes<L: Lanes<Stored = f32x8>, const N: usize>(lanes: [L; N]) -> [f32x8; N] {
    let mut out = [f32x8::ZERO; N];
    let mut i = 0;
    while i < N {
        out[i] = lanes[i].store();
        i += 1;
    }
    out
}

/// Kernel of eight hits, each on a material of its own.
pub(crate) struct EightHits<'a, M: Model, K, const I: usize, const N: usize> {
    material: &'a M::Material<f32x8>,
    input: &'a [f32x8; I],
    columns: PhantomData<K>,
}

impl<'a, M: Model, K, const I: usize, const N: usize> EightHits<'a, M, K, I, N> {
    #[inline(always)]
    pub(crate) fn new(material: &'a M::Material<f32x8>, input: &'a [f32x8; I]) -> Self {
        Self {
            material,
            input,
            columns: PhantomData,
        }
    }
}

impl<M: Model, K: HitRow<M, I, N>, const I: usize, const N: usize> Kernel
    for EightHits<'_, M, K, I, N>
{
    type Output = [f32x8; N];
    // Packing the materials takes more time than more registers would save.
    const MANY_REGISTERS: bool = false;

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> [f32x8; N] {
        store_lanes(K::row::<L, f32x8>(self.material, lanes_of(self.input)))
    }
}
