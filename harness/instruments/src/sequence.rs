//! Sources of the uniform numbers `xi` that estimators consume: independent, Halton and stratified.
//!
//! Every source is determined by `(seed, stream)`: one seed per run, and one stream per cell of the comparison (see [`stream_id`]). A
//! figure therefore does not depend on which thread computed it or on what ran before. Numbers are in [0, 1), and after [`to_unit_f32`]
//! in [0, 1 - 2^-24]. No number is ever exactly 1.

mod halton;
mod stratified;

pub use halton::{HALTON_BASES, Halton};
pub use stratified::{Stratified, strata};

use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use serde::Serialize;

/// Largest number that a source returns as `f32`: 1 - 2^-24.
pub const MAX_XI_F32: f32 = 1.0 - f32::EPSILON / 2.0;

/// Source of points in the unit cube, whose coordinates are the uniform numbers of a sample.
pub trait XiSource {
    /// Fills `point` with the coordinates of the next point, each in [0, 1).
    ///
    /// - Shape: one coordinate per element. An independent source accepts any length; the others document theirs.
    ///
    /// # Panics
    /// Panics if the source has fewer dimensions than `point` has elements.
    fn next_point(&mut self, point: &mut [f64]);

    /// Returns the first `D` coordinates of the next point, in [0, 1).
    fn next_xi<const D: usize>(&mut self) -> [f64; D]
    where
        Self: Sized,
    {
        let mut point = [0.0; D];
        self.next_point(&mut point);
        point
    }

    /// Returns the first `D` coordinates of the next point as `f32`, in [0, 1 - 2^-24].
    fn next_xi_f32<const D: usize>(&mut self) -> [f32; D]
    where
        Self: Sized,
    {
        self.next_xi::<D>().map(to_unit_f32)
    }
}

impl<S: XiSource + ?Sized> XiSource for Box<S> {
    fn next_point(&mut self, point: &mut [f64]) {
        (**self).next_point(point);
    }
}

/// Rounds a number of [0, 1) to `f32` without ever reaching 1, whereas rounding to nearest would reach it from 1 - 2^-25 on.
///
/// - Domain: any `x`. Numbers below 0 and NaN give 0, and numbers from 1 - 2^-24 on give 1 - 2^-24.
#[inline]
#[must_use]
pub fn to_unit_f32(x: f64) -> f32 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounding to f32 is the purpose; the clamp follows"
    )]
    let y = x as f32;
    // NaN fails the comparison and becomes 0.
    if y > 0.0 { y.min(MAX_XI_F32) } else { 0.0 }
}

/// Returns the stream number of the comparison's cell at the given indices, for [`Independent::new`] and its siblings.
///
/// The number is a chain of `SplitMix64` finalisers: distinct lists of indices have distinct streams except with a probability of about
/// 2^-64 per pair. The start is salted, so that the hash of a small length cannot cancel the hash of an equal index.
#[must_use]
pub fn stream_id(indices: &[u64]) -> u64 {
    let start = mix(0x6861_6972_6973_0001_u64.wrapping_add((indices.len() as u64) << 32));
    indices.iter().fold(start, |h, &i| mix(h ^ mix(i)))
}

/// Hashes a number by the finaliser of `SplitMix64` (Steele, Lea and Flood 2014; constants by Stafford), with the increment that keeps
/// 0 from being a fixed point.
#[inline]
#[must_use]
pub fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Returns the upper 53 bits as a multiple of 2^-53 in [0, 1).
#[inline]
#[must_use]
pub fn unit_f64(bits: u64) -> f64 {
    (bits >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
}

/// Maps a hash to a whole number below `bound`.
fn below(hash: u64, bound: u64) -> u64 {
    ((u128::from(hash) * u128::from(bound)) >> 64) as u64
}

/// Source of independent uniform numbers, drawn by the generator `ChaCha8`.
///
/// # Examples
/// ```
/// use hairis_instruments::sequence::{Independent, XiSource};
/// let mut a = Independent::new(1, 7);
/// let mut b = Independent::new(1, 7);
/// assert_eq!(a.next_xi_f32::<3>(), b.next_xi_f32::<3>(), "a stream is reproducible");
/// ```
#[derive(Clone, Debug)]
pub struct Independent {
    rng: ChaCha8Rng,
}

impl Independent {
    /// Makes the source for stream `stream` of the run with seed `seed`. Streams of one seed do not overlap, because the stream number
    /// is the cipher's nonce.
    #[must_use]
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(stream);
        Self { rng }
    }

    /// Draws a number in [0, 1), which is a multiple of 2^-53.
    #[inline]
    pub fn next_f64(&mut self) -> f64 {
        unit_f64(self.rng.next_u64())
    }

    /// Draws a number in [0, 1 - 2^-24], which is a multiple of 2^-24.
    #[inline]
    pub fn next_f32(&mut self) -> f32 {
        (self.rng.next_u32() >> 8) as f32 * (1.0 / 16_777_216.0)
    }

    /// Draws a whole number below `bound`, or returns 0 if `bound` is 0. The bias is below `bound` / 2^64.
    pub fn next_below(&mut self, bound: usize) -> usize {
        #[expect(clippy::cast_possible_truncation, reason = "a number below `bound`")]
        let index = below(self.rng.next_u64(), bound as u64) as usize;
        index
    }
}

impl XiSource for Independent {
    fn next_point(&mut self, point: &mut [f64]) {
        for x in point {
            *x = self.next_f64();
        }
    }
}

/// Kind of source that a comparison draws its samples from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SequenceKind {
    /// [`Independent`] numbers, on which variance per sample is defined.
    Independent,
    /// Scrambled [`Halton`] points, as the paper draws its samples.
    Halton,
    /// Jittered [`Stratified`] points, the paper's "stratified uniform".
    Stratified,
}

impl SequenceKind {
    /// Kinds of source in the order of reports.
    pub const ALL: [Self; 3] = [Self::Independent, Self::Halton, Self::Stratified];

    /// Returns the name of the kind in reports and flags.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Halton => "halton",
            Self::Stratified => "stratified",
        }
    }

    /// Makes a source of this kind for estimates with `samples` points of `dims` coordinates each.
    ///
    /// Each further `samples` points of a stratified source are a new randomisation, whereas a Halton source goes on with its sequence.
    /// Use one source (one stream) for each independent randomisation.
    ///
    /// # Panics
    /// Panics for `Halton` with more dimensions than [`HALTON_BASES`] has.
    #[must_use]
    pub fn source(
        self,
        seed: u64,
        stream: u64,
        dims: usize,
        samples: usize,
    ) -> Box<dyn XiSource + Send> {
        match self {
            Self::Independent => Box::new(Independent::new(seed, stream)),
            Self::Halton => Box::new(Halton::new(dims, seed, stream)),
            Self::Stratified => Box::new(Stratified::new(&strata(samples, dims), seed, stream)),
        }
    }
}
