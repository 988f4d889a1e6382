//! The model in the registry, and its parameters as fields.

use super::{Form, KajiyaKay, KajiyaKayDesc, KajiyaKayParams};
use crate::{Field, Kind, Parameters, Registered, Values};
use hairis::ParamError;

#[cfg(feature = "textbook")]
use super::{KajiyaKayConstants, KajiyaKayParameters, KajiyaKayReference};
#[cfg(feature = "textbook")]
use crate::Accuracy;
#[cfg(feature = "textbook")]
use hairis::reference::Real;

const FORMS: [(&str, Form); 2] = [
    ("reciprocal", Form::Reciprocal),
    ("published", Form::Published),
];

impl Parameters for KajiyaKayParams {
    const FIELDS: &'static [Field] = &[
        Field::new("kd", Kind::Rgb).uniform(0.0, 0.6),
        Field::new("ks", Kind::Rgb).uniform(0.0, 0.4),
        Field::new("exponent", Kind::Number)
            .log_uniform(2.0, 500.0)
            .narrow(1000.0),
        Field::new("form", Kind::Word(&[FORMS[0].0, FORMS[1].0])).optional(),
    ];
    const PRESETS: &'static [(&'static str, Self)] = &Self::presets();

    #[inline]
    fn values(&self) -> Values {
        let d = self.desc();
        let form = FORMS
            .iter()
            .find(|(_, form)| *form == d.form)
            .map_or(FORMS[0].0, |(word, _)| word);
        Values::none(Self::FIELDS)
            .with("kd", &d.kd)
            .with("ks", &d.ks)
            .with("exponent", &[d.exponent])
            .with_word("form", form)
    }

    #[inline]
    fn from_values(values: &Values) -> Result<Self, ParamError> {
        let word = values.word("form");
        let form = FORMS
            .iter()
            .find(|(one, _)| *one == word)
            .map_or(Form::default(), |(_, form)| *form);
        let [exponent] = values.get("exponent");
        Self::new(&KajiyaKayDesc {
            kd: values.get("kd"),
            ks: values.get("ks"),
            exponent,
            form,
        })
    }
}

impl Registered for KajiyaKay {
    const NAME: &'static str = "kajiya-kay";
    const MODEL: Self = Self;

    #[cfg(feature = "textbook")]
    type Formulas<T: Real> = KajiyaKayConstants<T>;
    #[cfg(feature = "textbook")]
    type Reference<T: Real> = KajiyaKayReference<T>;
    // For exponents up to 1000.
    #[cfg(feature = "textbook")]
    const ACCURACY: Accuracy = Accuracy {
        value: 1e-5,
        pdf: 1e-5,
        sample_value: 1e-5,
        sample_pdf: 1e-5,
        sample_weight: 2e-5,
        cdf: 0.0,
        slack_in_pdf: true,
    };

    #[cfg(feature = "textbook")]
    #[inline]
    fn formulas<T: Real>(params: &KajiyaKayParams) -> KajiyaKayConstants<T> {
        KajiyaKayConstants::new(&params.into())
    }

    #[cfg(feature = "textbook")]
    #[inline]
    fn exact_formulas<T: Real>(
        params: &KajiyaKayParams,
        exact: &Values<T>,
    ) -> KajiyaKayConstants<T> {
        let [exponent] = exact.get("exponent");
        let form = params.desc().form;
        KajiyaKayConstants::new(&KajiyaKayParameters {
            kd: exact.get("kd"),
            ks: exact.get("ks"),
            exponent,
            form,
        })
    }

    #[cfg(feature = "textbook")]
    #[inline]
    fn reference_at<T: Real>(
        formulas: &KajiyaKayConstants<T>,
        wo: [T; 3],
        _h: T,
    ) -> KajiyaKayReference<T> {
        formulas.prepare(wo)
    }

    /// Errors grow with the exponent of the bell: from 1e-12 of its peak down they are absolute.
    #[cfg(feature = "textbook")]
    #[inline]
    fn slack(params: &KajiyaKayParams, _wo: [f64; 3], wi: [f64; 3]) -> [f64; 3] {
        let (desc, [_, v, w]) = (params.desc(), wi);
        let peak =
            0.5 / (core::f64::consts::PI * super::cosine_integral(f64::from(desc.exponent) + 2.0));
        desc.ks
            .map(|ks| 1e-17 * f64::from(ks) * peak / libm::hypot(v, w))
    }
}
