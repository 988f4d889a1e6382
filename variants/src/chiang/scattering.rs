//! Fibre whose lobes widen where light crosses more of it, as if a medulla scattered it.

use super::gather::{self, ChiangMaterial, ChiangPrepared, ChiangWidths, Four, four};
use super::params::{ABOUT, ABOUT_BY, ALONG, SHARE, root};
use super::{Chiang, ChiangDesc, ChiangParams};
use crate::parameters::appended;
use crate::{Field, Kind, Parameters, Registered, Values};
use core::f32::consts::{LN_2, TAU};
use hairis::model::math::{gaussian_and_complement, log2_one_plus};
use hairis::model::{Direction, LobeEval, LobeModel, Precision};
use hairis::simd::{Broadcast, Lanes, Pair, Scalar, Vec3x, lane_struct, store4};
use hairis::{Hit, ParamError, PerLobe};

/// [`Chiang`] with a fake medulla, as the fibre of OSL has it: TT, TRT and the rest are the wider, the longer their way through the fibre.
///
/// A path of `p` passages leaves `u^p` of its light unscattered, with `u = (1 - scattering^2)^(1 / cos theta_o)`. A lobe has the width of its
/// own roughness plus `1 - u^p`, at most that of a roughness of 1 or its own: TT with `p = 1`, TRT and the rest with `p = 2`, along the fibre
/// and about it. R stays as it is.
///
/// - Lobes, near field, tints, choice and bounds of weights: those of [`Chiang::MEAN`]. Without scattering, value and density are its to the
///   bit.
/// - Energy: that of [`Chiang`]. A lobe has its width by `wo` alone, and the density of its samples is exact.
/// - Roughness of a lobe: that whose width is the lobe's [`width_m`](ChiangDesc::width_m) or [`width_n`](ChiangDesc::width_n), over the
///   default of that lobe.
/// - Source: `PhysicalHairLobe` of OSL's BSDL. Light scattered in a medulla is not modelled: for that, see Yan et al. 2017.
/// - Accuracy: that of [`Chiang`], and that of the widths, which are off by 1.5e-5 of themselves at most.
///
/// ```
/// use glam::Vec3;
/// use hairis::{Hit, Material};
/// use hairis_variants::{ChiangParams, chiang::{ScatteringChiang, ScatteringDesc, ScatteringParams}};
/// let desc = ScatteringDesc { fiber: ChiangParams::white(), scattering: 0.4 };
/// let hair = Material::new(&ScatteringChiang, &ScatteringParams::new(&desc)?);
/// let bsdf = hair.prepare(Hit::new(Vec3::new(0.6, 0.8, 0.0), 0.3));
/// assert!(bsdf.sample([0.5, 0.25, 0.75]).is_some());
/// # Ok::<(), hairis::ParamError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScatteringChiang;

/// Unchecked scattering, and the checked parameters of the fibre. Set the fields that differ from the default, and pass the description to
/// [`ScatteringParams::new`].
///
/// - Default: that of [`ChiangParams`], without scattering.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct ScatteringDesc {
    /// Parameters of the fibre.
    pub fiber: ChiangParams,
    /// Scattering of the medulla, in `[0, 1]`: the root of the share of the light that a passage across the fibre scatters, which is at most
    /// .99.
    pub scattering: f32,
}

/// Parameters of a fibre with scattering that have passed all checks.
///
/// ```
/// use hairis_variants::chiang::{ScatteringDesc, ScatteringParams};
/// let refused = ScatteringParams::new(&ScatteringDesc { scattering: 1.5, ..ScatteringDesc::default() });
/// assert_eq!(refused.unwrap_err().to_string(), "scattering must be in [0, 1], got 1.5");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "ScatteringDesc", into = "ScatteringDesc")
)]
pub struct ScatteringParams(ScatteringDesc);

impl ScatteringParams {
    /// Checks `desc` and makes parameters from it.
    ///
    /// # Errors
    ///
    /// Returns an error if the scattering is outside its range (see [`ScatteringDesc`]), with its value; NaN is always rejected.
    #[inline]
    pub fn new(desc: &ScatteringDesc) -> Result<Self, ParamError> {
        SHARE.check("scattering", &[desc.scattering])?;
        Ok(Self(*desc))
    }

    /// Returns the description with the values that were checked.
    #[inline]
    #[must_use]
    pub const fn desc(&self) -> &ScatteringDesc {
        &self.0
    }
}

#[cfg(feature = "serde")]
impl TryFrom<ScatteringDesc> for ScatteringParams {
    type Error = ParamError;

    #[inline]
    fn try_from(desc: ScatteringDesc) -> Result<Self, ParamError> {
        Self::new(&desc)
    }
}

#[cfg(feature = "serde")]
impl From<ScatteringParams> for ScatteringDesc {
    #[inline]
    fn from(params: ScatteringParams) -> Self {
        params.0
    }
}

lane_struct! {
    /// Constants of a material: those of the fibre, and what widens its lobes.
    pub struct ScatteringMaterial {
        /// Constants of the fibre.
        fiber: ChiangMaterial<C>,
        /// Twice the optical depth of a passage across the fibre, to be the argument of a Gaussian.
        twice_depth: C,
        /// Roughnesses of TT and TRT along the fibre, and about it.
        roughness: [C; 4],
    }
}

/// Largest share of the light that a passage across the fibre scatters.
const MOST: f32 = 0.99;

impl<L: Lanes<Stored = L>> ScatteringMaterial<L> {
    fn new<W: Precision<Lane = L>>(
        fiber: ChiangMaterial<L>,
        desc: &ChiangDesc<L>,
        scattering: L,
    ) -> Self {
        L::stage("scattering, and the roughnesses that it adds to");
        let c = W::constant;
        let [_, tt, trt] = desc.width_m.map(W::of);
        let along = root(W::of(desc.beta_m));
        let [_, tt_about, trt_about] = desc.width_n.map(W::of);
        let about = W::of(desc.beta_n);
        let about = about * ABOUT.over(about);
        let roughness = [
            ALONG.roughness(tt * along * c(1.0 / f64::from(TT))),
            ALONG.roughness(trt * along * c(1.0 / f64::from(TRT))),
            ABOUT.roughness(tt_about * about),
            ABOUT.roughness(trt_about * about),
        ];
        let scattered = (scattering * scattering).min(L::splat(MOST));
        Self {
            fiber,
            twice_depth: log2_one_plus(-scattered) * (-2.0 * LN_2),
            roughness: roughness.map(W::rounded),
        }
    }
}

/// Coefficients of a width by the powers of its roughness, along the fibre and about it.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to a float is the purpose"
)]
const TERMS: [[f32; 2]; 3] = {
    let (along, about) = (ALONG.terms, ABOUT.terms);
    [
        [along[0] as f32, about[0] as f32],
        [along[1] as f32, about[1] as f32],
        [along[2] as f32, about[2] as f32],
    ]
};

/// Scale of the azimuthal logistic over its width.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to a float is the purpose"
)]
const BY: f32 = ABOUT_BY as f32;

/// Longitudinal widths of TT and TRT, in widths of a roughness, at which a lobe has that roughness: those of [`ChiangDesc::default`].
const TT: f32 = 0.5;
const TRT: f32 = 2.0;

/// Returns a number for the widths along the fibre, and one for those about it.
#[inline(always)]
fn each<L: Lanes>(along: f32, about: f32) -> Four<L> {
    Pair(Pair::splat(along), Pair::splat(about))
}

/// Returns a number for TT, and one for TRT.
#[inline(always)]
fn two<L: Lanes>(tt: f32, trt: f32) -> Pair<L> {
    Pair(L::splat(tt), L::splat(trt))
}

/// Returns the numbers of TT, TRT and the rest, and that of R, where the fibre scatters. Elsewhere the lobes keep their own.
#[inline(always)]
fn replaced<L: Lanes, C: Broadcast<L>>(
    scatters: L::Mask,
    own: &[C; 4],
    [tt, trt, rest]: [L; 3],
) -> [L::Stored; 4] {
    store4([
        own[0].lanes(),
        L::select(scatters, tt, own[1].lanes()),
        L::select(scatters, trt, own[2].lanes()),
        L::select(scatters, rest, own[3].lanes()),
    ])
}

/// Returns the widths of the fibre seen from `wo`.
#[inline(always)]
fn widths<L: Lanes, C: Broadcast<L>>(
    m: &ScatteringMaterial<C>,
    wo: Vec3x<L>,
) -> ChiangWidths<L::Stored> {
    L::stage("scattering: the share of the light that has left its path, by passages");
    let cos_o = Direction::normalized(wo).cos_theta;
    let depth = L::quotient(m.twice_depth.lanes(), cos_o.max(L::splat(1e-18)));
    let (left, lost) = gaussian_and_complement(depth);
    let scatters = L::splat(0.0).lt(lost);
    let lost = Pair(lost, lost * (left + 1.0));

    L::stage("scattering: widths of TT and TRT along the fibre and about it");
    let own = four(&m.roughness);
    // Whatever the rounding of a roughness of 1, it is no more.
    let is_wider = Four::splat(1.0 + 1e-6).lt(own);
    let grown = (own + Pair(lost, lost)).min(Four::splat(1.0));
    let x = Four::select(is_wider, own, grown);
    // x^18 along the fibre, and x^20 about it.
    let x_2 = x * x;
    let x_4 = x_2 * x_2;
    let x_8 = x_4 * x_4;
    let steep = x_8 * x_8 * Pair(x_2.0, x_4.1);
    let [a, b, c] = TERMS;
    let sum = each(c[0], c[1]).mul_add(steep, each(b[0], b[1]));
    let sum = x.mul_add(sum, each(a[0], a[1]));
    let Pair(root, s) = x * sum * Pair(two(TT, TRT), two(BY, BY));
    let v = root * root;

    L::stage("scattering: normalisation of the lobes");
    let inverse = Four::quotient(Four::splat(1.0), Pair(v, s));
    // exp(-2 / v), exp(-pi / s), and their complements.
    let (Pair(_, tail), Pair(cut, rest)) = gaussian_and_complement(inverse * each(4.0, TAU));
    let kept = Pair::quotient(rest, tail + Pair::splat(1.0));
    let Pair(inv_v, inv_s) = inverse;
    let norm = Pair::quotient(inv_v * inv_s, cut * kept);
    let norm_rest = L::quotient(inv_v.1, cut.1 * TAU);
    let all = &m.fiber.widths;
    let (by, scale) = (v * Pair::splat(-LN_2), s * Pair::splat(0.5 * LN_2));
    let four_inv = inv_s * Pair::splat(4.0);
    ChiangWidths {
        minus_v_ln_2: replaced(scatters, &all.minus_v_ln_2, [by.0, by.1, by.1]),
        inv_variance: replaced(scatters, &all.inv_variance, [inv_v.0, inv_v.1, inv_v.1]),
        cut: replaced(scatters, &all.cut, [cut.0, cut.1, cut.1]),
        norm: replaced(scatters, &all.norm, [norm.0, norm.1, norm_rest]),
        scale_ln_2: replaced(scatters, &all.scale_ln_2, [scale.0, scale.1, scale.1]),
        four_inv_scale: replaced(
            scatters,
            &all.four_inv_scale,
            [four_inv.0, four_inv.1, four_inv.1],
        ),
        kept: replaced(scatters, &all.kept, [kept.0, kept.1, kept.1]),
        differ: L::select(scatters, L::splat(-1.0), all.differ.lanes()).store(),
    }
}

impl LobeModel for ScatteringChiang {
    type Params = ScatteringParams;
    type Material<C: Scalar> = ScatteringMaterial<C>;
    type Prepared<C: Scalar> = ChiangPrepared<C>;

    const LOBES: &'static [&'static str] = Chiang::<false>::LOBES;
    const CONSERVES: bool = true;

    #[inline]
    fn material(&self, params: &ScatteringParams) -> ScatteringMaterial<f32> {
        let ScatteringDesc { fiber, scattering } = params.desc();
        let constants = LobeModel::material(&Chiang::MEAN, fiber);
        ScatteringMaterial::new::<f64>(constants, fiber.desc(), *scattering)
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &ScatteringMaterial<C>,
        hit: Hit<L>,
    ) -> ChiangPrepared<L::Stored> {
        let fiber = ChiangMaterial {
            widths: widths(material, hit.wo),
            ..material.fiber.spread::<L>()
        };
        gather::prepare::<L, L::Stored>(&fiber, hit)
    }

    #[inline(always)]
    fn weights<L: Lanes, C: Broadcast<L>>(prepared: &ChiangPrepared<C>) -> PerLobe<L> {
        <Chiang as LobeModel>::weights(prepared)
    }

    #[inline(always)]
    fn energies<L: Lanes, C: Broadcast<L>>(prepared: &ChiangPrepared<C>) -> PerLobe<L> {
        <Chiang as LobeModel>::energies(prepared)
    }

    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L>>(
        prepared: &ChiangPrepared<C>,
        wi: &Direction<L>,
    ) -> PerLobe<LobeEval<L>> {
        <Chiang as LobeModel>::lobes(prepared, wi)
    }

    #[inline(always)]
    fn first_four<L: Lanes, C: Broadcast<L>>(
        prepared: &ChiangPrepared<C>,
        wi: &Direction<L>,
    ) -> [LobeEval<L>; 4] {
        <Chiang as LobeModel>::first_four(prepared, wi)
    }

    #[inline(always)]
    fn sample_lobe<L: Lanes, C: Broadcast<L>>(
        prepared: &ChiangPrepared<C>,
        lobe: L::Index,
        xi: [L; 3],
    ) -> Direction<L> {
        <Chiang as LobeModel>::sample_lobe(prepared, lobe, xi)
    }

    #[inline(always)]
    fn albedo<L: Lanes, C: Broadcast<L>>(prepared: &ChiangPrepared<C>) -> PerLobe<[L; 3]> {
        <Chiang as LobeModel>::albedo(prepared)
    }
}

/// Field of the scattering, which follows those of the fibre.
const OWN: [Field; 1] = [Field::new(
    "scattering",
    Kind::Number,
    SHARE,
    "Scattering of a medulla, which widens TT, TRT and the rest.",
)
.uniform(0.0, 0.8)
.optional()];

impl Parameters for ScatteringParams {
    const FIELDS: &'static [Field] = {
        const ALL: [Field; Values::<f32>::MOST] = appended(ChiangParams::FIELDS, &OWN);
        ALL.split_at(ChiangParams::FIELDS.len() + OWN.len()).0
    };
    /// Presets of the fibre, each with some scattering.
    const PRESETS: &'static [(&'static str, Self)] = &{
        let fibers = ChiangParams::presets();
        let mut all = [("", Self::scattering(fibers[0].1)); 6];
        let mut place = 0;
        while place < all.len() {
            all[place] = (fibers[place].0, Self::scattering(fibers[place].1));
            place += 1;
        }
        all
    };

    #[inline]
    fn values(&self) -> Values {
        let ScatteringDesc { fiber, scattering } = self.desc();
        fiber
            .values()
            .of_fields(Self::FIELDS)
            .with("scattering", &[*scattering])
    }

    #[inline]
    fn from_values(values: &Values) -> Result<Self, ParamError> {
        Self::new(&ScatteringDesc {
            fiber: ChiangParams::from_values(&values.of_fields(ChiangParams::FIELDS))?,
            scattering: values.number_at(ChiangParams::FIELDS.len()),
        })
    }

    #[inline]
    fn chain(values: &Values, by_kept: &Values<f64>) -> Values<f64> {
        let fields = ChiangParams::FIELDS;
        ChiangParams::chain(&values.of_fields(fields), &by_kept.of_fields(fields))
            .of_fields(Self::FIELDS)
            .with("scattering", by_kept.numbers("scattering"))
    }

    /// Checks `factor` and returns the fibre unchanged, because it returns no more light than it receives.
    #[inline]
    fn scaled(&self, factor: f32) -> Result<Self, ParamError> {
        self.0.fiber.scaled(factor).map(|_| *self)
    }
}

impl ScatteringParams {
    const fn scattering(fiber: ChiangParams) -> Self {
        Self(ScatteringDesc {
            fiber,
            scattering: 0.4,
        })
    }
}

impl Registered for ScatteringChiang {
    const NAME: &'static str = "chiang-scattering";
    const MODEL: Self = Self;
    const NEAR_FIELD: bool = true;
    const COLORS: Option<&'static str> = Some("attenuation");

    #[inline]
    fn constants<W: Precision>(values: &Values<W::Lane>) -> ScatteringMaterial<W::Lane> {
        let fields = ChiangParams::FIELDS;
        ScatteringMaterial::new::<W>(
            <Chiang as Registered>::constants::<W>(&values.of_fields(fields)),
            &ChiangDesc::of_values(values),
            values.number_at(fields.len()),
        )
    }
}
