//! Registry entry of Kajiya and Kay's model, and its parameters as fields.

use super::params::EXPONENT;
use super::{Form, KajiyaKay, KajiyaKayDesc, KajiyaKayMaterial, KajiyaKayParams};
use crate::{Field, Kind, Parameters, Registered, Values};
use hairis::ParamError;
use hairis::model::Precision;
use hairis::params::Rule;
use hairis::simd::Lanes;

const FORMS: [(&str, Form); 2] = [
    ("reciprocal", Form::Reciprocal),
    ("published", Form::Published),
];

impl Parameters for KajiyaKayParams {
    const FIELDS: &'static [Field] = &[
        Field::new("kd", Kind::Rgb, Rule::NotNegative, "Diffuse albedo.").uniform(0.0, 0.6),
        Field::new(
            "ks",
            Kind::Rgb,
            Rule::NotNegative,
            "Specular albedo seen from the normal plane.",
        )
        .uniform(0.0, 0.4),
        Field::new(
            "exponent",
            Kind::Number,
            EXPONENT,
            "Exponent of the highlight.",
        )
        .log_uniform(2.0, 500.0)
        .narrow(1000.0),
        Field::word(
            "form",
            Kind::Word(&[FORMS[0].0, FORMS[1].0]),
            "Form of the highlight.",
        )
        .optional(),
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
        Self::new(&KajiyaKayDesc {
            kd: values.get_at(0),
            ks: values.get_at(1),
            exponent: values.number_at(2),
            form,
        })
    }

    #[inline]
    fn scaled(&self, factor: f32) -> Result<Self, ParamError> {
        Self::scaled(self, factor)
    }
}

impl Registered for KajiyaKay {
    const NAME: &'static str = "kajiya-kay";
    const MODEL: Self = Self;

    #[inline]
    fn constants<W: Precision>(values: &Values<W::Lane>) -> KajiyaKayMaterial<W::Lane> {
        let reciprocal = values.number_at(3).lt(W::Lane::splat(0.5));
        super::constants::<W>(
            values.get_at(0),
            values.get_at(1),
            values.number_at(2),
            reciprocal,
        )
    }
}
