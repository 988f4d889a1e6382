//! The published model over any bell: its value, its samplers, its energy conservation and its albedo.

pub(crate) mod albedo;
mod angles;
mod bell;
mod conserving;
mod energy;
mod gaussian;
mod matched;
mod published;
pub(crate) mod quadrature;
mod results;
mod sampling;
mod truncated;
mod view;

use conserving::AlbedoFit;
use published::{PublishedMaterial, PublishedPrepared};
use view::{HairLobes, HairView};

pub use bell::{Bell, FourBells, TwoBells};
pub use gaussian::Gaussian;
pub use matched::{Matched, MatchedBell};

pub(crate) use angles::{Angles, LobeTerms};
pub(crate) use published::selection;
pub(crate) use results::{finish_eval, finish_lobes, finish_sample, mix_densities};
pub(crate) use sampling::{FoldedXi, direction_from_angles};
pub(crate) use view::prepare as prepare_view;

use crate::model::lobe::times;
use crate::model::{Eval, Hit, LobeEval, LobeMask, Model, PerLobe, Precision, SampleLanes};
use crate::params::{HairDesc, HairParams};
use crate::simd::{Broadcast, Choice, Lanes, Scalar, Vec3x, lanes4};

/// Cosine of the inclination below which a direction lies on the fibre's axis: there value and density are 0, and a sample is
/// discarded (section 3.3 of the paper).
pub const GRAZING: f32 = 1e-5;

/// The artist-friendly model of Sadeghi et al. 2010 as Ou et al. 2012 state it, with the bell `B` and the importance sampler that
/// they publish.
///
/// `S = sum of I M(theta_h) N(phi) / cos^2 theta_d` over R, TT, TRT-g and the glints. The model is reciprocal but does not conserve
/// energy: see [`Conserving`](crate::Conserving) and [`Material::conserving_scale`](crate::Material::conserving_scale).
///
/// - Source: Ou et al. 2012, equation 1, table 2 and section 3.2, with the misprints listed in `ERRATA.md` corrected.
/// - Units: value and density per steradian.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Published<B>(pub B);

impl<B: Bell> Published<B> {
    /// Computes the constants of a material in any [`Precision`], from a description that is not checked.
    #[inline]
    #[must_use]
    pub fn constants<W: Precision>(&self, desc: &HairDesc<W::Lane>) -> PublishedMaterial<W::Lane> {
        PublishedMaterial::of::<B, W>(self.0, desc)
    }
}

impl<B: Bell> Model for Published<B> {
    type Params = HairParams;
    type Material<C: Scalar> = PublishedMaterial<C>;
    type Prepared<C: Scalar> = PublishedPrepared<C>;
    type Fit<C: Scalar> = AlbedoFit<C>;
    type Inner = Self;

    const LOBES: &'static [&'static str] = &["r", "tt", "trt", "glint"];
    const CONSERVES: bool = false;

    #[inline]
    fn material(&self, params: &HairParams) -> PublishedMaterial<f32> {
        self.constants::<f64>(params.desc())
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &PublishedMaterial<C>,
        hit: Hit<L>,
    ) -> PublishedPrepared<L::Stored> {
        published::prepare(material, hit.wo)
    }

    #[inline(always)]
    fn restrict<C: Lanes>(
        prepared: &PublishedPrepared<C>,
        lobes: LobeMask,
    ) -> PublishedPrepared<C> {
        prepared.restrict(lobes)
    }

    #[inline(always)]
    fn eval<L: Lanes, C: Broadcast<L>>(prepared: &PublishedPrepared<C>, wi: Vec3x<L>) -> Eval<L> {
        let (angles, sound) = Angles::from_direction(&prepared.view, wi);
        let terms = angles.eval_lobes::<B, C>(&prepared.view);
        finish_eval(
            &prepared.view,
            &angles,
            sound,
            &terms,
            mix_densities(terms.density, &prepared.weight),
        )
    }

    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L>>(
        prepared: &PublishedPrepared<C>,
        wi: Vec3x<L>,
    ) -> PerLobe<LobeEval<L>> {
        let (angles, sound) = Angles::from_direction(&prepared.view, wi);
        let terms = angles.eval_lobes::<B, C>(&prepared.view);
        let density = times(terms.density, lanes4(&prepared.density));
        finish_lobes(&prepared.view, &angles, sound, &terms, density)
    }

    #[inline(always)]
    fn sample<L: Lanes, C: Broadcast<L>>(
        prepared: &PublishedPrepared<C>,
        xi: [L; 3],
    ) -> SampleLanes<L> {
        let (wi, choice, angles) = sampling::draw(prepared, xi);
        let terms = angles.eval_lobes::<B, C>(&prepared.view);
        finish_sample(
            &prepared.view,
            wi,
            choice,
            &angles,
            &terms,
            mix_densities(terms.density, &prepared.weight),
        )
    }

    #[inline(always)]
    fn draw<L: Lanes, C: Broadcast<L>>(
        prepared: &PublishedPrepared<C>,
        xi: [L; 3],
    ) -> (Vec3x<L>, L) {
        let (wi, choice, _) = sampling::draw(prepared, xi);
        (wi, choice.to_number())
    }

    #[inline(always)]
    fn energy<L: Lanes, C: Broadcast<L>>(prepared: &PublishedPrepared<C>) -> L {
        energy::published(prepared)
    }

    #[inline]
    fn fit(material: &PublishedMaterial<f32>) -> AlbedoFit<f32> {
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
        prepared: &PublishedPrepared<L::Stored>,
    ) -> PublishedPrepared<L::Stored> {
        PublishedPrepared {
            view: conserving::fitted::<L, C>(fit, &prepared.view),
            ..*prepared
        }
    }

    #[inline(always)]
    fn conserving<L: Lanes>(
        prepared: &PublishedPrepared<L::Stored>,
        lanes: L::Mask,
    ) -> PublishedPrepared<L::Stored> {
        PublishedPrepared {
            view: conserving::integrated::<B, L>(&prepared.view, lanes),
            ..*prepared
        }
    }

    #[inline(always)]
    fn albedo<L: Lanes, C: Broadcast<L>>(prepared: &PublishedPrepared<C>) -> PerLobe<[L; 3]> {
        albedo::albedo::<B, L, C>(&prepared.view)
    }
}
