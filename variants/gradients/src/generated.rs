//! Generated derivatives, and the models that have them.

use crate::columns::{Call, GROUP, INPUTS, OUTPUTS, finite_or_0};
use core::cell::Cell;
use core::marker::PhantomData;
use hairis::f32x8;
use hairis::simd::{Kernel, LaneStruct, Lanes, Level, Path};
use hairis::{Gaussian, Matched, Published};
use hairis_variants::{AllCauchy, Cauchy, Chiang, DEon, KajiyaKay, ModelId, Registered};

/// Packets whose derivatives are summed in single precision.
const BLOCK: usize = 64;
/// Packets that take turns: each chunk of operations runs over all of them before the next chunk does. The numbers that they keep in
/// between should stay in the second level of cache.
const TURNS: usize = 4;

/// Number that all lanes share.
#[derive(Clone, Copy, Debug)]
enum Slot {
    /// A number of a material, given by its place.
    Number(usize),
    /// The bits of a constant.
    Constant(u32),
}

/// Derivatives that read `S` shared numbers, and have a sum for each of `N` numbers of a material. They keep `K` numbers of a packet, of
/// which the inputs and the outputs come first.
trait Rows<const S: usize, const N: usize, const K: usize> {
    /// Shared numbers. They are kept in memory, where instructions read them, because compilers would load constants into registers one
    /// at a time.
    const SLOTS: &'static [Slot; S];
    /// Computes the results and the derivatives by the hit from the inputs of each packet. Derivatives by the material are added to
    /// `sums`, and `finite` stays finite if all derivatives by the hit are finite.
    fn rows<L: Lanes<Stored = f32x8>>(
        shared: &[f32x8; S],
        packets: &mut [[f32x8; K]],
        sums: &mut [f32x8; N],
        finite: &mut f32x8,
    );
}

mod models {
    #![allow(
        clippy::all,
        clippy::pedantic,
        non_snake_case,
        unused,
        reason = "generated: one line per operation"
    )]
    use super::{INPUTS, OUTPUTS, Rows, Slot, at, upper};
    use hairis::f32x8;
    use hairis::simd::Lanes;
    macro_rules! sources {
        ($($(#[$doc:meta])* $variant:ident: $model:ty;)*) => {
            $(include!(concat!(env!("OUT_DIR"), "/", stringify!($variant), ".rs"));)*
        };
    }
    hairis_variants::for_each_model! { sources }
}

/// Loads a kept number. Compilers check a call faster than an index and a reference, of which there are ten thousand.
#[inline(always)]
fn at<L: Lanes<Stored = f32x8>, const K: usize>(kept: &[f32x8; K], place: usize) -> L {
    L::load(&kept[place])
}

/// Clears the lower 12 bits of the numbers. Lanes that do not fuse need this operation.
#[inline(always)]
fn upper<L: Lanes<Stored: Upper>>(x: L) -> L {
    L::load(&x.store().upper())
}

/// Stored lanes whose bits can be taken apart.
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

/// Kernel that computes derivatives for full packets of hits.
struct Hits<'c, G, const S: usize, const N: usize, const K: usize> {
    shared: &'c [f32x8; S],
    /// Room for packets that take turns.
    kept: &'c mut [[f32x8; K]],
    inputs: [&'c [[f32; 8]]; INPUTS],
    outputs: [&'c [Cell<[f32; 8]>]; OUTPUTS],
    sums: &'c mut [f32x8; N],
    finite: &'c mut f32x8,
    rows: PhantomData<G>,
}

impl<G: Rows<S, N, K>, const S: usize, const N: usize, const K: usize> Kernel
    for Hits<'_, G, S, N, K>
{
    type Output = ();
    // In chunks of this size 32 registers save less than 2% of the time, and compiling all models once more takes longest.
    const MANY_REGISTERS: bool = false;

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) {
        let packets = self.inputs[0].len();
        let mut at = 0;
        while at < packets {
            // Each column has the packets; an index would leave a panic in the code.
            let few = at..packets.min(at + self.kept.len());
            let Some(kept) = self.kept.get_mut(..few.len()) else {
                return;
            };
            for (place, column) in self.inputs.iter().enumerate() {
                let column = column.get(few.clone()).unwrap_or_default();
                for (k, numbers) in kept.iter_mut().zip(column) {
                    k[place] = f32x8::new(*numbers);
                }
            }
            G::rows::<L>(self.shared, kept, self.sums, self.finite);
            for (place, column) in self.outputs.iter().enumerate() {
                let column = column.get(few.clone()).unwrap_or_default();
                for (k, numbers) in kept.iter().zip(column) {
                    numbers.set(k[INPUTS + place].to_array());
                }
            }
            at = few.end;
        }
    }
}

/// Model of the list that has generated derivatives. Sealed.
pub trait Differentiable: Registered + sealed::Sealed {
    /// Names of the numbers of a material, as fields of [`Model::Material`](hairis::model::Model::Material): `beta[1]`.
    const MATERIAL: &'static [&'static str];

    /// Computes the derivatives of the weighted sum of a material's numbers by the numbers of the parameters, in the order of their
    /// fields.
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

    /// Seals [`Differentiable`](super::Differentiable) to the models of the list.
    pub trait Sealed {}

    /// Columns of a call, in a type that other crates cannot make.
    #[derive(Debug)]
    pub struct Rows<'c, 'a, 'b>(pub(crate) &'c mut Call<'a, 'b>);
}

/// Runs the derivatives `G`, whose sums belong to the numbers at these places among all numbers of a material.
#[inline]
fn run<G: Rows<S, N, K>, const S: usize, const N: usize, const K: usize>(
    call: &mut Call<'_, '_>,
    all: &[f32],
    places: &'static [usize],
    level: Level,
) {
    // A call of one packet does not clear the room of several.
    if call.len <= 8 {
        with_room::<G, S, N, K, 1>(call, all, places, level);
    } else {
        with_room::<G, S, N, K, TURNS>(call, all, places, level);
    }
}

/// Provides room for `PACKETS` packets on the stack. Each size is a function with a stack frame of its own.
#[inline(never)]
fn with_room<
    G: Rows<S, N, K>,
    const S: usize,
    const N: usize,
    const K: usize,
    const PACKETS: usize,
>(
    call: &mut Call<'_, '_>,
    all: &[f32],
    places: &'static [usize],
    level: Level,
) {
    run_in::<G, S, N, K>(&mut [[f32x8::ZERO; K]; PACKETS], call, all, places, level);
}

/// Runs the derivatives in this room. Compiled once per program.
#[inline(never)]
fn run_in<G: Rows<S, N, K>, const S: usize, const N: usize, const K: usize>(
    kept: &mut [[f32x8; K]],
    call: &mut Call<'_, '_>,
    all: &[f32],
    places: &'static [usize],
    level: Level,
) {
    let shared = G::SLOTS.map(|slot| {
        f32x8::splat(match slot {
            Slot::Number(place) => all[place],
            Slot::Constant(bits) => f32::from_bits(bits),
        })
    });
    let mut sums = [f32x8::ZERO; N];
    let (mut at, mut alone_until) = (0, if call.has_each() { call.len } else { 0 });
    while at < call.len {
        // Derivatives that are not finite count as 0. They are rare: packets whose sums are not finite are computed again, each alone.
        let is_alone = at < alone_until;
        let mut rows = if is_alone {
            // Adding to -0 changes no bit.
            [f32x8::splat(-0.0); N]
        } else {
            sums
        };
        let mut finite = f32x8::ZERO;
        let most = if is_alone { 1 } else { GROUP };
        let count = call.packets(at, most, |inputs, outputs| {
            level.run(Hits::<G, S, N, K> {
                shared: &shared,
                kept: &mut *kept,
                inputs,
                outputs,
                sums: &mut rows,
                finite: &mut finite,
                rows: PhantomData,
            });
        });
        if is_alone {
            for (sum, row) in sums.iter_mut().zip(&mut rows) {
                *row = f32x8::new(row.to_array().map(finite_or_0));
                *sum += *row;
            }
            call.finish(at, places, &rows);
        } else if is_finite(
            &rows
                .iter()
                .fold(finite, |all, row| all + *row * f32x8::ZERO),
        ) {
            sums = rows;
        } else {
            alone_until = at + 8 * count;
            continue;
        }
        at += 8 * count;
        if at % (8 * BLOCK) == 0 || at >= call.len {
            for (place, lanes) in places.iter().zip(&mut sums) {
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

fn is_finite(lanes: &f32x8) -> bool {
    lanes.to_array().into_iter().all(f32::is_finite)
}

/// Operation on a model of the list whose type has derivatives, which [`visit`] calls with that type.
pub trait Visitor {
    /// Result of the operation.
    type Output;

    /// Performs the operation on the model `M`.
    fn visit<M: Differentiable>(self) -> Self::Output;
}

macro_rules! differentiable {
    ($($(#[$doc:meta])* $variant:ident: $model:ty;)*) => {
        /// Calls `visitor` with the type of the model `id`, as [`ModelId::visit`] does.
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
                    run::<ValuePdf, { ValuePdf::S }, { ValuePdf::N }, { ValuePdf::K }>(call.0, &all, VALUE_PDF, level);
                } else {
                    run::<Value, { Value::S }, { Value::N }, { Value::K }>(call.0, &all, VALUE, level);
                }
            }
        }
        )*
    };
}
hairis_variants::for_each_model! { differentiable }
