//! Parameters of d'Eon's far field: the description, its checks and the presets.

use crate::with_diffuse::check_diffuse;
use core::f32::consts::{FRAC_PI_4, PI};
use hairis::ParamError;
use hairis::params::{Pigments, Rule, melanin_absorption};

/// Range of accepted roughnesses.
pub(super) const ROUGHNESS: Rule = Rule::Range([1e-2, 1.0]);
/// Range of accepted tilts of the cuticle, in radians.
pub(super) const TILT: Rule = Rule::Range([-FRAC_PI_4, FRAC_PI_4]);
/// Range of accepted indices of refraction. At an index of 1, TT would be a line.
pub(super) const INDEX: Rule = Rule::Range([1.1, 3.0]);

/// Unchecked parameters of d'Eon's far field. Set the fields that differ from the default, and pass the description to
/// [`DEonParams::new`].
///
/// - Default: warm brown hair (eumelanin 1.3, pheomelanin .2), a `roughness` of .2, a tilt of 2 degrees, an `eta` of 1.55.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        deny_unknown_fields,
        bound(deserialize = "T: Copy + From<f32> + serde::Deserialize<'de>")
    )
)]
pub struct DEonDesc<T = f32> {
    /// Roughness of the surface, in `[.01, 1]`, which gives every lobe its widths.
    pub roughness: T,
    /// Tilt of the cuticle's scales, rad in `[-pi/4, pi/4]`. Positive moves the primary highlight towards the root.
    pub tilt: T,
    /// Index of refraction, in `[1.1, 3]`.
    pub eta: T,
    /// Absorption per fibre radius, linear RGB, each finite and at least 0.
    pub sigma_a: [T; 3],
    /// Share of the light that the diffuse lobe takes from the other lobes, in `[0, 1]`.
    #[cfg_attr(feature = "serde", serde(default = "no_diffuse"))]
    pub diffuse: T,
    /// Colour of the diffuse lobe, linear RGB in `[0, 1]`.
    #[cfg_attr(feature = "serde", serde(default = "white"))]
    pub diffuse_color: [T; 3],
}

#[cfg(feature = "serde")]
fn no_diffuse<T: From<f32>>() -> T {
    DEonDesc::DEFAULT.diffuse.into()
}

#[cfg(feature = "serde")]
fn white<T: From<f32>>() -> [T; 3] {
    DEonDesc::DEFAULT.diffuse_color.map(T::from)
}

impl<T: Copy> DEonDesc<T> {
    /// Converts every number of the description, for instance to another precision.
    #[inline]
    #[must_use]
    pub fn map<U>(&self, convert: impl Fn(T) -> U) -> DEonDesc<U> {
        DEonDesc {
            roughness: convert(self.roughness),
            tilt: convert(self.tilt),
            eta: convert(self.eta),
            sigma_a: self.sigma_a.map(&convert),
            diffuse: convert(self.diffuse),
            diffuse_color: self.diffuse_color.map(&convert),
        }
    }
}

impl DEonDesc {
    const DEFAULT: Self = Self::look(1.3, 0.2);

    /// Returns the default with this melanin, for use in constants.
    const fn look(eumelanin: f32, pheomelanin: f32) -> Self {
        Self {
            roughness: 0.2,
            tilt: 2.0 * PI / 180.0,
            eta: 1.55,
            sigma_a: melanin_absorption([eumelanin, pheomelanin]),
            diffuse: 0.0,
            diffuse_color: [1.0; 3],
        }
    }

    /// Sets the absorption of these concentrations of d'Eon's pigments: see [`Pigments::absorption`].
    ///
    /// # Errors
    ///
    /// Returns an error if a concentration is negative or not finite.
    #[inline]
    pub fn with_melanin(self, eumelanin: f32, pheomelanin: f32) -> Result<Self, ParamError> {
        let melanin = [eumelanin, pheomelanin];
        Rule::NotNegative.check("melanin", &melanin)?;
        let sigma_a = Pigments::D_EON.absorption(melanin);
        Ok(Self {
            sigma_a: sigma_a.map(|c| c.min(f32::MAX)),
            ..self
        })
    }
}

impl Default for DEonDesc {
    #[inline]
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Parameters of d'Eon's far field that have passed all checks.
///
/// ```
/// use hairis_variants::{DEonDesc, DEonParams};
/// let refused = DEonParams::new(&DEonDesc { roughness: 0.0, ..DEonDesc::default() });
/// assert_eq!(refused.unwrap_err().to_string(), "roughness must be in [0.01, 1], got 0");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "DEonDesc", into = "DEonDesc")
)]
pub struct DEonParams(DEonDesc);

impl DEonParams {
    /// Checks `desc` and makes parameters of the model from it.
    ///
    /// # Errors
    ///
    /// Returns an error for the first field outside its range (see [`DEonDesc`]), with its value; NaN and infinities are always rejected.
    #[inline]
    pub fn new(desc: &DEonDesc) -> Result<Self, ParamError> {
        ROUGHNESS.check("roughness", &[desc.roughness])?;
        TILT.check("tilt", &[desc.tilt])?;
        INDEX.check("eta", &[desc.eta])?;
        Rule::NotNegative.check("sigma_a", &desc.sigma_a)?;
        check_diffuse(desc.diffuse, &desc.diffuse_color)?;
        Ok(Self(*desc))
    }

    /// Returns the description with the values that were checked.
    #[inline]
    #[must_use]
    pub const fn desc(&self) -> &DEonDesc {
        &self.0
    }
}

/// Presets, which are the default with the melanin of d'Eon et al. 2011; the melanin of white hair is this project's own.
impl DEonParams {
    /// Returns the preset of blond hair, with .3 of eumelanin.
    #[inline]
    #[must_use]
    pub const fn blond() -> Self {
        Self(DEonDesc::look(0.3, 0.0))
    }

    /// Returns the preset of brown hair, with 1.3 of eumelanin.
    #[inline]
    #[must_use]
    pub const fn brown() -> Self {
        Self(DEonDesc::look(1.3, 0.0))
    }

    /// Returns the preset of red hair, with .25 of eumelanin and 1.1 of pheomelanin.
    #[inline]
    #[must_use]
    pub const fn red() -> Self {
        Self(DEonDesc::look(0.25, 1.1))
    }

    /// Returns the preset of black hair, with 8 of eumelanin.
    #[inline]
    #[must_use]
    pub const fn black() -> Self {
        Self(DEonDesc::look(8.0, 0.0))
    }

    /// Returns the preset of white hair, with .02 of eumelanin.
    #[inline]
    #[must_use]
    pub const fn white() -> Self {
        Self(DEonDesc::look(0.02, 0.0))
    }

    /// Returns every preset with its name, for menus and test grids.
    #[inline]
    #[must_use]
    pub const fn presets() -> [(&'static str, Self); 6] {
        [
            ("default", Self(DEonDesc::DEFAULT)),
            ("blond", Self::blond()),
            ("brown", Self::brown()),
            ("red", Self::red()),
            ("black", Self::black()),
            ("white", Self::white()),
        ]
    }
}

impl Default for DEonParams {
    #[inline]
    fn default() -> Self {
        Self(DEonDesc::DEFAULT)
    }
}

#[cfg(feature = "serde")]
impl TryFrom<DEonDesc> for DEonParams {
    type Error = ParamError;

    #[inline]
    fn try_from(desc: DEonDesc) -> Result<Self, ParamError> {
        Self::new(&desc)
    }
}

#[cfg(feature = "serde")]
impl From<DEonParams> for DEonDesc {
    #[inline]
    fn from(params: DEonParams) -> Self {
        params.0
    }
}
