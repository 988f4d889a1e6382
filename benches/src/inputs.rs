//! Inputs drawn from a fixed seed before any clock starts.

use core::array::from_fn;
use core::f32::consts::TAU;
use glam::Vec3;
use hairis::{Material, Vec3x8};
use hairis_variants::{Parameters, Registered};
use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use wide::f32x8;

/// Directions in one pass, in packets of eight: their inputs and outputs stay in the first two levels of cache.
pub const DIRECTIONS: usize = 1024;

/// Directions and numbers, all lanes different.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// Directions uniform over the sphere: towards the light.
    pub wi: Vec<Vec3>,
    /// Directions towards the viewer.
    pub wo: Vec<Vec3>,
    /// Uniform numbers.
    pub xi: Vec<[f32; 3]>,
}

impl Inputs {
    /// The inputs of every bench.
    #[must_use]
    pub fn draw() -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(0x6861_6972);
        let mut xi = || {
            (0..DIRECTIONS)
                .map(|_| hairis::random::xi(&mut rng))
                .collect::<Vec<_>>()
        };
        let directions = |xi: Vec<[f32; 3]>| {
            xi.into_iter()
                .map(|[height, turn, _]| on_sphere(height, turn))
                .collect()
        };
        Self {
            wi: directions(xi()),
            wo: directions(xi()),
            xi: xi(),
        }
    }
}

fn on_sphere(height: f32, turn: f32) -> Vec3 {
    let u = 2.0 * height - 1.0;
    // From the crate, not from the system: the same bits everywhere.
    let (sin, cos) = libm::sincosf(turn * TAU);
    let plane = libm::sqrtf(1.0 - u * u);
    Vec3::new(u, plane * cos, plane * sin)
}

/// The directions as the formulas take them.
#[must_use]
pub fn arrays(v: &[Vec3]) -> Vec<[f32; 3]> {
    v.iter().map(|v| v.to_array()).collect()
}

/// The elements of two lists, paired.
pub(crate) fn pairs<A: Clone, B: Clone>(a: &[A], b: &[B]) -> Vec<(A, B)> {
    a.iter().cloned().zip(b.iter().cloned()).collect()
}

/// Rows of both.
pub(crate) fn joined(a: &[[f32; 3]], b: &[[f32; 3]]) -> Vec<[f32; 6]> {
    a.iter()
        .zip(b)
        .map(|([x, y, z], [u, v, w])| [*x, *y, *z, *u, *v, *w])
        .collect()
}

/// Eight directions per packet.
#[must_use]
pub fn packets(v: &[Vec3]) -> Vec<Vec3x8> {
    let (eights, _) = v.as_chunks::<8>();
    eights.iter().map(|eight| (*eight).into()).collect()
}

/// Eight triples of numbers per packet.
#[must_use]
pub fn xi_packets(xi: &[[f32; 3]]) -> Vec<[f32x8; 3]> {
    let (eights, _) = xi.as_chunks::<8>();
    eights
        .iter()
        .map(|eight| from_fn(|k| f32x8::new(eight.map(|xi| xi[k]))))
        .collect()
}

/// Parameters of the eight lanes: the presets in turn.
#[must_use]
pub fn params<M: Registered>() -> [M::Params; 8] {
    let presets = M::Params::PRESETS;
    from_fn(|lane| presets[lane % presets.len()].1)
}

/// The materials of [`params`].
#[must_use]
pub fn materials<M: Registered>() -> [Material<M>; 8] {
    params::<M>().map(|params| Material::new(&M::MODEL, &params))
}

/// A column of [`DIRECTIONS`] numbers for slices, at an address chosen by its number.
///
/// Columns a multiple of 4096 bytes apart, as those of 1024 floats allocated together, delay each other: a load waits for
/// an earlier store to an address equal to its own modulo 4096, even in another column. That made an evaluation 40% slower
/// here. It is a pitfall for hosts and no property of the kernel: columns of the benches begin 256 bytes apart modulo
/// 4096, which works for sixteen of them, each on a cache line.
#[derive(Clone, Debug)]
pub struct Column {
    numbers: Vec<f32>,
    start: usize,
}

/// Numbers in 4096 bytes.
const PAGE: usize = 1024;
/// Numbers between two columns, modulo [`PAGE`].
const STAGGER: usize = 64;

impl Column {
    /// Column `index` of a call, filled with `numbers`.
    ///
    /// # Panics
    ///
    /// If there are more than [`DIRECTIONS`] of them.
    #[must_use]
    pub fn new(index: usize, numbers: impl IntoIterator<Item = f32>) -> Self {
        let mut column = vec![0.0; 2 * PAGE + DIRECTIONS];
        let start = column.as_ptr().align_offset(4 * PAGE) + STAGGER * index % PAGE;
        for (to, from) in column[start..start + DIRECTIONS].iter_mut().zip(numbers) {
            *to = from;
        }
        Self {
            numbers: column,
            start,
        }
    }

    /// Part of the column.
    #[inline(always)]
    #[must_use]
    pub fn part(&self, at: usize, len: usize) -> &[f32] {
        &self.numbers[self.start + at..][..len]
    }

    /// Part of the column, to write to.
    #[inline(always)]
    #[must_use]
    pub fn part_mut(&mut self, at: usize, len: usize) -> &mut [f32] {
        &mut self.numbers[self.start + at..][..len]
    }
}
