//! Inputs drawn from a fixed seed before any clock starts.

use core::array::from_fn;
use core::f32::consts::TAU;
use glam::Vec3;
use hairis::{Material, Vec3x8};
use hairis_variants::{Parameters, Registered};
use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use wide::f32x8;

/// Number of directions in one pass, in packets of eight: their inputs and outputs stay in the first two levels of cache.
pub const DIRECTIONS: usize = 1024;

/// Directions and uniform numbers of one pass, with all lanes different.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// Directions towards the light, uniform over the sphere.
    pub wi: Vec<Vec3>,
    /// Directions towards the viewer, uniform over the sphere.
    pub wo: Vec<Vec3>,
    /// Triples of uniform random numbers.
    pub xi: Vec<[f32; 3]>,
}

impl Inputs {
    /// Draws the inputs that every bench uses, from a fixed seed.
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
    // Functions of the libm crate, not of the system, so that the bits are the same everywhere.
    let (sin, cos) = libm::sincosf(turn * TAU);
    let plane = libm::sqrtf(1.0 - u * u);
    Vec3::new(u, plane * cos, plane * sin)
}

/// Converts directions to the arrays that the formulas take.
#[must_use]
pub fn arrays(v: &[Vec3]) -> Vec<[f32; 3]> {
    v.iter().map(|v| v.to_array()).collect()
}

/// Pairs the elements of two lists.
#[inline(never)]
pub(crate) fn pairs<A: Clone, B: Clone>(a: &[A], b: &[B]) -> Vec<(A, B)> {
    a.iter().cloned().zip(b.iter().cloned()).collect()
}

/// Joins the triples of two lists into rows of six numbers.
#[inline(never)]
pub(crate) fn joined(a: &[[f32; 3]], b: &[[f32; 3]]) -> Vec<[f32; 6]> {
    a.iter()
        .zip(b)
        .map(|([x, y, z], [u, v, w])| [*x, *y, *z, *u, *v, *w])
        .collect()
}

/// Packs directions, eight per packet; a remainder of fewer than eight is dropped.
#[must_use]
#[inline(never)]
pub fn packets(v: &[Vec3]) -> Vec<Vec3x8> {
    let (eights, _) = v.as_chunks::<8>();
    eights.iter().map(|eight| (*eight).into()).collect()
}

/// Packs triples of numbers, eight per packet; a remainder of fewer than eight is dropped.
#[must_use]
#[inline(never)]
pub fn xi_packets(xi: &[[f32; 3]]) -> Vec<[f32x8; 3]> {
    let (eights, _) = xi.as_chunks::<8>();
    eights
        .iter()
        .map(|eight| from_fn(|k| f32x8::new(eight.map(|xi| xi[k]))))
        .collect()
}

/// Returns the parameters of the eight lanes, which are the presets of the model in turn.
#[must_use]
pub fn params<M: Registered>() -> [M::Params; 8] {
    let presets = M::Params::PRESETS;
    from_fn(|lane| presets[lane % presets.len()].1)
}

/// Returns the materials of the eight lanes, made from [`params`].
#[must_use]
pub fn materials<M: Registered>() -> [Material<M>; 8] {
    params::<M>().map(|params| Material::new(&M::MODEL, &params))
}

/// Column of [`DIRECTIONS`] numbers for slices, at an address that depends on the column's index.
///
/// Columns a multiple of 4096 bytes apart, such as columns of 1024 floats allocated together, delay each other. A load waits for an
/// earlier store to an address that is equal modulo 4096, even in another column. Such columns made an evaluation 40% slower here. This
/// is a pitfall for hosts and not a property of the kernel, so the columns of the benches begin 256 bytes apart modulo 4096. Sixteen
/// columns fit in this way, each on a cache line.
#[derive(Clone, Debug)]
pub struct Column {
    numbers: Vec<f32>,
    start: usize,
}

/// Number of `f32` values in 4096 bytes.
const PAGE: usize = 1024;
/// Distance between the starts of two columns, in numbers, modulo [`PAGE`].
const STAGGER: usize = 64;

impl Column {
    /// Makes the column with number `index` of a call, and fills it with the first [`DIRECTIONS`] of `numbers`.
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

    /// Returns the `len` numbers of the column that begin at `at`.
    #[inline(always)]
    #[must_use]
    pub fn part(&self, at: usize, len: usize) -> &[f32] {
        &self.numbers[self.start + at..][..len]
    }

    /// Returns the `len` numbers of the column that begin at `at`, to write to.
    #[inline(always)]
    #[must_use]
    pub fn part_mut(&mut self, at: usize, len: usize) -> &mut [f32] {
        &mut self.numbers[self.start + at..][..len]
    }
}
