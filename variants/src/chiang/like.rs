//! Parameters of other renderers, and the fibre that they describe.

use super::params::{INDEX, ROUGHNESS, SHARE, root};
use super::{ChiangDesc, ChiangParams};
use crate::{Field, Kind, Values};
use core::f32::consts::PI;
use hairis::ParamError;
use hairis::model::Precision;
use hairis::params::{Pigments, Rule};

/// Renderer whose parameters of hair describe this fibre, by the names and with the conventions of that renderer.
///
#[doc = include_str!("../guide/renderers.md")]
///
/// - Source: `bsdf_hair_chiang_setup` and its node in Cycles 4, `mx_chiang_hair_bsdf.glsl` of `MaterialX` 1.39,
///   `bsdf_physicalhair_impl.h` of OSL, and the documentation of pbrt-v4 and Mitsuba 3.
///
/// ```
/// use hairis_variants::{ChiangParams, chiang::Likeness};
/// let cycles = Likeness::find("cycles").expect("in the table");
/// let values = cycles.defaults().with("roughness", &[0.2]).with("coat", &[0.5]);
/// let hair: ChiangParams = cycles.params(&values)?;
/// assert!(hair.desc().width_m[0] < 0.5); // a coat narrows R alone
/// # Ok::<(), hairis::ParamError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Likeness {
    /// Name of the renderer.
    pub name: &'static str,
    /// Parameters of the renderer by their names, in the order of files.
    pub fields: &'static [Field],
    /// Sets the renderer's defaults.
    set: fn(Values) -> Values,
    /// Converts values of the fields, which obey their rules.
    convert: fn(&Values) -> Result<ChiangDesc, ParamError>,
}

impl Likeness {
    /// Every renderer of the table.
    pub const ALL: &'static [Self] = &[
        Self {
            name: "cycles",
            fields: CYCLES,
            set: |values| {
                values
                    .with("roughness", &[0.3])
                    .with("radial_roughness", &[0.3])
                    .with("offset", &[2.0 * PI / 180.0])
                    .with("ior", &[1.55])
                    .with("random", &[0.5])
                    .with("melanin", &[0.8])
                    .with("melanin_redness", &[1.0])
                    .with("tint", &[1.0; 3])
            },
            convert: cycles,
        },
        Self {
            name: "materialx",
            fields: MATERIALX,
            set: |values| {
                values
                    .with("longitudinal", &[0.1])
                    .with("azimuthal", &[0.2])
                    .with("scale_TT", &[0.5])
                    .with("scale_TRT", &[2.0])
                    .with("cuticle_angle", &[0.5])
                    .with("ior", &[1.55])
                    .with("absorption_coefficient", &[0.0; 3])
                    .with("tint_R", &[1.0; 3])
                    .with("tint_TT", &[1.0; 3])
                    .with("tint_TRT", &[1.0; 3])
                    .with("eumelanin_color", &Pigments::D_EON.colors()[0])
                    .with("pheomelanin_color", &Pigments::D_EON.colors()[1])
            },
            convert: materialx,
        },
        Self {
            name: "osl",
            fields: OSL,
            set: |values| {
                values
                    .with("IOR", &[1.55])
                    .with("R_tint", &[1.0; 3])
                    .with("TT_tint", &[1.0; 3])
                    .with("TRT_tint", &[1.0; 3])
            },
            convert: osl,
        },
        Self {
            name: "pbrt",
            fields: PBRT,
            set: |values| {
                values
                    .with("beta_m", &[0.3])
                    .with("beta_n", &[0.3])
                    .with("alpha", &[2.0])
                    .with("eta", &[1.55])
                    .with("eumelanin", &[1.3])
            },
            convert: pbrt,
        },
        Self {
            name: "mitsuba",
            fields: MITSUBA,
            set: |values| {
                values
                    .with("longitudinal_roughness", &[0.3])
                    .with("azimuthal_roughness", &[0.3])
                    .with("scale_tilt", &[2.0])
                    .with("int_ior", &[1.55])
                    .with("ext_ior", &[1.000_277])
                    .with("eumelanin", &[1.3])
                    .with("pheomelanin", &[0.2])
            },
            convert: mitsuba,
        },
    ];

    /// Finds a renderer by its name.
    #[inline]
    #[must_use]
    pub fn find(name: &str) -> Option<&'static Self> {
        Self::ALL.iter().find(|one| one.name == name)
    }

    /// Returns the renderer's defaults. Fields that the renderer has no default for are not set, and are 0.
    #[inline]
    #[must_use]
    pub fn defaults(&self) -> Values {
        (self.set)(Values::none(self.fields))
    }

    /// Returns the fibre that values of the fields describe.
    ///
    /// # Errors
    ///
    /// Returns an error for the first value outside its range, or for the field of [`ChiangDesc`] whose range the fibre exceeds.
    ///
    /// # Panics
    ///
    /// Panics if the values belong to other fields.
    #[inline(never)]
    pub fn params(&self, values: &Values) -> Result<ChiangParams, ParamError> {
        for field in self.fields.iter().filter(|field| values.has(field.name)) {
            if let Some(rule) = field.rule {
                rule.check(field.name, values.numbers(field.name))?;
            }
        }
        ChiangParams::new(&(self.convert)(values)?)
    }
}

/// Tilts that every renderer of the table accepts, in degrees.
const DEGREES: Rule = Rule::Range([-45.0, 45.0]);
/// Angle of a cuticle in radians.
const ANGLE: Rule = super::params::TILT;

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

const CYCLES: &[Field] = &[
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
fn cycles(values: &Values) -> Result<ChiangDesc, ParamError> {
    let one = |name: &str| values.get::<1>(name)[0];
    let varied = |share: &str| 1.0 + 2.0 * (one("random") - 0.5) * one(share);
    let clamp = |roughness: f32| roughness.clamp(1e-3, 1.0);
    let factor = varied("random_roughness");
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
        return desc.with_color(values.get("color"));
    }
    if values.has("absorption_coefficient") {
        return Ok(ChiangDesc {
            sigma_a: values.get("absorption_coefficient"),
            ..desc
        });
    }
    let melanin = (one("melanin") * varied("random_color")).clamp(0.0, 1.0);
    let pigment = desc.with_melanin_amount(melanin, one("melanin_redness"))?;
    let dye = desc.with_color(values.get("tint"))?;
    Ok(ChiangDesc {
        sigma_a: [0, 1, 2].map(|c| pigment.sigma_a[c] + dye.sigma_a[c]),
        ..desc
    })
}

const MATERIALX: &[Field] = &[
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
    number(
        "cuticle_angle",
        super::params::CUTICLE,
        "Angle of the cuticle's scales.",
    )
    .optional(),
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
fn materialx(values: &Values) -> Result<ChiangDesc, ParamError> {
    let one = |name: &str| values.get::<1>(name)[0];
    let colors = ["eumelanin_color", "pheomelanin_color"].map(|name| values.get(name));
    let desc = ChiangDesc {
        beta_m: one("longitudinal"),
        beta_n: one("azimuthal"),
        eta: one("ior"),
        tint_r: values.get("tint_R"),
        tint_tt: values.get("tint_TT"),
        tint_trt: values.get("tint_TRT"),
        width_m: [1.0, one("scale_TT"), one("scale_TRT")],
        sigma_a: values.get("absorption_coefficient"),
        ..ChiangDesc::default().with_cuticle_angle(one("cuticle_angle"))?
    };
    if values.has("melanin") {
        let [concentration, redness] = values.get("melanin");
        let desc = desc.with_pigments(Pigments::from_colors(colors)?);
        return desc.with_melanin_amount(concentration, redness);
    }
    if values.has("color") {
        return desc.with_color(values.get("color"));
    }
    Ok(desc)
}

const OSL: &[Field] = &[
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
    number(
        "scattering",
        Rule::Range([0.0, 0.0]),
        "Medulla, which widens lobes by wo.",
    )
    .optional(),
    number("offset", ANGLE, "Angle of the cuticle's scales.")
        .radians()
        .optional(),
    index("IOR"),
    absorption("absorption"),
    share("R_tint", "Tint of R.").optional(),
    share("TT_tint", "Tint of TT.").optional(),
    share("TRT_tint", "Tint of TRT.").optional(),
];

/// The closure without `scattering`. Its tint of TRT leaves the rest as it is, whereas the rest here has the tint of TRT.
fn osl(values: &Values) -> Result<ChiangDesc, ParamError> {
    let one = |name: &str| values.get::<1>(name)[0];
    let [tt, all] = ["troughness", "lroughness"].map(|name| root(f64::from(one(name))));
    Ok(ChiangDesc {
        beta_m: one("lroughness"),
        beta_n: one("aroughness"),
        tilt: -one("offset"),
        eta: one("IOR"),
        sigma_a: values.get("absorption"),
        tint_r: values.get("R_tint"),
        tint_tt: values.get("TT_tint"),
        tint_trt: values.get("TRT_tint"),
        width_m: [1.0, (0.5 * tt / all).rounded(), 2.0],
        ..ChiangDesc::default()
    })
}

const PBRT: &[Field] = &[
    roughness("beta_m"),
    azimuthal_roughness("beta_n"),
    tilt("alpha"),
    index("eta"),
    absorption("sigma_a"),
    EUMELANIN,
    share("reflectance", "Colour of a mass of such hair.").instead_of("sigma_a"),
    PHEOMELANIN,
];

fn pbrt(values: &Values) -> Result<ChiangDesc, ParamError> {
    let one = |name: &str| values.get::<1>(name)[0];
    let desc = ChiangDesc {
        beta_m: one("beta_m"),
        beta_n: one("beta_n"),
        tilt: -one("alpha") * (PI / 180.0),
        eta: one("eta"),
        sigma_a: values.get("sigma_a"),
        ..ChiangDesc::default()
    };
    if values.has("eumelanin") {
        return desc.with_melanin(one("eumelanin"), one("pheomelanin"));
    }
    if values.has("reflectance") {
        return desc.with_color(values.get("reflectance"));
    }
    Ok(desc)
}

const MITSUBA: &[Field] = &[
    roughness("longitudinal_roughness"),
    azimuthal_roughness("azimuthal_roughness"),
    tilt("scale_tilt"),
    number("int_ior", INDEX, "Index of refraction inside.").optional(),
    number("ext_ior", INDEX, "Index of refraction outside.").optional(),
    absorption("sigma_a"),
    EUMELANIN,
    PHEOMELANIN,
];

fn mitsuba(values: &Values) -> Result<ChiangDesc, ParamError> {
    let one = |name: &str| values.get::<1>(name)[0];
    let desc = ChiangDesc {
        beta_m: one("longitudinal_roughness"),
        beta_n: one("azimuthal_roughness"),
        tilt: -one("scale_tilt") * (PI / 180.0),
        eta: one("int_ior") / one("ext_ior"),
        sigma_a: values.get("sigma_a"),
        ..ChiangDesc::default()
    };
    if values.has("eumelanin") {
        return desc.with_melanin(one("eumelanin"), one("pheomelanin"));
    }
    Ok(desc)
}
