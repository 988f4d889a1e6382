//! Registry entry of the energy-conserving fibre, and its parameters as fields.

use super::params::{CUTICLE, INDEX, ROUGHNESS, SHARE, TILT, WIDTH};
use super::{Chiang, ChiangDesc, ChiangMaterial, ChiangParams, Shifts, stand_ins};
use crate::{Field, Kind, Parameters, Registered, Values};
use core::f64::consts::PI;
use hairis::ParamError;
use hairis::model::Precision;
use hairis::params::{Pigments, Rule, melanin_concentrations};
use hairis::simd::Lanes;

const SHIFTS: [(&str, Shifts); 2] = [("d-eon", Shifts::DEon), ("small-angle", Shifts::SmallAngle)];

const LOBES: Kind = Kind::Numbers(&["r", "tt", "trt"]);
/// Words of pigments for Rec. 709 and for `ACEScg`, and what they stand for.
const PIGMENTS: [&str; 4] = ["d-eon", "cycles", "d-eon-acescg", "cycles-acescg"];
const EUMELANIN: [&[f32]; 4] = [
    &Pigments::D_EON.eumelanin,
    &Pigments::CYCLES.eumelanin,
    &Pigments::D_EON_ACES_CG.eumelanin,
    &Pigments::CYCLES_ACES_CG.eumelanin,
];
const PHEOMELANIN: [&[f32]; 4] = [
    &Pigments::D_EON.pheomelanin,
    &Pigments::CYCLES.pheomelanin,
    &Pigments::D_EON_ACES_CG.pheomelanin,
    &Pigments::CYCLES_ACES_CG.pheomelanin,
];

impl ChiangDesc {
    /// Returns the description that the values of the fields form, in any type of number. Nothing is checked, no field stands in for
    /// another, and a word is that of [`Shifts::default`].
    ///
    /// # Panics
    ///
    /// Panics if the values belong to the fields of another model.
    #[inline]
    #[must_use]
    pub fn of_values<T: Copy>(values: &Values<T>) -> ChiangDesc<T> {
        let [beta_m, beta_n, tilt, eta] = [0, 1, 2, 3].map(|index| values.number_at(index));
        ChiangDesc {
            beta_m,
            beta_n,
            tilt,
            eta,
            sigma_a: values.get_at(4),
            shifts: Shifts::default(),
            tint_r: values.get_at(10),
            tint_tt: values.get_at(11),
            tint_trt: values.get_at(12),
            width_m: values.get_at(13),
            width_n: values.get_at(14),
            eumelanin: values.get_at(15),
            pheomelanin: values.get_at(16),
        }
    }
}

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
        Field::new(
            "cuticle_angle",
            Kind::Number,
            CUTICLE,
            "The tilt as MaterialX has it: pi (angle - 1/2) rad.",
        )
        .instead_of("tilt"),
        Field::new("tint_r", Kind::Rgb, SHARE, "Tint of R.").optional(),
        Field::new("tint_tt", Kind::Rgb, SHARE, "Tint of TT.").optional(),
        Field::new("tint_trt", Kind::Rgb, SHARE, "Tint of TRT and of the rest.").optional(),
        Field::new(
            "width_m",
            LOBES,
            WIDTH,
            "Longitudinal widths of the lobes, in widths of beta_m.",
        )
        .optional(),
        Field::new(
            "width_n",
            LOBES,
            WIDTH,
            "Azimuthal widths of the lobes, in widths of beta_n.",
        )
        .optional(),
        Field::new(
            "eumelanin",
            Kind::Rgb,
            Rule::NotNegative,
            "Absorption of a unit of eumelanin.",
        )
        .named(&PIGMENTS, &EUMELANIN)
        .optional(),
        Field::new(
            "pheomelanin",
            Kind::Rgb,
            Rule::NotNegative,
            "Absorption of a unit of pheomelanin.",
        )
        .named(&PIGMENTS, &PHEOMELANIN)
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
            .with("tint_r", &d.tint_r)
            .with("tint_tt", &d.tint_tt)
            .with("tint_trt", &d.tint_trt)
            .with("width_m", &d.width_m)
            .with("width_n", &d.width_n)
            .with("eumelanin", &d.eumelanin)
            .with("pheomelanin", &d.pheomelanin)
    }

    #[inline]
    fn from_values(values: &Values) -> Result<Self, ParamError> {
        let word = values.word("shifts");
        let desc = ChiangDesc {
            shifts: SHIFTS
                .iter()
                .find(|(one, _)| *one == word)
                .map_or(Shifts::default(), |(_, shifts)| *shifts),
            ..ChiangDesc::of_values(values)
        };
        let desc = if values.has("cuticle_angle") {
            let [angle] = values.get("cuticle_angle");
            desc.with_cuticle_angle(angle)?
        } else {
            desc
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
        let pigments = ChiangDesc::of_values(values).pigments();
        let mut by_melanin = |melanin: [f32; 2]| {
            let [eumelanin, pheomelanin] =
                melanin.map(|amount| by_absorption.map(|by| by * f64::from(amount)));
            by = by
                .with("eumelanin", &eumelanin)
                .with("pheomelanin", &pheomelanin);
        };
        if values.has("melanin") {
            by_melanin(values.get("melanin"));
            by = by.with("melanin", &stand_ins::by_melanin(&pigments, by_absorption));
        } else if values.has("melanin_amount") {
            let [amount, redness] = values.get("melanin_amount");
            // A legal amount is never refused.
            by_melanin(melanin_concentrations(amount, redness).unwrap_or_default());
            let by_amount =
                stand_ins::by_melanin_amount(&pigments, [amount, redness], by_absorption);
            by = by.with("melanin_amount", &by_amount);
        } else if values.has("color") {
            let (color, beta_n) = (values.get("color"), values.number_at(1));
            let (by_color, by_beta_n) = stand_ins::by_color(color, beta_n, by_absorption);
            by = by
                .with("beta_n", &[by_kept.number_at(1) + by_beta_n])
                .with("color", &by_color);
        }
        if values.has("cuticle_angle") {
            by = by.with("cuticle_angle", &[PI * by_kept.number_at(2)]);
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
        let small_angle = W::Lane::splat(0.5).lt(values.number_at(8));
        ChiangMaterial::new::<W>(&ChiangDesc::of_values(values), small_angle)
    }
}
