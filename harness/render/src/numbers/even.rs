//! Points of an additive sequence, which fill a square or a cube evenly.

/// Points of an additive sequence (Roberts's generalised golden ratio), shifted. Any successive points fill the cube evenly.
///
/// If the shift is uniform, each point is uniform, so that estimates from the points are unbiased. A number costs one addition.
///
/// ```
/// use hairis_render::numbers::Even;
/// let even = Even::cube([0.3, 0.9, 0.6]);
/// assert_eq!(even.eight(5)[1][3], even.at(8)[1]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Even<const D: usize> {
    /// Shift in units of 2^-32, like the steps, so that sums wrap around as they should.
    shift: [u32; D],
    steps: [u32; D],
}

/// Powers of `1/g`, `g^(D + 1) = g + 1`, in units of 2^-32.
const SQUARE: [u32; 2] = [3_242_174_889, 2_447_445_414];
const CUBE: [u32; 3] = [3_518_319_155, 2_882_110_345, 2_360_945_575];

impl Even<2> {
    /// Creates the points of a square, from a shift in units of 2^-32.
    #[must_use]
    pub fn square(shift: [u32; 2]) -> Self {
        Self {
            shift,
            steps: SQUARE,
        }
    }
}

impl Even<3> {
    /// Creates the points of a cube, from a shift in `[0, 1)` along each axis.
    #[must_use]
    pub fn cube(shift: [f32; 3]) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a number of 24 bits below 2^32"
        )]
        let shift = shift.map(|x| (x * 4_294_967_296.0) as u32);
        Self { shift, steps: CUBE }
    }
}

impl<const D: usize> Even<D> {
    /// Returns the point of index `i`, which is in `[0, 1)` along each axis.
    #[inline]
    #[must_use]
    pub fn at(&self, i: u32) -> [f32; D] {
        core::array::from_fn(|axis| {
            unit(self.shift[axis].wrapping_add(self.steps[axis].wrapping_mul(i)))
        })
    }

    /// Returns the points `first` to `first + 7` by axis, one per lane.
    #[inline]
    #[must_use]
    pub fn eight(&self, first: u32) -> [[f32; 8]; D] {
        core::array::from_fn(|axis| {
            let (step, mut at) = (self.steps[axis], [0; 8]);
            at[0] = self.shift[axis].wrapping_add(step.wrapping_mul(first));
            for lane in 1..8 {
                at[lane] = at[lane - 1].wrapping_add(step);
            }
            at.map(unit)
        })
    }
}

/// Converts the upper 24 bits to a number in `[0, 1)`.
#[inline]
fn unit(bits: u32) -> f32 {
    // Convert from a signed number, which vectors do in one instruction.
    (bits >> 8).cast_signed() as f32 * (1.0 / 16_777_216.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_powers_of_the_golden_ratio() {
        for (steps, d) in [(&SQUARE[..], 2), (&CUBE[..], 3)] {
            let g = (0..60).fold(2.0_f64, |g, _| (1.0 + g).powf(1.0 / f64::from(d + 1)));
            for (step, power) in steps.iter().zip(1..) {
                let expected = g.powi(-power) * 4_294_967_296.0;
                assert!(
                    (f64::from(*step) - expected).abs() < 1.0,
                    "{step} for {expected}"
                );
            }
        }
    }

    #[test]
    fn rows_of_points_fill_the_square_evenly() {
        for first in [0, 1 << 14, 4_000_000_000] {
            let even = Even::square([123_456_789, 3_987_654_321]);
            let mut counts = [[0_u32; 4]; 4];
            for i in 0..64 {
                let [x, y] = even
                    .at(first + i)
                    .map(|x| (0..4).rev().find(|k| x * 4.0 >= *k as f32).unwrap_or(0));
                counts[x][y] += 1;
            }
            assert!(
                counts.iter().flatten().all(|count| (2..=6).contains(count)),
                "{counts:?}"
            );
        }
    }

    #[test]
    fn eight_points_are_those_of_one_at_a_time() {
        let even = Even::cube([0.25, 1.0 - f32::EPSILON / 2.0, 0.0]);
        for first in [0, 7, 1_000_003] {
            let [x, y, z] = even.eight(first);
            for (lane, i) in (first..first + 8).enumerate() {
                let one = even.at(i);
                assert!(one.iter().all(|x| (0.0..1.0).contains(x)), "{one:?}");
                assert_eq!(one, [x[lane], y[lane], z[lane]]);
            }
        }
    }
}
