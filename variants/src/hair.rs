//! The published model and its variants in the registry: parameters, names, formulas.

use crate::{Cauchy, Field, Kind, Parameters, Registered, Values};
use hairis::model::MatchedBell;
use hairis::params::HairDesc;
use hairis::{Gaussian, HairParams, Matched, ParamError, Published};

#[cfg(feature = "textbook")]
use crate::Accuracy;
#[cfg(feature = "textbook")]
use hairis::{
    Lobe, reference, reference::HairReference, reference::MatchedReference, reference::Real,
    reference::Shape,
};

/// Half a degree, rad.
const NARROW: f32 = 0.008_726_646;

/// Random hair is that of everyday: widths of 1 to 30 degrees, shifts within 15 degrees, glints at 10 to 80 degrees and
/// of strength 0.1 to 10, colours in `[0, 1)`.
impl Parameters for HairParams {
    const FIELDS: &'static [Field] = &[
        Field::new(
            "alpha",
            Kind::Numbers(&["alpha_r", "alpha_tt", "alpha_trt"]),
        )
        .uniform(-15.0, 15.0)
        .degrees(),
        Field::new("beta", Kind::Numbers(&["beta_r", "beta_tt", "beta_trt"]))
            .log_uniform(1.0, 30.0)
            .degrees()
            .narrow(NARROW),
        Field::new("gamma_tt", Kind::Number)
            .log_uniform(1.0, 30.0)
            .degrees()
            .narrow(NARROW),
        Field::new("gamma_g", Kind::Number)
            .log_uniform(1.0, 30.0)
            .degrees()
            .narrow(NARROW),
        Field::new("phi_g", Kind::Number)
            .uniform(10.0, 80.0)
            .degrees()
            .late(),
        Field::new("i_r", Kind::Rgb)
            .alias("intensity_r")
            .uniform(0.0, 1.0),
        Field::new("i_tt", Kind::Rgb)
            .alias("intensity_tt")
            .uniform(0.0, 1.0),
        Field::new("i_trt", Kind::Rgb)
            .alias("intensity_trt")
            .uniform(0.0, 1.0),
        Field::new("i_g", Kind::Number)
            .alias("intensity_g")
            .log_uniform(0.1, 10.0)
            .late(),
    ];
    const PRESETS: &'static [(&'static str, Self)] = &Self::presets();

    #[inline]
    fn values(&self) -> Values {
        let d = self.desc();
        Values::none(Self::FIELDS)
            .with("alpha", &[d.alpha_r, d.alpha_tt, d.alpha_trt])
            .with("beta", &[d.beta_r, d.beta_tt, d.beta_trt])
            .with("gamma_tt", &[d.gamma_tt])
            .with("gamma_g", &[d.gamma_g])
            .with("phi_g", &[d.phi_g])
            .with("i_r", &d.intensity_r)
            .with("i_tt", &d.intensity_tt)
            .with("i_trt", &d.intensity_trt)
            .with("i_g", &[d.intensity_g])
    }

    #[inline]
    fn from_values(values: &Values) -> Result<Self, ParamError> {
        let [alpha_r, alpha_tt, alpha_trt] = values.get("alpha");
        let [beta_r, beta_tt, beta_trt] = values.get("beta");
        let number = |name| {
            let [number] = values.get(name);
            number
        };
        Self::new(&HairDesc {
            alpha_r,
            alpha_tt,
            alpha_trt,
            beta_r,
            beta_tt,
            beta_trt,
            gamma_tt: number("gamma_tt"),
            gamma_g: number("gamma_g"),
            phi_g: number("phi_g"),
            intensity_r: values.get("i_r"),
            intensity_tt: values.get("i_tt"),
            intensity_trt: values.get("i_trt"),
            intensity_g: number("i_g"),
        })
    }
}

/// A bell that the registry has models of.
pub trait RegisteredBell: MatchedBell + Send + Sync + 'static {
    /// Name of the models.
    const NAME: &'static str;
    /// The bell as it is registered.
    const BELL: Self;
    /// The bell in the formulas.
    #[cfg(feature = "textbook")]
    const SHAPE: Shape;
    /// Relative errors allowed of S, of what a matched sampler reports, and of its cdf.
    #[cfg(feature = "textbook")]
    const ERRORS: [f64; 3];
}

impl RegisteredBell for Gaussian {
    const NAME: &'static str = "gaussian";
    const BELL: Self = Self;
    #[cfg(feature = "textbook")]
    const SHAPE: Shape = Shape::Gaussian;
    #[cfg(feature = "textbook")]
    const ERRORS: [f64; 3] = [1e-4, 3e-5, 5e-5];
}

impl RegisteredBell for Cauchy {
    const NAME: &'static str = "cauchy";
    const BELL: Self = Self::PAPER;
    #[cfg(feature = "textbook")]
    const SHAPE: Shape = Shape::Cauchy;
    #[cfg(feature = "textbook")]
    const ERRORS: [f64; 3] = [1e-5; 3];
}

/// Of the published sampler a weight is a value over a density: its bound is the sum of theirs. A cdf moves by 20 times as
/// much as the angle on the narrowest lobe, of a degree, and the angle of a rounded direction by 2e-7 rad.
impl<B: RegisteredBell> Registered for Published<B> {
    const NAME: &'static str = B::NAME;
    const CHOICE: Option<(&'static str, &'static str)> = Some(("sampler", "published"));
    const MODEL: Self = Self(B::BELL);

    #[cfg(feature = "textbook")]
    type Formulas<T: Real> = reference::Parameters<T>;
    #[cfg(feature = "textbook")]
    type Reference<T: Real> = HairReference<T>;
    #[cfg(feature = "textbook")]
    const ACCURACY: Accuracy = {
        let [value, _, _] = B::ERRORS;
        let sample_weight = value + 1e-5;
        Accuracy {
            value,
            pdf: 1e-5,
            sample_value: value,
            sample_pdf: 1e-5,
            sample_weight,
            cdf: 1e-5,
            slack_in_pdf: false,
        }
    };

    #[cfg(feature = "textbook")]
    #[inline]
    fn formulas<T: Real>(params: &HairParams) -> reference::Parameters<T> {
        reference::Parameters::from(params)
    }

    #[cfg(feature = "textbook")]
    #[inline]
    fn exact_formulas<T: Real>(
        _params: &HairParams,
        exact: &Values<T>,
    ) -> reference::Parameters<T> {
        exact_parameters(exact)
    }

    #[cfg(feature = "textbook")]
    #[inline]
    fn reference_at<T: Real>(
        formulas: &reference::Parameters<T>,
        wo: [T; 3],
        _h: T,
    ) -> HairReference<T> {
        HairReference::prepare(formulas, B::SHAPE, wo)
    }

    #[cfg(feature = "textbook")]
    #[inline]
    fn slack(params: &HairParams, wo: [f64; 3], wi: [f64; 3]) -> [f64; 3] {
        slack(B::SHAPE, params, wo, wi)
    }

    #[cfg(feature = "textbook")]
    #[inline]
    fn cdf(reference: &HairReference<f64>, lobe: Lobe, theta_i: f64, phi: f64) -> Option<[f64; 2]> {
        Some([
            reference.cdf_theta(lobe, theta_i),
            reference.cdf_phi(lobe, phi),
        ])
    }
}

/// A matched density is made of the model's own bells, and is allowed what S is; samples stay away from where S is known
/// worst. The largest seen of their density, S and weight is 2e-5 (Gaussian) and 9.8e-6 (Cauchy); of their cdf, 2.5e-5 on
/// Gaussian lobes that lie off the sphere and fall from its pole, and 2.4e-6 on Cauchy ones (four seeds, in full).
impl<B: RegisteredBell, const BANDS: usize> Registered for Matched<B, BANDS> {
    const NAME: &'static str = B::NAME;
    const CHOICE: Option<(&'static str, &'static str)> = Some((
        "sampler",
        match BANDS {
            5 => "matched-5",
            9 => "matched",
            25 => "matched-25",
            _ => panic!("there is no such sampler"),
        },
    ));
    const MODEL: Self = Self(B::BELL);

    #[cfg(feature = "textbook")]
    type Formulas<T: Real> = reference::Parameters<T>;
    #[cfg(feature = "textbook")]
    type Reference<T: Real> = MatchedReference<T>;
    #[cfg(feature = "textbook")]
    const ACCURACY: Accuracy = {
        let [value, sample, cdf] = B::ERRORS;
        Accuracy {
            value,
            pdf: value,
            sample_value: sample,
            sample_pdf: sample,
            sample_weight: sample,
            cdf,
            slack_in_pdf: true,
        }
    };

    #[cfg(feature = "textbook")]
    #[inline]
    fn formulas<T: Real>(params: &HairParams) -> reference::Parameters<T> {
        reference::Parameters::from(params)
    }

    #[cfg(feature = "textbook")]
    #[inline]
    fn exact_formulas<T: Real>(
        _params: &HairParams,
        exact: &Values<T>,
    ) -> reference::Parameters<T> {
        exact_parameters(exact)
    }

    #[cfg(feature = "textbook")]
    #[inline]
    fn reference_at<T: Real>(
        formulas: &reference::Parameters<T>,
        wo: [T; 3],
        _h: T,
    ) -> MatchedReference<T> {
        MatchedReference::prepare(formulas, B::SHAPE, wo, BANDS)
    }

    #[cfg(feature = "textbook")]
    #[inline]
    fn slack(params: &HairParams, wo: [f64; 3], wi: [f64; 3]) -> [f64; 3] {
        slack(B::SHAPE, params, wo, wi)
    }

    #[cfg(feature = "textbook")]
    #[inline]
    fn cdf(
        reference: &MatchedReference<f64>,
        lobe: Lobe,
        theta_i: f64,
        phi: f64,
    ) -> Option<[f64; 2]> {
        Some([
            reference.cdf_theta(lobe, theta_i),
            reference.cdf_phi(lobe, phi),
        ])
    }
}

/// The formulas' parameters of these values.
#[cfg(feature = "textbook")]
#[inline]
fn exact_parameters<T: Real>(exact: &Values<T>) -> reference::Parameters<T> {
    let number = |name| {
        let [number] = exact.get(name);
        number
    };
    reference::Parameters {
        alpha: exact.get("alpha"),
        beta: exact.get("beta"),
        gamma_tt: number("gamma_tt"),
        gamma_g: number("gamma_g"),
        phi_g: number("phi_g"),
        intensity_r: exact.get("i_r"),
        intensity_tt: exact.get("i_tt"),
        intensity_trt: exact.get("i_trt"),
        intensity_g: number("i_g"),
    }
}

/// The kernels' Gaussians are 0 from between `2^-114` and `2^-115` down, each of the four lobes.
#[cfg(feature = "textbook")]
#[inline]
fn slack(shape: Shape, params: &HairParams, wo: [f64; 3], wi: [f64; 3]) -> [f64; 3] {
    const FLOOR: f64 = 1.0 / (1_u128 << 114) as f64;
    if shape != Shape::Gaussian {
        return [0.0; 3];
    }
    let [theta_o, theta_i] = [wo, wi].map(|[u, v, w]| u.atan2(v.hypot(w)));
    let cos_theta_d = (0.5 * (theta_o - theta_i)).cos();
    let d = params.desc();
    core::array::from_fn(|c| {
        let intensity =
            d.intensity_r[c] + d.intensity_tt[c] + d.intensity_trt[c] * (1.0 + d.intensity_g);
        f64::from(intensity) * FLOOR / (cos_theta_d * cos_theta_d)
    })
}
