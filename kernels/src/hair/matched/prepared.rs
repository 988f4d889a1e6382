//! Constants of a matched sampler per material and direction.

use super::MatchedBell;
use super::band_cdf::integrate_bands;
use super::bands::bands;
use super::hemispheres::Hemispheres;
use super::material::{MatchedMaterial, extent};
use crate::hair::{prepare_view, selection, times};
use crate::model::HairView;
use crate::simd::{Broadcast, LaneStruct, Lanes, Scalar, Vec3x, lanes3, lanes4, store3, store4};
use crate::{Lobe, LobeMask};
use wide::f32x8;

/// Energies and areas below this count as 0: next to denormals their reciprocals would have no digits. Energies are to the scale
/// of the brightest lobe and of the largest area.
const LEAST_ENERGY: f32 = 1e-36;

/// Least area above 0: a Gaussian is cut at `2^-115` of its peak, and W is at least .004 in a band. Its reciprocal is a float.
const LEAST_AREA: f32 = 3e-39;

/// A channel below this share of the largest is ignored in the choice of lobes: the square of its reciprocal is a float.
const LEAST_CHANNEL: f32 = 1e-18;

/// The constants of a shading point with a matched sampler of `N` bands.
///
/// Arrays of four are in the order of [`Lobe`], of two TT and the glints, of `N` from the lower pole to the upper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MatchedPrepared<C, const N: usize> {
    /// The lobes as seen from `wo`.
    pub view: HairView<C>,
    /// Origin of the integrals of each inclination.
    pub origin: [C; 4],
    /// The constant for W in each band; ascends to the band in the middle.
    pub height: [C; N],
    /// One over it.
    pub slope: [C; N],
    /// In each band the integral of a lobe's M exceeds `slope` times that of `M W` from the nearer pole by this much. Above the
    /// middle it is the negative integral.
    pub offset: [[C; 4]; N],
    /// The same in the middle, with the integral of `M W` from the upper pole.
    pub offset_above: [C; 4],
    /// Integral of `M W` from the lower pole up to a point in the middle band.
    pub below: [C; 4],
    /// Integral of `M W` over the sphere.
    pub area: [C; 4],
    /// Factor on `M N` of each lobe in the mixture density, but for W.
    pub weight: [C; 4],
    /// Factor on areas that makes the largest 1.
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

/// The shading point of a material seen from `wo`.
#[inline(always)]
pub(super) fn prepare<B, L, C, P, const K: usize, const N: usize, const BY_CHANNEL: bool>(
    m: &MatchedMaterial<C>,
    wo: Vec3x<L>,
) -> MatchedPrepared<L::Stored, N>
where
    B: MatchedBell,
    L: Lanes,
    C: Broadcast<L>,
    P: Hemispheres<L, K>,
{
    let c = L::splat;
    let zero = c(0.0);
    let hair = &m.lobes;
    let view = prepare_view(hair, wo);
    let theta_o = [view.half_sin_theta_o.lanes(), view.half_cos_theta_o.lanes()];
    let (shift, inv_beta) = (
        lanes3(&[view.shift[0], view.shift[1], view.shift[2]]),
        lanes3(&hair.inv_beta),
    );
    let cdf = integrate_bands::<B, L, P, K, N>(view.quarter_o.lanes(), shift, inv_beta, theta_o);
    // The glints share the inclination of TRT.
    let [r, tt, trt] = cdf.area;
    let total = [r, tt, trt, trt];

    // To the scale of the largest area, which may be next to nothing where all lobes lie off the sphere.
    let mut importance = lanes4(&m.importance);
    let mut size = lanes4(&m.extent);
    let mut largest = zero;
    let mut l = 0;
    while l < 4 {
        largest = largest.max(L::keep(zero.lt(importance[l] * size[l]), total[l]));
        l += 1;
    }
    let scale = L::select(zero.lt(largest), L::quotient(c(1.0), largest), zero);
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

    MatchedPrepared {
        view,
        origin: shared4(cdf.origin),
        height: cdf.height,
        slope: cdf.slope,
        offset: cdf.offset,
        offset_above: cdf.offset_above,
        below: shared4(cdf.below),
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

/// Sampling weights of lobes of these sizes: the root of the sum of the squared shares of the channels.
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
        let relative = L::keep(
            (most * L::splat(LEAST_CHANNEL)).lt(total[c]),
            L::quotient(most, total[c]),
        );
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

/// R, TT, TRT, and for the glints TRT again.
#[inline(always)]
pub(super) fn shared4<L: Lanes>([r, tt, trt]: [L; 3]) -> [L::Stored; 4] {
    store4([r, tt, trt, trt])
}

/// Two numbers of a material, one per lane.
#[inline(always)]
fn spread2<L: Lanes, C: Broadcast<L>>(x: &[C; 2]) -> [L::Stored; 2] {
    [x[0].lanes().store(), x[1].lanes().store()]
}

impl<C, const N: usize> MatchedPrepared<C, N> {
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
                L::select(
                    below,
                    self.height[j].lanes(),
                    self.height[N - 1 - j].lanes(),
                )
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
        let mut by_extent = extent::<B, L, C>(&self.view.lobes, azimuth_mass);
        let mut by_area = by_extent;
        let mut l = 0;
        while l < 4 {
            let area = self.area[l].lanes();
            by_area[l] = L::keep(
                L::splat(0.0).lt(area),
                L::quotient(one, area.max(L::splat(LEAST_AREA))),
            );
            by_extent[l] = L::keep(
                L::splat(0.0).lt(by_extent[l]),
                L::quotient(one, by_extent[l]),
            );
            l += 1;
        }
        [by_area, by_extent]
    }
}

impl<C: Lanes, const N: usize> MatchedPrepared<C, N> {
    /// The shading point with only some of its lobes.
    #[inline(always)]
    pub(super) fn restrict(&self, lobes: LobeMask) -> Self {
        let factor = Lobe::ALL.map(|lobe| C::splat(lobes.factor(lobe)));
        let (p, bounds, inv_total) = selection(times(self.selection, factor));
        let weight = times(times(self.weight, factor), [inv_total; 4]);
        Self {
            view: self.view.restrict(lobes),
            weight,
            selection: p,
            bounds,
            ..*self
        }
    }
}

impl<const N: usize> MatchedPrepared<f32x8, N> {
    /// The numbers of one lane.
    ///
    /// # Panics
    ///
    /// If `lane` is above 7.
    #[inline]
    #[must_use]
    pub fn lane(&self, lane: usize) -> MatchedPrepared<f32, N> {
        let at = |x: f32x8| x.as_array()[lane];
        MatchedPrepared {
            view: self.view.lane(lane),
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

impl<C: Scalar, const N: usize> LaneStruct for MatchedPrepared<C, N> {
    type One = MatchedPrepared<f32, N>;
    type Eight = MatchedPrepared<f32x8, N>;
    #[inline]
    fn pack(g: [&MatchedPrepared<f32, N>; 8]) -> MatchedPrepared<f32x8, N> {
        macro_rules! n {
            ($f:ident) => {
                core::array::from_fn(|i| f32x8::new(g.map(|g| g.$f[i])))
            };
        }
        MatchedPrepared {
            view: HairView::pack(g.map(|g| &g.view)),
            origin: n!(origin),
            height: n!(height),
            slope: n!(slope),
            offset: core::array::from_fn(|i| {
                core::array::from_fn(|j| f32x8::new(g.map(|g| g.offset[i][j])))
            }),
            offset_above: n!(offset_above),
            below: n!(below),
            area: n!(area),
            weight: n!(weight),
            scale: f32x8::new(g.map(|g| g.scale)),
            selection: n!(selection),
            bounds: n!(bounds),
            azimuth_mass: n!(azimuth_mass),
            azimuth_from: n!(azimuth_from),
            azimuth_origin: n!(azimuth_origin),
        }
    }
    #[inline]
    fn lane(eight: &MatchedPrepared<f32x8, N>, lane: usize) -> MatchedPrepared<f32, N> {
        eight.lane(lane)
    }
}
