//! What runs over slices: rows of numbers, in whole packets and then eight at a time.
#![cfg_attr(
    not(any(target_arch = "x86", target_arch = "x86_64")),
    allow(dead_code, reason = "packets of other levels have more than eight lanes on these machines alone")
)]

use crate::dispatch::{self, Level};
use crate::lanes::Packet;
use crate::model::{Drawn, Eval8};
use crate::{Broadcast, Lanes, Model, Vec3x};
use core::fmt::Debug;
use core::{mem, slice};
use wide::f32x8;

/// What a batch computes of three numbers a lane: `N` numbers a lane.
pub(crate) trait Row<const N: usize> {
    fn row<M: Model, L: Lanes, C: Broadcast<L> + Debug>(gather: &M::Gather<C>, input: [L; 3]) -> [L; N];
    /// The same of eight lanes, by the entry point of packets.
    fn eight<M: Model>(level: Level, gather: &M::Gather<f32>, input: &[f32x8; 3]) -> [f32x8; N];
}

/// Value and density of eight directions.
#[inline(always)]
fn eval8<M: Model>(level: Level, gather: &M::Gather<f32>, [x, y, z]: &[f32x8; 3]) -> Eval8 {
    dispatch::eval8::<M, f32>(level, gather, &Vec3x::new(*x, *y, *z))
}

/// The value alone: what only the density needs is not computed.
pub(crate) struct ValueRow;
impl Row<3> for ValueRow {
    #[inline(always)]
    fn row<M: Model, L: Lanes, C: Broadcast<L> + Debug>(gather: &M::Gather<C>, [x, y, z]: [L; 3]) -> [L; 3] {
        M::eval::<L, C>(gather, Vec3x::new(x, y, z)).value
    }
    #[inline(always)]
    fn eight<M: Model>(level: Level, gather: &M::Gather<f32>, input: &[f32x8; 3]) -> [f32x8; 3] {
        eval8::<M>(level, gather, input).value
    }
}

/// The density alone.
pub(crate) struct PdfRow;
impl Row<1> for PdfRow {
    #[inline(always)]
    fn row<M: Model, L: Lanes, C: Broadcast<L> + Debug>(gather: &M::Gather<C>, [x, y, z]: [L; 3]) -> [L; 1] {
        [M::eval::<L, C>(gather, Vec3x::new(x, y, z)).pdf]
    }
    #[inline(always)]
    fn eight<M: Model>(level: Level, gather: &M::Gather<f32>, input: &[f32x8; 3]) -> [f32x8; 1] {
        [eval8::<M>(level, gather, input).pdf]
    }
}

pub(crate) struct EvalRow;
impl Row<4> for EvalRow {
    #[inline(always)]
    fn row<M: Model, L: Lanes, C: Broadcast<L> + Debug>(gather: &M::Gather<C>, [x, y, z]: [L; 3]) -> [L; 4] {
        let eval = M::eval::<L, C>(gather, Vec3x::new(x, y, z));
        let [r, g, b] = eval.value;
        [r, g, b, eval.pdf]
    }
    #[inline(always)]
    fn eight<M: Model>(level: Level, gather: &M::Gather<f32>, input: &[f32x8; 3]) -> [f32x8; 4] {
        let eval = eval8::<M>(level, gather, input);
        let [r, g, b] = eval.value;
        [r, g, b, eval.pdf]
    }
}

/// The numbers of a sample in the order of its slices.
#[inline(always)]
fn columns<L>(s: Drawn<L>) -> [L; 11] {
    let ([r, g, b], [wr, wg, wb]) = (s.value, s.weight);
    [s.wi.x, s.wi.y, s.wi.z, r, g, b, s.pdf, wr, wg, wb, s.slot]
}

pub(crate) struct SampleRow;
impl Row<11> for SampleRow {
    #[inline(always)]
    fn row<M: Model, L: Lanes, C: Broadcast<L> + Debug>(gather: &M::Gather<C>, xi: [L; 3]) -> [L; 11] {
        columns(M::sample::<L, C>(gather, xi))
    }
    #[inline(always)]
    fn eight<M: Model>(level: Level, gather: &M::Gather<f32>, xi: &[f32x8; 3]) -> [f32x8; 11] {
        columns(dispatch::sample8::<M, f32>(level, gather, xi))
    }
}

/// The loop of a batch over whole packets. Every column has as many packets as the first; were one shorter, none would
/// be written, for want of a branch that panics.
///
/// Columns are cut to one length before the loop, so that it has no branch but its own: the compiler moves what leads to
/// a result past the branch that decides on its being written, and with it all of one packet of a pair before the other.
#[inline(always)]
pub(crate) fn packets<M: Model, R: Row<N>, L: Packet<W>, C: Broadcast<L> + Debug, const N: usize, const W: usize>(
    gather: &M::Gather<C>,
    [first, second, third]: [&[[f32; W]]; 3],
    outputs: &mut [&mut [[f32; W]]; N],
) {
    let len = first.len();
    let (Some(second), Some(third)) = (second.get(..len), third.get(..len)) else { return };
    // No loops over columns: compilers that save space leave them, and the row in memory.
    macro_rules! run {
        ($($column:ident $index:literal)*) => {
            $(
                let $column = match outputs.get_mut($index).map(|column| mem::take(column).split_at_mut_checked(len)) {
                    Some(Some((whole, _))) => whole,
                    Some(None) => return,
                    None => &mut [],
                };
            )*
            for at in 0..len {
                let row = R::row::<M, L, C>(gather, [L::read(&first[at]), L::read(&second[at]), L::read(&third[at])]);
                $(
                    if $index < N {
                        row[$index].write(&mut $column[at]);
                    }
                )*
            }
        };
    }
    const { assert!(N <= 11, "every column is written") };
    run!(a 0 b 1 c 2 d 3 e 4 f 5 g 6 h 7 i 8 j 9 k 10);
}

/// Cuts slices into whole packets, on which `run` is called, and says how many rows are done then.
///
/// What is left is less than a packet. If it is more than eight rows, or a packet is no more than eight, the last rows of
/// the slices are a packet once more: a row is the same wherever it is computed. Slices of less than a packet of eight are
/// its first lanes.
#[inline(always)]
pub(crate) fn in_packets<const N: usize, const W: usize>(
    inputs: [&[f32]; 3],
    outputs: &mut [&mut [f32]; N],
    mut run: impl FnMut([&[[f32; W]]; 3], &mut [&mut [[f32; W]]; N]),
) -> usize {
    let len = inputs[0].len();
    if len >= W {
        run(inputs.map(|column| column.as_chunks().0), &mut outputs.each_mut().map(|column| column.as_chunks_mut().0));
        let left = len % W;
        if left == 0 || (W > 8 && left <= 8) {
            return len - left;
        }
        let last = inputs.map(|column| column.last_chunk().map_or(&[][..], slice::from_ref));
        run(last, &mut outputs.each_mut().map(|column| column.last_chunk_mut().map_or(&mut [][..], slice::from_mut)));
    } else if W == 8 && len > 0 {
        let mut from = [[0.0; W]; 3];
        for (to, column) in from.iter_mut().zip(inputs) {
            copy(column, to);
        }
        let mut to = [[0.0; W]; N];
        run(from.each_ref().map(slice::from_ref), &mut to.each_mut().map(slice::from_mut));
        for (from, column) in to.iter().zip(outputs) {
            copy(from, column);
        }
    } else {
        return 0;
    }
    len
}

/// Rows from `done` on, eight at a time; the last eight of the slices take in some that are done already.
///
/// Slices of less than eight rows are lanes 0 on.
#[inline(always)]
pub(crate) fn in_eights<M: Model, R: Row<N>, const N: usize>(
    level: Level,
    gather: &M::Gather<f32>,
    inputs: [&[f32]; 3],
    outputs: &mut [&mut [f32]; N],
    mut done: usize,
) {
    let len = inputs[0].len();
    while done < len {
        let start = done.min(len.saturating_sub(8));
        let mut from = [[0.0; 8]; 3];
        for (to, column) in from.iter_mut().zip(&inputs) {
            copy(column.get(start..).unwrap_or_default(), to);
        }
        let row = R::eight::<M>(level, gather, &from.map(f32x8::new));
        for (lanes, column) in row.iter().zip(outputs.iter_mut()) {
            copy(lanes.as_array(), column.get_mut(start..).unwrap_or_default());
        }
        done = start + 8;
    }
}

/// Copies eight numbers, or as many as the shorter has. In pieces of fixed length: a loop, and the system's copy all the
/// more, costs several times as much.
#[inline(always)]
fn copy(from: &[f32], to: &mut [f32]) {
    if let (Some(from), Some(to)) = (from.first_chunk::<8>(), to.first_chunk_mut::<8>()) {
        *to = *from;
        return;
    }
    let len = from.len().min(to.len());
    let (Some(from), Some(to)) = (from.get(..len), to.get_mut(..len)) else { return };
    // Two halves that overlap.
    macro_rules! halves {
        ($half:literal) => {
            if let (Some(first), Some(last)) = (from.first_chunk::<$half>(), from.last_chunk::<$half>()) {
                if let Some(to) = to.first_chunk_mut() {
                    *to = *first;
                }
                if let Some(to) = to.last_chunk_mut() {
                    *to = *last;
                }
                return;
            }
        };
    }
    halves!(4);
    halves!(2);
    halves!(1);
}
