//! Uniform numbers for camera rays and paths, which are functions of seed, pixel, sample and place on the path alone.

mod even;
pub mod strata;

pub use even::Even;

use clap::ValueEnum;
use hairis_instruments::sequence::{HALTON_BASES, Halton, mix, to_unit_f32};

/// Source of the uniform numbers of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Sequence {
    /// Independent numbers
    Independent,
    /// Scrambled Halton points, as the paper draws its samples: 16 dimensions, independent numbers beyond
    Halton,
    /// Owen-scrambled Sobol' points, four dimensions at a time
    Sobol,
    /// One point in each cell of a grid of 4 by 4 per 16 samples, two dimensions at a time
    Stratified,
}

/// Uniform numbers of one path, drawn four at a time.
///
/// Groups of four are independent of each other. The samples of one group, pixel and seed are points of one sequence.
///
/// ```
/// use hairis_render::numbers::{Numbers, Sequence};
/// let below = |sample| Numbers::new(Sequence::Sobol, 1, 7, sample).four()[2] < 0.5;
/// assert_eq!((0..64).filter(|sample| below(*sample)).count(), 32);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Numbers {
    sequence: Sequence,
    key: u64,
    sample: u32,
    group: u32,
}

/// Points of a Sobol' sequence before it is scrambled anew, as many as the crate allows.
pub const SOBOL_POINTS: u32 = 1 << 16;

impl Numbers {
    /// Creates the numbers of a sample of a pixel, from the first group on.
    #[inline]
    #[must_use]
    pub fn new(sequence: Sequence, seed: u64, pixel: u64, sample: u32) -> Self {
        Self {
            sequence,
            key: mix(mix(seed) ^ pixel),
            sample,
            group: 0,
        }
    }

    /// Returns the index of the sample within its pixel.
    #[inline]
    #[must_use]
    pub fn sample(&self) -> u32 {
        self.sample
    }

    /// Returns the numbers of a further part of a path, where the path is split. Parts count from 1,
    /// because the path itself keeps its numbers.
    #[inline]
    #[must_use]
    pub fn part(&self, part: u32) -> Self {
        let key = mix(self.key ^ mix(u64::from(part) << 32 | u64::from(self.group)));
        Self { key, ..*self }
    }

    /// Returns the next four numbers of the path, each in `[0, 1 - 2^-24]`.
    #[inline]
    pub fn four(&mut self) -> [f32; 4] {
        let group = self.group;
        self.group += 1;
        match self.sequence {
            Sequence::Sobol => {
                let turn = u64::from(self.sample / SOBOL_POINTS) << 32 | u64::from(group);
                sobol_burley::sample_4d(
                    self.sample % SOBOL_POINTS,
                    0,
                    half(mix(self.key ^ mix(turn))),
                )
            }
            Sequence::Halton if group as usize * 4 < HALTON_BASES.len() => {
                let halton = Halton::new(HALTON_BASES.len(), self.key, 0);
                let number = |dimension| {
                    to_unit_f32(
                        halton.coordinate(group as usize * 4 + dimension, u64::from(self.sample)),
                    )
                };
                core::array::from_fn(number)
            }
            Sequence::Stratified => {
                let pair = |pair: u64| {
                    strata::pair(
                        mix(self.key ^ mix(2 * u64::from(group) + pair)),
                        self.sample,
                    )
                };
                let ([a, b], [c, d]) = (pair(0), pair(1));
                [a, b, c, d]
            }
            Sequence::Independent | Sequence::Halton => {
                let first = mix(self.key ^ mix(u64::from(self.sample) << 32 | u64::from(group)));
                let second = mix(first);
                [
                    half(first >> 32),
                    half(first),
                    half(second >> 32),
                    half(second),
                ]
                .map(unit)
            }
        }
    }
}

/// Returns the lower 32 bits.
#[inline]
fn half(bits: u64) -> u32 {
    (bits & 0xffff_ffff) as u32
}

/// Converts the upper 24 bits to a number in `[0, 1)`.
#[inline]
fn unit(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}
