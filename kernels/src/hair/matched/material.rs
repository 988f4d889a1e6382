//! Constants of a matched sampler per material.

use super::MatchedBell;
use crate::hair::HairLobes;
use crate::hair::view::intensities;
use crate::model::Precision;
use crate::params::HairDesc;
use crate::simd::{Broadcast, Lanes};
use core::f32::consts::PI;

/// Least share of the largest intensity, in the sampler, for a lobe that has any intensity, so that it is still drawn when it is
/// alone.
const LEAST_IMPORTANCE: f64 = 1e-15;

crate::simd::lane_struct! {
    /// Constants of a material with a matched sampler.
    ///
    /// Arrays of two hold TT and the glints; arrays of four are in the order of [`Lobe`](crate::Lobe).
    pub struct MatchedMaterial {
        /// Lobes of the material.
        pub(in crate::hair) lobes: HairLobes<C>,
        /// Intensity of each lobe, the mean of its RGB, to the scale of the largest intensity.
        pub(in crate::hair) importance: [C; 4],
        /// Intensity of each lobe in each channel, to the same scale, with the channels of R first.
        pub(in crate::hair) intensity: [C; 12],
        /// Integral of a lobe without its colour, per unit of its inclination's integral.
        pub(in crate::hair) extent: [C; 4],
        /// Integral of the azimuth's bell over one side.
        pub(in crate::hair) azimuth_mass: [C; 2],
        /// Integral of the azimuth's bell up to the start of the side.
        pub(in crate::hair) azimuth_from: [C; 2],
        /// Origin of both integrals of the azimuth.
        pub(in crate::hair) azimuth_origin: [C; 2],
    }
}

/// Computes the integral of each lobe without its colour, per unit of its inclination's integral.
#[inline(always)]
pub(super) fn extent<B: MatchedBell, L: Lanes, C: Broadcast<L>>(
    hair: &HairLobes<C>,
    azimuth_mass: [L; 2],
) -> [L; 4] {
    L::stage("integral of each lobe without its colour, per unit of its inclination's integral");
    // dtheta_i is two widths for each of x; the azimuth of R and TRT-g has an area of 4, and bells have two sides.
    let unit = L::splat(2.0 * B::UNIT);
    let [r, tt, trt] = [
        hair.beta[0].lanes() * unit,
        hair.beta[1].lanes() * unit,
        hair.beta[2].lanes() * unit,
    ];
    let both_sides = L::splat(4.0 * B::UNIT);
    let azimuth_tt = hair.half_gamma[0].lanes() * azimuth_mass[0] * both_sides;
    let azimuth_g = hair.half_gamma[1].lanes() * azimuth_mass[1] * both_sides;
    [r * 4.0, tt * azimuth_tt, trt * 4.0, trt * azimuth_g]
}

impl<L: Lanes<Stored = L> + Broadcast<L>> MatchedMaterial<L> {
    /// Computes the material of a description, whose ranges are those of checked parameters.
    #[inline]
    #[must_use]
    pub(super) fn of<B: MatchedBell, W: Precision<Lane = L>>(bell: B, d: &HairDesc<L>) -> Self {
        let (zero, pi) = (L::splat(0.0), L::splat(PI));
        let lobes = HairLobes::of::<B, W>(bell, d);
        let phi_g = d.phi_g;
        let [inv_gamma_tt, inv_gamma_g] = lobes.inv_half_gamma.map(|inv| inv * 0.5);
        let ranges = [
            (zero, pi * inv_gamma_tt),
            (-phi_g * inv_gamma_g, (pi - phi_g) * inv_gamma_g),
        ];
        L::stage("sampler: integrals of the azimuths' bells");
        let azimuth_origin = ranges.map(|(lo, hi)| B::origin(lo, hi));
        let from_to =
            |i: usize| [ranges[i].0, ranges[i].1].map(|x| B::integral(azimuth_origin[i], x));
        let [tt, glint] = [from_to(0), from_to(1)];
        // Integrals ascend except for their rounding.
        let azimuth_mass = [tt, glint].map(|[from, to]| zero.max(to - from));
        let intensity = intensity::<W>(d);
        Self {
            lobes,
            importance: intensity.map(|rgb| (rgb[0] + rgb[1] + rgb[2]) * (1.0 / 3.0)),
            intensity: core::array::from_fn(|i| intensity[i / 3][i % 3]),
            extent: extent::<B, L, L>(&lobes, azimuth_mass),
            azimuth_mass,
            azimuth_from: [tt[0], glint[0]],
            azimuth_origin,
        }
    }
}

/// Computes the intensity of each lobe in each channel, to the scale of the largest mean.
///
/// Scaled, because the product of two of the largest legal intensities overflows a float.
#[inline]
fn intensity<W: Precision>(d: &HairDesc<W::Lane>) -> [[W::Lane; 3]; 4] {
    let (c, zero) = (W::constant, W::constant(0.0));
    let ([r, tt, trt], factors) = intensities::<W>(d);
    <W::Lane as Lanes>::stage(
        "intensity of each lobe in each channel, to the scale of the largest mean",
    );
    let colors = [r, tt, trt, trt];
    let all: [[W; 3]; 4] = core::array::from_fn(|lobe| colors[lobe].map(|x| x * factors[lobe]));
    let mean = all.map(|[r, g, b]| (r + g + b) / c(3.0));
    let largest = mean[0].max(mean[1]).max(mean[2]).max(mean[3]);
    let least = largest * c(LEAST_IMPORTANCE);
    // Divisors are never 0, because compilers compute quotients that are not used.
    let positive = |x: W| x.max(c(W::LEAST));
    core::array::from_fn(|lobe| {
        let own = mean[lobe];
        let is_faint = <W::Lane as Lanes>::and(zero.lt(own), own.lt(least));
        let by = W::select(
            is_faint,
            c(LEAST_IMPORTANCE) / positive(own),
            c(1.0) / positive(largest),
        );
        all[lobe].map(|x| (x * by).rounded())
    })
}
