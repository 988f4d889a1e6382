//! What is constant for a material, and for a material seen from one direction (section 3.3 of the paper).

use super::albedo::bell_area;
use crate::lanes::{store3, store4};
use crate::math::half_atan2;
use crate::truncated::TruncatedCauchy;
use crate::{Bell, Broadcast, HairParams, Lanes, Lobe, LobeMask, Vec3x};
use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

crate::lane_struct! {
    /// The constants of a material of the published model.
    ///
    /// Arrays of two are TT and the glints, of three R, TT, TRT; arrays of four are in the order of [`Lobe`].
    pub struct HairMaterial {
        /// Longitudinal shift, rad.
        pub alpha: [C; 3],
        /// Longitudinal width, rad; the glints share TRT's.
        pub beta: [C; 4],
        /// `1 / beta`.
        pub inv_beta: [C; 3],
        /// Half the azimuthal width of TT and the glints, rad.
        pub half_gamma: [C; 2],
        /// `2 / gamma`.
        pub inv_half_gamma: [C; 2],
        /// Half of the angle between a glint and `wo`, rad.
        pub half_phi_g: C,
        /// The azimuth's truncated Cauchy on one side: sine of the middle of its angles, to a
        /// common scale with the cosine.
        pub azimuth_sin: [C; 2],
        /// Cosine of the middle.
        pub azimuth_cos: [C; 2],
        /// Angle from end to end, rad; below 0 for TT, whose cdf runs towards its centre.
        pub azimuth_span: [C; 2],
        /// The azimuthal density but for its shape, per rad.
        pub azimuth_density: [C; 2],
        /// Integral of the azimuthal term over the circle, rad.
        pub azimuth_area: [C; 2],
        /// Colour of R, linear RGB.
        pub color_r: [C; 3],
        /// Colour of TT.
        pub color_tt: [C; 3],
        /// Colour of TRT and the glints.
        pub color_trt: [C; 3],
        /// Factor on each lobe that is no colour: 1, and the strength of the glints (up to 1e6; its excess is in the
        /// colour of TRT).
        pub strength: [C; 4],
        /// Probability of choosing each lobe: its share of the energy.
        pub selection: [C; 4],
        /// Where the next lobe begins in `xi_lobe`.
        pub bounds: [C; 3],
    }
}

crate::lane_struct! {
    /// The constants of a gather point of the published model: those of its material, and those of `wo`.
    pub struct HairGather {
        /// Half the sine of `theta_o`.
        pub half_sin_theta_o: C,
        /// Half its cosine.
        pub half_cos_theta_o: C,
        /// The part of `wo` in the normal plane, with the digits it was given: v and w, and its length.
        pub plane_o: [C; 3],
        /// One over that length.
        pub inv_plane_o: C,
        /// `theta_o / 2 - alpha`: added to `theta_i / 2` it is `theta_h - alpha`.
        pub shift: [C; 4],
        /// The longitude's truncated Cauchy: sine of the middle of its angles, to a common scale with the cosine.
        pub longitude_sin: [C; 4],
        /// Cosine of the middle.
        pub longitude_cos: [C; 4],
        /// Angle from end to end (A - B in the paper), rad.
        pub longitude_span: [C; 4],
        /// Density of each lobe but for its shape and for `1 / cos theta_i`.
        pub density: [C; 4],
        /// The same times the probability of the lobe.
        pub weight: [C; 4],
        /// The constants of the material.
        pub material: (HairMaterial<C>),
    }
}

/// The probability of each lobe from its energy, and where the next one begins.
///
/// The last lobe with any energy reaches to 2: a rounded sum never lets `xi_lobe` fall through to a lobe without.
/// Without any energy all probabilities are 0.
#[inline(always)]
fn selection<L: Lanes>(energy: [L; 4]) -> ([L; 4], [L; 3]) {
    let c = L::splat;
    let zero = c(0.0);
    let total = (energy[0] + energy[1]) + (energy[2] + energy[3]);
    let inv_total = L::select(zero.lt(total), c(1.0) / total, zero);
    let p = [energy[0] * inv_total, energy[1] * inv_total, energy[2] * inv_total, energy[3] * inv_total];
    let (two, low) = (c(2.0), p[0] + p[1]);
    let more = [p[1] + p[2] + p[3], p[2] + p[3], p[3]];
    let bounds = [
        L::select(zero.lt(more[0]), p[0], two),
        L::select(zero.lt(more[1]), low, two),
        L::select(zero.lt(more[2]), low + p[2], two),
    ];
    (p, bounds)
}

impl HairMaterial<f32> {
    /// The material of checked parameters.
    #[inline]
    #[must_use]
    pub(super) fn of<B: Bell>(bell: B, params: &HairParams) -> Self {
        let d = params.desc();
        let k = bell.width_factor();
        // Below 5e-5 rad the product of four Cauchy denominators overflows far from the centres.
        let [b_r, b_tt, b_trt, gamma_tt, gamma_g] =
            [d.beta_r, d.beta_tt, d.beta_trt, d.gamma_tt, d.gamma_g].map(|width| (width * k).max(5e-5));
        let beta = [b_r, b_tt, b_trt];
        let phi_g = d.phi_g;
        let glint = TruncatedCauchy::new(-phi_g, FRAC_PI_2 - phi_g, gamma_g);
        let tt = TruncatedCauchy::new(0.0, PI, gamma_tt);
        let (p, bounds) = selection(energies(&beta, gamma_tt, gamma_g, params));
        // Glints of absurd strength take the excess from the colour, so that their product overflows last.
        let excess = (d.intensity_g * 1e-6).max(1.0);
        Self {
            alpha: [d.alpha_r, d.alpha_tt, d.alpha_trt],
            beta: [beta[0], beta[1], beta[2], beta[2]],
            inv_beta: beta.map(|b| 1.0 / b),
            half_gamma: [0.5 * gamma_tt, 0.5 * gamma_g],
            inv_half_gamma: [2.0 / gamma_tt, 2.0 / gamma_g],
            half_phi_g: 0.5 * phi_g,
            azimuth_sin: [tt.sin_mid, glint.sin_mid],
            azimuth_cos: [tt.cos_mid, glint.cos_mid],
            azimuth_span: [-tt.span, glint.span],
            azimuth_density: [0.5 / (tt.span * gamma_tt), 0.5 / (glint.span * gamma_g)],
            azimuth_area: [bell_area::<B>(-PI, PI, gamma_tt), 2.0 * bell_area::<B>(-phi_g, PI - phi_g, gamma_g)],
            color_r: d.intensity_r,
            color_tt: d.intensity_tt,
            color_trt: d.intensity_trt.map(|c| (c * excess).min(f32::MAX)),
            strength: [1.0, 1.0, 1.0 / excess, d.intensity_g / excess],
            selection: p,
            bounds,
        }
    }
}

/// Energy of each lobe as section 3.2.3 of the paper estimates it, to the scale of the largest.
///
/// In double precision: the product of two of the largest legal intensities overflows a float.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "shares of the largest, in [0, 1]")]
fn energies(beta: &[f32; 3], gamma_tt: f32, gamma_g: f32, params: &HairParams) -> [f32; 4] {
    use core::f64::consts::PI;
    let d = params.desc();
    let mean = |rgb: [f32; 3]| rgb.iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0;
    let (i_r, i_tt, i_trt) = (mean(d.intensity_r), mean(d.intensity_tt), mean(d.intensity_trt));
    let root = 4.0 * libm::sqrt(2.0 * PI);
    let energy = [
        root * f64::from(beta[0]) * i_r,
        2.0 * PI * f64::from(beta[1]) * f64::from(gamma_tt) * i_tt,
        root * f64::from(beta[2]) * i_trt,
        4.0 * PI * f64::from(beta[2]) * f64::from(gamma_g) * i_trt * f64::from(d.intensity_g),
    ];
    let largest = energy.iter().fold(0.0, |a: f64, e| a.max(*e));
    energy.map(|e| if largest > 0.0 { (e / largest) as f32 } else { 0.0 })
}

/// `theta_o / 2 - alpha`, and the longitude of a lobe.
#[inline(always)]
fn longitude<L: Lanes, C: Broadcast<L>>(half_theta_o: L, alpha: C, beta: C) -> (L, TruncatedCauchy<L>) {
    let shift = half_theta_o - alpha.lanes();
    let quarter = L::splat(FRAC_PI_4);
    (shift, TruncatedCauchy::new(shift - quarter, shift + quarter, beta.lanes()))
}

/// The gather point of a material seen from `wo`.
#[inline(always)]
pub(super) fn prepare<L: Lanes, C: Broadcast<L>>(m: &HairMaterial<C>, wo: Vec3x<L>) -> HairGather<L::Stored> {
    let c = L::splat;
    let (zero, one) = (c(0.0), c(1.0));
    // The digits of a wo of about unit length are kept as they are; any other is scaled by its largest component, so
    // that no finite wo overflows or vanishes. Zero counts as v.
    let largest = wo.x.abs().max(wo.y.abs().max(wo.z.abs()));
    let some = c(1e-30).lt(largest);
    let usual = L::and(c(0.25).lt(largest), largest.lt(c(4.0)));
    let by = L::select(usual, one, one / largest);
    let x = L::select(some, wo.x * by, zero);
    let y = L::select(some, wo.y * by, one);
    let z = L::select(some, wo.z * by, zero);
    let plane_sq = y.mul_add(y, z * z);
    let plane = plane_sq.sqrt();
    let len = x.mul_add(x, plane_sq).sqrt();
    // On the axis the azimuth is 0 by convention.
    let off_axis = zero.lt(plane);
    let span_plane = L::select(off_axis, plane, one);
    let reciprocal = one / (len * span_plane);
    let (half_inv_len, inv_plane) = (c(0.5) * (reciprocal * span_plane), reciprocal * len);
    let half_theta_o = half_atan2(x, plane, len);
    // Products of components this small would leave the range of a float; their last digit is none of the bounds'.
    let near_axis = plane.lt(c(1e-4));
    let cos_phi_o = L::select(off_axis, y * inv_plane, one);
    let sin_phi_o = z * inv_plane;

    let [r, tt, trt] = [
        longitude::<L, C>(half_theta_o, m.alpha[0], m.beta[0]),
        longitude::<L, C>(half_theta_o, m.alpha[1], m.beta[1]),
        longitude::<L, C>(half_theta_o, m.alpha[2], m.beta[2]),
    ];
    let span = [r.1.span, tt.1.span, trt.1.span];

    // 1 / (2 span beta) of the three, from one division; each is at least 1e-9.
    let range = [span[0] * m.beta[0].lanes(), span[1] * m.beta[1].lanes(), span[2] * m.beta[2].lanes()];
    let first_two = range[0] * range[1];
    let reciprocal = c(0.5) / (first_two * range[2]);
    let (of_trt, rest) = (reciprocal * first_two, reciprocal * range[2]);
    let quarter = c(0.25);
    let density = [
        rest * range[1] * quarter,
        rest * range[0] * m.azimuth_density[0].lanes(),
        of_trt * quarter,
        of_trt * m.azimuth_density[1].lanes(),
    ];
    let p = &m.selection;
    let weight =
        [density[0] * p[0].lanes(), density[1] * p[1].lanes(), density[2] * p[2].lanes(), density[3] * p[3].lanes()];

    HairGather {
        half_sin_theta_o: (x * half_inv_len).store(),
        half_cos_theta_o: (plane * half_inv_len).store(),
        plane_o: store3([
            L::select(near_axis, cos_phi_o, y),
            L::select(near_axis, sin_phi_o, z),
            L::select(near_axis, one, plane),
        ]),
        inv_plane_o: L::select(near_axis, one, inv_plane).store(),
        shift: store4([r.0, tt.0, trt.0, trt.0]),
        longitude_sin: store4([r.1.sin_mid, tt.1.sin_mid, trt.1.sin_mid, trt.1.sin_mid]),
        longitude_cos: store4([r.1.cos_mid, tt.1.cos_mid, trt.1.cos_mid, trt.1.cos_mid]),
        longitude_span: store4([span[0], span[1], span[2], span[2]]),
        density: store4(density),
        weight: store4(weight),
        material: m.spread::<L>(),
    }
}

impl<C: Lanes> HairGather<C> {
    /// The gather point with only some of its lobes.
    #[inline(always)]
    pub(super) fn restrict(&self, lobes: LobeMask) -> Self {
        let factor = Lobe::ALL.map(|lobe| C::splat(lobes.factor(lobe)));
        let times = |x: [C; 4]| [x[0] * factor[0], x[1] * factor[1], x[2] * factor[2], x[3] * factor[3]];
        let hair = &self.material;
        let (p, bounds) = selection(times(hair.selection));
        Self {
            weight: [self.density[0] * p[0], self.density[1] * p[1], self.density[2] * p[2], self.density[3] * p[3]],
            material: HairMaterial {
                color_r: hair.color_r.map(|x| x * factor[0]),
                color_tt: hair.color_tt.map(|x| x * factor[1]),
                strength: times(hair.strength),
                selection: p,
                bounds,
                ..*hair
            },
            ..*self
        }
    }
}
