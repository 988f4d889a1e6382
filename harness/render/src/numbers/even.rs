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

impl Even<2> {
    /// Steps along the axes: powers of `1/g`, `g^3 = g + 1`, in units of 2^-32.
    pub const STEPS: [u32; 2] = [3_242_174_889, 2_447_445_414];

    /// Creates the points of a square, from a shift in units of 2^-32.
    #[must_use]
    pub fn square(shift: [u32; 2]) -> Self {
        Self {
            shift,
            steps: Self::STEPS,
        }
    }
}

impl Even<3> {
    /// Steps along the axes: powers of `1/g`, `g^4 = g + 1`, in units of 2^-32.
    pub const STEPS: [u32; 3] = [3_518_319_155, 2_882_110_345, 2_360_945_575];

    /// Creates the points of a cube, from a shift in `[0, 1)` along each axis.
    #[must_use]
    pub fn cube(shift: [f32; 3]) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a number of 24 bits below 2^32"
        )]
        let shift = shift.map(|x| (x * 4_294_967_296.0) as u32);
        Self {
            shift,
            steps: Self::STEPS,
        }
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
