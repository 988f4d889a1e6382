//! Constants of a matched sampler per material and direction.

use super::MatchedBell;
use super::band_cdf::{integrate_bands, shared4};
use super::bands::bands;
use super::hemispheres::Hemispheres;
use super::material::{MatchedMaterial, extent};
use crate::hair::{HairView, prepare_view, selection};
use crate::model::LobeMask;
use crate::model::lobe::times;
use crate::simd::{Broadcast, Lanes, Spread, Vec3x, lanes3, lanes4, store3, store4};

/// Least energy and area: smaller ones count as 0, because close to denormals their reciprocals would have no digits. Energies are
/// to the scale of the brightest lobe and of the largest area.
const LEAST_ENERGY: f32 = 1e-36;

/// Least area above 0: a Gaussian is cut at `2^-115` of its peak, and W is at least .004 in a band. Its reciprocal is a finite
/// float.
const LEAST_AREA: f32 = 3e-39;

/// Least share of the largest channel: a smaller channel is ignored in the choice of lobes, so that the square of the reciprocal is
/// a finite float.
const LEAST_CHANNEL: f32 = 1e-18;

crate::simd::lane_struct! {
    /// Constants of a shading point with a matched sampler of `N` bands.
    ///
    /// Arrays of four are in the order of [`Lobe`](crate::Lobe), arrays of two hold TT and the glints, and arrays of `N` run from
    /// the lower pole to the upper.
    pub struct MatchedPrepared<const N: usize> {
        /// Lobes as viewed from `wo`.
        pub(in crate::hair) view: HairView<C>,
        /// Origin of the integrals of each lobe's inclination.
        pub(in crate::hair) origin: [C; 4],
        /// Constant for W in each band, which ascends to the band in the middle.
        pub(in crate::hair) height: [C; N],
        /// Reciprocal of `height`.
        pub(in crate::hair) slope: [C; N],
        /// Excess, in each band, of the integral of a lobe's M over `slope` times the integral of `M W` from the nearer pole. Above
        /// the middle the integral of M is taken negative.
        pub(in crate::hair) offset: [[C; 4]; N],
        /// Offsets in the middle band, with the integral of `M W` from the upper pole.
        pub(in crate::hair) offset_above: [C; 4],
        /// Integral of `M W` from the lower pole up to a point in the middle band.
        pub(in crate::hair) below: [C; 4],
        /// Integral of `M W` over the sphere.
        pub(in crate::hair) area: [C; 4],
        /// Factor on `M N` of each lobe in the mixture density, without W.
        pub(in crate::hair) weight: [C; 4],
        /// Factor on areas that makes the largest area 1.
        pub(in crate::hair) scale: C,
        /// Probability of choosing each lobe.
        pub(in crate::hair) selection: [C; 4],
        /// Start of the next lobe in `xi_lobe`.
        pub(in crate::hair) bounds: [C; 3],
        /// Integral of the azimuth's bell over one side.
        pub(in crate::hair) azimuth_mass: [C; 2],
        /// Integral of the azimuth's bell up to the start of the side.
        pub(in crate::hair) azimuth_from: [C; 2],
        /// Origin of both integrals of the azimuth.
        pub(in crate::hair) azimuth_origin: [C; 2],
    }
}

/// Computes the shading point of a material viewed from `wo`.
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
    L::stage("probability of each lobe: its integral");
    // The glints share the inclination of TRT.
    let [r, tt, trt] = cdf.area;
    let total = [r, tt, trt, trt];

    // To the scale of the largest area, which may be next to nothing where all lobes lie off the sphere.
    let mut importance = lanes4(&m.importance);
    let size = lanes4(&m.extent);
    let least = c(f32::MIN_POSITIVE);
    let mut largest = least;
    let mut l = 0;
    while l < 4 {
        largest = largest.max(L::keep(zero.lt(importance[l] * size[l]), total[l]));
        l += 1;
    }
    let scale = L::select(least.lt(largest), L::quotient(c(1.0), largest), zero);
    let size = times(size, times(total, [scale; 4]));
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
        azimuth_mass: Spread::<L>::spread(&m.azimuth_mass),
        azimuth_from: Spread::<L>::spread(&m.azimuth_from),
        azimuth_origin: Spread::<L>::spread(&m.azimuth_origin),
    }
}

/// Computes sampling weights of lobes of these sizes: the root of the sum of the squared shares of the channels.
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
            (most * LEAST_CHANNEL).lt(total[c]),
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

impl<C, const N: usize> MatchedPrepared<C, N> {
    /// Returns the constant for W in the band of an inclination.
    #[inline(always)]
    pub(super) fn height<L: Lanes>(&self, sin_theta_i: L) -> L
    where
        C: Broadcast<L>,
    {
        L::stage("constant of the band in which wi lies");
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

    /// Computes the integral of each lobe without its colour, with the constants for W.
    #[inline(always)]
    pub(super) fn extents<B: MatchedBell, L: Lanes>(&self) -> [L; 4]
    where
        C: Broadcast<L>,
    {
        let azimuth_mass = [self.azimuth_mass[0].lanes(), self.azimuth_mass[1].lanes()];
        times(
            extent::<B, L, C>(&self.view.lobes, azimuth_mass),
            lanes4(&self.area),
        )
    }

    /// Computes the factors on `M N W` of a lobe drawn alone. Apply them one after the other, because their product may be too
    /// large.
    #[inline(always)]
    pub(super) fn lone_density<B: MatchedBell, L: Lanes>(&self) -> [[L; 4]; 2]
    where
        C: Broadcast<L>,
    {
        L::stage("normalisation of each lobe alone");
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
    /// Returns the shading point with only some of its lobes.
    #[inline(always)]
    pub(super) fn restrict(&self, lobes: LobeMask) -> Self {
        let factor = lobes.factors();
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
