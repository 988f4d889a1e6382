//! Formulas of the models of the registry.

mod chiang;

use crate::d_eon::{DEonReference, absorption_of_melanin};
use crate::interface::Reference;
use crate::kajiya_kay::{KajiyaKayConstants, KajiyaKayReference, cosine_power_integral};
use crate::published::{HairReference, MatchedReference, Shape};
use crate::real::Real;
use crate::with_diffuse::{WithDiffuseConstants, WithDiffuseReference};
use core::f64::consts::PI;
use core::fmt::Debug;
use hairis::params::HairDesc;
use hairis::{Gaussian, HairParams, Matched, ParamError, Published};
use hairis_variants::{
    AllCauchy, Cauchy, Chiang, DEon, DEonDesc, DEonParams, DiffusePresets, KajiyaKay,
    KajiyaKayDesc, KajiyaKayParams, ModelId, Parameters, Registered, RegisteredBell, Values,
    WithDiffuse, WithDiffuseParams, hair_desc,
};

/// Model of the registry, paired with its formulas.
pub trait Formulas: Registered {
    /// Numbers that the formulas compute once per material.
    type Constants<T: Real>: Copy + Debug + Send + Sync;
    /// Formulas at one shading point.
    type Point<T: Real>: Reference<T> + Copy + 'static;
    /// Accuracy that comparisons with the formulas require.
    const ACCURACY: Accuracy;

    /// Computes the constants of the formulas from checked parameters.
    fn formulas<T: Real>(params: &Self::Params) -> Self::Constants<T>;

    /// Computes the constants of the formulas from the numbers of `exact`, in any precision. `params` are the same numbers, rounded,
    /// and provide the settings that are words.
    fn exact_formulas<T: Real>(params: &Self::Params, exact: &Values<T>) -> Self::Constants<T>;

    /// Prepares the formulas for the direction `wo` at the offset `h`.
    fn point<T: Real>(constants: &Self::Constants<T>, wo: [T; 3], h: T) -> Self::Point<T>;

    /// Returns the absolute error of S allowed beside the relative error, by channel: 0 unless the model cuts its tails.
    fn slack(params: &Self::Params, wo: [f64; 3], wi: [f64; 3]) -> [f64; 3];
}

/// Largest errors allowed against the formulas in `f64`: relative, except that of a cdf, which is absolute.
///
/// - Domain: directions further than 1e-3 rad from the axis, random materials of [`Field::draw`](hairis_variants::Field::draw), of
///   Kajiya and Kay's model those with a `kd` of a fiftieth and more.
/// - Source: the errors of angles times the steepness of the lobes, with a margin over the largest that searches uphill found; the
///   guide `platforms` of `hairis` has a table of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Error of S at a given direction.
    pub value: f64,
    /// Error of the density of a given direction.
    pub pdf: f64,
    /// Error of the S that a sample reports, at its direction.
    pub sample_value: f64,
    /// Error of the density that a sample reports.
    pub sample_pdf: f64,
    /// Error of the weight that a sample reports.
    pub sample_weight: f64,
    /// Distance of [`Reference::cdf`] from the numbers of a sample.
    pub cdf: f64,
    /// True if the density is allowed the [`slack`] of S as well, as the same share of its value.
    pub slack_in_pdf: bool,
}

/// Computation on a model of the registry as a type: see [`visit`].
pub trait Visitor {
    /// Result of the computation.
    type Output;

    /// Computes the result for the model `M`.
    fn visit<M: Formulas>(self) -> Self::Output;
}

macro_rules! formulas {
    ($($(#[$doc:meta])* $variant:ident: $model:ty;)*) => {
        /// Calls `visitor` with the model's type, as [`ModelId::visit`] does.
        pub fn visit<V: Visitor>(id: ModelId, visitor: V) -> V::Output {
            match id {
                $(ModelId::$variant => visitor.visit::<$model>(),)*
                _ => unreachable!("the list has every model"),
            }
        }
    };
}
hairis_variants::for_each_model! { formulas }

/// Prepares the formulas of a model with these values, for the direction `wo` at the offset `h`.
///
/// # Errors
///
/// Returns an error if a value is out of its range.
pub fn reference<T: Real>(
    id: ModelId,
    values: &Values,
    wo: [T; 3],
    h: T,
) -> Result<Box<dyn Reference<T>>, ParamError> {
    exact_reference(id, values, &values.map(T::from_f32), wo, h)
}

/// Prepares the formulas with the numbers of `exact`, for the direction `wo` at the offset `h`. `values` are the same numbers,
/// rounded.
///
/// # Errors
///
/// Returns an error if one of `values` is out of its range; `exact` is not checked.
pub fn exact_reference<T: Real>(
    id: ModelId,
    values: &Values,
    exact: &Values<T>,
    wo: [T; 3],
    h: T,
) -> Result<Box<dyn Reference<T>>, ParamError> {
    struct Prepare<'a, T>(&'a Values, &'a Values<T>, [T; 3], T);
    impl<T: Real> Visitor for Prepare<'_, T> {
        type Output = Result<Box<dyn Reference<T>>, ParamError>;
        fn visit<M: Formulas>(self) -> Self::Output {
            let Self(values, exact, wo, h) = self;
            let constants = M::exact_formulas(&M::Params::from_values(values)?, exact);
            Ok(Box::new(M::point(&constants, wo, h)))
        }
    }
    visit(id, Prepare(values, exact, wo, h))
}

/// Returns the accuracy that comparisons with the formulas of a model require.
#[must_use]
pub fn accuracy(id: ModelId) -> Accuracy {
    struct Required;
    impl Visitor for Required {
        type Output = Accuracy;
        fn visit<M: Formulas>(self) -> Accuracy {
            M::ACCURACY
        }
    }
    visit(id, Required)
}

/// Returns the absolute error of S that is allowed, by channel: see [`Formulas::slack`].
///
/// # Errors
///
/// Returns an error if a value is out of its range.
pub fn slack(
    id: ModelId,
    values: &Values,
    wo: [f64; 3],
    wi: [f64; 3],
) -> Result<[f64; 3], ParamError> {
    struct Allowed<'a>(&'a Values, [f64; 3], [f64; 3]);
    impl Visitor for Allowed<'_> {
        type Output = Result<[f64; 3], ParamError>;
        fn visit<M: Formulas>(self) -> Self::Output {
            Ok(M::slack(&M::Params::from_values(self.0)?, self.1, self.2))
        }
    }
    visit(id, Allowed(values, wo, wi))
}

/// Bell of the registry, as the formulas have it.
trait Bell: RegisteredBell {
    const SHAPE: Shape;
    /// Relative errors allowed of S and of the published sampler's density, and absolute error of a matched sampler's cdf.
    const ERRORS: [f64; 3];
}

/// Error of a product of two Cauchy bells of a degree, which change by 57 per radian where they are steepest.
const DENSITY: f64 = 3e-5;

impl Bell for Gaussian {
    const SHAPE: Shape = Shape::Gaussian;
    // A lobe of a degree, 12.6 widths from its centre, changes by 720 per radian: by 2e-4 as its two angles err by 1.4e-7 and 2.6e-7 rad.
    // The cdf of a lobe off the sphere has the relative error of `normal_tail_inverse`, 2.2e-4, and as much by its angle.
    const ERRORS: [f64; 3] = [2e-4, DENSITY, 4e-4];
}

impl Bell for Cauchy {
    const SHAPE: Shape = Shape::Cauchy;
    const ERRORS: [f64; 3] = [DENSITY, DENSITY, 1e-5];
}

/// A weight of the published sampler is a value over a density, so that its bound is the sum of theirs. A cdf moves by 20 times as
/// much as the angle on the narrowest lobe, of a degree, and the angle of a rounded direction by 2e-7 rad.
impl<B: Bell> Formulas for Published<B> {
    type Constants<T: Real> = HairDesc<T>;
    type Point<T: Real> = HairReference<T>;
    const ACCURACY: Accuracy = {
        let [value, pdf, _] = B::ERRORS;
        Accuracy {
            value,
            pdf,
            sample_value: value,
            sample_pdf: pdf,
            sample_weight: value + pdf,
            cdf: 1e-5,
            slack_in_pdf: false,
        }
    };

    #[inline]
    fn formulas<T: Real>(params: &HairParams) -> HairDesc<T> {
        params.desc().map(T::from_f32)
    }

    #[inline]
    fn exact_formulas<T: Real>(_params: &HairParams, exact: &Values<T>) -> HairDesc<T> {
        hair_desc(exact)
    }

    #[inline]
    fn point<T: Real>(constants: &HairDesc<T>, wo: [T; 3], _h: T) -> HairReference<T> {
        HairReference::prepare(constants, B::SHAPE, wo)
    }

    fn slack(params: &HairParams, wo: [f64; 3], wi: [f64; 3]) -> [f64; 3] {
        hair_slack(B::SHAPE, params, wo, wi)
    }
}

/// A matched density is made of the model's own bells, and is allowed the same error as S. So are results of samples, which come to the
/// tails of a lobe at the ends of the uniform numbers, and off the sphere.
impl<B: Bell, const BANDS: usize> Formulas for Matched<B, BANDS> {
    type Constants<T: Real> = HairDesc<T>;
    type Point<T: Real> = MatchedReference<T>;
    const ACCURACY: Accuracy = {
        let [value, _, cdf] = B::ERRORS;
        Accuracy {
            value,
            pdf: value,
            sample_value: value,
            sample_pdf: value,
            sample_weight: value,
            cdf,
            slack_in_pdf: true,
        }
    };

    #[inline]
    fn formulas<T: Real>(params: &HairParams) -> HairDesc<T> {
        params.desc().map(T::from_f32)
    }

    #[inline]
    fn exact_formulas<T: Real>(_params: &HairParams, exact: &Values<T>) -> HairDesc<T> {
        hair_desc(exact)
    }

    #[inline]
    fn point<T: Real>(constants: &HairDesc<T>, wo: [T; 3], _h: T) -> MatchedReference<T> {
        MatchedReference::prepare(constants, B::SHAPE, wo, BANDS)
    }

    fn slack(params: &HairParams, wo: [f64; 3], wi: [f64; 3]) -> [f64; 3] {
        hair_slack(B::SHAPE, params, wo, wi)
    }
}

/// Returns the slack of the published model: in the kernels each of the four Gaussians is 0 from between `2^-114` and `2^-115` down.
fn hair_slack(shape: Shape, params: &HairParams, wo: [f64; 3], wi: [f64; 3]) -> [f64; 3] {
    const FLOOR: f64 = 1.0 / (1_u128 << 114) as f64;
    if shape != Shape::Gaussian {
        return [0.0; 3];
    }
    let [theta_o, theta_i] = [wo, wi].map(|[u, v, w]| u.atan2(v.hypot(w)));
    let cos_theta_d = (0.5 * (theta_o - theta_i)).cos();
    let d = params.desc();
    core::array::from_fn(|c| {
        let intensity = d.i_r[c] + d.i_tt[c] + d.i_trt[c] * (1.0 + d.i_g);
        f64::from(intensity) * FLOOR / (cos_theta_d * cos_theta_d)
    })
}

/// Formulas with an accuracy that holds for exponents from 2 to 1000.
impl Formulas for KajiyaKay {
    type Constants<T: Real> = KajiyaKayConstants<T>;
    type Point<T: Real> = KajiyaKayReference<T>;
    const ACCURACY: Accuracy = Accuracy {
        value: 2e-5,
        pdf: 2e-5,
        sample_value: 2e-5,
        sample_pdf: 2e-5,
        sample_weight: 2e-5,
        cdf: 0.0,
        slack_in_pdf: true,
    };

    #[inline]
    fn formulas<T: Real>(params: &KajiyaKayParams) -> KajiyaKayConstants<T> {
        KajiyaKayConstants::new(&params.desc().map(T::from_f32))
    }

    #[inline]
    fn exact_formulas<T: Real>(
        params: &KajiyaKayParams,
        exact: &Values<T>,
    ) -> KajiyaKayConstants<T> {
        let [exponent] = exact.get("exponent");
        KajiyaKayConstants::new(&KajiyaKayDesc {
            kd: exact.get("kd"),
            ks: exact.get("ks"),
            exponent,
            form: params.desc().form,
        })
    }

    #[inline]
    fn point<T: Real>(
        constants: &KajiyaKayConstants<T>,
        wo: [T; 3],
        _h: T,
    ) -> KajiyaKayReference<T> {
        constants.prepare(wo)
    }

    /// Returns the slack of the highlight, whose errors grow with the exponent of the bell: from 1e-12 of its peak down they are
    /// absolute.
    fn slack(params: &KajiyaKayParams, _wo: [f64; 3], wi: [f64; 3]) -> [f64; 3] {
        let (desc, [_, v, w]) = (params.desc(), wi);
        let peak = 0.5 / (PI * cosine_power_integral(f64::from(desc.exponent) + 2.0));
        desc.ks.map(|ks| 1e-17 * f64::from(ks) * peak / v.hypot(w))
    }
}

impl Formulas for DEon {
    type Constants<T: Real> = DEonDesc<T>;
    type Point<T: Real> = DEonReference<T>;
    // `1e-5 + 5e-7 / w`, where the narrowest w is that of R at its edge, at a roughness of .1.
    const ACCURACY: Accuracy = Accuracy {
        value: 4.6e-5,
        pdf: 4.6e-5,
        sample_value: 4.6e-5,
        sample_pdf: 4.6e-5,
        sample_weight: 1e-4,
        cdf: 0.0,
        slack_in_pdf: true,
    };

    #[inline]
    fn formulas<T: Real>(params: &DEonParams) -> DEonDesc<T> {
        params.desc().map(T::from_f32)
    }

    #[inline]
    fn exact_formulas<T: Real>(_params: &DEonParams, exact: &Values<T>) -> DEonDesc<T> {
        let parameters = DEonDesc::of_values(exact);
        if exact.has("melanin") {
            DEonDesc {
                sigma_a: absorption_of_melanin(exact.get("melanin")),
                ..parameters
            }
        } else {
            parameters
        }
    }

    #[inline]
    fn point<T: Real>(constants: &DEonDesc<T>, wo: [T; 3], _h: T) -> DEonReference<T> {
        DEonReference::prepare(constants, wo)
    }

    /// Returns the slack of the lobes, whose errors grow with their exponent: from `exp(-12)` of the peak down they are absolute. So is the
    /// error of TT next to its last azimuth, where a rounded azimuth does not determine it.
    fn slack(params: &DEonParams, wo: [f64; 3], wi: [f64; 3]) -> [f64; 3] {
        let desc = params.desc().map(f64::from);
        let [_, v, w] = wi;
        let k = wo[1].hypot(wo[2]).max(1e-3);
        let peak = 0.2 / desc.roughness / k;
        let tail = Self::ACCURACY.value * (-12.0_f64).exp() * peak / v.hypot(w);
        DEonReference::prepare(&desc, wo)
            .slack(wi)
            .map(|edge| edge + tail)
    }
}

/// Formulas whose error is that of the model, and never less than that of the cylinder.
impl<M: Formulas<Params: DiffusePresets>> Formulas for WithDiffuse<M> {
    type Constants<T: Real> = WithDiffuseConstants<M::Constants<T>, T>;
    type Point<T: Real> = WithDiffuseReference<M::Point<T>, T>;
    const ACCURACY: Accuracy = M::ACCURACY;

    #[inline]
    fn formulas<T: Real>(params: &Self::Params) -> Self::Constants<T> {
        let desc = params.desc();
        WithDiffuseConstants {
            fiber: M::formulas(&desc.fiber),
            diffuse: T::from_f32(desc.diffuse),
            diffuse_color: desc.diffuse_color.map(T::from_f32),
        }
    }

    #[inline]
    fn exact_formulas<T: Real>(params: &Self::Params, exact: &Values<T>) -> Self::Constants<T> {
        // The fields of the model come first, so that they have the places and names of the model alone.
        let first = <M::Params as Parameters>::FIELDS.len();
        WithDiffuseConstants {
            fiber: M::exact_formulas(&params.desc().fiber, exact),
            diffuse: exact.number_at(first),
            diffuse_color: exact.get_at(first + 1),
        }
    }

    #[inline]
    fn point<T: Real>(constants: &Self::Constants<T>, wo: [T; 3], h: T) -> Self::Point<T> {
        let fiber = M::point(&constants.fiber, wo, h);
        WithDiffuseReference::prepare(constants, fiber, M::LOBES.len(), wo)
    }

    fn slack(params: &WithDiffuseParams<M::Params>, wo: [f64; 3], wi: [f64; 3]) -> [f64; 3] {
        M::slack(&params.desc().fiber, wo, wi)
    }
}
