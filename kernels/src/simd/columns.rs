//! Rows of numbers over slices: in whole packets and then eight at a time.
#![cfg_attr(
    not(any(target_arch = "x86", target_arch = "x86_64")),
    allow(dead_code, reason = "packets of other levels have more than eight lanes on these machines alone")
)]

use super::lanes::{Broadcast, Lanes, Packet};
use core::{array, mem, slice};

/// Work of [`Level::run_rows`](crate::Level::run_rows) over columns: `I` numbers in, `N` numbers out, whatever the lanes.
pub trait Row<const I: usize, const N: usize>: Copy {
    /// Whether columns may be left out. An empty input but the first then reads as 0, and an empty output is not written.
    const OPTIONAL: bool = false;

    /// The numbers of each lane. Mark it `#[inline(always)]`, and all it calls.
    fn row<L: Lanes>(self, input: [L; I]) -> [L; N]
    where
        f32: Broadcast<L>;
}

/// The loop of a batch over whole packets. Every column has as many packets as the first, or none where it may be left out;
/// were one shorter, none would be written, for want of a branch that panics.
///
/// Columns are cut to one length before the loop, so that it has no other branch: the compiler moves the computation of
/// a result past the branch that decides on its being written, and with it all of one packet of a pair before the other.
#[inline(always)]
pub(crate) fn packets<R: Row<I, N>, L: Packet<W>, const I: usize, const N: usize, const W: usize>(
    row: R,
    inputs: [&[[f32; W]]; I],
    outputs: &mut [&mut [[f32; W]]; N],
) where
    f32: Broadcast<L>,
{
    let len = inputs[0].len();
    // No loops over columns: compilers that save space leave them, and the row in memory.
    macro_rules! run {
        ([$($input:ident $i:literal)*] [$($output:ident $o:literal)*]) => {
            $(
                let $input = match inputs.get($i).map(|column| column.get(..len)) {
                    Some(Some(whole)) => whole,
                    Some(None) if !R::OPTIONAL => return,
                    _ => &[],
                };
            )*
            $(
                let $output = match outputs.get_mut($o).map(|column| mem::take(column).split_at_mut_checked(len)) {
                    Some(Some((whole, _))) => whole,
                    Some(None) if !R::OPTIONAL => return,
                    _ => &mut [],
                };
            )*
            for at in 0..len {
                let mut input = [L::splat(0.0); I];
                $(
                    if $i < I {
                        input[$i] = if !R::OPTIONAL {
                            L::read(&$input[at])
                        } else if let Some(from) = $input.get(at) {
                            L::read(from)
                        } else {
                            L::splat(0.0)
                        };
                    }
                )*
                let row = row.row::<L>(input);
                $(
                    if $o < N {
                        if !R::OPTIONAL {
                            row[$o].write(&mut $output[at]);
                        } else if let Some(to) = $output.get_mut(at) {
                            row[$o].write(to);
                        }
                    }
                )*
            }
        };
    }
    const { assert!(I <= 7 && N <= 11, "every column is read or written") };
    run!([a 0 b 1 c 2 d 3 e 4 f 5 g 6] [p 0 q 1 r 2 s 3 t 4 u 5 v 6 w 7 x 8 y 9 z 10]);
}

/// Calls `run` on the whole packets of the slices from row `done` on. Returns the number of rows done.
///
/// The rest is less than a packet. If it is more than half of one, or `all` of it is wanted, the last packet of rows is
/// computed once more: a row is the same wherever it is computed.
#[inline(always)]
pub(crate) fn in_packets<const I: usize, const N: usize, const W: usize>(
    inputs: [&[f32]; I],
    outputs: &mut [&mut [f32]; N],
    done: usize,
    all: bool,
    mut run: impl FnMut([&[[f32; W]]; I], &mut [&mut [[f32; W]]; N]),
) -> usize {
    let len = inputs[0].len();
    let rows = len.saturating_sub(done);
    if rows >= W {
        run(
            inputs.map(|column| column.get(done..).unwrap_or_default().as_chunks().0),
            &mut outputs.each_mut().map(|column| column.get_mut(done..).unwrap_or_default().as_chunks_mut().0),
        );
    }
    let left = rows % W;
    if left == 0 || len < W || (left <= W / 2 && !all) {
        return len - left;
    }
    let last = inputs.map(|column| column.last_chunk().map_or(&[][..], slice::from_ref));
    run(last, &mut outputs.each_mut().map(|column| column.last_chunk_mut().map_or(&mut [][..], slice::from_mut)));
    len
}

/// Calls `run` on the rows from `done` on, eight at a time.
///
/// The last eight include rows that are done already. Slices of less than eight rows are lanes 0 on.
#[inline(always)]
pub(crate) fn in_eights<const I: usize, const N: usize>(
    inputs: [&[f32]; I],
    outputs: &mut [&mut [f32]; N],
    done: usize,
    mut run: impl FnMut([&[[f32; 8]]; I], &mut [&mut [[f32; 8]]; N]),
) {
    let done = in_packets(inputs, outputs, done, true, &mut run);
    if done == inputs[0].len() {
        return;
    }
    let len = inputs[0].len();
    let mut from = [[0.0; 8]; I];
    match len {
        4.. => read_few::<4, I>(&inputs, &mut from, len),
        2.. => read_few::<2, I>(&inputs, &mut from, len),
        _ => read_few::<1, I>(&inputs, &mut from, len),
    }
    // Not zeros, which compilers write by a call of memset.
    const FILL: [f32; 8] = [1.0; 8];
    let mut to = [FILL; N];
    run(array::from_fn(|column| slice::from_ref(&from[column])), &mut to.each_mut().map(slice::from_mut));
    match len {
        4.. => write_few::<4, N>(&to, outputs, len),
        2.. => write_few::<2, N>(&to, outputs, len),
        _ => write_few::<1, N>(&to, outputs, len),
    }
}

/// Copies `len` rows into lanes; `HALF` is at least half of it.
#[inline(always)]
fn read_few<const HALF: usize, const I: usize>(columns: &[&[f32]; I], lanes: &mut [[f32; 8]; I], len: usize) {
    let mut column = 0;
    while column < I {
        copy_halves::<HALF>(columns[column], &mut lanes[column], len);
        column += 1;
    }
}

/// Copies `len` rows from lanes; `HALF` is at least half of it.
#[inline(always)]
fn write_few<const HALF: usize, const N: usize>(lanes: &[[f32; 8]; N], columns: &mut [&mut [f32]; N], len: usize) {
    let mut column = 0;
    while column < N {
        copy_halves::<HALF>(&lanes[column], columns[column], len);
        column += 1;
    }
}

/// Copies `len` numbers, at most 8.
#[inline(always)]
pub(crate) fn copy(from: &[f32], to: &mut [f32], len: usize) {
    match len {
        4.. => copy_halves::<4>(from, to, len),
        2.. => copy_halves::<2>(from, to, len),
        _ => copy_halves::<1>(from, to, len),
    }
}

/// Copies the first `HALF` of `len` numbers, and the last: of fixed length each. A loop, and the system's copy all the more,
/// costs several times as much.
#[inline(always)]
fn copy_halves<const HALF: usize>(from: &[f32], to: &mut [f32], len: usize) {
    let (Some(from), Some(to)) = (from.get(..len), to.get_mut(..len)) else { return };
    let Some(rest) = len.checked_sub(HALF) else { return };
    if let (Some(from), Some(to)) = (from.first_chunk::<HALF>(), to.first_chunk_mut()) {
        *to = *from;
    }
    let (Some(from), Some(to)) = (from.get(rest..), to.get_mut(rest..)) else { return };
    if let (Some(from), Some(to)) = (from.first_chunk::<HALF>(), to.first_chunk_mut()) {
        *to = *from;
    }
}
