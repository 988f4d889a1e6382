//! Constants of a matched sampler per material.

use super::MatchedBell;
use crate::HairParams;
use crate::hair::HairLobes;
use crate::simd::{Broadcast, Lanes};
use core::f32::consts::PI;

/// Least share of the largest intensity, for the sampler, of a lobe that has any: alone, it is still drawn.
const LEAST_IMPORTANCE: f64 = 1e-15;

crate::simd::lane_struct! {
    /// The constants of a material with a matched sampler.
    ///
    /// Arrays of two are TT and the glints, of four in the order of [`Lobe`](crate::Lobe).
    pub struct MatchedMaterial {
        /// Its lobes.
        pub(in crate::hair) lobes: HairLobes<C>,
        /// Intensity of each lobe, the mean of its RGB, to the scale of the largest.
        pub(in crate::hair) importance: [C; 4],
        /// Intensity of each lobe in each channel, to the same scale: the channels of R first.
        pub(in crate::hair) intensity: [C; 12],
        /// Integral of a lobe without its colour, per unit of its inclination's integral.
        pub(in crate::hair) extent: [C; 4],
        /// Integral of the azimuth's bell over one side.
        pub(in crate::hair) azimuth_mass: [C; 2],
        /// Its integral up to where the side begins.
        pub(in crate::hair) azimuth_from: [C; 2],
        /// The origin of both.
        pub(in crate::hair) azimuth_origin: [C; 2],
    }
}

/// Integral of each lobe without its colour, per unit of its inclination's integral.
#[inline(always)]
pub(super) fn extent<B: MatchedBell, L: Lanes, C: Broadcast<L>>(
    hair: &HairLobes<C>,
    azimuth_mass: [L; 2],
) -> [L; 4] {
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

impl MatchedMaterial<f32> {
    /// The material of checked parameters.
    #[inline]
    #[must_use]
    pub(super) fn of<B: MatchedBell>(bell: B, params: &HairParams) -> Self {
        let lobes = HairLobes::of(bell, params);
        let phi_g = params.desc().phi_g;
        let [inv_gamma_tt, inv_gamma_g] = lobes.inv_half_gamma.map(|inv| 0.5 * inv);
        let ranges = [
            (0.0, PI * inv_gamma_tt),
            (-phi_g * inv_gamma_g, (PI - phi_g) * inv_gamma_g),
        ];
        let azimuth_origin = ranges.map(|(lo, hi)| B::origin(lo, hi));
        let from_to =
            |i: usize| [ranges[i].0, ranges[i].1].map(|x| B::integral(azimuth_origin[i], x));
        let [tt, glint] = [from_to(0), from_to(1)];
        // Integrals ascend but for their rounding.
        let azimuth_mass = [tt, glint].map(|[from, to]| 0.0_f32.max(to - from));
        let intensity = intensity(params);
        Self {
            lobes,
            importance: intensity.map(|rgb| (rgb[0] + rgb[1] + rgb[2]) * (1.0 / 3.0)),
            intensity: core::array::from_fn(|i| intensity[i / 3][i % 3]),
            extent: extent::<B, f32, f32>(&lobes, azimuth_mass),
            azimuth_mass,
            azimuth_from: [tt[0], glint[0]],
            azimuth_origin,
        }
    }
}

/// Intensity of each lobe in each channel, to the scale of the largest mean.
///
/// In double precision: the product of two of the largest legal intensities overflows a float.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    reason = "at most 3 times the largest"
)]
fn intensity(params: &HairParams) -> [[f32; 3]; 4] {
    let d = params.desc();
    let double = |rgb: [f32; 3], factor: f32| rgb.map(|c| f64::from(c) * f64::from(factor));
    let all = [
        double(d.i_r, 1.0),
        double(d.i_tt, 1.0),
        double(d.i_trt, 1.0),
        double(d.i_trt, d.i_g),
    ];
    let mean = |rgb: &[f64; 3]| (rgb[0] + rgb[1] + rgb[2]) / 3.0;
    let largest = all.iter().map(mean).fold(0.0, f64::max);
    all.map(|rgb| {
        let (own, least) = (mean(&rgb), largest * LEAST_IMPORTANCE);
        let by = if own < least {
            LEAST_IMPORTANCE / own
        } else {
            1.0 / largest
        };
        rgb.map(|c| if own > 0.0 { (c * by) as f32 } else { 0.0 })
    })
}
