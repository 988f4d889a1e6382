//! Constants of the published sampler: per material, and per material and direction (section 3.3 of the paper).

use super::view::{self, HairLobes, HairView, intensities};
use crate::hair::truncated::TruncatedCauchy;
use crate::model::lobe::times;
use crate::model::{Bell, LobeMask, Precision};
use crate::params::HairDesc;
use crate::simd::{Broadcast, Lanes, Vec3x, lanes4, store4};
use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

crate::simd::lane_struct! {
    /// Constants of the published sampler per material; arrays of two hold TT and the glints.
    pub(super) struct PublishedConstants {
        /// Truncated Cauchy of the azimuth on one side: tangent of the middle of its angles.
        pub(in crate::hair) azimuth_middle: [C; 2],
        /// Angle from end to end, rad; negative for TT, whose cdf runs towards its centre.
        pub(in crate::hair) azimuth_span: [C; 2],
        /// Normalisation of the azimuthal density, per rad.
        pub(in crate::hair) azimuth_density: [C; 2],
        /// Probability of choosing each lobe: its share of the energy.
        pub(in crate::hair) selection: [C; 4],
        /// Start of the next lobe in `xi_lobe`.
        pub(in crate::hair) bounds: [C; 3],
    }
}

crate::simd::lane_struct! {
    /// Constants of a material of the published model.
    pub struct PublishedMaterial {
        /// Lobes of the material.
        pub(in crate::hair) lobes: HairLobes<C>,
        /// Constants of the sampler of these lobes.
        pub(in crate::hair) sampler: PublishedConstants<C>,
    }
}

crate::simd::lane_struct! {
    /// Constants of a shading point of the published model: those of its material, and those of `wo`.
    pub struct PublishedPrepared {
        /// Lobes as viewed from `wo`.
        pub(in crate::hair) view: HairView<C>,
        /// Truncated Cauchy of the inclination: tangent of the middle of its angles.
        pub(in crate::hair) inclination_middle: [C; 4],
        /// Angle from end to end (A - B in the paper), rad.
        pub(in crate::hair) inclination_span: [C; 4],
        /// Density of each lobe without its shape and without `1 / cos theta_i`.
        pub(in crate::hair) density: [C; 4],
        /// Density times the probability of the lobe.
        pub(in crate::hair) weight: [C; 4],
        /// Constants of the material's sampler.
        pub(in crate::hair) sampler: PublishedConstants<C>,
    }
}

/// Computes the probability of each lobe from its energy, the start of the next lobe, and the reciprocal of the sum of the energies.
/// An energy is 0 or at least 1e-36.
///
/// The last lobe with any energy reaches to 2, so that a rounded sum never selects a lobe without energy. If no lobe has any energy,
/// all probabilities are 0, and the last number is finite.
#[inline(always)]
pub(crate) fn selection<L: Lanes>(energy: [L; 4]) -> ([L; 4], [L; 3], L) {
    let c = L::splat;
    let zero = c(0.0);
    let total = (energy[0] + energy[1]) + (energy[2] + energy[3]);
    let inv_total = L::quotient(c(1.0), total.max(c(f32::MIN_POSITIVE)));
    let p = times(energy, [inv_total; 4]);
    let (two, low) = (c(2.0), p[0] + p[1]);
    let more = [p[1] + p[2] + p[3], p[2] + p[3], p[3]];
    let bounds = [
        L::select_predictable(zero.lt(more[0]), p[0], two),
        L::select_predictable(zero.lt(more[1]), low, two),
        L::select_predictable(zero.lt(more[2]), low + p[2], two),
    ];
    (p, bounds, inv_total)
}

impl<L: Lanes<Stored = L>> PublishedMaterial<L> {
    /// Computes the material of a description, whose ranges are those of checked parameters.
    #[inline]
    #[must_use]
    pub(super) fn of<B: Bell, W: Precision<Lane = L>>(bell: B, d: &HairDesc<L>) -> Self {
        let c = L::splat;
        let lobes = HairLobes::of::<B, W>(bell, d);
        L::stage("sampler: azimuths of TT and the glints, as truncated Cauchy distributions");
        let phi_g = d.phi_g;
        let [gamma_tt, gamma_g] = lobes.half_gamma.map(|half| half * 2.0);
        let glint = TruncatedCauchy::new(-phi_g, c(FRAC_PI_2) - phi_g, gamma_g);
        let tt = TruncatedCauchy::new(c(0.0), c(PI), gamma_tt);
        let energy = energies::<W>(lobes.beta, [gamma_tt, gamma_g], d);
        let (p, bounds, _) = selection(energy);
        let sampler = PublishedConstants {
            azimuth_middle: [tt.tan_mid, glint.tan_mid],
            azimuth_span: [-tt.span, glint.span],
            azimuth_density: [
                L::quotient(c(0.5), tt.span * gamma_tt),
                L::quotient(c(0.5), glint.span * gamma_g),
            ],
            selection: p,
            bounds,
        };
        Self { lobes, sampler }
    }
}

/// Least share of the largest energy for a lobe that has any energy, so that it is still drawn when it is alone.
const LEAST_SHARE: f64 = 1e-30;

/// Computes the energy of each lobe as section 3.2.3 of the paper estimates it, to the scale of the largest energy.
///
/// Scaled, because the product of two of the largest legal intensities overflows a float.
#[inline]
fn energies<W: Precision>(
    beta: [W::Lane; 4],
    [gamma_tt, gamma_g]: [W::Lane; 2],
    d: &HairDesc<W::Lane>,
) -> [W::Lane; 4] {
    use core::f64::consts::PI;
    let (c, zero) = (W::constant, W::constant(0.0));
    let (colors, [of_r, of_tt, of_trt, of_glint]) = intensities::<W>(d);
    let [i_r, i_tt, i_trt] = colors.map(|[r, g, b]| (r + g + b) / c(3.0));
    <W::Lane as Lanes>::stage("energy of each lobe, and its share");
    let root = c(4.0 * libm::sqrt(2.0 * PI));
    let [r, tt, trt, glint] = [
        root * W::of(beta[0]) * i_r * of_r,
        c(2.0 * PI) * W::of(beta[1]) * W::of(gamma_tt) * i_tt * of_tt,
        root * W::of(beta[2]) * i_trt * of_trt,
        c(4.0 * PI) * W::of(beta[2]) * W::of(gamma_g) * i_trt * of_glint,
    ];
    let largest = r.max(tt).max(trt).max(glint).max(c(W::LEAST));
    let share = |energy: W, intensity: W| {
        let share = energy / largest;
        W::select(zero.lt(intensity), share.max(c(LEAST_SHARE)), share).rounded()
    };
    [
        share(r, i_r * of_r),
        share(tt, i_tt * of_tt),
        share(trt, i_trt * of_trt),
        share(glint, i_trt * of_glint),
    ]
}

/// Makes the truncated Cauchy of a lobe's inclination; except for the shift, its ends are the same for all lobes.
#[inline(always)]
fn inclination<L: Lanes, C: Broadcast<L>>(
    [lo, hi]: [L; 2],
    shift: L,
    beta: C,
) -> TruncatedCauchy<L> {
    TruncatedCauchy::new(lo + shift, hi + shift, beta.lanes())
}

/// Computes the shading point of a material viewed from `wo`.
#[inline(always)]
pub(super) fn prepare<L: Lanes, C: Broadcast<L>>(
    m: &PublishedMaterial<C>,
    wo: Vec3x<L>,
) -> PublishedPrepared<L::Stored> {
    let c = L::splat;
    let (hair, sampler) = (&m.lobes, &m.sampler);
    let view = view::prepare(hair, wo);
    L::stage("sampler: inclinations, as Cauchy distributions cut to the sphere");
    let quarter_o = view.quarter_o.lanes();
    let ends = [quarter_o - FRAC_PI_4, quarter_o + FRAC_PI_4];
    let [r, tt, trt] = [
        inclination::<L, C>(ends, view.shift[0].lanes(), hair.beta[0]),
        inclination::<L, C>(ends, view.shift[1].lanes(), hair.beta[1]),
        inclination::<L, C>(ends, view.shift[2].lanes(), hair.beta[2]),
    ];
    let span = [r.span, tt.span, trt.span];

    L::stage("sampler: density of each lobe but for its shape");
    // 1 / (2 span beta) of the three, from one division; each is at least 1e-9.
    // Alone: in vectors with the squares of an evaluation that follows, unused lanes hold denormals, which take twice the time.
    let range = [
        (span[0] * hair.beta[0].lanes()).alone(),
        (span[1] * hair.beta[1].lanes()).alone(),
        (span[2] * hair.beta[2].lanes()).alone(),
    ];
    let first_two = range[0] * range[1];
    let reciprocal = L::quotient(c(0.5), first_two * range[2]);
    let (of_trt, rest) = (reciprocal * first_two, reciprocal * range[2]);
    let quarter = c(0.25);
    let density = [
        rest * range[1] * quarter,
        rest * range[0] * sampler.azimuth_density[0].lanes(),
        of_trt * quarter,
        of_trt * sampler.azimuth_density[1].lanes(),
    ];
    let weight = times(density, lanes4(&sampler.selection));

    PublishedPrepared {
        view,
        inclination_middle: store4([r.tan_mid, tt.tan_mid, trt.tan_mid, trt.tan_mid]),
        inclination_span: store4([span[0], span[1], span[2], span[2]]),
        density: store4(density),
        weight: store4(weight),
        sampler: sampler.spread::<L>(),
    }
}

impl<C: Lanes> PublishedPrepared<C> {
    /// Returns the shading point with only some of its lobes.
    #[inline(always)]
    pub(super) fn restrict(&self, lobes: LobeMask) -> Self {
        let (p, bounds, _) = selection(times(self.sampler.selection, lobes.factors()));
        Self {
            view: self.view.restrict(lobes),
            weight: times(self.density, p),
            sampler: PublishedConstants {
                selection: p,
                bounds,
                ..self.sampler
            },
            ..*self
        }
    }
}
