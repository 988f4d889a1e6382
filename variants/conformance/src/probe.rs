//! Numbers, directions and hits at which models are tested, and their conversion to lanes.

use crate::size::cases;
use core::f64::consts::PI;
use glam::Vec3;
use hairis::simd::f32x8;
use hairis::{Hit, Hit8, Lobe, LobeMask, Vec3x8};
use std::sync::OnceLock;

/// Direction, or any vector, in the fibre's frame.
pub(crate) type Direction = Vec3;

/// Largest uniform number below 1.
pub(crate) const LAST: f32 = 1.0 - f32::EPSILON / 2.0;

/// Rounds a number to the nearest single-precision number.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to a float is the purpose"
)]
#[must_use]
pub fn narrow(x: f64) -> f32 {
    x as f32
}

/// Generator of uniform numbers (splitmix64), from a seed that each test chooses.
///
/// The environment variable `HAIRIS_SEED`, a whole number, gives every test other numbers. Without it, the numbers are the same in every
/// run.
#[derive(Clone, Debug)]
pub struct Draws(pub u64);

/// Returns the seed of this run: the one in the environment, or 0.
///
/// # Panics
///
/// Panics if `HAIRIS_SEED` is not a whole number of 64 bits.
pub(crate) fn run_seed() -> u64 {
    static SEED: OnceLock<u64> = OnceLock::new();
    *SEED.get_or_init(|| match std::env::var("HAIRIS_SEED") {
        Ok(text) => text
            .parse()
            .unwrap_or_else(|_| panic!("HAIRIS_SEED must be a whole number, got {text:?}")),
        Err(_) => 0,
    })
}

/// Difference of the states of two draws: 2^64 over the golden ratio.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

impl Draws {
    /// Draws 64 random bits, which depend on `HAIRIS_SEED`.
    pub fn bits(&mut self) -> u64 {
        self.mixed(run_seed())
    }

    /// Skips `count` draws.
    pub(crate) fn skip(&mut self, count: u64) {
        self.0 = self.0.wrapping_add(STEP.wrapping_mul(count));
    }

    /// Draws 64 random bits that are the same in every run.
    pub(crate) fn unseeded(&mut self) -> u64 {
        self.mixed(0)
    }

    fn mixed(&mut self, run_seed: u64) -> u64 {
        self.0 = self.0.wrapping_add(STEP);
        let mut z = self.0 ^ run_seed;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Draws a multiple of `2^-24` in `[0, 1)`.
    pub fn xi(&mut self) -> f32 {
        narrow((self.bits() >> 40) as f64 / 16_777_216.0)
    }

    /// Draws three uniform numbers, each as [`xi`](Self::xi) draws it.
    pub fn xi3(&mut self) -> [f32; 3] {
        [self.xi(), self.xi(), self.xi()]
    }

    /// Draws a number that is uniform in `[lo, hi)`.
    pub fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * (self.bits() >> 11) as f64 / 9_007_199_254_740_992.0
    }

    pub(crate) fn pick<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        let n = from.len() as u64;
        let at = usize::try_from(self.bits() % n).unwrap_or(0);
        &from[at]
    }

    /// Draws any direction, uniform in its angles: as many next to the axis as elsewhere.
    pub(crate) fn direction(&mut self) -> Direction {
        direction(self.between(-0.5 * PI, 0.5 * PI), self.between(-PI, PI))
    }

    /// Draws a hit seen from any direction, with any offset.
    pub(crate) fn hit(&mut self) -> Hit {
        Hit {
            wo: self.direction().into(),
            h: narrow(self.between(-1.0, 1.0)),
        }
    }
}

/// Returns the unit direction at these angles in rad, rounded to single precision.
#[must_use]
pub fn direction(theta: f64, phi: f64) -> Direction {
    let ((sin, cos), (sin_phi, cos_phi)) = (theta.sin_cos(), phi.sin_cos());
    Direction::new(narrow(sin), narrow(cos * cos_phi), narrow(cos * sin_phi))
}

/// Converts a vector to double precision.
#[must_use]
pub fn double(v: Direction) -> [f64; 3] {
    [f64::from(v.x), f64::from(v.y), f64::from(v.z)]
}

/// Returns the cosine of the inclination of a unit vector.
pub(crate) fn cos_theta(v: Direction) -> f64 {
    (f64::from(v.y).powi(2) + f64::from(v.z).powi(2)).sqrt()
}

/// Returns sine and cosine of the inclination and of the azimuth, each pair times a length.
pub(crate) fn sides([u, v, w]: [f64; 3]) -> [[f64; 2]; 2] {
    [[u, (v * v + w * w).sqrt()], [w, v]]
}

/// Returns the inclination and the azimuth of a direction.
pub(crate) fn angles(direction: [f64; 3]) -> [f64; 2] {
    sides(direction).map(|[sin, cos]| sin.atan2(cos))
}

/// Returns the distance between two vectors.
pub(crate) fn distance(a: Direction, b: Direction) -> f64 {
    let ([a0, a1, a2], [b0, b1, b2]) = (double(a), double(b));
    ((a0 - b0).powi(2) + (a1 - b1).powi(2) + (a2 - b2).powi(2)).sqrt()
}

/// Returns the directions that rounding the components and the inclination may turn a direction into. They are moved by `by` along the
/// fibre, moved across the fibre by as much less as the direction is shorter there, and turned by `by` towards the axis and away from it.
pub(crate) fn rounded(v: Direction, by: f64) -> [Direction; 8] {
    let cos = cos_theta(v);
    let (along, across) = (narrow(by), narrow(by * cos));
    let moved = |x: f32, y: f32, z: f32| Direction::new(v.x + x, v.y + y, v.z + z);
    let turned = |by: f64| {
        // On the axis, every direction across is equally good.
        let [y, z] = if cos > 0.0 {
            [v.y, v.z].map(|x| f64::from(x) / cos)
        } else {
            [1.0, 0.0]
        };
        let across = -by * f64::from(v.x);
        moved(narrow(by * cos), narrow(across * y), narrow(across * z))
    };
    [
        moved(along, 0.0, 0.0),
        moved(-along, 0.0, 0.0),
        turned(by),
        turned(-by),
        moved(0.0, across, 0.0),
        moved(0.0, -across, 0.0),
        moved(0.0, 0.0, across),
        moved(0.0, 0.0, -across),
    ]
}

/// Number of hits for properties that take an integral.
const HITS: usize = 7;

/// Returns the hits for properties that take an integral: normal, tilted both ways, and grazing at more than 80 degrees.
pub(crate) fn hits() -> [Hit; HITS] {
    const THETA_O: [f64; HITS] = [0.0, 25.0, -50.0, 70.0, -82.0, 87.0, 89.9];
    const H: [f32; HITS] = [0.0, 0.35, -0.8, 0.99, -0.6, 0.999, -0.1];
    core::array::from_fn(|i| Hit {
        wo: direction(THETA_O[i].to_radians(), 0.9 * i as f64 - 2.5).into(),
        h: H[i],
    })
}

/// Returns the hits at which a property integrates the density of a material: all of [`hits`] in CI's size, and two of them in the usual
/// size, other ones for the next material. Each has its number among all hits of all materials.
pub(crate) fn numbered_hits(material: usize) -> impl Iterator<Item = (usize, Hit)> {
    let all = hits();
    let count = cases(all.len()).min(all.len());
    let chosen = (0..count).map(|n| (material + n * all.len() / count) % all.len());
    let chosen: Vec<usize> = chosen.collect();
    let numbered = all.into_iter().enumerate();
    let number = move |n: usize| material * HITS + n;
    numbered.filter_map(move |(n, hit)| chosen.contains(&n).then_some((number(n), hit)))
}

/// Returns the hits of [`numbered_hits`].
pub(crate) fn some_hits(material: usize) -> impl Iterator<Item = Hit> {
    numbered_hits(material).map(|(_, hit)| hit)
}

/// Returns awkward hits, followed by `count` random ones.
pub(crate) fn hits_and(count: usize, draws: &mut Draws) -> Vec<Hit> {
    hits()
        .into_iter()
        .chain((0..count).map(|_| draws.hit()))
        .collect()
}

/// Returns every subset of the slots, the empty one first and the full one last.
pub(crate) fn masks() -> Vec<LobeMask> {
    let subset = |bits: usize| {
        let lobes: Vec<Lobe> = Lobe::ALL
            .into_iter()
            .filter(|lobe| bits >> lobe.index() & 1 == 1)
            .collect();
        LobeMask::of(&lobes)
    };
    (0..1 << Lobe::COUNT).map(subset).collect()
}

/// Packs eight vectors into lanes.
pub(crate) fn packet(v: &[Direction; 8]) -> Vec3x8 {
    (*v).into()
}

/// Packs eight hits into lanes.
pub(crate) fn hits8(hits: &[Hit; 8]) -> Hit8 {
    Hit {
        wo: packet(&hits.map(|hit| hit.wo.into())),
        h: f32x8::new(hits.map(|hit| hit.h)),
    }
}

/// Packs eight triples of numbers into lanes.
#[must_use]
pub fn triples(xi: &[[f32; 3]; 8]) -> [f32x8; 3] {
    core::array::from_fn(|axis| f32x8::new(xi.map(|xi| xi[axis])))
}

/// Direction numbers of Sobol's second and third coordinate, for the polynomials `x + 1` and `x^2 + x + 1`.
const DIRECTIONS: [[u32; 32]; 2] = {
    let mut v = [[0; 32]; 2];
    (v[0][0], v[1][0], v[1][1]) = (1 << 31, 1 << 31, 3 << 30);
    let mut i = 1;
    while i < 32 {
        v[0][i] = v[0][i - 1] ^ (v[0][i - 1] >> 1);
        if i > 1 {
            v[1][i] = v[1][i - 1] ^ v[1][i - 2] ^ (v[1][i - 2] >> 2);
        }
        i += 1;
    }
    v
};

/// Returns point `n` of Sobol's three-dimensional sequence. Of `2^m` points, each of `2^m` equal intervals along every axis holds one,
/// and so do all but a few of as many equal rectangles in any two axes.
pub(crate) fn sobol(n: u32) -> [f32; 3] {
    let sum = |directions: &[u32; 32]| {
        let bits = directions
            .iter()
            .enumerate()
            .filter(|(bit, _)| n >> bit & 1 == 1);
        bits.fold(0, |sum, (_, direction)| sum ^ direction)
    };
    [n.reverse_bits(), sum(&DIRECTIONS[0]), sum(&DIRECTIONS[1])]
        .map(|x| (x >> 8) as f32 / 16_777_216.0)
}

/// Returns `count` triples by component.
pub(crate) fn columns(count: u32, xi: impl FnMut(u32) -> [f32; 3]) -> [Vec<f32>; 3] {
    let mut columns = [const { Vec::new() }; 3];
    fill(&mut columns, count, xi);
    columns
}

/// Replaces columns by `count` triples.
pub(crate) fn fill(columns: &mut [Vec<f32>; 3], count: u32, mut xi: impl FnMut(u32) -> [f32; 3]) {
    columns.iter_mut().for_each(Vec::clear);
    for n in 0..count {
        for (column, x) in columns.iter_mut().zip(xi(n)) {
            column.push(x);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::sobol;

    #[test]
    fn sobol_points_are_a_net() {
        const COUNT: usize = 1 << 10;
        let points: Vec<[f32; 3]> = (0..1024).map(sobol).collect();
        // Every elementary rectangle of the first two coordinates holds one point.
        for rows in (0..=10).map(|power| 1 << power) {
            let mut seen = vec![0; COUNT];
            for [x, y, _] in &points {
                let cell = |x: f32, n: usize| (1..n).filter(|i| *i as f32 <= x * n as f32).count();
                seen[cell(*x, rows) * (COUNT / rows) + cell(*y, COUNT / rows)] += 1;
            }
            assert!(seen.iter().all(|n| *n == 1), "{rows} rows");
        }
        let mut third: Vec<f32> = points.iter().map(|[.., z]| *z).collect();
        third.sort_by(f32::total_cmp);
        assert!(
            third
                .iter()
                .enumerate()
                .all(|(n, z)| *z == n as f32 / COUNT as f32),
            "the third coordinate"
        );
    }
}
