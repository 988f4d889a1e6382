//! What a matched sampler keeps of a material, and of a material seen from one direction.

use super::MatchedBell;
use super::bands::bands;
use crate::hair::{prepare_point, selection, times};
use crate::lanes::{lanes3, pair::Pair, store3, store4};
use crate::{Broadcast, HairLobes, HairParams, HairPoint, Lanes, Lobe, LobeMask, Vec3x};
use core::f32::consts::{FRAC_PI_4, PI};
use wide::f32x8;

/// Energies below this share of the largest are none, nor are areas below it: next to denormals their reciprocals would have
/// no digits.
const LEAST_ENERGY: f32 = 1e-36;

/// Intensities below this share of the largest are none to the sampler.
const LEAST_IMPORTANCE: f64 = 1e-25;

crate::lane_struct! {
    /// The constants of a material with a matched sampler.
    ///
    /// Arrays of two are TT and the glints, of four in the order of [`Lobe`].
    pub struct MatchedMaterial {
        /// Its lobes.
        pub lobes: (HairLobes<C>),
        /// Intensity of each lobe, the mean of its RGB, to the scale of the largest.
        pub importance: [C; 4],
        /// The same times what a lobe integrates to for each unit of its longitude's integral.
        pub capacity: [C; 4],
        /// Integral of the azimuth's bell over one side.
        pub azimuth_mass: [C; 2],
        /// Its integral up to where the side begins.
        pub azimuth_from: [C; 2],
        /// The origin of both.
        pub azimuth_origin: [C; 2],
    }
}

/// The bands on one side of the normal plane, from the pole to the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MatchedSide<C, const N: usize> {
    /// W in each band.
    pub height: [C; N],
    /// Integral of M up to a band's end towards the pole, for each lobe.
    pub integral: [[C; 4]; N],
    /// Integral of `M W` over the side.
    pub area: [C; 4],
}

/// The constants of a gather point with a matched sampler of `N` bands a side.
///
/// Arrays of four are in the order of [`Lobe`], of two TT and the glints; the side below the normal plane is first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MatchedGather<C, const N: usize> {
    /// The lobes as seen from `wo`.
    pub point: HairPoint<C>,
    /// Origin of the integrals of each longitude.
    pub origin: [C; 4],
    /// The bands of each side.
    pub sides: [MatchedSide<C, N>; 2],
    /// Integral of `M W` over the sphere.
    pub area: [C; 4],
    /// Factor on `M N` of each lobe in the mixture density, but for W.
    pub weight: [C; 4],
    /// What areas are multiplied with, so that the largest is 1.
    pub scale: C,
    /// Probability of choosing each lobe.
    pub selection: [C; 4],
    /// Where the next lobe begins in `xi_lobe`.
    pub bounds: [C; 3],
    /// Integral of the azimuth's bell over one side.
    pub azimuth_mass: [C; 2],
    /// Its integral up to where the side begins.
    pub azimuth_from: [C; 2],
    /// The origin of both.
    pub azimuth_origin: [C; 2],
}

/// What each lobe integrates to, but for its colour, for each unit of its longitude's integral.
#[inline(always)]
fn extent<B: MatchedBell, L: Lanes, C: Broadcast<L>>(hair: &HairLobes<C>, azimuth_mass: [L; 2]) -> [L; 4] {
    // dtheta_i is two widths for each of x; the azimuth of R and TRT-g has an area of 4, and bells have two sides.
    let unit = L::splat(2.0 * B::UNIT);
    let [r, tt, trt] = [hair.beta[0].lanes() * unit, hair.beta[1].lanes() * unit, hair.beta[2].lanes() * unit];
    let sides = L::splat(4.0 * B::UNIT);
    let azimuth_tt = hair.half_gamma[0].lanes() * azimuth_mass[0] * sides;
    let azimuth_g = hair.half_gamma[1].lanes() * azimuth_mass[1] * sides;
    let four = L::splat(4.0);
    [r * four, tt * azimuth_tt, trt * four, trt * azimuth_g]
}

impl MatchedMaterial<f32> {
    /// The material of checked parameters.
    #[inline]
    #[must_use]
    pub(super) fn of<B: MatchedBell>(bell: B, params: &HairParams) -> Self {
        let lobes = HairLobes::of(bell, params);
        let phi_g = params.desc().phi_g;
        let [inv_gamma_tt, inv_gamma_g] = lobes.inv_half_gamma.map(|inv| 0.5 * inv);
        let sides = [(0.0, PI * inv_gamma_tt), (-phi_g * inv_gamma_g, (PI - phi_g) * inv_gamma_g)];
        let azimuth_origin = sides.map(|(lo, hi)| B::origin(lo, hi));
        let from_to = |i: usize| [sides[i].0, sides[i].1].map(|x| B::integral(azimuth_origin[i], x));
        let [tt, glint] = [from_to(0), from_to(1)];
        // Integrals ascend but for their rounding.
        let azimuth_mass = [tt, glint].map(|[from, to]| 0.0_f32.max(to - from));
        let importance = importance(params);
        Self {
            lobes,
            importance,
            capacity: times(extent::<B, f32, f32>(&lobes, azimuth_mass), importance),
            azimuth_mass,
            azimuth_from: [tt[0], glint[0]],
            azimuth_origin,
        }
    }
}

/// Intensity of each lobe to the scale of the largest.
///
/// In double precision: the product of two of the largest legal intensities overflows a float.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "shares of the largest, in [0, 1]")]
fn importance(params: &HairParams) -> [f32; 4] {
    let d = params.desc();
    let mean = |rgb: [f32; 3]| rgb.iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0;
    let trt = mean(d.intensity_trt);
    let all = [mean(d.intensity_r), mean(d.intensity_tt), trt, trt * f64::from(d.intensity_g)];
    let largest = all.iter().fold(0.0, |a: f64, i| a.max(*i));
    all.map(|i| if i > largest * LEAST_IMPORTANCE { (i / largest) as f32 } else { 0.0 })
}

/// A longitude, from the lower pole and from the upper one towards the normal plane, side by side.
#[derive(Clone, Copy)]
struct Longitude<L> {
    shift: L,
    inv_beta: L,
    origin: L,
    /// Integral of M up to here, and that of `M W` from the pole.
    integral: Pair<L>,
    area: Pair<L>,
}

impl<L: Lanes> Longitude<L> {
    /// At the poles.
    #[inline(always)]
    fn at_poles<B: MatchedBell>(shift: L, inv_beta: L) -> Self {
        let (zero, quarter) = (L::splat(0.0), L::splat(FRAC_PI_4));
        let origin = B::origin((shift - quarter) * inv_beta, (shift + quarter) * inv_beta);
        let this = Self { shift, inv_beta, origin, integral: Pair(zero, zero), area: Pair(zero, zero) };
        Self { integral: this.integral_to::<B>(FRAC_PI_4), ..this }
    }

    /// The integrals up to half an inclination on either side.
    #[inline(always)]
    fn integral_to<B: MatchedBell>(&self, half_theta_i: f32) -> Pair<L> {
        let end = L::splat(half_theta_i);
        let x = Pair((self.shift - end) * self.inv_beta, (self.shift + end) * self.inv_beta);
        B::integral(Pair(self.origin, self.origin), x)
    }

    /// Goes on through a band.
    #[inline(always)]
    fn pass<B: MatchedBell>(&mut self, half_theta_i: f32, height: Pair<L>) {
        let next = self.integral_to::<B>(half_theta_i);
        self.area = (next - self.integral).abs().mul_add(height, self.area);
        self.integral = next;
    }
}

/// Runs a body for every band `j` of `N`: straight on, so that what it writes is written where it belongs.
macro_rules! for_bands {
    ($j:ident < $n:ident, $body:block) => { for_bands!(@$j $n $body 0 1 2 3 4 5 6 7 8 9 10 11) };
    (@$j:ident $n:ident $body:block $($i:literal)*) => {
        $(if $i < $n {
            let $j = $i;
            $body
        })*
    };
}

/// Both sides, and R, TT and TRT when they have passed them.
#[inline(always)]
fn sides<B: MatchedBell, L: Lanes, const N: usize>(
    shift: [L; 3],
    inv_beta: [L; 3],
    theta_o: [L; 2],
) -> ([MatchedSide<L::Stored, N>; 2], [Longitude<L>; 3]) {
    let mut r = Longitude::at_poles::<B>(shift[0], inv_beta[0]);
    let mut tt = Longitude::at_poles::<B>(shift[1], inv_beta[1]);
    let mut trt = Longitude::at_poles::<B>(shift[2], inv_beta[2]);
    let none = L::splat(0.0).store();
    let side = MatchedSide { height: [none; N], integral: [[none; 4]; N], area: [none; 4] };
    let [mut lower, mut upper] = [side; 2];
    for_bands!(j < N, {
        let band = &const { bands::<N>() }[j];
        lower.integral[j] = shared4([r.integral.0, tt.integral.0, trt.integral.0]);
        upper.integral[j] = shared4([r.integral.1, tt.integral.1, trt.integral.1]);
        let w = band.residual(theta_o);
        (lower.height[j], upper.height[j]) = (w.0.store(), w.1.store());
        r.pass::<B>(band.half_inner, w);
        tt.pass::<B>(band.half_inner, w);
        trt.pass::<B>(band.half_inner, w);
    });
    lower.area = shared4([r.area.0, tt.area.0, trt.area.0]);
    upper.area = shared4([r.area.1, tt.area.1, trt.area.1]);
    ([lower, upper], [r, tt, trt])
}

/// The gather point of a material seen from `wo`.
#[inline(always)]
pub(super) fn prepare<B: MatchedBell, L: Lanes, C: Broadcast<L>, const N: usize>(
    m: &MatchedMaterial<C>,
    wo: Vec3x<L>,
) -> MatchedGather<L::Stored, N> {
    let c = L::splat;
    let zero = c(0.0);
    let hair = &m.lobes;
    let point = prepare_point(hair, wo);
    let theta_o = [point.half_sin_theta_o.lanes(), point.half_cos_theta_o.lanes()];
    let (shift, inv_beta) = (lanes3(&[point.shift[0], point.shift[1], point.shift[2]]), lanes3(&hair.inv_beta));
    let (sides, [r, tt, trt]) = sides::<B, L, N>(shift, inv_beta, theta_o);
    let origin = [r.origin, tt.origin, trt.origin];
    // The glints share the longitude of TRT.
    let trt = trt.area.0 + trt.area.1;
    let total = [r.area.0 + r.area.1, tt.area.0 + tt.area.1, trt, trt];

    // Energies to the scale of the largest area, which may be next to nothing where all lobes lie off the sphere.
    let capacity = [m.capacity[0].lanes(), m.capacity[1].lanes(), m.capacity[2].lanes(), m.capacity[3].lanes()];
    let mut largest = zero;
    let mut l = 0;
    while l < 4 {
        largest = largest.max(L::keep(zero.lt(capacity[l]), total[l]));
        l += 1;
    }
    let scale = L::select(zero.lt(largest), c(1.0) / largest, zero);
    let mut energy = [zero; 4];
    l = 0;
    while l < 4 {
        let e = capacity[l] * (total[l] * scale);
        energy[l] = L::keep(c(LEAST_ENERGY).lt(e), e);
        l += 1;
    }
    let (p, bounds, inv_total) = selection(energy);
    let mut weight = [zero; 4];
    l = 0;
    while l < 4 {
        weight[l] = L::keep(zero.lt(energy[l]), m.importance[l].lanes() * inv_total);
        l += 1;
    }

    MatchedGather {
        point,
        origin: shared4(origin),
        sides,
        area: store4(total),
        weight: store4(weight),
        scale: scale.store(),
        selection: store4(p),
        bounds: store3(bounds),
        azimuth_mass: spread2::<L, C>(&m.azimuth_mass),
        azimuth_from: spread2::<L, C>(&m.azimuth_from),
        azimuth_origin: spread2::<L, C>(&m.azimuth_origin),
    }
}

/// R, TT, TRT, and for the glints TRT again.
#[inline(always)]
fn shared4<L: Lanes>([r, tt, trt]: [L; 3]) -> [L::Stored; 4] {
    store4([r, tt, trt, trt])
}

/// Two numbers of a material, a lane each.
#[inline(always)]
fn spread2<L: Lanes, C: Broadcast<L>>(x: &[C; 2]) -> [L::Stored; 2] {
    [x[0].lanes().store(), x[1].lanes().store()]
}

impl<C, const N: usize> MatchedGather<C, N> {
    /// W in the band of an inclination.
    #[inline(always)]
    pub(super) fn height<L: Lanes>(&self, sin_theta_i: L) -> L
    where
        C: Broadcast<L>,
    {
        let across = sin_theta_i.abs();
        let [below, above] = [&self.sides[0].height, &self.sides[1].height];
        let (mut lower, mut upper) = (below[0].lanes(), above[0].lanes());
        let mut j = 1;
        while j < N {
            let inside = across.lt(L::splat(const { bands::<N>() }[j].outer));
            lower = L::select(inside, below[j].lanes(), lower);
            upper = L::select(inside, above[j].lanes(), upper);
            j += 1;
        }
        L::select(sin_theta_i.lt(L::splat(0.0)), lower, upper)
    }

    /// Factors on `M N W` of a lobe drawn alone, to be applied one after the other: their product may be too large.
    #[inline(always)]
    pub(super) fn lone_density<B: MatchedBell, L: Lanes>(&self) -> [[L; 4]; 2]
    where
        C: Broadcast<L>,
    {
        let one = L::splat(1.0);
        let azimuth_mass = [self.azimuth_mass[0].lanes(), self.azimuth_mass[1].lanes()];
        let mut by_extent = extent::<B, L, C>(&self.point.lobes, azimuth_mass);
        let mut by_area = by_extent;
        let mut l = 0;
        while l < 4 {
            let area = self.area[l].lanes();
            by_area[l] = L::keep(L::splat(LEAST_ENERGY).lt(area), one / area);
            by_extent[l] = L::keep(L::splat(0.0).lt(by_extent[l]), one / by_extent[l]);
            l += 1;
        }
        [by_area, by_extent]
    }
}

impl<C: Lanes, const N: usize> MatchedGather<C, N> {
    /// The gather point with only some of its lobes.
    #[inline(always)]
    pub(super) fn restrict(&self, lobes: LobeMask) -> Self {
        let factor = Lobe::ALL.map(|lobe| C::splat(lobes.factor(lobe)));
        let (p, bounds, inv_total) = selection(times(self.selection, factor));
        let weight = times(times(self.weight, factor), [inv_total; 4]);
        Self { point: self.point.restrict(lobes), weight, selection: p, bounds, ..*self }
    }
}

impl<const N: usize> MatchedGather<f32x8, N> {
    /// The numbers of one lane.
    ///
    /// # Panics
    ///
    /// If `lane` is above 7.
    #[inline]
    #[must_use]
    pub fn lane(&self, lane: usize) -> MatchedGather<f32, N> {
        let at = |x: f32x8| x.as_array()[lane];
        MatchedGather {
            point: self.point.lane(lane),
            origin: self.origin.map(at),
            sides: self.sides.map(|side| MatchedSide {
                height: side.height.map(at),
                integral: side.integral.map(|band| band.map(at)),
                area: side.area.map(at),
            }),
            area: self.area.map(at),
            weight: self.weight.map(at),
            scale: at(self.scale),
            selection: self.selection.map(at),
            bounds: self.bounds.map(at),
            azimuth_mass: self.azimuth_mass.map(at),
            azimuth_from: self.azimuth_from.map(at),
            azimuth_origin: self.azimuth_origin.map(at),
        }
    }
}
