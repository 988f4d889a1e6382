//! Samplers of lower variance for the published model, which follow its bells and its angular factor W.

mod band_cdf;
mod bands;
mod bell;
mod hemispheres;
mod material;
mod prepared;
mod sampling;

pub use bell::MatchedBell;
use material::MatchedMaterial;
use prepared::MatchedPrepared;

use crate::hair::conserving::{self, AlbedoFit};
use crate::hair::{
    Angles, LobeTerms, albedo, energy, finish_eval, finish_lobes, finish_sample, mix_densities,
};
use crate::model::lobe::times;
use crate::model::{Eval, Hit, LobeEval, LobeMask, Model, PerLobe, Precision, SampleLanes};
use crate::params::{HairDesc, HairParams};
use crate::simd::pair::Pair;
use crate::simd::portable::Unfused;
use crate::simd::{Broadcast, Choice, Lanes, Scalar, Vec3x};

/// The model of [`Published`](crate::Published), with the same parameters, values and albedo, but with a sampler of lower variance
/// that follows the values more closely.
///
/// Each lobe is drawn from its own bells, cut to the sphere: truncated Gaussians on the Gaussian model, truncated Cauchys on the
/// all-Cauchy model, and the glints on the whole circle. The remaining factor of `S cos theta_i` is
/// `W = (cos theta_i / cos theta_d)^2`, at most 4 and the same for all lobes. W is approximated by a constant in each of `BANDS`
/// bands of inclination, which are narrower towards the poles, where W falls to 0. Lobes are chosen by their integrals with these
/// constants.
///
/// From the poles to the band in the middle the constants ascend. The integral of a lobe's bell is then a function of the integral
/// of its product with W from the nearer pole, which is drawn uniformly: the least of one line per band. Inversion therefore needs
/// no search.
///
/// With `BY_CHANNEL` lobes are chosen by their shares of red, green and blue, `sqrt(sum_c (E_lc / sum_k E_kc)^2)`, instead of the
/// mean of the three channels. This choice evens out the relative variances of the channels, while the default minimises the
/// variance of their mean. Use it for saturated colours: V of the blue of red hair falls from .41–.73 to .13–.20, and V of the mean
/// rises from .01–.03 to .11–.14 (test `by_channel`).
///
/// - Density: exact, as reported. With `h` the constant of the band it is `h sum I M N / sum E`, over `cos theta_i`, which is the
///   model itself times `h / W`. The density jumps where bands meet. The band of a direction depends on its first component alone,
///   so that every precision agrees.
/// - Weights: bounded by the sum of the energies times the largest `W / h`, in closed form (`Reference::weight_bound` of
///   `hairis-reference`); the mean of a weight's RGB is `W / h` times that sum. By channel, the largest energy over its lobe's
///   probability replaces the sum.
/// - Accuracy: the density contains the bells and is as exact as S, to 2e-4 relative (Gaussian) and 3e-5 (Cauchy). So are the values that
///   a sample reports, for the direction it returns, where S is above 1e-20. These bounds are for widths of a degree and more, further
///   than 1e-3 rad from the fibre's axis; errors grow as widths shrink. A Gaussian lobe below `2^-115` of its peak has neither value nor density, and a lobe whose energy is below 1e-36
///   of the largest is not sampled.
/// - Domain: `BANDS` is 5, 9 or 25. By channel, a channel below 1e-18 of the brightest is ignored.
/// - Source: ours; it replaces section 3.2 of Ou et al. 2012.
///
/// # Gain and cost
///
/// The table was measured under constant light, over the 3024 cells of a grid of everyday hair (test `matched::variance`). V is the
/// relative variance of one sample, as a mean; the gain is V of the published sampler over it, as geometric mean (and least). The
/// largest weight is the bound over the mean where it is largest (test `matched::fireflies`), in this range: `beta_r` from 0.5 to 60
/// degrees, `gamma_tt` from 1 to 60, `gamma_g` from 1 to 40, `phi_g` from 10 to 80, `i_g` from 0.1 to 10, `theta_o` up to 89.9, and
/// intensities of bright hair. It belongs to half a degree, strong glints and a grazing view, where weights hardly ever come near it.
///
/// | sampler | Gaussian: V, gain | all-Cauchy: V, gain | largest weight, Gaussian, all-Cauchy |
/// |---|---|---|---|
/// | published | .2469 | .1889 | |
/// | `Matched<_, 5>` | .0412, 7.3 (2.3) | .0448, 4.4 (2.1) | 13, 6.7 |
/// | `Matched<_, 9>`, the default | .0206, 14 (3.7) | .0223, 8.8 (3.5) | 7.0, 4.0 |
/// | `Matched<_, 25>` | .0059, 56 (8.3) | .0065, 35 (8.2) | 3.1, 2.5 |
///
/// The sampler gains under any broad light. No sampler of the hair reduces the variance that a small or a textured light adds. In
/// the far tails of a Gaussian lobe, where such a light may stand, the published sampler places more samples. Sample such lights
/// themselves, and combine the estimates by MIS. The [guide](crate::guide::choosing) has times, and which sampler to use when.
///
/// ```
/// use glam::Vec3;
/// use hairis::{Gaussian, HairParams, Matched, Material, Published};
/// let (hair, matched) = (Published(Gaussian), Matched::new(Gaussian));
/// let wo = Vec3::new(0.6, 0.8, 0.0);
/// let [hair, matched] = [Material::new(&hair, &HairParams::default()).prepare(wo).eval(Vec3::Y),
///     Material::new(&matched, &HairParams::default()).prepare(wo).eval(Vec3::Y)];
/// assert_eq!(hair, matched); // one model, two samplers
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Matched<B, const BANDS: usize = 9, const BY_CHANNEL: bool = false>(pub B);

impl<B> Matched<B> {
    /// Makes the recommended matched sampler, with nine bands and with lobes chosen by the mean over the channels. For other
    /// samplers name the type: `Matched::<_, 25>(Gaussian)`.
    #[inline]
    #[must_use]
    pub const fn new(bell: B) -> Self {
        Self(bell)
    }
}

impl<B: MatchedBell, const BANDS: usize, const BY_CHANNEL: bool> Matched<B, BANDS, BY_CHANNEL> {
    /// Computes the constants of a material in any [`Precision`], from a description that is not checked.
    #[inline]
    #[must_use]
    pub fn constants<W: Precision>(&self, desc: &HairDesc<W::Lane>) -> MatchedMaterial<W::Lane> {
        MatchedMaterial::of::<B, W>(self.0, desc)
    }
}

impl<B: MatchedBell, const BANDS: usize, const BY_CHANNEL: bool> Model
    for Matched<B, BANDS, BY_CHANNEL>
{
    type Params = HairParams;
    type Material<C: Scalar> = MatchedMaterial<C>;
    type Prepared<C: Scalar> = MatchedPrepared<C, BANDS>;
    type Fit<C: Scalar> = AlbedoFit<C>;
    type Inner = Self;

    const LOBES: &'static [&'static str] = &["r", "tt", "trt", "glint"];
    const CONSERVES: bool = false;

    #[inline]
    fn material(&self, params: &HairParams) -> MatchedMaterial<f32> {
        self.constants::<f64>(params.desc())
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &MatchedMaterial<C>,
        hit: Hit<L>,
    ) -> MatchedPrepared<L::Stored, BANDS> {
        prepared::prepare::<B, L, C, Pair<L>, 3, BANDS, BY_CHANNEL>(material, hit.wo)
    }

    #[inline(always)]
    fn prepare_one(material: &MatchedMaterial<f32>, hit: Hit<f32>) -> MatchedPrepared<f32, BANDS> {
        prepared::prepare::<B, f32, f32, Unfused, 1, BANDS, BY_CHANNEL>(material, hit.wo)
    }

    #[inline(always)]
    fn restrict<C: Lanes>(
        prepared: &MatchedPrepared<C, BANDS>,
        lobes: LobeMask,
    ) -> MatchedPrepared<C, BANDS> {
        prepared.restrict(lobes)
    }

    #[inline(always)]
    fn eval<L: Lanes, C: Broadcast<L>>(
        prepared: &MatchedPrepared<C, BANDS>,
        wi: Vec3x<L>,
    ) -> Eval<L> {
        let (angles, sound) = Angles::from_direction(&prepared.view, wi);
        let terms = angles.eval_lobes::<B, C>(&prepared.view);
        finish_eval(
            &prepared.view,
            &angles,
            sound,
            &terms,
            density(prepared, &angles, &terms),
        )
    }

    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L>>(
        prepared: &MatchedPrepared<C, BANDS>,
        wi: Vec3x<L>,
    ) -> PerLobe<LobeEval<L>> {
        let (angles, sound) = Angles::from_direction(&prepared.view, wi);
        let terms = angles.eval_lobes::<B, C>(&prepared.view);
        let height = prepared.height::<L>(angles.sin_theta_i);
        let [by_area, by_extent] = prepared.lone_density::<B, L>();
        let density = times(times(times(terms.value, [height; 4]), by_area), by_extent);
        finish_lobes(&prepared.view, &angles, sound, &terms, density)
    }

    #[inline(always)]
    fn sample<L: Lanes, C: Broadcast<L>>(
        prepared: &MatchedPrepared<C, BANDS>,
        xi: [L; 3],
    ) -> SampleLanes<L> {
        let (wi, choice, angles) = sampling::draw::<B, L, C, BANDS>(prepared, xi);
        let terms = angles.eval_lobes::<B, C>(&prepared.view);
        finish_sample(
            &prepared.view,
            wi,
            choice,
            &angles,
            &terms,
            density(prepared, &angles, &terms),
        )
    }

    #[inline(always)]
    fn draw<L: Lanes, C: Broadcast<L>>(
        prepared: &MatchedPrepared<C, BANDS>,
        xi: [L; 3],
    ) -> (Vec3x<L>, L) {
        let (wi, choice, _) = sampling::draw::<B, L, C, BANDS>(prepared, xi);
        (wi, choice.to_number())
    }

    #[inline(always)]
    fn energy<L: Lanes, C: Broadcast<L>>(prepared: &MatchedPrepared<C, BANDS>) -> L {
        energy::sum(&prepared.view, prepared.extents::<B, L>())
    }

    #[inline]
    fn fit(material: &MatchedMaterial<f32>) -> AlbedoFit<f32> {
        AlbedoFit::of::<B>(&material.lobes)
    }

    #[inline]
    fn raw_fit<C: Scalar + From<f32>>() -> AlbedoFit<C> {
        AlbedoFit::raw()
    }

    #[inline(always)]
    fn unfit<L: Lanes, C: Broadcast<L>>(fit: &AlbedoFit<C>) -> L {
        fit.warp.refused.lanes()
    }

    #[inline(always)]
    fn fitted<L: Lanes, C: Broadcast<L>>(
        fit: &AlbedoFit<C>,
        prepared: &MatchedPrepared<L::Stored, BANDS>,
    ) -> MatchedPrepared<L::Stored, BANDS> {
        MatchedPrepared {
            view: conserving::fitted::<L, C>(fit, &prepared.view),
            ..*prepared
        }
    }

    #[inline(always)]
    fn conserving<L: Lanes>(
        prepared: &MatchedPrepared<L::Stored, BANDS>,
        lanes: L::Mask,
    ) -> MatchedPrepared<L::Stored, BANDS> {
        MatchedPrepared {
            view: conserving::integrated::<B, L>(&prepared.view, lanes),
            ..*prepared
        }
    }

    #[inline(always)]
    fn albedo<L: Lanes, C: Broadcast<L>>(prepared: &MatchedPrepared<C, BANDS>) -> PerLobe<[L; 3]> {
        albedo::albedo::<B, L, C>(&prepared.view)
    }
}

/// Computes the mixture density times `cos theta_i`.
#[inline(always)]
fn density<L: Lanes, C: Broadcast<L>, const N: usize>(
    prepared: &MatchedPrepared<C, N>,
    angles: &Angles<L>,
    terms: &LobeTerms<L>,
) -> L {
    mix_densities(terms.value, &prepared.weight)
        * (prepared.height(angles.sin_theta_i) * prepared.scale.lanes())
}
