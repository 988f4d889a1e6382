//! Cells of the sphere in a sequence in which neighbours have similar directions.

use hairis::Vec3x8;
use hairis::simd::{Broadcast, Kernel, Lanes, Level, f32x8};

/// Number of cells along a side of the square to which the sphere is unfolded.
pub const SIDE: usize = 8;
/// Number of cells.
pub const CELLS: usize = SIDE * SIDE;

/// Places of the square's cells along Hilbert's curve, row by row.
pub static CURVE: [u8; CELLS] = curve();

/// Returns the cell of a unit vector per lane.
#[inline]
#[must_use]
pub fn cells(direction: &Vec3x8) -> [u8; 8] {
    let [a, b] = Level::detect()
        .run(Unfold(direction))
        .map(|side| side.fast_trunc_int().to_array());
    // Wrap numbers beyond the square, and those that are NaN, into some cell.
    core::array::from_fn(|lane| {
        CURVE[(a[lane].cast_unsigned() as usize % SIDE) * SIDE
            + b[lane].cast_unsigned() as usize % SIDE]
    })
}

/// Kernel that unfolds the octahedron: the upper half of the sphere is in the middle of the square, the lower half around it.
///
/// Returns places on the square, in cells.
struct Unfold<'a>(&'a Vec3x8);

impl Kernel for Unfold<'_> {
    type Output = [f32x8; 2];

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> [f32x8; 2] {
        let (x, y, z): (L, L, L) = (self.0.x.lanes(), self.0.y.lanes(), self.0.z.lanes());
        let c = L::splat;
        let one = c(1.0);
        let length = (x.abs() + y.abs() + z.abs()).max(c(f32::MIN_POSITIVE));
        let by = L::quotient(one, length);
        let (a, b) = (x * by, z * by);
        let below = y.lt(c(0.0));
        let folded = [(one - b.abs()).times_sign(a), (one - a.abs()).times_sign(b)];
        // A little less than half the side, so that both edges are within.
        let half = c(0.5 * SIDE as f32);
        let place = |upper: L, lower: L| {
            L::select(below, lower, upper)
                .mul_add(half * (1.0 - 1e-6), half)
                .store()
        };
        [place(a, folded[0]), place(b, folded[1])]
    }
}

/// Returns Hilbert's curve through a square of [`SIDE`] cells a side.
const fn curve() -> [u8; CELLS] {
    let mut places = [0; CELLS];
    let mut place = 0;
    while place < CELLS {
        let (mut x, mut y, mut rest, mut side) = (0, 0, place, 1);
        while side < SIDE {
            let (right, up) = (1 & (rest / 2), 1 & (rest ^ (rest / 2)));
            if up == 0 {
                if right == 1 {
                    (x, y) = (side - 1 - x, side - 1 - y);
                }
                (x, y) = (y, x);
            }
            (x, y) = (x + side * right, y + side * up);
            (rest, side) = (rest / 4, 2 * side);
        }
        #[expect(clippy::cast_possible_truncation, reason = "below 64")]
        let number = place as u8;
        places[x * SIDE + y] = number;
        place += 1;
    }
    places
}
