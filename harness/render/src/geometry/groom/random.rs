//! Random numbers of a strand, of a clump, or of the roots of a head.

use core::f32::consts::TAU;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// Purpose of a sequence of random numbers; no two purposes share numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Stream {
    /// A strand, by number.
    Strand(usize),
    /// A clump, by number.
    Clump(usize),
    /// Roots of a head, by level: strands, clumps or locks of clumps.
    Roots(u64),
}

/// Random numbers of one strand or clump, which depend on the seed and on its number alone.
#[derive(Clone, Debug)]
pub(crate) struct Random(ChaCha8Rng);

impl Random {
    pub(crate) fn new(seed: u64, stream: Stream) -> Self {
        let mut numbers = ChaCha8Rng::seed_from_u64(seed);
        numbers.set_stream(match stream {
            Stream::Strand(strand) => 2 * strand as u64,
            Stream::Clump(clump) => 2 * clump as u64 + 1,
            Stream::Roots(level) => u64::MAX - level,
        });
        Self(numbers)
    }

    /// Draws a number that is uniform over `[0, 1)`.
    pub(crate) fn uniform(&mut self) -> f32 {
        (self.0.next_u32() >> 8) as f32 / (1 << 24) as f32
    }

    /// Draws a phase that is uniform over `[0, 2 pi)`.
    pub(crate) fn phase(&mut self) -> f32 {
        TAU * self.uniform()
    }

    /// Draws a normal number with deviation 1, by the method of Box and Muller.
    pub(crate) fn normal(&mut self) -> f32 {
        let radius = (-2.0 * libm::logf(1.0 - self.uniform())).sqrt();
        radius * libm::cosf(self.phase())
    }

    /// Draws a number as [`normal`](Self::normal) does, clamped at two deviations.
    pub(crate) fn normal_cut(&mut self) -> f32 {
        self.normal().clamp(-2.0, 2.0)
    }
}
