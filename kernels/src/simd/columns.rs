//! Rows of numbers over columns: slices of one length, which every call checks once.
#![allow(
    unsafe_code,
    reason = "a check per packet and column is most of what a short call costs"
)]

use super::lanes::{Lanes, Packet};
use core::marker::PhantomData;
use core::mem::MaybeUninit;
use core::ptr;

/// Computation of `N` numbers from `I` numbers, on any lanes, for columns: see [`Level::run_rows`](crate::simd::Level::run_rows).
pub trait Row<const I: usize, const N: usize>: Copy {
    /// True if columns may be left out. An empty input other than the first then reads as 0, and an empty output is not written.
    const OPTIONAL: bool = false;
    /// True if inputs may be left out as well, where columns may.
    const OPTIONAL_INPUTS: bool = Self::OPTIONAL;
    /// True if two packets are computed side by side. Set it to false if their code together would not fit the CPU's instruction
    /// cache.
    const PAIRS: bool = true;

    /// Computes the output of each lane. Mark this function and every function it calls `#[inline(always)]`.
    fn row<L: Lanes>(self, input: [L; I]) -> [L; N];
}

/// Runs `body` for every column `i` below `n`, without a loop, because compilers that optimise for size keep loops, and with them
/// the columns in memory.
macro_rules! each {
    ($i:ident < $n:ident, $body:expr) => {
        each!($i < $n, $body, 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14)
    };
    ($i:ident < $n:ident, $body:expr, $($column:literal)*) => {
        $(
            if const { $column < $n } {
                let $i = $column;
                $body;
            }
        )*
    };
}

/// Columns of `len` rows, as the addresses of that many numbers each.
#[derive(Clone, Copy)]
pub(crate) struct Columns<'a, const I: usize, const N: usize> {
    inputs: [*const f32; I],
    outputs: [*mut f32; N],
    len: usize,
    /// Bit set of the columns that are left out, the inputs first: the addresses of these columns are not used.
    absent: u32,
    slices: PhantomData<&'a mut [f32]>,
}

impl<'a, const I: usize, const N: usize> Columns<'a, I, N> {
    /// Takes the columns that are as long as the first input, and leaves out the others.
    #[inline(always)]
    pub(crate) fn some(inputs: &[&'a [f32]; I], outputs: &'a mut [&mut [f32]; N]) -> Self {
        let len = inputs[0].len();
        let mut columns = Self::empty(len);
        each!(i < I, {
            columns.inputs[i] = inputs[i].as_ptr();
            columns.absent |= u32::from(inputs[i].len() != len) << i;
        });
        each!(i < N, {
            columns.outputs[i] = outputs[i].as_mut_ptr();
            columns.absent |= u32::from(outputs[i].len() != len) << (I + i);
        });
        columns
    }

    #[inline(always)]
    fn empty(len: usize) -> Self {
        Self {
            inputs: [ptr::null(); I],
            outputs: [ptr::null_mut(); N],
            len,
            absent: 0,
            slices: PhantomData,
        }
    }

    /// Returns the columns from row `first` on.
    #[inline(always)]
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    fn after(&self, first: usize) -> Self {
        let mut columns = *self;
        each!(
            i < I,
            columns.inputs[i] = columns.inputs[i].wrapping_add(first)
        );
        each!(
            i < N,
            columns.outputs[i] = columns.outputs[i].wrapping_add(first)
        );
        columns.len -= first;
        columns
    }

    /// Calls `run` with the rows from `done` on and with the number of their packets of `W`, if there are any. Returns the number of
    /// rows done.
    ///
    /// The rest is less than a packet. If the rest is more than half of a packet, the last packet of rows is computed as well, which
    /// repeats some rows: a row is the same wherever it is computed.
    #[inline(always)]
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    pub(crate) fn in_packets<const W: usize>(
        &self,
        done: usize,
        run: impl Fn(&Self, usize),
    ) -> usize {
        let (packets, left) = ((self.len - done) / W, (self.len - done) % W);
        if packets > 0 {
            run(&self.after(done), packets);
        }
        if left <= W / 2 || self.len < W {
            return self.len - left;
        }
        run(&self.after(self.len - W), 1);
        self.len
    }

    /// Calls `run` with columns and the first of eight rows, for the rows from `done` on. The last eight rows include some that are
    /// done already. Fewer than eight rows in all are copied to the lanes from 0 on.
    #[inline(always)]
    pub(crate) fn in_eights(&self, done: usize, run: impl Fn(&Columns<'_, I, N>, usize)) {
        let len = self.len;
        if done == len {
            return;
        }
        let mut from = [[1.0_f32; 8]; I];
        let mut to = [const { MaybeUninit::<[f32; 8]>::uninit() }; N];
        let mut columns = *self;
        if len < 8 {
            each!(i < I, {
                if self.absent >> i & 1 == 0 {
                    // SAFETY: each column has `len` numbers, at most eight.
                    unsafe { copy(self.inputs[i], from[i].as_mut_ptr(), len) };
                }
                columns.inputs[i] = from[i].as_ptr();
            });
            each!(i < N, columns.outputs[i] = to[i].as_mut_ptr().cast());
            columns.len = 8;
        }
        // One call, so that the compiler makes one copy of the model.
        let last = columns.len - 8;
        let mut at = done.min(last);
        loop {
            run(&columns, at);
            if at == last {
                break;
            }
            at = (at + 8).min(last);
        }
        if len < 8 {
            each!(i < N, {
                if self.absent >> (I + i) & 1 == 0 {
                    // SAFETY: each column has `len` numbers, at most eight, and `run` wrote eight.
                    unsafe { copy(to[i].as_ptr().cast(), self.outputs[i], len) };
                }
            });
        }
    }

    /// Computes packets of `W` rows from the first row on. The loop has no branch but its own, unless columns may be left out. The
    /// compiler would move the computation of a result past a branch that decides whether the result is written, and thus compute
    /// all of one packet of a pair before the other.
    ///
    /// # Safety
    ///
    /// There are as many packets.
    #[inline(always)]
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    pub(crate) unsafe fn packets<R: Row<I, N>, L: Packet<W>, const W: usize>(
        &self,
        row: R,
        packets: usize,
    ) {
        let columns = *self;
        for packet in 0..packets {
            // SAFETY: there are as many packets.
            unsafe { columns.packet::<R, L, W>(row, packet * W) };
        }
    }

    /// Computes the `W` rows that begin at row `at`.
    ///
    /// # Safety
    ///
    /// There are as many rows.
    #[inline(always)]
    pub(crate) unsafe fn packet<R: Row<I, N>, L: Packet<W>, const W: usize>(
        &self,
        row: R,
        at: usize,
    ) {
        const { assert!(I <= 15 && N <= 15, "every column is read or written") };
        let mut input = [L::splat(0.0); I];
        each!(i < I, {
            if !R::OPTIONAL_INPUTS || self.absent >> i & 1 == 0 {
                // SAFETY: the column has these rows.
                input[i] = L::read_fresh(unsafe { &*self.inputs[i].add(at).cast() });
            }
        });
        let row = row.row::<L>(input);
        each!(i < N, {
            if !R::OPTIONAL || self.absent >> (I + i) & 1 == 0 {
                // SAFETY: as above, and nothing else refers to the column.
                row[i].write(unsafe { &mut *self.outputs[i].add(at).cast() });
            }
        });
    }
}

/// Columns of a call in the making: outputs are added, or left out, one after the other.
pub(crate) struct Naming<'a, const I: usize, const N: usize> {
    columns: Columns<'a, I, N>,
    /// 0 if all columns so far are of one length. Bits are collected instead of branches, because the check is most of the cost of a
    /// short slice.
    differ: usize,
}

impl<'a, const I: usize, const N: usize> Naming<'a, I, N> {
    #[inline(always)]
    pub(crate) fn new(inputs: &[&'a [f32]; I]) -> Self {
        let len = inputs[0].len();
        let (mut columns, mut differ) = (Columns::empty(len), 0);
        each!(i < I, {
            columns.inputs[i] = inputs[i].as_ptr();
            differ |= inputs[i].len() ^ len;
        });
        Self { columns, differ }
    }

    /// Adds the outputs from place `at` on, or leaves them out.
    #[inline(always)]
    pub(crate) fn output<const K: usize>(
        mut self,
        at: usize,
        outputs: Option<[&'a mut [f32]; K]>,
    ) -> Self {
        if let Some(outputs) = outputs {
            each!(i < K, {
                self.columns.outputs[at + i] = outputs[i].as_mut_ptr();
                self.differ |= outputs[i].len() ^ self.columns.len;
            });
        } else {
            self.columns.absent |= ((1 << K) - 1) << (I + at);
        }
        self
    }

    /// Returns the columns, or `None` if they differ in length.
    #[inline(always)]
    pub(crate) fn all(self) -> Option<Columns<'a, I, N>> {
        (self.differ == 0).then_some(self.columns)
    }
}

/// Copies `len` numbers, at most 8.
///
/// # Safety
///
/// Both have `len` numbers.
#[inline(always)]
unsafe fn copy(from: *const f32, to: *mut f32, len: usize) {
    // SAFETY: the caller's.
    unsafe {
        match len {
            4.. => copy_halves::<4>(from, to, len - 4),
            2.. => copy_halves::<2>(from, to, len - 2),
            _ => *to = *from,
        }
    }
}

/// Copies the first `HALF` of `rest + HALF` numbers, and the last `HALF`. A loop, and even more so the system's copy, costs several
/// times as much.
///
/// # Safety
///
/// Both have that many numbers, and `rest` is at most `HALF`.
#[inline(always)]
unsafe fn copy_halves<const HALF: usize>(from: *const f32, to: *mut f32, rest: usize) {
    // SAFETY: the caller's.
    unsafe {
        *to.cast::<[f32; HALF]>() = *from.cast::<[f32; HALF]>();
        *to.add(rest).cast::<[f32; HALF]>() = *from.add(rest).cast::<[f32; HALF]>();
    }
}

/// Copies the first numbers of `from` to `to`: as many as both have, at most 8.
#[inline(always)]
pub(crate) fn copy_few(from: &[f32], to: &mut [f32]) {
    let len = from.len().min(to.len()).min(8);
    if len > 0 {
        // SAFETY: both have `len` numbers.
        unsafe { copy(from.as_ptr(), to.as_mut_ptr(), len) }
    }
}
