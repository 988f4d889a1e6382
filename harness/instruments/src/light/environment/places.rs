//! Places of eight directions on an environment map, in single precision.

use hairis::Vec3x8;
use hairis::model::math::atan2_upper;
use hairis::simd::{Broadcast, Kernel, Lanes};
use wide::f32x8;

/// Distance from an edge, as a share of the count of texels, below which a place is computed again in double precision.
const DOUBT: f32 = 6e-7;

/// Kernel that computes the rows and columns of eight directions in texels; the integer part is the index.
pub(super) struct Places<'a> {
    pub(super) dir: &'a Vec3x8,
    /// Counts of rows and columns.
    pub(super) texels: [f32; 2],
}

impl Kernel for Places<'_> {
    type Output = [f32x8; 2];

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> [f32x8; 2] {
        let (x, y, z): (L, L, L) = (self.dir.x.lanes(), self.dir.y.lanes(), self.dir.z.lanes());
        let c = L::splat;
        let [rows, columns] = self.texels;
        let polar = atan2_upper(x.mul_add(x, z * z).sqrt(), y);
        let turn = atan2_upper(x.abs(), -z).times_sign(x);
        let row = polar * (rows / core::f32::consts::PI);
        let column = turn.mul_add(c(columns / core::f32::consts::TAU), c(0.5 * columns));
        [row.store(), column.store()]
    }
}

/// Returns the lanes, as bits, whose place cannot be trusted: those nearer to an edge between `texels` texels than the error of single
/// precision, and those that are NaN.
///
/// - Accuracy: places err by less than `3e-7 texels`, half of it in the angles.
pub(super) fn in_doubt(place: f32x8, texels: f32) -> u32 {
    let half = f32x8::splat(0.5);
    let whole = place.fast_trunc_int().round_float();
    let inside = (place - whole - half)
        .abs()
        .simd_lt(half - f32x8::splat(DOUBT * texels));
    !inside.to_bitmask() & 0xff
}
