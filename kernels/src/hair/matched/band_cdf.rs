//! Cumulative integrals of the lobes' inclinations over the bands.

use super::MatchedBell;
use super::bands::bands;
use super::hemispheres::Hemispheres;
use crate::simd::{Lanes, store4};
use core::f32::consts::FRAC_PI_4;

/// Cumulative integrals of an inclination, from the lower pole inwards and from the upper pole inwards.
#[derive(Clone, Copy)]
struct Inclination<P> {
    shift: P,
    inv_beta: P,
    origin: P,
    /// Integral of M up to the current point, negative above the normal plane, so that it ascends from either pole.
    integral: P,
    /// Integral of `M W` from the pole.
    area: P,
}

impl<P: Lanes> Inclination<P> {
    /// Makes the integrals at the poles.
    #[inline(always)]
    fn at_poles<B: MatchedBell, L, const K: usize>(quarter_o: P, shift: P, inv_beta: P) -> Self
    where
        P: Hemispheres<L, K>,
    {
        let (none, quarter) = (P::splat(0.0), P::splat(FRAC_PI_4));
        let [lo, hi] = [(quarter_o - quarter) + shift, (quarter_o + quarter) + shift];
        let origin = B::origin(lo * inv_beta, hi * inv_beta);
        let this = Self {
            shift,
            inv_beta,
            origin,
            integral: none,
            area: none,
        };
        Self {
            integral: this.integral_to::<B, L, K>(quarter_o + P::outwards(FRAC_PI_4)),
            ..this
        }
    }

    /// Computes the integrals up to half an inclination, plus `quarter_o`, in either hemisphere.
    #[inline(always)]
    fn integral_to<B: MatchedBell, L, const K: usize>(&self, to: P) -> P
    where
        P: Hemispheres<L, K>,
    {
        B::integral(self.origin, (to + self.shift) * self.inv_beta).negate_above()
    }

    /// Advances through a band, and returns the offset of its line.
    #[inline(always)]
    fn pass<B: MatchedBell, L, const K: usize>(&mut self, to: P, height: P, minus_slope: P) -> P
    where
        P: Hemispheres<L, K>,
    {
        let offset = self.offset(minus_slope);
        let next = self.integral_to::<B, L, K>(to);
        self.area = (next - self.integral).abs().mul_add(height, self.area);
        self.integral = next;
        offset
    }

    /// Returns the integral, less a slope times the area.
    #[inline(always)]
    fn offset(&self, minus_slope: P) -> P {
        minus_slope.mul_add(self.area, self.integral)
    }

    /// Returns the integral of `M W` up to a point in the middle band, and over the sphere.
    #[inline(always)]
    fn join<L, const K: usize>(&self, height: P) -> [P; 2]
    where
        P: Hemispheres<L, K>,
    {
        let middle = (self.integral + self.integral.swapped()).abs() * height;
        [
            middle.mul_add(P::splat(0.5), self.area),
            (self.area + self.area.swapped()) + middle,
        ]
    }
}

/// Runs a body for every `j` below `n`, up to twelve, unrolled so that its writes have constant indices.
macro_rules! for_each {
    ($j:ident < $n:expr, $body:block) => { for_each!(@$j ($n) $body 0 1 2 3 4 5 6 7 8 9 10 11) };
    (@$j:ident $n:tt $body:block $($i:literal)*) => {
        $(if const { $i < $n } {
            let $j = $i;
            $body
        })*
    };
}

/// Cdf of the inclinations over the bands, as [`MatchedPrepared`](super::MatchedPrepared) has it; arrays of three hold R, TT and
/// TRT.
pub(super) struct BandCdf<L: Lanes, const N: usize> {
    pub(super) origin: [L; 3],
    pub(super) height: [L::Stored; N],
    pub(super) slope: [L::Stored; N],
    pub(super) offset: [[L::Stored; 4]; N],
    pub(super) offset_above: [L::Stored; 4],
    pub(super) below: [L; 3],
    pub(super) area: [L; 3],
}

/// Stores the numbers of R, TT and TRT, and for the glints that of TRT again.
#[inline(always)]
pub(super) fn shared4<L: Lanes>([r, tt, trt]: [L; 3]) -> [L::Stored; 4] {
    store4([r, tt, trt, trt])
}

/// Integrates over all bands, from both poles to the middle.
#[inline(always)]
pub(super) fn integrate_bands<
    B: MatchedBell,
    L: Lanes,
    P: Hemispheres<L, K>,
    const K: usize,
    const N: usize,
>(
    quarter_o: L,
    shift: [L; 3],
    inv_beta: [L; 3],
    theta_o: [L; 2],
) -> BandCdf<L, N> {
    L::stage(
        "integrals of the lobes' bells over the bands of inclination, from both poles to the middle",
    );
    let none = L::splat(0.0);
    let (quarter_o, shift, inv_beta) =
        (P::of(quarter_o), P::of_lobes(shift), P::of_lobes(inv_beta));
    let mut lobes = [Inclination::at_poles::<B, L, K>(quarter_o, shift[0], inv_beta[0]); K];
    for_each!(k < K, {
        lobes[k] = Inclination::at_poles::<B, L, K>(quarter_o, shift[k], inv_beta[k]);
    });
    let mut of_lobes = [P::splat(0.0); K];
    for_each!(k < K, {
        of_lobes[k] = lobes[k].origin;
    });
    let [origin, _] = P::lobes_apart(of_lobes);
    let mut cdf = BandCdf {
        origin,
        height: [none.store(); N],
        slope: [none.store(); N],
        offset: [[none.store(); 4]; N],
        offset_above: [none.store(); 4],
        below: [none; 3],
        area: [none; 3],
    };
    let (mut height, mut minus_slope) = (P::splat(0.0), P::splat(f32::MIN));
    for_each!(j < N / 2, {
        let band = &const { bands(N) }[j];
        // Heights ascend inwards, although W may have its mode before the middle.
        let cos_sq: P = band.cos_sq_theta_d(theta_o);
        height = height.max(P::quotient(P::splat(band.cos_sq_theta_i()), cos_sq));
        minus_slope = minus_slope.max(cos_sq * (-1.0 / band.cos_sq_theta_i()));
        let to = quarter_o + P::outwards(band.half_inner);
        for_each!(k < K, {
            of_lobes[k] = lobes[k].pass::<B, L, K>(to, height, minus_slope);
        });
        let (heights, slopes, offsets) = (
            height.apart(),
            minus_slope.abs().apart(),
            P::lobes_apart(of_lobes),
        );
        (cdf.height[j], cdf.height[N - 1 - j]) = (heights[0].store(), heights[1].store());
        (cdf.slope[j], cdf.slope[N - 1 - j]) = (slopes[0].store(), slopes[1].store());
        (cdf.offset[j], cdf.offset[N - 1 - j]) = (shared4(offsets[0]), shared4(offsets[1]));
    });
    let cos_sq: P = const { bands(N) }[N / 2].cos_sq_theta_d(theta_o);
    let height = height
        .max(height.swapped())
        .max(P::quotient(P::splat(1.0), cos_sq));
    let slope = minus_slope.max(minus_slope.swapped()).abs().min(cos_sq);
    let minus_slope = slope.times_sign(P::splat(-1.0));
    (cdf.height[N / 2], cdf.slope[N / 2]) = (height.apart()[0].store(), slope.apart()[0].store());
    let mut area = of_lobes;
    let mut below = of_lobes;
    for_each!(k < K, {
        of_lobes[k] = lobes[k].offset(minus_slope);
        [below[k], area[k]] = lobes[k].join::<L, K>(height);
    });
    let [offset, offset_above] = P::lobes_apart(of_lobes);
    (cdf.offset[N / 2], cdf.offset_above) = (shared4(offset), shared4(offset_above));
    ([cdf.below, _], [cdf.area, _]) = (P::lobes_apart(below), P::lobes_apart(area));
    cdf
}
