//! Lobes of a material, and the view terms of a shading point, which all samplers of the published model share.

use super::bell::bell_area;
use crate::model::lobe::times;
use crate::model::math::{FRAC_PI_2_LOW, half_atan2_parts};
use crate::model::{Bell, LobeMask, Precision};
use crate::params::HairDesc;
use crate::simd::{Broadcast, Lanes, Vec3x, lanes3, store3, store4};
use core::f32::consts::PI;

crate::simd::lane_struct! {
    /// Lobes of a material: the constants of its value, which every sampler reads.
    ///
    /// Arrays of two hold TT and the glints, arrays of three R, TT and TRT; arrays of four are in the order of
    /// [`Lobe`](crate::Lobe).
    pub(crate) struct HairLobes {
        /// Longitudinal shift, rad.
        pub(in crate::hair) alpha: [C; 3],
        /// Longitudinal width, rad; the glints share that of TRT.
        pub(in crate::hair) beta: [C; 4],
        /// `1 / beta`.
        pub(in crate::hair) inv_beta: [C; 3],
        /// Half the azimuthal width of TT and the glints, rad.
        pub(in crate::hair) half_gamma: [C; 2],
        /// `2 / gamma`.
        pub(in crate::hair) inv_half_gamma: [C; 2],
        /// Half of the angle between a glint and `wo`, rad.
        pub(in crate::hair) half_phi_g: C,
        /// `pi/2` less `half_phi_g`.
        pub(in crate::hair) half_back_g: C,
        /// Integral of the azimuthal term over the circle, rad.
        pub(in crate::hair) azimuth_area: [C; 2],
        /// Colour of R, linear RGB.
        pub(in crate::hair) color_r: [C; 3],
        /// Colour of TT, linear RGB.
        pub(in crate::hair) color_tt: [C; 3],
        /// Colour of TRT and the glints, linear RGB.
        pub(in crate::hair) color_trt: [C; 3],
        /// Factor on each lobe beside its colour: 1, and the strength of the glints (up to 1e6; the colour of TRT holds the excess).
        pub(in crate::hair) strength: [C; 4],
    }
}

crate::simd::lane_struct! {
    /// View terms of a shading point, which every sampler reads: the lobes of its material, and `wo`.
    pub(crate) struct HairView {
        /// Half the sine of `theta_o`.
        pub(in crate::hair) half_sin_theta_o: C,
        /// Half the cosine of `theta_o`.
        pub(in crate::hair) half_cos_theta_o: C,
        /// Part of `wo` in the normal plane, with the digits it was given: v and w, and its length.
        pub(in crate::hair) plane_o: [C; 3],
        /// Reciprocal of that length.
        pub(in crate::hair) inv_plane_o: C,
        /// `pi/4` with the sign of `theta_o` where `theta_o` is next to a pole, else 0.
        pub(in crate::hair) quarter_o: C,
        /// `theta_o / 2 - alpha` less `quarter_o`: small, and with more digits than the sum. `shift` and `quarter_o` added to
        /// `theta_i / 2` are `theta_h - alpha`.
        pub(in crate::hair) shift: [C; 4],
        /// Lobes of the material.
        pub(in crate::hair) lobes: HairLobes<C>,
    }
}

impl<L: Lanes<Stored = L>> HairLobes<L> {
    /// Computes the lobes of a description, whose ranges are those of checked parameters.
    #[inline]
    #[must_use]
    pub(crate) fn of<B: Bell, W: Precision<Lane = L>>(bell: B, d: &HairDesc<L>) -> Self {
        L::stage("widths of the lobes, and azimuths of TT and the glints");
        let (c, one, pi) = (L::splat, L::splat(1.0), L::splat(PI));
        let k = bell.width_factor();
        // Below 5e-5 rad the product of four Cauchy denominators overflows far from the centres.
        let [b_r, b_tt, b_trt, gamma_tt, gamma_g] =
            [d.beta[0], d.beta[1], d.beta[2], d.gamma_tt, d.gamma_g]
                .map(|width| (width * k).max(c(5e-5)));
        let phi_g = d.phi_g;
        // The float next to pi is above it by a thousandth of the least width.
        let to_back = (pi - phi_g) + 2.0 * FRAC_PI_2_LOW;
        // Glints of absurd strength take the excess from the colour, so that their product overflows last.
        let excess = (d.i_g * 1e-6).max(one);
        let area = |lo: L, hi: L, width: L| {
            L::stage("area of the azimuth's bell");
            let (lo, hi) = (L::quotient(lo, width), L::quotient(hi, width));
            let area = if W::IS_DOUBLE {
                bell_area::<B, L>(lo, hi)
            } else {
                B::area(lo, hi)
            };
            area * width
        };
        Self {
            alpha: d.alpha,
            beta: [b_r, b_tt, b_trt, b_trt],
            inv_beta: [b_r, b_tt, b_trt].map(|b| L::quotient(one, b)),
            half_gamma: [gamma_tt * 0.5, gamma_g * 0.5],
            inv_half_gamma: [L::quotient(c(2.0), gamma_tt), L::quotient(c(2.0), gamma_g)],
            half_phi_g: phi_g * 0.5,
            half_back_g: to_back * 0.5,
            azimuth_area: [
                area(-pi, pi, gamma_tt),
                area(-phi_g, to_back, gamma_g) * 2.0,
            ],
            color_r: d.i_r,
            color_tt: d.i_tt,
            color_trt: d.i_trt.map(|x| (x * excess).min(c(f32::MAX))),
            strength: [
                one,
                one,
                L::quotient(one, excess),
                L::quotient(d.i_g, excess),
            ],
        }
    }
}

/// Least share of the brightest lobe that [`intensities`] distinguishes from 0 in single precision.
const LEAST_SHARE: f32 = 1e-30;

/// Computes the intensities of R, TT and TRT, and a factor for each lobe; the glints have the intensities of TRT. The products of
/// both are on a common scale.
#[inline]
pub(crate) fn intensities<W: Precision>(d: &HairDesc<W::Lane>) -> ([[W; 3]; 3], [W; 4]) {
    let c = <W::Lane as Lanes>::splat;
    let (colors, one) = ([d.i_r, d.i_tt, d.i_trt], c(1.0));
    if W::IS_DOUBLE {
        let factors = [one, one, one, d.i_g];
        return (colors.map(|rgb| rgb.map(W::of)), factors.map(W::of));
    }
    <W::Lane as Lanes>::stage(
        "intensity of each lobe to the scale of its brightest channel, and these to that of the brightest lobe",
    );
    let least = c(f32::MIN_POSITIVE);
    let largest = colors.map(|[r, g, b]| r.max(g).max(b));
    let brightest = largest[0].max(largest[1]).max(largest[2]).max(least);
    // A lobe without intensity has the scale of the brightest, so that it has derivatives by its intensity.
    let scale = largest.map(|x| <W::Lane as Lanes>::select(c(0.0).lt(x), x, brightest));
    let [r, tt, trt] = scale.map(|x| <W::Lane as Lanes>::quotient(x, brightest));
    let glint = trt * d.i_g;
    let by = one.max(<W::Lane as Lanes>::keep(c(0.0).lt(largest[2]), glint));
    let share = |x: W::Lane, is_there: W::Lane| {
        let share = <W::Lane as Lanes>::quotient(x, by);
        let some = share.max(c(LEAST_SHARE));
        W::of(<W::Lane as Lanes>::select(c(0.0).lt(is_there), some, share))
    };
    (
        core::array::from_fn(|lobe| {
            let most = scale[lobe].max(least);
            colors[lobe].map(|x| W::of(<W::Lane as Lanes>::quotient(x, most)))
        }),
        [
            share(r, scale[0]),
            share(tt, scale[1]),
            share(trt, scale[2]),
            share(glint, d.i_g),
        ],
    )
}

/// Computes the view terms of a material viewed from `wo`.
#[inline(always)]
pub(crate) fn prepare<L: Lanes, C: Broadcast<L>>(
    lobes: &HairLobes<C>,
    wo: Vec3x<L>,
) -> HairView<L::Stored> {
    L::stage("wo: length, inclination, and the part across the fibre");
    let c = L::splat;
    let one = c(1.0);
    // The digits of a wo of about unit length are kept as they are; any other is scaled by its largest component, so
    // that no finite wo overflows or vanishes. Zero counts as v. Of any other, the component that is NaN, or infinite and
    // then scaled by 0, is NaN after that.
    let least = c(f32::MIN_POSITIVE);
    let largest = wo.x.abs().max(wo.z.abs().max(wo.y.abs()));
    let usual = L::and(c(0.25).lt(largest), largest.lt(c(4.0)));
    let none = largest.lt(least);
    let by = L::select_predictable(usual, one, L::quotient(one, largest.max(least)));
    let x = wo.x * by;
    let y = L::select_predictable(none, one, wo.y * by);
    let z = wo.z * by;
    let plane_sq = y.mul_add(y, z * z);
    let len = x.mul_add(x, plane_sq).sqrt();
    // NaN if any component is, because `min` returns its second operand for NaN: no direction is sound then
    // (`Angles::from_direction`), and no sample has an inclination.
    let plane = plane_sq.sqrt().min(len);
    // On the axis the azimuth is 0 by convention, and so it is where `plane_sq` is next to denormals and has no digits.
    let off_axis = c(1e-18).lt(plane);
    let span_plane = L::select_predictable(off_axis, plane, one);
    let reciprocal = L::quotient(one, len * span_plane);
    let (half_inv_len, inv_plane) = (c(0.5) * (reciprocal * span_plane), reciprocal * len);
    let [quarter_o, half_rest] = half_atan2_parts(x, plane, len);
    // Products of components this small would underflow; the stated bounds do not cover their last digit.
    let near_axis = plane.lt(c(1e-4));
    let cos_phi_o = L::select_predictable(off_axis, y * inv_plane, one);
    let sin_phi_o = z * inv_plane;

    L::stage("half the inclination of wo, less the shift of each lobe");
    let [r, tt, trt] = lanes3(&lobes.alpha);
    let [r, tt, trt] = [half_rest - r, half_rest - tt, half_rest - trt];

    HairView {
        half_sin_theta_o: (x * half_inv_len).store(),
        half_cos_theta_o: (plane * half_inv_len).store(),
        plane_o: store3([
            L::select_predictable(near_axis, cos_phi_o, y),
            L::select_predictable(near_axis, sin_phi_o, z),
            L::select_predictable(near_axis, one, plane),
        ]),
        inv_plane_o: L::select_predictable(near_axis, one, inv_plane).store(),
        quarter_o: quarter_o.store(),
        shift: store4([r, tt, trt, trt]),
        lobes: lobes.spread::<L>(),
    }
}

impl<C: Lanes> HairView<C> {
    /// Returns the shading point with only some of its lobes.
    #[inline(always)]
    pub(crate) fn restrict(&self, lobes: LobeMask) -> Self {
        let factor = lobes.factors::<C>();
        let hair = &self.lobes;
        Self {
            lobes: HairLobes {
                color_r: hair.color_r.map(|x| x * factor[0]),
                color_tt: hair.color_tt.map(|x| x * factor[1]),
                strength: times(hair.strength, factor),
                ..*hair
            },
            ..*self
        }
    }
}
