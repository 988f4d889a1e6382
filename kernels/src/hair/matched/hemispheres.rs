//! Inclinations of the three lobes in both hemispheres, in lanes: below the normal plane and above it.

use crate::simd::Lanes;
use crate::simd::pair::Pair;
use crate::simd::portable::Unfused;
use wide::f32x8;

/// Numbers of lobes below the normal plane and above it; `K` such numbers hold R, TT and TRT.
pub(super) trait Hemispheres<L, const K: usize>: Lanes {
    /// Repeats a number for all lobes, in both hemispheres.
    fn of(x: L) -> Self;
    /// Loads one number each for R, TT and TRT, the same in both hemispheres.
    fn of_lobes(x: [L; 3]) -> [Self; K];
    /// Returns `-x` below the normal plane and `x` above.
    fn outwards(x: f32) -> Self;
    /// Negates the number above the normal plane, and keeps it below.
    fn negate_above(self) -> Self;
    /// Exchanges the hemispheres.
    fn swapped(self) -> Self;
    /// Returns the numbers below and above, for a quantity that is the same for all lobes.
    fn apart(self) -> [L; 2];
    /// Returns the numbers of R, TT and TRT below the normal plane, and above it.
    fn lobes_apart(x: [Self; K]) -> [[L; 3]; 2];
}

/// Packets, which compute one lobe at a time.
impl<L: Lanes> Hemispheres<L, 3> for Pair<L> {
    #[inline(always)]
    fn of(x: L) -> Self {
        Self(x, x)
    }
    #[inline(always)]
    fn of_lobes([r, tt, trt]: [L; 3]) -> [Self; 3] {
        [Self(r, r), Self(tt, tt), Self(trt, trt)]
    }
    #[inline(always)]
    fn outwards(x: f32) -> Self {
        Self(L::splat(-x), L::splat(x))
    }
    #[inline(always)]
    fn negate_above(self) -> Self {
        Self(self.0, self.1.times_sign(L::splat(-1.0)))
    }
    #[inline(always)]
    fn swapped(self) -> Self {
        Self(self.1, self.0)
    }
    #[inline(always)]
    fn apart(self) -> [L; 2] {
        [self.0, self.1]
    }
    #[inline(always)]
    fn lobes_apart([r, tt, trt]: [Self; 3]) -> [[L; 3]; 2] {
        [[r.0, tt.0, trt.0], [r.1, tt.1, trt.1]]
    }
}

/// One shading point: lanes 0 to 2 are the lobes below, and lanes 4 to 6 the lobes above. One lane would compute each after the
/// other and give the same bits, because these lanes do not fuse either.
impl Hemispheres<f32, 1> for Unfused {
    #[inline(always)]
    fn of(x: f32) -> Self {
        <Self as Lanes>::splat(x)
    }
    #[inline(always)]
    fn of_lobes([r, tt, trt]: [f32; 3]) -> [Self; 1] {
        [Self(f32x8::new([r, tt, trt, trt, r, tt, trt, trt]))]
    }
    #[inline(always)]
    fn outwards(x: f32) -> Self {
        Self(f32x8::new([-x, -x, -x, -x, x, x, x, x]))
    }
    #[inline(always)]
    fn negate_above(self) -> Self {
        self.times_sign(<Self as Hemispheres<f32, 1>>::outwards(-1.0))
    }
    #[inline(always)]
    fn swapped(self) -> Self {
        let [a, b, c, d, e, f, g, h] = self.0.to_array();
        Self(f32x8::new([e, f, g, h, a, b, c, d]))
    }
    #[inline(always)]
    fn apart(self) -> [f32; 2] {
        let [below, .., above] = self.0.to_array();
        [below, above]
    }
    #[inline(always)]
    fn lobes_apart([x]: [Self; 1]) -> [[f32; 3]; 2] {
        let [r, tt, trt, _, r_above, tt_above, trt_above, _] = x.0.to_array();
        [[r, tt, trt], [r_above, tt_above, trt_above]]
    }
}
