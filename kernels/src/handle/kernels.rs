//! Functions of a model as kernels of the vector layer, over packets of eight lanes and over rows of columns.

use crate::model::{Eval, Eval8, Hit8, LobeEval8, Model, Sample8, SampleLanes};
use crate::simd::{Broadcast, Kernel, Lanes, Row, Scalar, Vec3x, fresh_lanes3, store3};
use crate::{Bsdf8, Hit, PerLobe, Vec3x8};
use core::marker::PhantomData;
use wide::f32x8;

/// Declares an `impl` for constants `C` that are `f32`, one number for all lanes, and for `f32x8`,
/// one number per lane.
macro_rules! for_constants {
    ($C:ident: $($item:tt)*) => {
        const _: () = {
            type $C = f32;
            $($item)*
        };
        const _: () = {
            type $C = f32x8;
            $($item)*
        };
    };
}

/// Kernel that prepares eight shading points. The caller's arguments are converted to hits inside the kernel, by vector code.
pub(crate) struct Prepare<'a, M: Model, C: Scalar, H> {
    pub(crate) material: &'a M::Material<C>,
    pub(crate) hits: H,
}

for_constants! { C:
impl<M: Model, H: Into<Hit8>> Kernel for Prepare<'_, M, C, H> {
    type Output = M::Prepared<f32x8>;
    const MANY_REGISTERS: bool = false;

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> M::Prepared<f32x8> {
        let hits: Hit8 = self.hits.into();
        let hit = Hit {
            wo: Vec3x::load(&hits.wo),
            h: hits.h.lanes(),
        };
        M::prepare::<L, C>(self.material, hit)
    }
}
}

/// Declares the kernel of one of a model's functions at a shading point, with eight lanes each.
macro_rules! at_bsdf {
    ($(#[$meta:meta])* $name:ident($input:ident: &$Input:ty) -> $Output:ty, $M:ident $L:ident $C:ident $prepared:ident $body:expr) => {
        $(#[$meta])*
        pub(crate) struct $name<'a, M: Model, C: Scalar> {
            pub(crate) prepared: &'a M::Prepared<C>,
            pub(crate) $input: &'a $Input,
        }

        for_constants! { $C:
            impl<$M: Model> Kernel for $name<'_, $M, $C> {
                type Output = $Output;

                #[inline(always)]
                fn run<$L: Lanes<Stored = f32x8>>(self) -> $Output {
                    let Self { $prepared, $input } = self;
                    $body
                }
            }
        }
    };
}

at_bsdf! {
    /// Value and density of eight directions.
    EvalPdf(wi: &Vec3x8) -> Eval8, M L C prepared M::eval::<L, C>(prepared, Vec3x::load_fresh(wi)).store()
}
at_bsdf! {
    /// Each lobe's value, colour and density at eight directions.
    Lobes(wi: &Vec3x8) -> PerLobe<LobeEval8>, M L C prepared {
        let [a, b, c, d] = M::lobes::<L, C>(prepared, Vec3x::load_fresh(wi)).0;
        PerLobe([a.store(), b.store(), c.store(), d.store()])
    }
}
at_bsdf! {
    /// Eight sampled directions.
    SampleWi(xi: &[f32x8; 3]) -> Sample8, M L C prepared M::sample::<L, C>(prepared, fresh_lanes3(xi)).store()
}

/// Kernel of the directional albedos of eight shading points.
pub(crate) struct Albedo<'a, M: Model> {
    pub(crate) prepared: &'a M::Prepared<f32x8>,
}

impl<M: Model> Kernel for Albedo<'_, M> {
    type Output = PerLobe<[f32x8; 3]>;
    const MANY_REGISTERS: bool = false;

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> PerLobe<[f32x8; 3]> {
        let [a, b, c, d] = M::albedo::<L, f32x8>(self.prepared).0;
        PerLobe([store3(a), store3(b), store3(c), store3(d)])
    }
}

/// Row of a batch: the columns `K` of one shading point.
pub(crate) struct AtBsdf<'a, M: Model, K> {
    pub(crate) prepared: &'a M::Prepared<f32>,
    columns: PhantomData<K>,
}

impl<'a, M: Model, K> AtBsdf<'a, M, K> {
    #[inline(always)]
    pub(crate) fn new(prepared: &'a M::Prepared<f32>) -> Self {
        Self {
            prepared,
            columns: PhantomData,
        }
    }
}

impl<M: Model, K> Clone for AtBsdf<'_, M, K> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}
impl<M: Model, K> Copy for AtBsdf<'_, M, K> {}

/// Column of the density alone.
pub(crate) struct Pdf;
impl<M: Model> Row<3, 1> for AtBsdf<'_, M, Pdf> {
    #[inline(always)]
    fn row<L: Lanes>(self, [x, y, z]: [L; 3]) -> [L; 1] {
        [M::eval::<L, f32>(self.prepared, Vec3x::new(x, y, z)).pdf]
    }
}

/// Columns of S and of the density, some of which may be left out.
pub(crate) struct ValuePdf;
impl<M: Model> Row<3, 4> for AtBsdf<'_, M, ValuePdf> {
    const OPTIONAL: bool = true;
    const OPTIONAL_INPUTS: bool = false;

    #[inline(always)]
    fn row<L: Lanes>(self, [x, y, z]: [L; 3]) -> [L; 4] {
        value_pdf(M::eval::<L, f32>(self.prepared, Vec3x::new(x, y, z)))
    }
}

/// Columns of samples, some of which may be left out.
pub(crate) struct Samples;
impl<M: Model> Row<3, 11> for AtBsdf<'_, M, Samples> {
    const OPTIONAL: bool = true;
    const OPTIONAL_INPUTS: bool = false;

    #[inline(always)]
    fn row<L: Lanes>(self, xi: [L; 3]) -> [L; 11] {
        columns(M::sample::<L, f32>(self.prepared, xi))
    }
}

/// Returns the numbers of a sample in the order of its slices.
#[inline(always)]
fn columns<L>(s: SampleLanes<L>) -> [L; 11] {
    let ([r, g, b], [wr, wg, wb]) = (s.value, s.weight);
    [s.wi.x, s.wi.y, s.wi.z, r, g, b, s.pdf, wr, wg, wb, s.slot]
}

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

/// Returns the numbers of an evaluation in the order of its columns.
#[inline(always)]
fn value_pdf<L>(eval: Eval<L>) -> [L; 4] {
    let [r, g, b] = eval.value;
    [r, g, b, eval.pdf]
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
