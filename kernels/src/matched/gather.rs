//! What a matched sampler keeps of a material seen from one direction.

use super::MatchedBell;
use super::bands::bands;
use super::material::{MatchedMaterial, extent};
use crate::hair::{prepare_point, selection, times};
use crate::lanes::{lanes4, pair::Pair, store3, store4};
use crate::{Broadcast, HairPoint, Lanes, Lobe, LobeMask, Vec3x};
use core::f32::consts::FRAC_PI_4;
use wide::f32x8;

/// Energies below this share of the largest are none, nor are areas below it: next to denormals their reciprocals would have
/// no digits.
const LEAST_ENERGY: f32 = 1e-36;

/// A channel below this share of the largest has no say in the choice of lobes: the square of its reciprocal is a float.
const LEAST_CHANNEL: f32 = 1e-18;

/// The constants of a gather point with a matched sampler of `N` bands.
///
/// Arrays of four are in the order of [`Lobe`], of two TT and the glints, of `N` from the lower pole to the upper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MatchedGather<C, const N: usize> {
    /// The lobes as seen from `wo`.
    pub point: HairPoint<C>,
    /// Origin of the integrals of each longitude.
    pub origin: [C; 4],
    /// What W is taken for in each band: it ascends to the band in the middle.
    pub height: [C; N],
    /// One over it.
    pub slope: [C; N],
    /// In each band the integral of a lobe's M is this much more than `slope` times that of `M W` from the nearer pole. Above the
    /// middle it is the negative integral.
    pub offset: [[C; 4]; N],
    /// The same in the middle, with the integral of `M W` from the upper pole.
    pub offset_above: [C; 4],
    /// Integral of `M W` from the lower pole up to somewhere in the middle.
    pub below: [C; 4],
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

/// Runs a body for every band `j` of the `n` on a side: straight on, as the bands are constants.
macro_rules! for_bands {
    ($j:ident < $n:expr, $body:block) => { for_bands!(@$j ($n) $body 0 1 2 3 4 5 6 7 8 9 10 11) };
    (@$j:ident $n:tt $body:block $($i:literal)*) => {
        $(if $i < $n {
            let $j = $i;
            $body
        })*
    };
}

impl<C: Copy, const N: usize> MatchedGather<C, N> {
    /// The heights of the bands as seen from an inclination.
    #[inline(always)]
    fn see<L: Lanes<Stored = C>>(&mut self, theta_o: [L; 2]) {
        let (mut height, mut slope) = (Pair::splat(0.0), Pair::splat(f32::MAX));
        for_bands!(j < N / 2, {
            let band = &const { bands(N) }[j];
            let above = N - 1 - j;
            // Heights ascend inwards, though W may have its mode before the middle.
            let cos_sq = band.cos_sq_theta_d(theta_o);
            height = height.max(Pair::splat(band.cos_sq_theta_i()) / cos_sq);
            slope = slope.min(cos_sq * Pair::splat(1.0 / band.cos_sq_theta_i()));
            (self.height[j], self.height[above]) = (height.0.store(), height.1.store());
            (self.slope[j], self.slope[above]) = (slope.0.store(), slope.1.store());
        });
        let cos_sq = const { bands(N) }[N / 2].cos_sq_theta_d(theta_o).0;
        self.height[N / 2] = height.0.max(height.1).max(L::splat(1.0) / cos_sq).store();
        self.slope[N / 2] = slope.0.min(slope.1).min(cos_sq).store();
    }

    /// Lobe `l`, through all bands from both poles to the middle, side by side. Integrals above are negative: they ascend from
    /// either pole.
    #[inline(always)]
    fn add<B: MatchedBell, L: Lanes<Stored = C>>(&mut self, l: usize, shift: L, inv_beta: L)
    where
        C: Broadcast<L>,
    {
        let (zero, quarter) = (L::splat(0.0), L::splat(FRAC_PI_4));
        let origin = B::origin((shift - quarter) * inv_beta, (shift + quarter) * inv_beta);
        self.origin[l] = origin.store();
        let lobe = Longitude { shift, inv_beta, origin };
        // Integrals up to here of M, and from the pole of M W.
        let (mut integral, mut area) = (lobe.integral::<B>(FRAC_PI_4), Pair(zero, zero));
        for_bands!(j < N / 2, {
            let above = N - 1 - j;
            let slope = Pair(self.slope[j].lanes(), self.slope[above].lanes());
            let offset = (-slope).mul_add(area, integral);
            (self.offset[j][l], self.offset[above][l]) = (offset.0.store(), offset.1.store());
            let next = lobe.integral::<B>(const { bands(N) }[j].half_inner);
            area = (next - integral).abs().mul_add(Pair(self.height[j].lanes(), self.height[above].lanes()), area);
            integral = next;
        });
        let slope: L = self.slope[N / 2].lanes();
        let offset = (-Pair(slope, slope)).mul_add(area, integral);
        (self.offset[N / 2][l], self.offset_above[l]) = (offset.0.store(), offset.1.store());
        let middle = (integral.0 + integral.1).abs() * self.height[N / 2].lanes();
        self.below[l] = middle.mul_add(L::splat(0.5), area.0).store();
        self.area[l] = ((area.0 + area.1) + middle).store();
    }

    /// The glints have the longitude of TRT.
    #[inline(always)]
    fn share(&mut self) {
        for_bands!(j < N / 2, {
            let above = N - 1 - j;
            (self.offset[j][3], self.offset[above][3]) = (self.offset[j][2], self.offset[above][2]);
        });
        self.offset[N / 2][3] = self.offset[N / 2][2];
        self.offset_above[3] = self.offset_above[2];
        self.origin[3] = self.origin[2];
        self.below[3] = self.below[2];
        self.area[3] = self.area[2];
    }
}

/// The longitude of a lobe.
struct Longitude<L> {
    shift: L,
    inv_beta: L,
    origin: L,
}

impl<L: Lanes> Longitude<L> {
    /// The integral of M up to half an inclination below the normal plane, and less that of as much above it.
    #[inline(always)]
    fn integral<B: MatchedBell>(&self, half_theta_i: f32) -> Pair<L> {
        let end = L::splat(half_theta_i);
        let x = Pair((self.shift - end) * self.inv_beta, (self.shift + end) * self.inv_beta);
        let Pair(below, above) = B::integral(Pair(self.origin, self.origin), x);
        Pair(below, -above)
    }
}

/// The gather point of a material seen from `wo`.
#[inline(always)]
pub(super) fn prepare<B: MatchedBell, L: Lanes, C: Broadcast<L>, const N: usize, const BY_CHANNEL: bool>(
    m: &MatchedMaterial<C>,
    wo: Vec3x<L>,
) -> MatchedGather<L::Stored, N> {
    let c = L::splat;
    let zero = c(0.0);
    let hair = &m.lobes;
    let point = prepare_point(hair, wo);
    let theta_o = [point.half_sin_theta_o.lanes(), point.half_cos_theta_o.lanes()];
    let none = zero.store();
    let mut gather = MatchedGather {
        point,
        origin: [none; 4],
        height: [none; N],
        slope: [none; N],
        offset: [[none; 4]; N],
        offset_above: [none; 4],
        below: [none; 4],
        area: [none; 4],
        weight: [none; 4],
        scale: none,
        selection: [none; 4],
        bounds: [none; 3],
        azimuth_mass: spread2::<L, C>(&m.azimuth_mass),
        azimuth_from: spread2::<L, C>(&m.azimuth_from),
        azimuth_origin: spread2::<L, C>(&m.azimuth_origin),
    };
    gather.see(theta_o);
    let mut l = 0;
    while l < 3 {
        gather.add::<B, L>(l, gather.point.shift[l].lanes(), hair.inv_beta[l].lanes());
        l += 1;
    }
    gather.share();
    let total = lanes4(&gather.area);

    // To the scale of the largest area, which may be next to nothing where all lobes lie off the sphere.
    let mut importance = lanes4(&m.importance);
    let mut size = lanes4(&m.extent);
    let mut largest = zero;
    l = 0;
    while l < 4 {
        largest = largest.max(L::keep(zero.lt(importance[l] * size[l]), total[l]));
        l += 1;
    }
    let scale = L::select(zero.lt(largest), c(1.0) / largest, zero);
    l = 0;
    while l < 4 {
        size[l] = size[l] * (total[l] * scale);
        l += 1;
    }
    if BY_CHANNEL {
        importance = by_channel::<L, C>(size, &m.intensity);
    }
    let mut energy = times(importance, size);
    l = 0;
    while l < 4 {
        energy[l] = L::keep(c(LEAST_ENERGY).lt(energy[l]), energy[l]);
        l += 1;
    }
    let (p, bounds, inv_total) = selection(energy);
    let mut weight = [zero; 4];
    l = 0;
    while l < 4 {
        weight[l] = L::keep(zero.lt(energy[l]), importance[l] * inv_total);
        l += 1;
    }

    gather.weight = store4(weight);
    gather.scale = scale.store();
    gather.selection = store4(p);
    gather.bounds = store3(bounds);
    gather
}

/// The importance of lobes of these sizes that lets each have the root of the sum of its squared shares of the channels.
#[inline(always)]
fn by_channel<L: Lanes, C: Broadcast<L>>(size: [L; 4], intensity: &[C; 12]) -> [L; 4] {
    let zero = L::splat(0.0);
    let (mut total, mut most) = ([zero; 3], zero);
    let mut c = 0;
    while c < 3 {
        let mut l = 0;
        while l < 4 {
            total[c] = intensity[3 * l + c].lanes().mul_add(size[l], total[c]);
            l += 1;
        }
        most = most.max(total[c]);
        c += 1;
    }
    let mut sum = [zero; 4];
    c = 0;
    while c < 3 {
        let relative = L::keep((most * L::splat(LEAST_CHANNEL)).lt(total[c]), most / total[c]);
        let mut l = 0;
        while l < 4 {
            let share = intensity[3 * l + c].lanes() * relative;
            sum[l] = share.mul_add(share, sum[l]);
            l += 1;
        }
        c += 1;
    }
    [sum[0].sqrt(), sum[1].sqrt(), sum[2].sqrt(), sum[3].sqrt()]
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
        let below = sin_theta_i.lt(L::splat(0.0));
        let mut height = L::select(below, self.height[0].lanes(), self.height[N - 1].lanes());
        let mut j = 1;
        while j <= N / 2 {
            let inside = across.lt(L::splat(const { bands(N) }[j].outer));
            let next = if j < N / 2 {
                L::select(below, self.height[j].lanes(), self.height[N - 1 - j].lanes())
            } else {
                self.height[j].lanes()
            };
            height = L::select(inside, next, height);
            j += 1;
        }
        height
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
            height: self.height.map(at),
            slope: self.slope.map(at),
            offset: self.offset.map(|band| band.map(at)),
            offset_above: self.offset_above.map(at),
            below: self.below.map(at),
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
