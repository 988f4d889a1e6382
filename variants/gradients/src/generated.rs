//! Generated derivatives, and which model has which.

use crate::columns::Call;
use core::marker::PhantomData;
use hairis::f32x8;
use hairis::simd::{Kernel, LaneStruct, Lanes, Level, Path};
use hairis::{Gaussian, Matched, Published};
use hairis_variants::{AllCauchy, Cauchy, Chiang, KajiyaKay, ModelId, Registered};

/// Numbers of an evaluation: red, green, blue, and the density.
pub(crate) const RESULTS: usize = 4;
/// Numbers of a hit and a direction: `wo`, `h`, `wi`.
pub(crate) const ARGUMENTS: usize = 7;
/// Numbers that each hit reads: these, and a weight per result.
pub(crate) const INPUTS: usize = ARGUMENTS + RESULTS;

/// Packets whose derivatives are summed in single precision.
const BLOCK: usize = 64;

/// Derivatives that read `N` numbers of a material, by lanes: `R` rows, the results, then a row per number, then one per argument.
trait Rows<const N: usize, const R: usize> {
    /// Whether the density is among the results, and not 0.
    const HAS_PDF: bool;
    /// The rows.
    fn rows<L: Lanes<Stored = f32x8>>(m: &[f32; N], v: &[f32x8; INPUTS], out: &mut [f32x8; R]);
}

mod models {
    #![allow(
        clippy::all,
        clippy::pedantic,
        non_snake_case,
        unused,
        reason = "generated: one line per operation"
    )]
    use super::{INPUTS, Rows, upper};
    use hairis::f32x8;
    use hairis::simd::Lanes;
    include!(concat!(env!("OUT_DIR"), "/models.rs"));
}

/// Numbers with the lower 12 bits cleared. Asked for by lanes that do not fuse.
#[inline(always)]
fn upper<L: Lanes<Stored: Upper>>(x: L) -> L {
    L::load(&x.store().upper())
}

/// Stored lanes whose bits are taken apart.
trait Upper {
    fn upper(self) -> Self;
}

impl Upper for f32x8 {
    #[inline(always)]
    fn upper(self) -> Self {
        self & Self::splat(f32::from_bits(0xffff_f000))
    }
}

impl Upper for f32 {
    #[inline(always)]
    fn upper(self) -> Self {
        Self::from_bits(self.to_bits() & 0xffff_f000)
    }
}

/// Numbers of one packet, and the sums of a block. The caller of the dispatched function makes them: there, clearing or copying them
/// would be calls.
struct Memory<const N: usize, const R: usize> {
    material: [f32; N],
    input: [f32x8; INPUTS],
    out: [f32x8; R],
    sums: [f32x8; N],
}

/// Slices of hits on a material, of which each number is at its place.
struct Hits<'c, 'a, 'b, G, const N: usize, const R: usize> {
    call: &'c mut Call<'a, 'b>,
    memory: &'c mut Memory<N, R>,
    places: &'static [usize],
    rows: PhantomData<G>,
}

impl<G: Rows<N, R>, const N: usize, const R: usize> Kernel for Hits<'_, '_, '_, G, N, R> {
    type Output = ();
    // Compiling the density once more takes longest.
    const MANY_REGISTERS: bool = !G::HAS_PDF;

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) {
        let Self {
            call,
            memory,
            places,
            ..
        } = self;
        let Memory {
            material,
            input,
            out,
            sums,
        } = memory;
        let mut packet = 0;
        while packet * 8 < call.len {
            call.read(packet * 8, input);
            G::rows::<L>(material, input, out);
            call.write::<N, R>(packet * 8, places, out);
            packet += 1;
            if call.sums.is_empty() {
                continue;
            }
            for (sum, row) in sums.iter_mut().zip(&out[RESULTS..]) {
                *sum = (L::load(sum) + L::load(row)).store();
            }
            if packet % BLOCK == 0 || packet * 8 >= call.len {
                for (place, lanes) in places.iter().zip(&mut *sums) {
                    if let Some(sum) = call.sums.get_mut(*place) {
                        for lane in lanes.to_array() {
                            *sum += f64::from(lane);
                        }
                    }
                    *lanes = f32x8::ZERO;
                }
            }
        }
    }
}

/// A model of the list, with its derivatives. Sealed.
pub trait Differentiable: Registered + sealed::Sealed {
    /// Names of the numbers of a material, as fields of [`Model::Material`](hairis::model::Model::Material): `beta[1]`.
    const MATERIAL: &'static [&'static str];

    /// Derivatives by the numbers of the parameters, in the order of their fields, of the weighted sum of a material's numbers.
    #[doc(hidden)]
    fn by_parameters(
        params: impl IntoIterator<Item = f32>,
        weights: impl IntoIterator<Item = f32>,
    ) -> impl Iterator<Item = f32>;

    /// Computes the derivatives of a call, of value and density if `HAS_PDF`.
    #[doc(hidden)]
    fn run<const HAS_PDF: bool>(
        call: sealed::Rows<'_, '_, '_>,
        material: &Self::Material<f32>,
        level: Level,
    );
}

pub(crate) mod sealed {
    use crate::columns::Call;

    /// Keeps the models in the list.
    pub trait Sealed {}

    /// The columns of a call.
    #[derive(Debug)]
    pub struct Rows<'c, 'a, 'b>(pub(crate) &'c mut Call<'a, 'b>);
}

/// Runs the derivatives `G`, which read the numbers at these places of all numbers of a material. Compiled once per program.
#[inline(never)]
fn run<G: Rows<N, R>, const N: usize, const R: usize>(
    call: &mut Call<'_, '_>,
    all: &[f32],
    places: &'static [usize],
    level: Level,
) {
    let mut memory = Memory {
        material: [0.0; N],
        input: [f32x8::ZERO; INPUTS],
        out: [f32x8::ZERO; R],
        sums: [f32x8::ZERO; N],
    };
    for (number, place) in memory.material.iter_mut().zip(places) {
        *number = all[*place];
    }
    level.run(Hits::<G, N, R> {
        call,
        memory: &mut memory,
        places,
        rows: PhantomData,
    });
}

/// Work on a model of the list as a type with derivatives: see [`visit`].
pub trait Visitor {
    /// Result of the work.
    type Output;

    /// Does the work on the model `M`.
    fn visit<M: Differentiable>(self) -> Self::Output;
}

macro_rules! differentiable {
    ($($(#[$doc:meta])* $variant:ident: $model:ty;)*) => {
        /// Calls `visitor` with the model's type, as [`ModelId::visit`] does.
        #[inline]
        pub fn visit<V: Visitor>(id: ModelId, visitor: V) -> V::Output {
            match id {
                $(ModelId::$variant => visitor.visit::<$model>(),)*
                _ => unreachable!("the list has every model"),
            }
        }

        $(
        impl sealed::Sealed for $model {}

        impl Differentiable for $model {
            const MATERIAL: &'static [&'static str] = models::$variant::MATERIAL;

            #[inline]
            fn by_parameters(
                params: impl IntoIterator<Item = f32>,
                weights: impl IntoIterator<Item = f32>,
            ) -> impl Iterator<Item = f32> {
                let (mut m, mut v) = ([0.0; models::$variant::PARAMETERS], [0.0; Self::MATERIAL.len()]);
                m.iter_mut().zip(params).for_each(|(to, x)| *to = x);
                v.iter_mut().zip(weights).for_each(|(to, x)| *to = x);
                models::$variant::by_parameters(&m, &v).into_iter()
            }

            #[inline]
            fn run<const HAS_PDF: bool>(
                call: sealed::Rows<'_, '_, '_>,
                material: &Self::Material<f32>,
                level: Level,
            ) {
                use models::$variant::{VALUE, VALUE_PDF, Value, ValuePdf};
                let mut all = [0.0; Self::MATERIAL.len()];
                let mut numbers = all.iter_mut();
                material.visit(&Path::Root, &mut |_, number| {
                    if let Some(to) = numbers.next() {
                        *to = number;
                    }
                });
                if const { HAS_PDF } {
                    run::<ValuePdf, { ValuePdf::N }, { ValuePdf::R }>(call.0, &all, VALUE_PDF, level);
                } else {
                    run::<Value, { Value::N }, { Value::R }>(call.0, &all, VALUE, level);
                }
            }
        }
        )*
    };
}
hairis_variants::for_each_model! { differentiable }
