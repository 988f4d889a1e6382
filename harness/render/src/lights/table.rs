//! Tables of directions towards a sky that are drawn beforehand.

use super::{LightSample8, Sky};
use crate::numbers::Even;
#[cfg(test)]
use hairis::simd::f32x8;
use hairis_instruments::sequence::mix;
use std::sync::OnceLock;

/// Largest number of directions of a table, which take 8 MB.
const MOST: usize = 1 << 18;
/// Largest number of tables of a scene; later passes read the first ones again.
const TABLES: u32 = 64;

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

    /// Makes all densities wrong by a factor.
    #[cfg(test)]
    pub(crate) fn scale_density(&mut self, by: f32) {
        self.blocks
            .iter_mut()
            .for_each(|block| block.pdf *= f32x8::splat(by));
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

    /// Replaces the table of the first pass.
    #[cfg(test)]
    pub(crate) fn set(&mut self, table: Option<Table>) {
        self.tables[0] = OnceLock::from(table);
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

#[cfg(test)]
mod tests {
    use super::*;
    use hairis_conformance::statistics::chi_square;
    use hairis_instruments::light::{Environment, Light as _};
    use hairis_instruments::sequence::{Independent, XiSource as _};
    use hairis_instruments::stats::Moments;

    fn map() -> Environment {
        let mut xi = Independent::new(4, 0);
        let pixels = (0..32)
            .map(|k| {
                xi.next_xi_f32::<3>()
                    .map(|x| if k == 9 { 20.0 * x } else { x })
            })
            .collect();
        Environment::from_pixels("small", 8, 4, pixels).expect("valid")
    }

    #[test]
    fn every_entry_has_the_density_of_the_sky() {
        // Over seeds, the texels of single entries, against the probabilities of texels.
        let map = map();
        let sky = Sky::from(map.clone());
        let texel = |dir: glam::Vec3| {
            let (polar, turn) = (dir.y.clamp(-1.0, 1.0).acos(), dir.x.atan2(-dir.z));
            let cell = |x: f32, n: usize| {
                (0..n)
                    .rev()
                    .find(|k| x * n as f32 >= *k as f32)
                    .unwrap_or(0)
            };
            cell(polar / core::f32::consts::PI, 4) * 8
                + cell(0.5 + turn / core::f32::consts::TAU, 8)
        };
        let mut counts = [[0_u64; 32]; 3];
        let seeds = 3000;
        for seed in 0..seeds {
            let table = Table::draw(&sky, seed, 1 << 10).expect("a sky");
            for (counts, place) in counts.iter_mut().zip([0, 77, table.blocks.len() - 1]) {
                counts[texel(table.block(place).direction.lane(place % 8))] += 1;
            }
        }
        let mut xi = Independent::new(5, 0);
        let mut expected = [0.0; 32];
        for _ in 0..2_000_000 {
            let sample = map.sample(xi.next_xi());
            expected[texel(sample.dir.as_vec3())] += seeds as f64 / 2e6;
        }
        for counts in &counts {
            let p = chi_square(counts, &expected, 5.0).p_value;
            assert!(p > 1e-3, "p {p}");
        }
    }

    #[test]
    fn tables_differ_by_seed_and_their_error_is_small() {
        let map = map();
        let sky = Sky::from(map.clone());
        let mut moments = Moments::new();
        for seed in 0..64 {
            let table = Table::draw(&sky, seed, 1 << 14).expect("a sky");
            let one = |block: &LightSample8| {
                let up = block.direction.y * block.direction.y;
                (up * block.radiance[1] / block.pdf)
                    .to_array()
                    .iter()
                    .map(|x| f64::from(*x))
                    .sum::<f64>()
            };
            let count = 8.0 * table.blocks.len() as f64;
            moments.push(table.blocks.iter().map(one).sum::<f64>() / count);
            let seen = sky.see8(&table.block(5).direction);
            assert_eq!(
                (seen.pdf, seen.radiance),
                (table.block(5).pdf, table.block(5).radiance)
            );
        }
        let got = moments.mean_estimate();
        // Independent directions would leave some 5e-3 of it in each table.
        assert!(
            8.0 * got.standard_error < 5e-4 * got.value && got.standard_error > 0.0,
            "{got:?}"
        );
        let truth = map.integrate(
            &|dir| [dir.y * dir.y; 3],
            &hairis_instruments::quadrature::SphereIntegrator::new(),
        );
        assert!(
            (got.value / truth.value[1] - 1.0).abs() < 1e-4,
            "{got:?} for {:?}",
            truth.value
        );
        assert!(Table::draw(&Sky::BLACK, 1, 16).is_none());
        let bytes = |length| size_of_val(&Table::draw(&sky, 1, length).expect("a sky").blocks[..]);
        assert_eq!([bytes(1 << 14), bytes(usize::MAX)], [1 << 19, 1 << 23]);
        let tables = Tables::new(&sky, 1, 64);
        let first = |pass| {
            tables
                .of_pass(pass)
                .expect("a sky")
                .block(0)
                .direction
                .lane(0)
        };
        assert!(
            first(0) != first(1) && first(3) == first(3 + TABLES),
            "a table per pass"
        );
    }
}
