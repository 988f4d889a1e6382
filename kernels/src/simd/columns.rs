//! Rows of numbers over slices: in whole packets and then eight at a time.
#![cfg_attr(
    not(any(target_arch = "x86", target_arch = "x86_64")),
    allow(dead_code, reason = "packets of other levels have more than eight lanes on these machines alone")
)]

use super::dispatch::{Kernel, Level};
use super::lanes::{Broadcast, Lanes, Packet, lanes3};
use core::{mem, slice};
use wide::f32x8;

/// Work of [`Level::run_rows`] over columns: three numbers in, `N` numbers out, whatever the lanes.
pub trait Row<const N: usize>: Copy {
    /// The numbers of each lane. Mark it `#[inline(always)]`, and all it calls.
    fn row<L: Lanes>(self, input: [L; 3]) -> [L; N]
    where
        f32: Broadcast<L>;

    /// The same of eight lanes, by [`Level::run`].
    #[inline(always)]
    fn eight(self, level: Level, input: &[f32x8; 3]) -> [f32x8; N] {
        level.run(Eight { row: self, input })
    }
}

/// One row of eight lanes.
struct Eight<'a, R, const N: usize> {
    row: R,
    input: &'a [f32x8; 3],
}

impl<R: Row<N>, const N: usize> Kernel for Eight<'_, R, N> {
    type Constant = f32;
    type Output = [f32x8; N];

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> [f32x8; N]
    where
        f32: Broadcast<L>,
        f32x8: Broadcast<L>,
    {
        let row = self.row.row::<L>(lanes3(self.input));
        let mut out = [f32x8::ZERO; N];
        let mut i = 0;
        while i < N {
            out[i] = row[i].store();
            i += 1;
        }
        out
    }
}

/// The loop of a batch over whole packets. Every column has as many packets as the first; were one shorter, none would
/// be written, for want of a branch that panics.
///
/// Columns are cut to one length before the loop, so that it has no other branch: the compiler moves the computation of
/// a result past the branch that decides on its being written, and with it all of one packet of a pair before the other.
#[inline(always)]
pub(crate) fn packets<R: Row<N>, L: Packet<W>, const N: usize, const W: usize>(
    row: R,
    [first, second, third]: [&[[f32; W]]; 3],
    outputs: &mut [&mut [[f32; W]]; N],
) where
    f32: Broadcast<L>,
{
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
                let row = row.row::<L>([L::read(&first[at]), L::read(&second[at]), L::read(&third[at])]);
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

/// Calls `run` on the whole packets of the slices. Returns the number of rows done.
///
/// The rest is less than a packet. If it is more than eight rows, or a packet is no more than eight, the last packet of
/// rows is computed once more: a row is the same wherever it is computed. Slices of less than a packet of eight fill its
/// first lanes.
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

/// Rows from `done` on, eight at a time; the last eight of the slices include some that are done already.
///
/// Slices of less than eight rows are lanes 0 on.
#[inline(always)]
pub(crate) fn in_eights<R: Row<N>, const N: usize>(
    level: Level,
    row: R,
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
        let lanes = row.eight(level, &from.map(f32x8::new));
        for (lanes, column) in lanes.iter().zip(outputs.iter_mut()) {
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
