//! Slices in, slices out: structures of arrays of any length and alignment.
//!
//! Slices whose addresses differ by a multiple of 4 KiB, as those of columns a power of two long do, cost up to 40 % more
//! on many CPUs: a load waits for an earlier store whose address has the same lower twelve bits. A few unused numbers
//! between columns avoid it.

use crate::dispatch::{self, Level};
use crate::lanes::Packet;
use crate::{Broadcast, Gather, Lanes, Model, Vec3x};
use core::fmt::{self, Debug};
use core::mem;

/// Slices of one call whose lengths differ: which, how long it is, and how long the first is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthError {
    /// Name of the slice at fault.
    pub field: &'static str,
    /// Its length.
    pub len: usize,
    /// Length of the first slice, which all others must have.
    pub expected: usize,
}

impl fmt::Display for LengthError {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { field, len, expected } = self;
        write!(f, "{field} has {len} entries where the first slice has {expected}")
    }
}

impl core::error::Error for LengthError {}

/// Where [`Gather::eval_pdf_batch`] writes: one entry a direction.
#[derive(Debug)]
pub struct EvalSlices<'a> {
    /// S, red, green and blue, per steradian.
    pub value: [&'a mut [f32]; 3],
    /// Density, per steradian.
    pub pdf: &'a mut [f32],
}

/// Where [`Gather::sample_batch`] writes: one entry a sample, all 0 but the direction for a discarded one.
#[derive(Debug)]
pub struct SampleSlices<'a> {
    /// Towards the light, in the fibre's frame: u, v, w.
    pub wi: [&'a mut [f32]; 3],
    /// S, red, green and blue, per steradian.
    pub value: [&'a mut [f32]; 3],
    /// Density, per steradian.
    pub pdf: &'a mut [f32],
    /// `value * cos theta_i / pdf`, red, green and blue.
    pub weight: [&'a mut [f32]; 3],
    /// Slot of the chosen lobe as a number, -1 for a discarded sample.
    pub slot: &'a mut [f32],
}

impl<M: Model> Gather<M> {
    /// Value and density of many directions: `wi` by component u, v, w.
    ///
    /// Nothing is read or written beyond the slices, which may be of any length and alignment.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    ///
    /// ```
    /// use hairis::{Bsdf, EvalSlices, Gaussian, Hair, HairParams};
    /// let gather = Bsdf::new(&Hair(Gaussian), &HairParams::default()).prepare(glam::Vec3::Y);
    /// let wi = [[0.0; 11], [0.6; 11], [0.8; 11]];
    /// let (mut value, mut pdf) = ([[0.0; 11]; 3], [0.0; 11]);
    /// let [r, g, b] = &mut value;
    /// gather.eval_pdf_batch([&wi[0], &wi[1], &wi[2]], EvalSlices { value: [r, g, b], pdf: &mut pdf })?;
    /// assert!(pdf.iter().all(|pdf| *pdf > 0.0));
    /// # Ok::<(), hairis::LengthError>(())
    /// ```
    #[inline]
    pub fn eval_pdf_batch(&self, wi: [&[f32]; 3], out: EvalSlices<'_>) -> Result<(), LengthError> {
        self.eval_pdf_batch_at(Level::detect(), wi, out)
    }

    /// As [`eval_pdf_batch`](Self::eval_pdf_batch), on a given instruction set.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn eval_pdf_batch_at(&self, level: Level, wi: [&[f32]; 3], out: EvalSlices<'_>) -> Result<(), LengthError> {
        dispatch::clean_upper_halves();
        let [r, g, b] = out.value;
        let mut out = [r, g, b, out.pdf];
        check_lengths(WI, wi, ["value.r", "value.g", "value.b", "pdf"], &out)?;
        dispatch::batch::<M, EvalRow, 4>(level, &self.inner, wi, &mut out);
        Ok(())
    }

    /// Value of many directions, without their densities: `wi` by component u, v, w; `value` red, green and blue.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn eval_batch(&self, wi: [&[f32]; 3], value: [&mut [f32]; 3]) -> Result<(), LengthError> {
        self.eval_batch_at(Level::detect(), wi, value)
    }

    /// As [`eval_batch`](Self::eval_batch), on a given instruction set.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn eval_batch_at(&self, level: Level, wi: [&[f32]; 3], value: [&mut [f32]; 3]) -> Result<(), LengthError> {
        dispatch::clean_upper_halves();
        let mut out = value;
        check_lengths(WI, wi, VALUE, &out)?;
        dispatch::batch::<M, ValueRow, 3>(level, &self.inner, wi, &mut out);
        Ok(())
    }

    /// Density of many directions, without their values: `wi` by component u, v, w.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn pdf_batch(&self, wi: [&[f32]; 3], pdf: &mut [f32]) -> Result<(), LengthError> {
        self.pdf_batch_at(Level::detect(), wi, pdf)
    }

    /// As [`pdf_batch`](Self::pdf_batch), on a given instruction set.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn pdf_batch_at(&self, level: Level, wi: [&[f32]; 3], pdf: &mut [f32]) -> Result<(), LengthError> {
        dispatch::clean_upper_halves();
        let mut out = [pdf];
        check_lengths(WI, wi, ["pdf"], &out)?;
        dispatch::batch::<M, PdfRow, 1>(level, &self.inner, wi, &mut out);
        Ok(())
    }

    /// Many samples: `xi` by component, for the lobe, the longitude and the azimuth, each in `[0, 1)`.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn sample_batch(&self, xi: [&[f32]; 3], out: SampleSlices<'_>) -> Result<(), LengthError> {
        self.sample_batch_at(Level::detect(), xi, out)
    }

    /// As [`sample_batch`](Self::sample_batch), on a given instruction set.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    #[inline]
    pub fn sample_batch_at(&self, level: Level, xi: [&[f32]; 3], out: SampleSlices<'_>) -> Result<(), LengthError> {
        dispatch::clean_upper_halves();
        let ([u, v, w], [r, g, b], [wr, wg, wb]) = (out.wi, out.value, out.weight);
        let mut out = [u, v, w, r, g, b, out.pdf, wr, wg, wb, out.slot];
        let names = [
            "wi.u", "wi.v", "wi.w", "value.r", "value.g", "value.b", "pdf", "weight.r", "weight.g", "weight.b", "slot",
        ];
        check_lengths(["xi.lobe", "xi.theta", "xi.phi"], xi, names, &out)?;
        dispatch::batch::<M, SampleRow, 11>(level, &self.inner, xi, &mut out);
        Ok(())
    }
}

/// Names of the slices of a direction, and of a value.
const WI: [&str; 3] = ["wi.u", "wi.v", "wi.w"];
const VALUE: [&str; 3] = ["value.r", "value.g", "value.b"];

#[inline]
fn check_lengths<const N: usize>(
    in_names: [&'static str; 3],
    inputs: [&[f32]; 3],
    out_names: [&'static str; N],
    outputs: &[&mut [f32]; N],
) -> Result<(), LengthError> {
    let expected = inputs[0].len();
    let inputs = in_names.into_iter().zip(inputs.iter().map(|s| s.len()));
    let outputs = out_names.into_iter().zip(outputs.iter().map(|s| s.len()));
    for (field, len) in inputs.chain(outputs) {
        if len != expected {
            return Err(LengthError { field, len, expected });
        }
    }
    Ok(())
}

/// What a batch computes of three numbers a lane: `N` numbers a lane.
pub(crate) trait Row<const N: usize> {
    fn row<M: Model, L: Lanes, C: Broadcast<L> + Debug>(gather: &M::Gather<C>, input: [L; 3]) -> [L; N];
}

/// The value alone: what only the density needs is not computed.
pub(crate) struct ValueRow;
impl Row<3> for ValueRow {
    #[inline(always)]
    fn row<M: Model, L: Lanes, C: Broadcast<L> + Debug>(gather: &M::Gather<C>, [x, y, z]: [L; 3]) -> [L; 3] {
        M::eval::<L, C>(gather, Vec3x::new(x, y, z)).value
    }
}

/// The density alone.
pub(crate) struct PdfRow;
impl Row<1> for PdfRow {
    #[inline(always)]
    fn row<M: Model, L: Lanes, C: Broadcast<L> + Debug>(gather: &M::Gather<C>, [x, y, z]: [L; 3]) -> [L; 1] {
        [M::eval::<L, C>(gather, Vec3x::new(x, y, z)).pdf]
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
}

pub(crate) struct SampleRow;
impl Row<11> for SampleRow {
    #[inline(always)]
    fn row<M: Model, L: Lanes, C: Broadcast<L> + Debug>(gather: &M::Gather<C>, xi: [L; 3]) -> [L; 11] {
        let s = M::sample::<L, C>(gather, xi);
        let ([r, g, b], [wr, wg, wb]) = (s.value, s.weight);
        [s.wi.x, s.wi.y, s.wi.z, r, g, b, s.pdf, wr, wg, wb, s.slot]
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

/// Cuts slices into whole packets, and the rest into one packet on the stack; `run` is called on either.
#[inline(always)]
pub(crate) fn in_packets<const N: usize, const W: usize>(
    inputs: [&[f32]; 3],
    outputs: &mut [&mut [f32]; N],
    mut run: impl FnMut([&[[f32; W]]; 3], &mut [&mut [[f32; W]]; N]),
) {
    let cut = inputs.map(<[f32]>::as_chunks);
    let mut out = outputs.each_mut().map(|column| column.as_chunks_mut());
    run(cut.map(|(whole, _)| whole), &mut out.each_mut().map(|(whole, _)| &mut **whole));
    if cut[0].1.is_empty() {
        return;
    }
    let mut from = [[[0.0; W]]; 3];
    for ([packet], (_, rest)) in from.iter_mut().zip(cut) {
        packet.iter_mut().zip(rest).for_each(|(to, from)| *to = *from);
    }
    let mut to = [[[0.0; W]]; N];
    run(from.each_ref().map(<[_; 1]>::as_slice), &mut to.each_mut().map(<[_; 1]>::as_mut_slice));
    for ([packet], (_, rest)) in to.iter().zip(out) {
        rest.iter_mut().zip(packet).for_each(|(to, from)| *to = *from);
    }
}
