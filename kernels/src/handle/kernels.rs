//! Functions of a model as kernels of the vector layer, over packets of eight lanes and over rows of columns.

use crate::frame::Vec3x8;
use crate::model::{Eval, Eval8, Hit, Hit8, LobeEval8, Model, PerLobe, Sample8, SampleLanes};
use crate::simd::{Broadcast, Kernel, Lanes, Row, Scalar, Vec3x, fresh_lanes3, store3};
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
        let [a, b, c, d, e] = M::lobes::<L, C>(prepared, Vec3x::load_fresh(wi)).0;
        PerLobe([a.store(), b.store(), c.store(), d.store(), e.store()])
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
        let [a, b, c, d, e] = M::albedo::<L, f32x8>(self.prepared).0;
        PerLobe([store3(a), store3(b), store3(c), store3(d), store3(e)])
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
pub(super) fn columns<L>(s: SampleLanes<L>) -> [L; 11] {
    let ([r, g, b], [wr, wg, wb]) = (s.value, s.weight);
    [s.wi.x, s.wi.y, s.wi.z, r, g, b, s.pdf, wr, wg, wb, s.slot]
}

/// Returns the numbers of an evaluation in the order of its columns.
#[inline(always)]
pub(super) fn value_pdf<L>(eval: Eval<L>) -> [L; 4] {
    let [r, g, b] = eval.value;
    [r, g, b, eval.pdf]
}
