//! Fields of each renderer, and their conversions.

use crate::chiang::ChiangDesc;
use crate::chiang::params::{CUTICLE, INDEX, ROUGHNESS, SHARE, TILT, root, scale};
use crate::chiang::stand_ins::varied;
use crate::{Field, Kind, Values};
use core::f32::consts::PI;
use hairis::ParamError;
use hairis::model::Precision;
use hairis::params::{Pigments, Rule};

/// Tilts that every renderer of the table accepts, in degrees.
const DEGREES: Rule = Rule::Range([-45.0, 45.0]);
/// Angle of a cuticle in radians.
const ANGLE: Rule = TILT;

const fn number(name: &'static str, rule: Rule, doc: &'static str) -> Field {
    Field::new(name, Kind::Number, rule, doc)
}

const fn share(name: &'static str, doc: &'static str) -> Field {
    Field::new(name, Kind::Rgb, SHARE, doc)
}

const fn absorption(name: &'static str) -> Field {
    Field::new(
        name,
        Kind::Rgb,
        Rule::NotNegative,
        "Absorption per fibre radius.",
    )
}

const fn roughness(name: &'static str) -> Field {
    number(name, ROUGHNESS, "Longitudinal roughness.").optional()
}

const fn azimuthal_roughness(name: &'static str) -> Field {
    number(name, ROUGHNESS, "Azimuthal roughness.").optional()
}

const fn tilt(name: &'static str) -> Field {
    number(name, DEGREES, "Angle of the cuticle's scales, in degrees.").optional()
}

const fn index(name: &'static str) -> Field {
    number(name, INDEX, "Index of refraction.").optional()
}

/// Melanin of pbrt and Mitsuba, in place of the absorption.
const EUMELANIN: Field = number(
    "eumelanin",
    Rule::NotNegative,
    "Concentration of eumelanin.",
)
.instead_of("sigma_a");
const PHEOMELANIN: Field = number(
    "pheomelanin",
    Rule::NotNegative,
    "Concentration of pheomelanin.",
)
.optional();

/// Returns the value of a field of one number.
#[inline(never)]
fn number_of(values: &Values, name: &str) -> f32 {
    values.get::<1>(name)[0]
}

/// Returns the value of a field of a colour.
#[inline(never)]
fn color_of(values: &Values, name: &str) -> [f32; 3] {
    values.get(name)
}

pub(super) const CYCLES: &[Field] = &[
    roughness("roughness"),
    azimuthal_roughness("radial_roughness"),
    number("coat", SHARE, "How much smoother R is.").optional(),
    number("offset", ANGLE, "Angle of the cuticle's scales.")
        .radians()
        .optional(),
    index("ior"),
    number("random", SHARE, "Random number of the strand.").optional(),
    number(
        "random_roughness",
        SHARE,
        "Share of roughness that is random.",
    )
    .optional(),
    number("random_color", SHARE, "Share of melanin that is random.").optional(),
    absorption("absorption_coefficient"),
    number("melanin", SHARE, "Amount of melanin.").instead_of("absorption_coefficient"),
    share("color", "Colour of a mass of such hair.").instead_of("absorption_coefficient"),
    number("melanin_redness", SHARE, "Share of pheomelanin.").optional(),
    share("tint", "Colour of a dye over the melanin.").optional(),
];

/// The node with its parametrisation: `1 + 2 (random - 1/2) random_roughness` multiplies both roughnesses, and the same of
/// `random_color` melanin. `coat` multiplies the roughness of R by `1 - coat`. The offset is the `alpha` of pbrt.
pub(super) fn cycles(values: &Values) -> Result<ChiangDesc, ParamError> {
    let one = |name: &str| number_of(values, name);
    let clamp = |roughness: f32| roughness.clamp(1e-3, 1.0);
    let factor = varied(one("random"), one("random_roughness"));
    let beta_m = clamp(one("roughness") * factor);
    // In double precision, as every width.
    let [r, all] = [clamp((1.0 - one("coat")) * beta_m), beta_m].map(|m| root(f64::from(m)));
    let desc = ChiangDesc {
        beta_m,
        beta_n: clamp(one("radial_roughness") * factor),
        tilt: -one("offset"),
        eta: one("ior"),
        width_m: [(r / all).rounded(), 0.5, 2.0],
        ..ChiangDesc::default().with_pigments(Pigments::CYCLES)
    };
    if values.has("color") {
        return desc.with_color(color_of(values, "color"));
    }
    if values.has("absorption_coefficient") {
        return Ok(ChiangDesc {
            sigma_a: color_of(values, "absorption_coefficient"),
            ..desc
        });
    }
    let [melanin, redness] = ["melanin", "melanin_redness"].map(one);
    desc.with_random_melanin(melanin, redness, one("random_color"), one("random"))?
        .with_dye(color_of(values, "tint"))
}

pub(super) const MATERIALX: &[Field] = &[
    roughness("longitudinal"),
    azimuthal_roughness("azimuthal"),
    number(
        "scale_TT",
        Rule::NotNegative,
        "Longitudinal width of TT, in widths of R.",
    )
    .optional(),
    number(
        "scale_TRT",
        Rule::NotNegative,
        "Longitudinal width of TRT, in widths of R.",
    )
    .optional(),
    number("cuticle_angle", CUTICLE, "Angle of the cuticle's scales.").optional(),
    index("ior"),
    share("tint_R", "Tint of R.").optional(),
    share("tint_TT", "Tint of TT.").optional(),
    share("tint_TRT", "Tint of TRT and of the rest.").optional(),
    absorption("absorption_coefficient"),
    Field::new(
        "melanin",
        Kind::Numbers(&["concentration", "redness"]),
        SHARE,
        "Inputs of deon_hair_absorption_from_melanin.",
    )
    .instead_of("absorption_coefficient"),
    share("color", "Input of chiang_hair_absorption_from_color.")
        .instead_of("absorption_coefficient"),
    share("eumelanin_color", "Colour of a unit of eumelanin.").optional(),
    share("pheomelanin_color", "Colour of a unit of pheomelanin.").optional(),
];

/// The node with `chiang_hair_roughness` and one of the nodes for absorption.
pub(super) fn materialx(values: &Values) -> Result<ChiangDesc, ParamError> {
    let one = |name: &str| number_of(values, name);
    let colors = ["eumelanin_color", "pheomelanin_color"].map(|name| color_of(values, name));
    let desc = ChiangDesc {
        beta_m: one("longitudinal"),
        beta_n: one("azimuthal"),
        eta: one("ior"),
        tint_r: color_of(values, "tint_R"),
        tint_tt: color_of(values, "tint_TT"),
        tint_trt: color_of(values, "tint_TRT"),
        width_m: [1.0, one("scale_TT"), one("scale_TRT")],
        sigma_a: color_of(values, "absorption_coefficient"),
        ..ChiangDesc::default().with_cuticle_angle(one("cuticle_angle"))?
    };
    if values.has("melanin") {
        let [concentration, redness] = values.get("melanin");
        let desc = desc.with_pigments(Pigments::from_colors(colors)?);
        return desc.with_melanin_amount(concentration, redness);
    }
    if values.has("color") {
        return desc.with_color(color_of(values, "color"));
    }
    Ok(desc)
}

/// Field of OSL that no other renderer has.
pub(super) const SCATTERING: &str = "scattering";

pub(super) const OSL: &[Field] = &[
    number(
        "lroughness",
        ROUGHNESS,
        "Longitudinal roughness of R and TRT.",
    ),
    number("troughness", ROUGHNESS, "Longitudinal roughness of TT."),
    number(
        "aroughness",
        Rule::Range([0.01, 1.0]),
        "Azimuthal roughness.",
    ),
    number(SCATTERING, SHARE, "Fake medulla, which widens TT and TRT.").optional(),
    number("offset", ANGLE, "Angle of the cuticle's scales.")
        .radians()
        .optional(),
    index("IOR"),
    absorption("absorption"),
    share("R_tint", "Tint of R.").optional(),
    share("TT_tint", "Tint of TT.").optional(),
    share("TRT_tint", "Tint of TRT.").optional(),
];

/// The closure, whose `scattering` is that of [`ScatteringParams`]. Its tint of TRT leaves the rest as it is, whereas the rest here has the tint of TRT.
pub(super) fn osl(values: &Values) -> Result<ChiangDesc, ParamError> {
    let one = |name: &str| number_of(values, name);
    let [tt, all] = ["troughness", "lroughness"].map(|name| root(f64::from(one(name))));
    Ok(ChiangDesc {
        beta_m: one("lroughness"),
        beta_n: one("aroughness"),
        tilt: -one("offset"),
        eta: one("IOR"),
        sigma_a: color_of(values, "absorption"),
        tint_r: color_of(values, "R_tint"),
        tint_tt: color_of(values, "TT_tint"),
        tint_trt: color_of(values, "TRT_tint"),
        width_m: [1.0, (0.5 * tt / all).rounded(), 2.0],
        ..ChiangDesc::default()
    })
}

pub(super) const PBRT: &[Field] = &[
    roughness("beta_m"),
    azimuthal_roughness("beta_n"),
    tilt("alpha"),
    index("eta"),
    absorption("sigma_a"),
    EUMELANIN,
    share("reflectance", "Colour of a mass of such hair.").instead_of("sigma_a"),
    PHEOMELANIN,
];

pub(super) fn pbrt(values: &Values) -> Result<ChiangDesc, ParamError> {
    let one = |name: &str| number_of(values, name);
    let desc = ChiangDesc {
        beta_m: one("beta_m"),
        beta_n: one("beta_n"),
        tilt: -one("alpha") * (PI / 180.0),
        eta: one("eta"),
        sigma_a: color_of(values, "sigma_a"),
        ..ChiangDesc::default()
    };
    if values.has("eumelanin") {
        return desc.with_melanin(one("eumelanin"), one("pheomelanin"));
    }
    if values.has("reflectance") {
        return desc.with_color(color_of(values, "reflectance"));
    }
    Ok(desc)
}

pub(super) const MITSUBA: &[Field] = &[
    roughness("longitudinal_roughness"),
    azimuthal_roughness("azimuthal_roughness"),
    tilt("scale_tilt"),
    number("int_ior", INDEX, "Index of refraction inside.").optional(),
    number("ext_ior", INDEX, "Index of refraction outside.").optional(),
    absorption("sigma_a"),
    EUMELANIN,
    PHEOMELANIN,
];

pub(super) fn mitsuba(values: &Values) -> Result<ChiangDesc, ParamError> {
    let one = |name: &str| number_of(values, name);
    let desc = ChiangDesc {
        beta_m: one("longitudinal_roughness"),
        beta_n: one("azimuthal_roughness"),
        tilt: -one("scale_tilt") * (PI / 180.0),
        eta: one("int_ior") / one("ext_ior"),
        sigma_a: color_of(values, "sigma_a"),
        ..ChiangDesc::default()
    };
    if values.has("eumelanin") {
        return desc.with_melanin(one("eumelanin"), one("pheomelanin"));
    }
    Ok(desc)
}

pub(super) const RTXCR: &[Field] = &[
    number(
        "longitudinalRoughness",
        ROUGHNESS,
        "Longitudinal roughness.",
    ),
    number("azimuthalRoughness", ROUGHNESS, "Azimuthal roughness."),
    number("ior", INDEX, "Index of refraction."),
    number(
        "cuticleAngleInDegrees",
        DEGREES,
        "Angle of the cuticle's scales, in degrees.",
    ),
    share("baseColor", "Colour of a mass of such hair."),
    number("melanin", SHARE, "Amount of melanin.").instead_of("baseColor"),
    number("melaninRedness", SHARE, "Share of pheomelanin.").optional(),
    Field::word(
        "absorptionModel",
        Kind::Word(&["normalized", "physics"]),
        "Formula of the melanin.",
    )
    .optional(),
    roughness("longitudinalRoughnessTT"),
    roughness("longitudinalRoughnessTRT"),
    azimuthal_roughness("azimuthalRoughnessTT"),
    azimuthal_roughness("azimuthalRoughnessTRT"),
];

/// The fibre of Chiang, and with one of the last four fields the "separate" one, in which a lobe has the width of its own roughness. Its far
/// field is d'Eon's.
pub(super) fn rtxcr(values: &Values) -> Result<ChiangDesc, ParamError> {
    let one = |name: &str| number_of(values, name);
    let desc = ChiangDesc {
        beta_m: one("longitudinalRoughness"),
        beta_n: one("azimuthalRoughness"),
        tilt: -one("cuticleAngleInDegrees") * (PI / 180.0),
        eta: one("ior"),
        ..ChiangDesc::default().with_pigments(Pigments::CYCLES)
    };
    // In widths of R.
    let width = |of: fn(f64) -> f64, name: &str, all: f32, default: f32| {
        if values.has(name) {
            (of(f64::from(one(name))) / of(f64::from(all))).rounded()
        } else {
            default
        }
    };
    let (m, n, [_, tt, trt]) = (desc.beta_m, desc.beta_n, desc.width_m);
    let desc = ChiangDesc {
        width_m: [
            1.0,
            width(root, "longitudinalRoughnessTT", m, tt),
            width(root, "longitudinalRoughnessTRT", m, trt),
        ],
        width_n: [
            1.0,
            width(scale, "azimuthalRoughnessTT", n, 1.0),
            width(scale, "azimuthalRoughnessTRT", n, 1.0),
        ],
        ..desc
    };
    if !values.has("melanin") {
        return desc.with_color(color_of(values, "baseColor"));
    }
    let [melanin, redness] = ["melanin", "melaninRedness"].map(one);
    if values.word("absorptionModel") == "physics" {
        let quantity = 2.4 * melanin * melanin;
        return desc.with_melanin(quantity * (1.0 - redness), quantity * redness);
    }
    desc.with_melanin_amount(melanin, redness)
}
