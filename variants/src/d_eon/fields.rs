//! Registry entry of d'Eon's far field, and its parameters as fields.

use super::params::{INDEX, ROUGHNESS, TILT};
use super::{DEon, DEonDesc, DEonMaterial, DEonParams};
use crate::chiang::by_melanin;
use crate::with_diffuse::DIFFUSE_FIELDS;
use crate::{Field, Kind, Parameters, Registered, Values};
use hairis::ParamError;
use hairis::model::Precision;
use hairis::params::{Pigments, Rule};

impl DEonDesc {
    /// Returns the description that the values of the fields form, in any type of number. Nothing is checked, and no field stands in for
    /// another.
    ///
    /// # Panics
    ///
    /// Panics if the values belong to the fields of another model.
    #[inline]
    #[must_use]
    pub fn of_values<T: Copy>(values: &Values<T>) -> DEonDesc<T> {
        DEonDesc {
            roughness: values.number_at(0),
            tilt: values.number_at(1),
            eta: values.number_at(2),
            sigma_a: values.get_at(3),
            diffuse: values.number_at(5),
            diffuse_color: values.get_at(6),
        }
    }
}

impl Parameters for DEonParams {
    const FIELDS: &'static [Field] = &[
        Field::new(
            "roughness",
            Kind::Number,
            ROUGHNESS,
            "Roughness of the surface.",
        )
        .log_uniform(0.1, 0.6)
        .narrow(0.02),
        Field::new("tilt", Kind::Number, TILT, "Tilt of the cuticle's scales.")
            .radians()
            .uniform(-5.0, 5.0)
            .degrees()
            .optional(),
        Field::new("eta", Kind::Number, INDEX, "Index of refraction.")
            .uniform(1.3, 1.7)
            .optional(),
        Field::new(
            "sigma_a",
            Kind::Rgb,
            Rule::NotNegative,
            "Absorption per fibre radius.",
        )
        .log_uniform(0.05, 5.0),
        Field::new(
            "melanin",
            Kind::Numbers(&["eumelanin", "pheomelanin"]),
            Rule::NotNegative,
            "Concentrations of both pigments.",
        )
        .instead_of("sigma_a"),
        DIFFUSE_FIELDS[0],
        DIFFUSE_FIELDS[1],
    ];
    const PRESETS: &'static [(&'static str, Self)] = &Self::presets();

    #[inline]
    fn values(&self) -> Values {
        let d = self.desc();
        Values::none(Self::FIELDS)
            .with("roughness", &[d.roughness])
            .with("tilt", &[d.tilt])
            .with("eta", &[d.eta])
            .with("sigma_a", &d.sigma_a)
            .with("diffuse", &[d.diffuse])
            .with("diffuse_color", &d.diffuse_color)
    }

    #[inline]
    fn from_values(values: &Values) -> Result<Self, ParamError> {
        let desc = DEonDesc::of_values(values);
        let desc = if values.has("melanin") {
            let [eumelanin, pheomelanin] = values.get("melanin");
            desc.with_melanin(eumelanin, pheomelanin)?
        } else {
            desc
        };
        Self::new(&desc)
    }

    #[inline]
    fn chain(values: &Values, by_kept: &Values<f64>) -> Values<f64> {
        if values.has("melanin") {
            let by = by_melanin(&Pigments::D_EON, by_kept.get_at(3));
            return by_kept.with("melanin", &by);
        }
        *by_kept
    }

    /// Checks `factor` and returns the fibre unchanged, because it returns no more light than it receives.
    #[inline]
    fn scaled(&self, factor: f32) -> Result<Self, ParamError> {
        Rule::NotNegative.check("factor", &[factor])?;
        Ok(*self)
    }
}

impl Registered for DEon {
    const NAME: &'static str = "d-eon";
    const MODEL: Self = Self;
    const COLORS: Option<&'static str> = Some("attenuation");

    #[inline]
    fn constants<W: Precision>(values: &Values<W::Lane>) -> DEonMaterial<W::Lane> {
        DEonMaterial::new::<W>(&DEonDesc::of_values(values))
    }
}
