//! Parameters of Kajiya and Kay's model: the description, its checks and the presets.

use core::f32::consts::{LN_2, PI};
use hairis::ParamError;
use hairis::model::Precision;
use hairis::params::Rule;

/// Range of accepted exponents.
pub(super) const EXPONENT: Rule = Rule::Range(EXPONENTS);
const EXPONENTS: [f32; 2] = [1.0, 1e4];
/// Range of accepted half widths of the highlight, in degrees, which corresponds to the range of exponents.
const WIDTHS: Rule = Rule::Degrees([0.675, 60.0]);

/// Form of the highlight, which decides how it depends on the inclination of the light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "kebab-case")
)]
pub enum Form {
    /// Reciprocal form: `S` is a function of `theta_i + theta_o` alone. The irradiance of the light falls as `cos theta_i`.
    #[default]
    Reciprocal,
    /// Form of the publication, which is not reciprocal: `S` has a factor `1 / cos theta_i`, so that the highlight is as bright under
    /// grazing light as in the publication.
    Published,
}

/// Unchecked parameters of the model of Kajiya & Kay 1989. Set the fields that differ from the default, and pass the description to
/// [`KajiyaKayParams::new`].
///
/// - Units: `kd` and `ks` are linear RGB albedos at `theta_o = 0`, so that a material with `kd + ks <= 1` never gains energy. The
///   constants of the publication are not normalised: `kd` is `pi^2` times the published constant, and `ks` is
///   `2 pi B(exponent + 1)` times the published constant, with `B(n)` the integral of `cos^n` over `[-pi/2, pi/2]`.
/// - Default: grey hair with a `kd` of .3, a `ks` of .2 and an exponent of 80.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct KajiyaKayDesc<T = f32> {
    /// Diffuse albedo, linear RGB, each finite and at least 0.
    pub kd: [T; 3],
    /// Specular albedo at `theta_o = 0`, linear RGB, each finite and at least 0.
    pub ks: [T; 3],
    /// Exponent of the highlight, in `[1, 1e4]`.
    pub exponent: T,
    /// Form of the highlight, reciprocal by default.
    #[cfg_attr(feature = "serde", serde(default))]
    pub form: Form,
}

impl<T: Copy> KajiyaKayDesc<T> {
    /// Converts every number of the description, for instance to another precision.
    #[inline]
    #[must_use]
    pub fn map<U>(&self, convert: impl Fn(T) -> U) -> KajiyaKayDesc<U> {
        KajiyaKayDesc {
            kd: self.kd.map(&convert),
            ks: self.ks.map(&convert),
            exponent: convert(self.exponent),
            form: self.form,
        }
    }
}

impl KajiyaKayDesc {
    const DEFAULT: Self = Self {
        kd: [0.3; 3],
        ks: [0.2; 3],
        exponent: 80.0,
        form: Form::Reciprocal,
    };

    /// Sets the exponent that gives the highlight this half width at half height in `theta_i + theta_o`.
    ///
    /// `exponent = -ln 2 / ln cos width`
    ///
    /// # Errors
    ///
    /// Returns an error if `width_deg` is outside `[0.675, 60]` degrees.
    ///
    /// ```
    /// use hairis_variants::KajiyaKayDesc;
    /// let glossy = KajiyaKayDesc::default().with_width_deg(7.531)?;
    /// assert!((glossy.exponent - 80.0).abs() < 0.1 && (glossy.width_deg() - 7.531).abs() < 1e-4);
    /// # Ok::<(), hairis::ParamError>(())
    /// ```
    #[inline]
    pub fn with_width_deg(self, width_deg: f32) -> Result<Self, ParamError> {
        WIDTHS.check("width_deg", &[width_deg])?;
        // ln cos w = ln(1 - 2 sin^2(w/2)), which loses no digits for a narrow highlight.
        let sin = libm::sinf(0.5 * width_deg * PI / 180.0);
        let exponent = -LN_2 / libm::log1pf(-2.0 * sin * sin);
        Ok(Self {
            exponent: exponent.clamp(EXPONENTS[0], EXPONENTS[1]),
            ..self
        })
    }

    /// Returns the half width of the highlight at half height in `theta_i + theta_o`, in degrees: `acos(2^(-1 / exponent))`.
    #[inline]
    #[must_use]
    pub fn width_deg(&self) -> f32 {
        // 1 - 2^(-1/p) = 2 sin^2(w/2).
        let drop = -libm::expm1f(-LN_2 / self.exponent);
        2.0 * libm::asinf(libm::sqrtf(0.5 * drop)) * 180.0 / PI
    }
}

/// Returns the integral of `cos^n` over `[-pi/2, pi/2]`, which is `sqrt(pi) gamma(n/2 + 1/2) / gamma(n/2 + 1)`.
///
/// - Domain: `n` above -1; in single precision, `n` from 1.
///
/// ```
/// use hairis_variants::kajiya_kay::cosine_integral;
/// assert!((cosine_integral(1.0) - 2.0).abs() < 1e-12);
/// ```
#[inline]
#[must_use]
pub fn cosine_integral<W: Precision>(n: W) -> W {
    let half = W::constant(0.5) * n;
    W::constant(libm::sqrt(core::f64::consts::PI)) * half.half_gamma_ratio()
}

impl Default for KajiyaKayDesc {
    #[inline]
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Parameters of Kajiya and Kay's model that have passed all checks.
///
/// ```
/// use hairis_variants::{KajiyaKayDesc, KajiyaKayParams};
/// let refused = KajiyaKayParams::new(&KajiyaKayDesc { exponent: 0.5, ..KajiyaKayDesc::default() });
/// assert_eq!(refused.unwrap_err().to_string(), "exponent must be in [1, 10000], got 0.5");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "KajiyaKayDesc", into = "KajiyaKayDesc")
)]
pub struct KajiyaKayParams(KajiyaKayDesc);

const BLOND: KajiyaKayParams = look([0.5, 0.36, 0.2], [0.16, 0.14, 0.11], 60.0);
const BROWN: KajiyaKayParams = look([0.14, 0.08, 0.045], [0.12, 0.11, 0.1], 80.0);
const RED: KajiyaKayParams = look([0.26, 0.085, 0.035], [0.13, 0.1, 0.08], 70.0);
const BLACK: KajiyaKayParams = look([0.015, 0.012, 0.01], [0.09, 0.09, 0.09], 120.0);
const WHITE: KajiyaKayParams = look([0.68, 0.66, 0.63], [0.18, 0.18, 0.18], 40.0);

const fn look(kd: [f32; 3], ks: [f32; 3], exponent: f32) -> KajiyaKayParams {
    KajiyaKayParams(KajiyaKayDesc {
        kd,
        ks,
        exponent,
        form: Form::Reciprocal,
    })
}

/// Presets, whose looks are this project's own. In each of them `kd + ks` is below 1 in every channel, so that none gains energy.
impl KajiyaKayParams {
    /// Checks `desc` and makes parameters of the model from it.
    ///
    /// # Errors
    ///
    /// Returns an error for the first field outside its range (see [`KajiyaKayDesc`]), with its value; NaN and infinities are always
    /// rejected. A sum `kd + ks` above 1 is accepted, although the material then gains energy.
    #[inline]
    pub fn new(desc: &KajiyaKayDesc) -> Result<Self, ParamError> {
        Rule::NotNegative.check("kd", &desc.kd)?;
        Rule::NotNegative.check("ks", &desc.ks)?;
        EXPONENT.check("exponent", &[desc.exponent])?;
        Ok(Self(*desc))
    }

    /// Returns the description with the values that were checked.
    #[inline]
    #[must_use]
    pub const fn desc(&self) -> &KajiyaKayDesc {
        &self.0
    }

    /// Multiplies both albedos by `factor`, and leaves the highlight's shape as it is.
    ///
    /// # Errors
    ///
    /// Returns an error if `factor` is negative or not finite, or if a product overflows.
    #[inline]
    pub fn scaled(&self, factor: f32) -> Result<Self, ParamError> {
        Rule::NotNegative.check("factor", &[factor])?;
        let times = |rgb: [f32; 3]| rgb.map(|c| c * factor);
        Self::new(&KajiyaKayDesc {
            kd: times(self.0.kd),
            ks: times(self.0.ks),
            ..self.0
        })
    }

    /// Returns the preset of blond hair, with a highlight of 8.7 degrees.
    #[inline]
    #[must_use]
    pub const fn blond() -> Self {
        BLOND
    }

    /// Returns the preset of brown hair, with a highlight of 7.5 degrees.
    #[inline]
    #[must_use]
    pub const fn brown() -> Self {
        BROWN
    }

    /// Returns the preset of red hair, with a highlight of 8.0 degrees.
    #[inline]
    #[must_use]
    pub const fn red() -> Self {
        RED
    }

    /// Returns the preset of black hair, with a highlight of 6.2 degrees on hardly any diffuse light.
    #[inline]
    #[must_use]
    pub const fn black() -> Self {
        BLACK
    }

    /// Returns the preset of white hair, with a highlight of 10.6 degrees.
    #[inline]
    #[must_use]
    pub const fn white() -> Self {
        WHITE
    }

    /// Returns every preset with its name, for menus and test grids.
    #[inline]
    #[must_use]
    pub const fn presets() -> [(&'static str, Self); 6] {
        [
            ("default", Self(KajiyaKayDesc::DEFAULT)),
            ("blond", BLOND),
            ("brown", BROWN),
            ("red", RED),
            ("black", BLACK),
            ("white", WHITE),
        ]
    }
}

impl Default for KajiyaKayParams {
    #[inline]
    fn default() -> Self {
        Self(KajiyaKayDesc::DEFAULT)
    }
}

#[cfg(feature = "serde")]
impl TryFrom<KajiyaKayDesc> for KajiyaKayParams {
    type Error = ParamError;

    #[inline]
    fn try_from(desc: KajiyaKayDesc) -> Result<Self, ParamError> {
        Self::new(&desc)
    }
}

#[cfg(feature = "serde")]
impl From<KajiyaKayParams> for KajiyaKayDesc {
    #[inline]
    fn from(params: KajiyaKayParams) -> Self {
        params.0
    }
}
