//! Angles of a direction relative to the shading point, and the lobe terms at these angles.

use super::{GRAZING, HairView};
use crate::model::math::{atan_unit, half_angle, quotients};
use crate::model::{Bell, FourBells, TwoBells};
use crate::simd::{Broadcast, Lanes, Vec3x, lanes3};
use core::f32::consts::FRAC_PI_2;

/// Angles of `wi` relative to the shading point, with sines and cosines.
#[derive(Clone, Copy)]
pub(crate) struct Angles<L: Lanes> {
    /// Half of `theta_i`, plus [`HairView::quarter_o`].
    pub(super) half_theta_i_plus_quarter: L,
    pub(crate) sin_theta_i: L,
    pub(crate) cos_theta_i: L,
    /// `1 / cos theta_i`.
    pub(crate) inv_cos_theta_i: L,
    /// Half of `|phi|`, or of `pi - |phi|`: the smaller of both has digits where it vanishes.
    pub(super) half: L,
    /// Mask of the lanes where `half` is half of `|phi|`.
    pub(super) of_phi: L::Mask,
    /// `cos(phi / 2)`.
    pub(super) cos_half_phi: L,
    /// Mask of `|phi| < pi/2`.
    pub(super) front: L::Mask,
}

/// Lobe terms at the angles of a direction.
#[derive(Clone, Copy)]
pub(crate) struct LobeTerms<L> {
    /// `M N`, with unit peaks: no colour, no strength.
    pub(crate) value: [L; 4],
    /// Products of Cauchy bells, with the glints cut at `pi/2`: the density of the published sampler without the constants of the
    /// shading point and without `1 / cos theta_i`.
    pub(super) density: [L; 4],
    /// `1 / cos^2 theta_d`.
    pub(crate) inv_cos_sq_theta_d: L,
}

impl<L: Lanes> Angles<L> {
    /// Computes the angles of `wi` relative to a shading point, and the mask of lanes where `wi` is a direction off the axis.
    #[inline(always)]
    pub(crate) fn from_direction<C: Broadcast<L>>(
        view: &HairView<C>,
        wi: Vec3x<L>,
    ) -> (Self, L::Mask) {
        L::stage("wi: inclination, and azimuth relative to wo");
        let c = L::splat;
        // Alone, because on one lane LLVM shuffles these numbers, for which the rest waits, into vectors with others. Evaluating the
        // Gaussian model then takes 6% to 7% more time, and a hit 5% to 10% (AMD family 25 model 1). Measure again:
        // `entry time eval/eval_pdf/gaussian/scalar 1`, builds in turns.
        let plane_sq = wi.y.mul_add(wi.y, wi.z * wi.z).alone();
        let cos_theta_i = plane_sq.sqrt();
        // Azimuth relative to wo, folded: tau is the tangent of half of |phi| or of pi - |phi|, at most 1.
        // R and TRT-g vanish with it at phi = pi: it takes the digits of wo as they are, and a sum that does not cancel.
        let [v_o, w_o, cos_o] = lanes3(&view.plane_o);
        let dot = wi.y.mul_add(v_o, wi.z * w_o).alone();
        let cross = L::difference_of_products(wi.z, v_o, wi.y, w_o).abs();
        let reach = cos_theta_i * cos_o;
        let far = reach + dot.abs();
        // Off the axis, seen from a wo that is a direction: else the length of its part across the fibre is NaN. Longer than
        // 2 is no direction; the comparison is false for the infinities of a sum that overflowed.
        let sound = L::and(
            (cos_o * GRAZING).lt(reach),
            wi.x.mul_add(wi.x, plane_sq).lt(c(4.0)),
        );

        // Next to opposite poles theta_i and theta_o cancel: the large terms first, without rounding there.
        let half_theta_i_plus_quarter =
            half_angle(wi.x, cos_theta_i).alone() + view.quarter_o.lanes();
        let [tau, half_inv_reach] = quotients([cross, far], [c(0.5), reach]);
        let cos_half = (far * half_inv_reach).sqrt();
        let front = c(0.0).lt(dot);
        let angles = Self {
            half_theta_i_plus_quarter,
            sin_theta_i: wi.x,
            cos_theta_i,
            inv_cos_theta_i: half_inv_reach * (cos_o + cos_o),
            half: atan_unit(tau).alone(),
            of_phi: front,
            cos_half_phi: L::select(front, cos_half, tau * cos_half),
            front,
        };
        (angles, sound)
    }

    /// Computes the lobe terms at these angles.
    #[inline(always)]
    pub(crate) fn eval_lobes<B: Bell, C: Broadcast<L>>(&self, view: &HairView<C>) -> LobeTerms<L> {
        let c = L::splat;
        let one = c(1.0);
        L::stage("distances from the centres of the lobes in widths, squared");
        let hair = &view.lobes;
        let plus_quarter = self.half_theta_i_plus_quarter;
        // Alone, because in vectors of them and numbers next to them in memory, unused squares overflow.
        let x_r = ((plus_quarter + view.shift[0].lanes()) * hair.inv_beta[0].lanes()).alone();
        let x_tt = ((plus_quarter + view.shift[1].lanes()) * hair.inv_beta[1].lanes()).alone();
        let x_trt = ((plus_quarter + view.shift[2].lanes()) * hair.inv_beta[2].lanes()).alone();
        // Their signs are not used: where `half` is of |phi| its distance from pi/2 is that of TT.
        let from_tt = self.half - L::keep(self.of_phi, c(FRAC_PI_2));
        let from_glint = self.half
            - L::select(
                self.of_phi,
                hair.half_phi_g.lanes(),
                hair.half_back_g.lanes(),
            );
        let y_tt = (from_tt * hair.inv_half_gamma[0].lanes()).alone();
        let y_g = (from_glint * hair.inv_half_gamma[1].lanes()).alone();
        let (s_r, s_tt, s_trt, t_tt, t_g) = (
            x_r * x_r,
            x_tt * x_tt,
            x_trt * x_trt,
            y_tt * y_tt,
            y_g * y_g,
        );

        L::stage("Cauchy bell of each distance");
        // Each of the five is at most 1e9, so that four of them
        // multiplied stay below the largest float.
        let (d_r, d_tt_x, d_trt) = (
            one_plus_square(x_r),
            one_plus_square(x_tt),
            one_plus_square(x_trt),
        );
        let (d_tt_y, d_g_y) = (one_plus_square(y_tt), one_plus_square(y_g));
        let (d_tt, d_g) = (d_tt_x * d_tt_y, d_trt * d_g_y);
        let [cauchy_tt, cauchy_g] = quotients([one, d_tt], [one, d_g]);
        let cauchy_trt = cauchy_g * d_g_y;
        L::stage("cos^2 theta_d");
        // The squared length of the mean of the two directions in the meridian plane: exact where both
        // are near opposite poles, where 1 + cos cos + sin sin cancels.
        let half = c(0.5);
        let mean_u = self
            .sin_theta_i
            .mul_add(half, view.half_sin_theta_o.lanes());
        let mean_c = self
            .cos_theta_i
            .mul_add(half, view.half_cos_theta_o.lanes());
        let cos_sq_theta_d = mean_u.mul_add(mean_u, (mean_c * mean_c).alone()).alone();
        let [cauchy_r, inv_cos_sq_theta_d] = quotients([one, d_r], [one, cos_sq_theta_d]);

        let tt = TwoBells {
            s: s_tt,
            t: t_tt,
            cauchy: cauchy_tt,
            cauchy_s: cauchy_tt * d_tt_y,
            cauchy_t: cauchy_tt * d_tt_x,
        };
        let glint = TwoBells {
            s: s_trt,
            t: t_g,
            cauchy: cauchy_g,
            cauchy_s: cauchy_trt,
            cauchy_t: cauchy_g * d_trt,
        };
        L::stage("bells of the lobes: M N");
        let [m_r, f_tt, m_trt, f_g] = B::four(FourBells {
            s_r,
            cauchy_r,
            tt,
            s_trt,
            cauchy_trt,
            glint,
        });
        LobeTerms {
            value: [
                m_r * self.cos_half_phi,
                f_tt,
                m_trt * self.cos_half_phi,
                f_g,
            ],
            density: [
                cauchy_r * self.cos_half_phi,
                cauchy_tt,
                cauchy_trt * self.cos_half_phi,
                // The sampler cuts the glints at pi/2: ERRATA E3.
                L::keep(self.front, cauchy_g),
            ],
            inv_cos_sq_theta_d,
        }
    }
}

/// Returns `1 + x^2`, computed alone.
#[inline(always)]
fn one_plus_square<L: Lanes>(x: L) -> L {
    x.mul_add(x, L::splat(1.0)).alone()
}

impl<L: Lanes> LobeTerms<L> {
    /// Returns S times `cos^2 theta_d`, linear RGB.
    #[inline(always)]
    pub(crate) fn sum_lobes<C: Broadcast<L>>(&self, view: &HairView<C>) -> [L; 3] {
        L::stage("sum of the lobes in their colours");
        let hair = &view.lobes;
        let trt = self.value[2] * hair.strength[2].lanes();
        let (f_r, f_tt) = (self.value[0], self.value[1]);
        let f_trt = self.value[3].mul_add(hair.strength[3].lanes(), trt);
        let (r, tt, trt) = (
            lanes3(&hair.color_r),
            lanes3(&hair.color_tt),
            lanes3(&hair.color_trt),
        );
        [
            f_r.mul_add(r[0], f_tt.mul_add(tt[0], f_trt * trt[0])),
            f_r.mul_add(r[1], f_tt.mul_add(tt[1], f_trt * trt[1])),
            f_r.mul_add(r[2], f_tt.mul_add(tt[2], f_trt * trt[2])),
        ]
    }
}
