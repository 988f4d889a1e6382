//! Registry entry of the energy-conserving fibre, and its parameters as fields.

use super::params::{INDEX, ROUGHNESS, SHARE, TILT};
use super::{Chiang, ChiangDesc, ChiangMaterial, ChiangParams, Shifts, stand_ins};
use crate::{Field, Kind, Parameters, Registered, Values};
use hairis::ParamError;
use hairis::model::Precision;
use hairis::params::Rule;
use hairis::simd::Lanes;

const SHIFTS: [(&str, Shifts); 2] = [("d-eon", Shifts::DEon), ("small-angle", Shifts::SmallAngle)];

impl Parameters for ChiangParams {
    const FIELDS: &'static [Field] = &[
        Field::new("beta_m", Kind::Number, ROUGHNESS, "Longitudinal roughness.")
            .log_uniform(0.1, 1.0)
            .narrow(0.02),
        Field::new("beta_n", Kind::Number, ROUGHNESS, "Azimuthal roughness.")
            .log_uniform(0.1, 1.0)
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
        Field::new(
            "melanin_amount",
            Kind::Numbers(&["amount", "redness"]),
            SHARE,
            "How dark and how red the pigment is.",
        )
        .instead_of("sigma_a"),
        Field::new("color", Kind::Rgb, SHARE, "Colour of a mass of such hair.")
            .instead_of("sigma_a"),
        Field::word(
            "shifts",
            Kind::Word(&[SHIFTS[0].0, SHIFTS[1].0]),
            "Formula of the lobes' shifts.",
        )
        .optional(),
    ];
    const PRESETS: &'static [(&'static str, Self)] = &Self::presets();

    #[inline]
    fn values(&self) -> Values {
        let d = self.desc();
        let shifts = SHIFTS
            .iter()
            .find(|(_, shifts)| *shifts == d.shifts)
            .map_or(SHIFTS[0].0, |(word, _)| word);
        Values::none(Self::FIELDS)
            .with("beta_m", &[d.beta_m])
            .with("beta_n", &[d.beta_n])
            .with("tilt", &[d.tilt])
            .with("eta", &[d.eta])
            .with("sigma_a", &d.sigma_a)
            .with_word("shifts", shifts)
    }

    #[inline]
    fn from_values(values: &Values) -> Result<Self, ParamError> {
        let word = values.word("shifts");
        let desc = ChiangDesc {
            beta_m: values.number_at(0),
            beta_n: values.number_at(1),
            tilt: values.number_at(2),
            eta: values.number_at(3),
            sigma_a: values.get_at(4),
            shifts: SHIFTS
                .iter()
                .find(|(one, _)| *one == word)
                .map_or(Shifts::default(), |(_, shifts)| *shifts),
        };
        let desc = if values.has("melanin") {
            let [eumelanin, pheomelanin] = values.get("melanin");
            desc.with_melanin(eumelanin, pheomelanin)?
        } else if values.has("melanin_amount") {
            let [amount, redness] = values.get("melanin_amount");
            desc.with_melanin_amount(amount, redness)?
        } else if values.has("color") {
            desc.with_color(values.get("color"))?
        } else {
            desc
        };
        Self::new(&desc)
    }

    #[inline]
    fn chain(values: &Values, by_kept: &Values<f64>) -> Values<f64> {
        let (mut by, by_absorption) = (*by_kept, by_kept.get_at(4));
        if values.has("melanin") {
            by = by.with("melanin", &stand_ins::by_melanin(by_absorption));
        } else if values.has("melanin_amount") {
            let amount = values.get("melanin_amount");
            let by_amount = stand_ins::by_melanin_amount(amount, by_absorption);
            by = by.with("melanin_amount", &by_amount);
        } else if values.has("color") {
            let (color, beta_n) = (values.get("color"), values.number_at(1));
            let (by_color, by_beta_n) = stand_ins::by_color(color, beta_n, by_absorption);
            by = by
                .with("beta_n", &[by_kept.number_at(1) + by_beta_n])
                .with("color", &by_color);
        }
        by
    }

    /// Checks `factor` and returns the fibre unchanged, because it returns no more light than it receives.
    #[inline]
    fn scaled(&self, factor: f32) -> Result<Self, ParamError> {
        Rule::NotNegative.check("factor", &[factor])?;
        Ok(*self)
    }
}

impl<const BY_CHANNEL: bool> Registered for Chiang<BY_CHANNEL> {
    const NAME: &'static str = "chiang";
    const CHOICE: Option<(&'static str, &'static str)> =
        Some(("select", if BY_CHANNEL { "by-channel" } else { "mean" }));
    const MODEL: Self = Self;
    const NEAR_FIELD: bool = true;
    const COLORS: Option<&'static str> = Some("attenuation");

    #[inline]
    fn constants<W: Precision>(values: &Values<W::Lane>) -> ChiangMaterial<W::Lane> {
        let [beta_m, beta_n, tilt, eta] = [0, 1, 2, 3].map(|index| values.number_at(index));
        let small_angle = W::Lane::splat(0.5).lt(values.number_at(8));
        ChiangMaterial::new::<W>([beta_m, beta_n, tilt, eta], values.get_at(4), small_angle)
    }
}
