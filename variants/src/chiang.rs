//! Energy-conserving fibre of Marschner, d'Eon and Chiang, in the near field and in the far field.

mod far_field;
mod fields;
mod gather;
mod like;
mod lobes;
mod params;
mod sampling;
mod scattering;
mod stand_ins;

pub use far_field::{FarField, OffsetNodes};
use gather::ChiangMaterial;
pub use gather::ChiangPrepared;
pub(crate) use gather::{Four, apart, four, same};
pub use like::Likeness;
pub use params::{ChiangDesc, ChiangParams, Shifts};
pub use scattering::{ScatteringChiang, ScatteringDesc, ScatteringMaterial, ScatteringParams};

pub(crate) use stand_ins::by_melanin;

use hairis::model::{Direction, LobeEval, LobeModel};
use hairis::simd::{Broadcast, Lanes, Scalar};
use hairis::{Hit, PerLobe};

/// Near-field model of Chiang et al. 2016, which pbrt, Mitsuba, Cycles and `MaterialX` render.
///
/// `S = sum of A_p M_p N_p / cos theta_i` over R, TT, TRT and the rest. The attenuations `A_p` follow from Fresnel's equations and
/// from absorption, the longitudinal terms `M_p` are those of d'Eon et al. 2011, and the azimuthal terms `N_p` are trimmed logistics.
///
/// - Lobes: "r", "tt", "trt" and "trrt+", which stands for all further paths, in slots 0 to 3.
/// - Near field: the model reads [`Hit::h`]. A host without `h` draws it uniformly per hit, because `h = 0` is not the far field.
/// - Tints are factors on `A_p` for R, TT and TRT; the rest has the tint of TRT. Each lobe has widths of its own.
/// - Energy: `S cos theta_i` integrates to `sum of A_p` for every `wo`, `h`, width and tilt, which is 1 without absorption and tints. The
///   model is not reciprocal, because `A_p` depends on `theta_o` alone, so that light tracing has to use the adjoint.
/// - Sampling: exact. Weights are `sum of A_p q_p` over `sum of w_p q_p`, with `q_p` the density of a lobe and `w_p` its
///   probability. They are at most 3, and 1 for clear hair without tints.
/// - Selection of a lobe: by the mean of `A_p` over the channels ([`Chiang::MEAN`], the default), or by its share in each channel
///   ([`Chiang::BY_CHANNEL`]). The latter leaves a third of the variance of the worst channel of red hair.
/// - Source: Chiang et al. 2016; d'Eon et al. 2011 (`M_p`) and 2013 (its sampling); `ERRATA.md` of this package.
/// - Accuracy: value, density and each lobe are accurate to `6.5e-6 + 1.2e-6 / sqrt(v) + 5e-7 (1 + p) / s`, further than 1e-3 rad from the
///   axis: to 2.4e-5 for roughnesses of .3, to 8e-5 for .1 (4.5e-5 for everyday indices and tilts), and to 1e-2 for 1e-3. The first term is the
///   error of the arithmetic. The others are the rounding of angles times the steepness of the lobe. A channel that is absorbed errs
///   besides by 3.6e-7 of its optical depth. Below `exp(-12)` of the peak of `M_p` the error
///   grows as the exponent does, and lobes end at about `2^-115` of the peak.
///
/// ```
/// use glam::Vec3;
/// use hairis::{Hit, Material};
/// use hairis_variants::{Chiang, ChiangParams};
/// let hair = Material::new(&Chiang::MEAN, &ChiangParams::white());
/// let prepared = hair.prepare(Hit::new(Vec3::new(0.6, 0.8, 0.0), 0.3));
/// let sample = prepared.sample([0.5, 0.25, 0.75]).expect("not along the fibre");
/// assert!(sample.weight.iter().all(|w| *w > 0.9 && *w < 1.0)); // hardly any absorption
/// let spectral = prepared.constants().prepared();
/// assert!(spectral.fresnel() > 0.0 && spectral.path_length() < 2.5); // radii
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Chiang<const BY_CHANNEL: bool = false>;

impl Chiang {
    /// Model that chooses lobes by the mean of their attenuation over the channels.
    pub const MEAN: Self = Self;
}

impl Chiang<true> {
    /// Model that chooses lobes by their share of the attenuation in every channel.
    pub const BY_CHANNEL: Self = Self;
}

impl<const BY_CHANNEL: bool> LobeModel for Chiang<BY_CHANNEL> {
    type Params = ChiangParams;
    type Material<C: Scalar> = ChiangMaterial<C>;
    type Prepared<C: Scalar> = ChiangPrepared<C>;

    const LOBES: &'static [&'static str] = &["r", "tt", "trt", "trrt+"];
    const CONSERVES: bool = true;

    #[inline]
    fn material(&self, params: &ChiangParams) -> ChiangMaterial<f32> {
        let d = params.desc();
        ChiangMaterial::new::<f64>(d, d.shifts == Shifts::SmallAngle)
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &ChiangMaterial<C>,
        hit: Hit<L>,
    ) -> ChiangPrepared<L::Stored> {
        gather::prepare(material, hit)
    }

    #[inline(always)]
    fn weights<L: Lanes, C: Broadcast<L>>(prepared: &ChiangPrepared<C>) -> PerLobe<L> {
        if BY_CHANNEL {
            gather::shares_by_channel(prepared)
        } else {
            gather::mean_shares(prepared)
        }
    }

    #[inline(always)]
    fn energies<L: Lanes, C: Broadcast<L>>(prepared: &ChiangPrepared<C>) -> PerLobe<L> {
        gather::mean_shares(prepared)
    }

    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L>>(
        prepared: &ChiangPrepared<C>,
        wi: &Direction<L>,
    ) -> PerLobe<LobeEval<L>> {
        PerLobe::padded(Self::first_four(prepared, wi), LobeEval::none())
    }

    #[inline(always)]
    fn first_four<L: Lanes, C: Broadcast<L>>(
        prepared: &ChiangPrepared<C>,
        wi: &Direction<L>,
    ) -> [LobeEval<L>; 4] {
        let (pdf, inv_cos) = lobes::densities(prepared, wi);
        macro_rules! each {
            ($($p:literal)*) => {
                [$(LobeEval::new(pdf[$p] * inv_cos, gather::attenuation(prepared, $p), pdf[$p])),*]
            };
        }
        each!(0 1 2 3)
    }

    #[inline(always)]
    fn sample_lobe<L: Lanes, C: Broadcast<L>>(
        prepared: &ChiangPrepared<C>,
        lobe: L::Index,
        xi: [L; 3],
    ) -> Direction<L> {
        sampling::sample(prepared, lobe, xi)
    }

    /// Returns the attenuations, which are the albedos of the lobes in closed form.
    #[inline(always)]
    fn albedo<L: Lanes, C: Broadcast<L>>(prepared: &ChiangPrepared<C>) -> PerLobe<[L; 3]> {
        let of = gather::attenuation;
        PerLobe([
            of(prepared, 0),
            of(prepared, 1),
            of(prepared, 2),
            of(prepared, 3),
            [L::splat(0.0); 3],
        ])
    }
}
