//! Parameters of other renderers, and the fibre that they describe.

mod renderers;

use renderers::{
    CYCLES, MATERIALX, MITSUBA, OSL, PBRT, RTXCR, SCATTERING, cycles, materialx, mitsuba, osl,
    pbrt, rtxcr,
};

use super::{Chiang, ChiangDesc, ChiangParams, ScatteringChiang, ScatteringDesc, ScatteringParams};
use crate::{Field, ModelId, Parameters as _, Values};
use core::f32::consts::PI;
use hairis::ParamError;
use hairis::params::{Pigments, Rule};

/// Renderer whose parameters of hair describe this fibre, by the names and with the conventions of that renderer.
///
#[doc = include_str!("../guide/renderers.md")]
///
/// - Source: `bsdf_hair_chiang_setup` and its node in Cycles 4, `mx_chiang_hair_bsdf.glsl` of `MaterialX` 1.39,
///   `bsdf_physicalhair_impl.h` of OSL, `HairMaterial.hlsli` of RTXCR, and the documentation of pbrt-v4 and Mitsuba 3.
///
/// ```
/// use hairis_variants::{ChiangParams, chiang::Likeness};
/// let cycles = Likeness::find("cycles").expect("in the table");
/// let values = cycles.defaults().with("roughness", &[0.2]).with("coat", &[0.5]);
/// let hair: ChiangParams = cycles.params(&values)?.desc().fiber;
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
        Self {
            name: "rtxcr",
            fields: RTXCR,
            set: |values| values.with("melaninRedness", &[0.0]),
            convert: rtxcr,
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

    /// Returns the fibre that values of the fields describe. Only OSL's scatters.
    ///
    /// # Errors
    ///
    /// Returns an error for the first value outside its range, or for the field of [`ChiangDesc`] whose range the fibre exceeds.
    ///
    /// # Panics
    ///
    /// Panics if the values belong to other fields.
    #[inline]
    pub fn params(&self, values: &Values) -> Result<ScatteringParams, ParamError> {
        ScatteringParams::new(&ScatteringDesc {
            fiber: self.fiber(values)?,
            scattering: self.scattering(values),
        })
    }

    /// Returns the fibre that values of the fields describe as an entry of the registry with its values: Chiang's, or the fibre with a fake
    /// medulla if it scatters.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`params`](Self::params), and one for `scattering` if the registry has no entry for it, which the feature
    /// `every-sampler` adds.
    ///
    /// # Panics
    ///
    /// Panics if the values belong to other fields.
    #[inline(never)]
    pub fn entry(&self, values: &Values) -> Result<(ModelId, Values), ParamError> {
        let scattering = self.scattering(values);
        if cfg!(feature = "every-sampler") && scattering != 0.0 {
            let params = self.params(values)?;
            return Ok((ModelId::of::<ScatteringChiang>(), params.values()));
        }
        let fiber = self.fiber(values)?;
        Rule::Range([0.0, 0.0]).check(SCATTERING, &[scattering])?;
        Ok((ModelId::of::<Chiang>(), fiber.values()))
    }

    /// Returns the fibre without its scattering.
    #[inline(never)]
    fn fiber(&self, values: &Values) -> Result<ChiangParams, ParamError> {
        for field in self.fields.iter().filter(|field| values.has(field.name)) {
            if let Some(rule) = field.rule {
                rule.check(field.name, values.numbers(field.name))?;
            }
        }
        ChiangParams::new(&(self.convert)(values)?)
    }

    /// Returns the scattering, which is 0 where the renderer has none.
    fn scattering(&self, values: &Values) -> f32 {
        let scatters = self.fields.iter().any(|field| field.name == SCATTERING);
        if scatters {
            values.get::<1>(SCATTERING)[0]
        } else {
            0.0
        }
    }
}
