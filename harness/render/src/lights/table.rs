//! Tables of directions towards a sky that are drawn beforehand.

use super::{LightSample8, Sky};
use crate::numbers::Even;
use hairis_instruments::sequence::mix;
use std::sync::OnceLock;

/// Largest number of directions of a table, which take 8 MB.
const MOST: usize = 1 << 18;
/// Largest number of tables of a scene; later passes read the first ones again.
pub const TABLES: u32 = 64;

/// Directions of a sky in blocks of eight, drawn once for many shading points. A point reads successive blocks, from a block of its own
/// choice.
///
/// The numbers behind the directions are an additive sequence that fills the square evenly (Roberts's generalised golden ratio), shifted
/// by two random numbers.
///
/// - Each direction has the sky's density, because its two numbers are uniform.
/// - Any successive blocks are spread evenly over the sky, because they are the same sequence with another shift.
/// - The mean over all points has the error of the table. It is that of a sum over evenly spread points, which is far below the noise of
///   a picture and differs from seed to seed.
#[derive(Clone, Debug)]
pub struct Table {
    blocks: Vec<LightSample8>,
}

impl Table {
    /// Draws a table of a given length in directions, at most 8 MB. Returns `None` for a black sky.
    #[must_use]
    pub fn draw(sky: &Sky, seed: u64, length: usize) -> Option<Self> {
        if sky.is_black() {
            return None;
        }
        let length = length.min(MOST);
        let start = mix(seed ^ 0x74_6162_6c65);
        let even = Even::square([low(start), low(mix(start))]);
        let block = |first| sky.sample8(&even.eight(first));
        Some(Self {
            blocks: (0..)
                .step_by(8)
                .take(length.div_ceil(8))
                .map(block)
                .collect(),
        })
    }

    /// Returns the place of a block that a uniform number selects.
    #[inline]
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a place of the table; the cast saturates"
    )]
    pub fn place(&self, xi: f32) -> usize {
        (xi * self.blocks.len() as f32) as usize
    }

    /// Returns a block by its place, which wraps around at the end of the table.
    #[inline]
    #[must_use]
    pub fn block(&self, place: usize) -> &LightSample8 {
        &self.blocks[place % self.blocks.len()]
    }

    /// Returns the blocks of the table, in the order in which points read them.
    #[must_use]
    pub fn blocks(&self) -> &[LightSample8] {
        &self.blocks
    }
}

/// Makes a table of directions that the caller has drawn, each with its density.
///
/// # Panics
///
/// [`block`](Table::block) panics if there are no blocks.
impl From<Vec<LightSample8>> for Table {
    fn from(blocks: Vec<LightSample8>) -> Self {
        Self { blocks }
    }
}

/// Tables for the passes of a picture, each drawn when it is first read.
///
/// A table depends on seed and pass alone, not on the thread that draws it.
#[derive(Debug)]
pub struct Tables<'a> {
    sky: &'a Sky,
    seed: u64,
    length: usize,
    tables: Vec<OnceLock<Option<Table>>>,
}

impl<'a> Tables<'a> {
    /// Creates tables of a given length in directions, which are not drawn yet.
    #[must_use]
    pub fn new(sky: &'a Sky, seed: u64, length: usize) -> Self {
        Self {
            sky,
            seed,
            length,
            tables: (0..TABLES).map(|_| OnceLock::new()).collect(),
        }
    }

    /// Replaces the table of the first pass by one that the caller has drawn.
    #[must_use]
    pub fn with_first(mut self, table: Option<Table>) -> Self {
        self.tables[0] = OnceLock::from(table);
        self
    }

    /// Returns the number of directions of a table.
    #[must_use]
    pub fn length(&self) -> usize {
        self.length
    }

    /// Returns the table of a pass, which is drawn if it is read for the first time. Returns `None` for a black sky.
    #[inline]
    #[must_use]
    pub fn of_pass(&self, pass: u32) -> Option<&Table> {
        let pass = pass % TABLES;
        let draw = || Table::draw(self.sky, mix(self.seed) ^ u64::from(pass), self.length);
        self.tables[pass as usize].get_or_init(draw).as_ref()
    }
}

/// Returns the lower 32 bits.
fn low(bits: u64) -> u32 {
    (bits & 0xffff_ffff) as u32
}
