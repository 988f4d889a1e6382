//! Halton sequence, scrambled so that independent randomisations yield honest error bars.

use super::{XiSource, below, mix, unit_f64};

/// Prime bases of the dimensions, in the order of the dimensions.
pub const HALTON_BASES: [u32; 16] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53];

/// Source of scrambled Halton points: dimension `d` is the radical inverse in the `d`-th prime, with each digit permuted at random.
///
/// The scrambling is Owen's nested scrambling with affine permutations, `digit -> (a digit + c) mod base`. A hash of the run, the
/// dimension and all earlier digits draws `a` in 1..base and `c` in 0..base. For a prime base this maps two distinct digits to a
/// uniform pair of distinct digits, as a full random permutation does, and variance depends on pairs only. Each point is uniform on its
/// own, so estimates are unbiased, and the elementary intervals stay equidistributed. Streams are independent randomisations, so the
/// spread of their means is the error. A Cranley-Patterson rotation was not chosen, because it keeps the correlated stripes of the
/// larger bases at the 16 to 64 samples of direct lighting.
///
/// - Source: Owen 1995; Matousek 1998, On the L2-discrepancy for anchored boxes.
/// - Shape: at most `dims` coordinates per point.
///
/// # Examples
/// ```
/// use hairis_instruments::sequence::{Halton, XiSource};
/// let mut halton = Halton::new(2, 1, 0);
/// let below = (0..64).filter(|_| halton.next_xi::<2>()[0] < 0.5).count();
/// assert_eq!(below, 32, "base 2 splits 64 points evenly");
/// ```
#[derive(Clone, Debug)]
pub struct Halton {
    dims: usize,
    key: u64,
    index: u64,
}

impl Halton {
    /// Makes the randomisation `(seed, stream)` in `dims` dimensions, which begins with its first point.
    ///
    /// # Panics
    /// Panics if `dims` exceeds the number of [`HALTON_BASES`].
    #[must_use]
    pub fn new(dims: usize, seed: u64, stream: u64) -> Self {
        assert!(
            dims <= HALTON_BASES.len(),
            "Halton has {} dimensions, {dims} asked for",
            HALTON_BASES.len()
        );
        Self {
            dims,
            key: mix(mix(seed) ^ stream),
            index: 0,
        }
    }

    /// Returns coordinate `dim` of the point at `index`, in [0, 1).
    ///
    /// # Panics
    /// Panics if `dim` is not below the number of [`HALTON_BASES`].
    #[must_use]
    pub fn coordinate(&self, dim: usize, index: u64) -> f64 {
        let hash = mix(self.key ^ mix(dim as u64));
        // A base that the compiler knows is divided by in a third of the time.
        macro_rules! in_base {
            ($($d:literal)*) => {
                match dim {
                    $($d => radical_inverse::<{ HALTON_BASES[$d] }>(hash, index),)*
                    _ => panic!("Halton has {} dimensions, {dim} asked for", HALTON_BASES.len()),
                }
            };
        }
        in_base!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15)
    }
}

/// Returns the radical inverse of `index` in `BASE`, with digits permuted by `hash` and by all earlier digits, in [0, 1).
fn radical_inverse<const BASE: u32>(mut hash: u64, index: u64) -> f64 {
    let b = u64::from(BASE);
    let mut rest = index;
    let mut value = 0.0;
    let mut scale = 1.0;
    // Digits down to 2^-32 keep the nesting; below that, a hash of the whole index places the point at random.
    while scale > 1.0 / 4_294_967_296.0 {
        let digit = rest % b;
        rest /= b;
        let a = 1 + below(hash, b - 1);
        let c = below(mix(hash), b);
        scale /= f64::from(BASE);
        value += ((a * digit + c) % b) as f64 * scale;
        hash = mix(hash ^ mix(digit + 1));
    }
    value += scale * unit_f64(mix(hash ^ mix(rest)));
    value.min(1.0 - f64::EPSILON / 2.0)
}

impl XiSource for Halton {
    fn next_point(&mut self, point: &mut [f64]) {
        assert!(
            point.len() <= self.dims,
            "{} coordinates asked of a Halton source with {}",
            point.len(),
            self.dims
        );
        for (dim, x) in point.iter_mut().enumerate() {
            *x = self.coordinate(dim, self.index);
        }
        self.index += 1;
    }
}
